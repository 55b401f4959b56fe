// SPIR-V reflection, run-time compilation and reload.
#include <algorithm>
#include <fstream>

#include "renderer/base/error.h"
#include "renderer/frame/frame.h"
#include "renderer/pipeline_use.h"
#include "shaders/embedded.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/light_kinds.h"
#include "shaders/shared/solve.h"
#include "tests/support.h"

namespace irad::test::shader_suite {
namespace {

const std::filesystem::path kRoot = sourceFolder();

std::vector<uint32_t> compileTest(const char* name) {
  return compileGlsl(kRoot / "shaders", (kRoot / "tests/shaders" / name).string());
}
void write(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

TEST(Reflection, LayoutBindingsAndWorkgroup) {
  const ShaderModule layout = reflect("layout.comp", compileTest("layout.comp"));
  EXPECT_EQ(layout.pushBytes, 80u);
  EXPECT_EQ(layout.addressOffsets, std::vector<uint32_t>{16});
  EXPECT_EQ(layout.localSize[1], 2u);
  EXPECT_EQ(layout.localSizeId[0], 3u);
  EXPECT_EQ(layout.localSizeId[1], UINT32_MAX);
  EXPECT_TRUE(layout.bindings.empty());
  bool push = false, inner = false;
  for (const ReflectedStruct& s : reflectStructs(layout.spirv)) {
    using Members = std::vector<std::pair<std::string, uint32_t>>;
    if (s.name == "Push") {
      push = true;
      EXPECT_EQ(s.members, (Members{{"direction", 0}, {"address", 16}, {"inner", 24}, {"matrix", 40}, {"last", 76}}));
      EXPECT_EQ(s.bytes, 80u);
    }
    if (s.name == "Inner") {
      inner = true;
      EXPECT_EQ(s.members, (Members{{"small", 0}, {"medium", 2}, {"value", 4}}));
      EXPECT_EQ(s.bytes, 8u);
    }
  }
  EXPECT_TRUE(push && inner);

  const ShaderModule image = reflect("image.comp", compileTest("image.comp"));
  EXPECT_EQ(image.localSize, (std::array<uint32_t, 3>{8, 8, 1}));
  ASSERT_EQ(image.bindings.size(), 2u);
  EXPECT_TRUE(image.bindings[0].storageImage);
  EXPECT_FALSE(image.bindings[1].storageImage);
  EXPECT_EQ(image.bindings[1].name, "source");
}

TEST(Reflection, EveryEmbeddedShaderIsReadable) {
  const ShaderLibrary library;
  for (const std::string& name : library.names()) EXPECT_LE(library.get(name).pushBytes, 128u) << name;
}

TEST(Reflection, AddressesAreFoundWithinStructsToo) {
  const ShaderLibrary library;
  // The facets' five arrays, the field, the hits, the surface, the two lists of rays that wait.
  EXPECT_EQ(library.get("gi/trace_rays.comp").addressOffsets,
            (std::vector<uint32_t>{0, 8, 16, 24, 32, 48, 56, 104, 112, 120}));
  EXPECT_EQ(library.get("raster/store_depth.comp").addressOffsets, std::vector<uint32_t>{0});
}

TEST(Reflection, NoShaderNeedsGeometryShaders) {
  // A capability that the device feature grants; gl_Layer and gl_PrimitiveID in a fragment shader ask for it, too.
  constexpr uint32_t kCapability = 17, kGeometry = 2;
  const ShaderLibrary library;
  for (const std::string& name : library.names()) {
    const std::vector<uint32_t>& spirv = library.get(name).spirv;
    for (size_t at = 5; at < spirv.size() && (spirv[at] & 0xFFFF) == kCapability; at += spirv[at] >> 16)
      EXPECT_NE(spirv.at(at + 1), kGeometry) << name;
  }
}

TEST(Reflection, UnknownShaderNamesNearOnes) {
  ShaderLibrary library;
  library.add("gi/test_solve.comp", compileTest("square.comp"));
  EXPECT_DEATH(library.get("gi/test_solv.comp"), "no shader 'gi/test_solv.comp'; near: gi/test_solve.comp");
}

TEST(Compile, EmbeddedAndRunTimeAgree) {
  // The same options on both paths: the first F5 without an edit changes nothing.
  ShaderLibrary library;
  const uint64_t generation = library.generation();
  const ShaderReload reload = library.reload(kRoot / "shaders");
  EXPECT_EQ(reload.errors, "");
  EXPECT_TRUE(reload.changed.empty()) << reload.changed.front();
  EXPECT_EQ(library.generation(), generation);
}

TEST(Compile, MessagesNameFileAndLine) {
  const TemporaryFolder folder;
  write(folder.path / "a.comp", "#version 460\nvoid main() {\n  undeclared = 1;\n}\n");
  try {
    compileGlsl(folder.path, "a.comp");
    FAIL();
  } catch (const WorkError& error) {
    EXPECT_NE(std::string(error.what()).find("a.comp:3"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("undeclared"), std::string::npos) << error.what();
  }
  EXPECT_THROW(compileGlsl(folder.path, "missing.comp"), WorkError);
}

using Reload = GpuTest;

TEST_F(Reload, BrokenShaderKeepsTheOldOnes) {
  const TemporaryFolder folder;
  const auto source = [](const char* value) {
    return fmt::format(
        "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"lib/value.glsl\"\n"
        "layout(local_size_x = 1) in;\nlayout(set = 0, binding = 0, r32ui) uniform uimage2D result;\n"
        "void main() {{ imageStore(result, ivec2(0), uvec4(VALUE + {})); }}\n",
        value);
  };
  write(folder.path / "lib/value.glsl", "#define VALUE 40\n");
  write(folder.path / "t/a.comp", source("1"));
  write(folder.path / "t/b.comp", source("2"));
  ShaderLibrary library;
  library.add("t/a.comp", compileGlsl(folder.path, "t/a.comp"));
  library.add("t/b.comp", compileGlsl(folder.path, "t/b.comp"));
  Timings timings;
  Context own(*gpu().device, library, timings);
  const Image result(own.device, {.name = "result", .format = VK_FORMAT_R32_UINT});
  const auto run = [&](const char* name) {
    Frame frame = own.begin();
    frame.pass("Run").shader(name).write(result).dispatch(1);
    frame.submitAndWait();
    return static_cast<int>(download(own, result)[0]);
  };
  EXPECT_EQ(run("t/a.comp"), 41);
  EXPECT_EQ(run("t/b.comp"), 42);

  // Nothing edited, or comments only: nothing is replaced.
  const uint64_t generation = library.generation();
  write(folder.path / "t/a.comp", source("1 /* as it was */"));
  ShaderReload reload = library.reload(folder.path);
  EXPECT_EQ(reload.errors, "");
  EXPECT_TRUE(reload.changed.empty());
  EXPECT_EQ(library.generation(), generation);

  // One good change and one mistake: neither is taken.
  write(folder.path / "t/a.comp", source("10"));
  write(folder.path / "t/b.comp", source("syntax error"));
  reload = library.reload(folder.path);
  EXPECT_NE(reload.errors.find("t/b.comp"), std::string::npos);
  EXPECT_TRUE(reload.changed.empty());
  EXPECT_EQ(library.generation(), generation);
  EXPECT_EQ(run("t/a.comp"), 41);
  EXPECT_EQ(run("t/b.comp"), 42);

  // Valid, but with a second image that the program does not know.
  std::string moved = source("imageLoad(other, ivec2(0)).x");
  moved.insert(moved.find("layout(set"), "layout(set = 0, binding = 1, r32ui) uniform uimage2D other;\n");
  write(folder.path / "t/b.comp", moved);
  EXPECT_NE(library.reload(folder.path).errors.find("t/b.comp: its images"), std::string::npos);
  EXPECT_EQ(run("t/a.comp"), 41);

  // Mended, with a changed header: both are taken.
  write(folder.path / "t/b.comp", source("20"));
  write(folder.path / "lib/value.glsl", "#define VALUE 100\n");
  reload = library.reload(folder.path);
  EXPECT_EQ(reload.errors, "");
  EXPECT_EQ(reload.changed, (std::vector<std::string>{"t/a.comp", "t/b.comp"}));
  EXPECT_GT(library.generation(), generation);
  EXPECT_EQ(run("t/a.comp"), 110);
  EXPECT_EQ(run("t/b.comp"), 120);

  EXPECT_NE(library.reload(folder.path / "nowhere").errors, "");
}

TEST(Constants, AreSetAndLeaveOutWhatTheySay) {
  const ShaderLibrary library;
  const ShaderModule& merge = library.get("gi/merge_rows.comp");
  const ShaderModule set = reflect(merge.name, withConstants(merge.spirv, {{CONSTANT_MERGE_WORKGROUP, 48}}));
  EXPECT_EQ(set.localSize[0], 48u);
  EXPECT_EQ(set.localSizeId, merge.localSizeId);
  const ShaderModule fixed = reflect(merge.name, specialized(merge.spirv, {{CONSTANT_MERGE_WORKGROUP, 48}}));
  EXPECT_EQ(fixed.localSize[0], 48u);
  EXPECT_EQ(fixed.localSizeId[0], UINT32_MAX);
  EXPECT_EQ(fixed.pushBytes, merge.pushBytes);

  // Without a kind of light there is nothing to look for.
  const std::vector<uint32_t>& seen = library.get("gi/direct_seen.comp").spirv;
  std::map<uint32_t, uint32_t> kinds;
  for (uint32_t kind = 0; kind < LIGHT_KINDS; ++kind) kinds[GATHER_LIGHTS + kind] = 0;
  const uint64_t all = functionInstructions(specialized(seen, {})),
                 none = functionInstructions(specialized(seen, kinds));
  EXPECT_LE(all, functionInstructions(seen));
  EXPECT_LT(none, all / 4);
}

TEST(Variants, AreTheirSourceWithADefinitionMore) {
  size_t variants = 0;
  const ShaderLibrary library;
  for (const EmbeddedShader& shader : embeddedShaders()) {
    if (shader.definition == std::string_view()) continue;
    ++variants;
    const std::vector<uint32_t> compiled = compileGlsl(kRoot / "shaders", shader.source, shader.definition);
    EXPECT_EQ(withoutDebugInfo(compiled), withoutDebugInfo(shader.spirv)) << shader.name;
    EXPECT_NE(withoutDebugInfo(shader.spirv), withoutDebugInfo(library.get(shader.source).spirv)) << shader.name;
    // Passes bind it whether or not a shader comes to read it: no optimizer may drop it.
    const auto volumes = std::ranges::count(library.get(shader.name).bindings, "jfaDistance", &ShaderBinding::name);
    EXPECT_EQ(volumes, contains(std::string(shader.definition), "TRACE_JFA_BINDING") ? 1 : 0) << shader.name;
  }
  EXPECT_GT(variants, 0u);
}

TEST(Variants, AreReloadedWithTheirSource) {
  const TemporaryFolder folder;
  const std::string name = "gi/trace_rays.comp";
  std::filesystem::copy(kRoot / "shaders", folder.path, std::filesystem::copy_options::recursive);
  for (const EmbeddedShader& shader : embeddedShaders())
    if (shader.source != name) std::filesystem::remove(folder.path / shader.source);
  ShaderLibrary library;
  ShaderReload reload = library.reload(folder.path);
  EXPECT_EQ(reload.errors, "");
  EXPECT_TRUE(reload.changed.empty());

  std::ifstream in(folder.path / name);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string row = "p.firstRow + ray";
  ASSERT_NE(text.find(row), std::string::npos);
  write(folder.path / name, text.replace(text.find(row), row.size(), "1u + " + row));
  reload = library.reload(folder.path);
  EXPECT_EQ(reload.errors, "");
  EXPECT_EQ(reload.changed, (std::vector<std::string>{name, "gi/trace_rays_jfa.comp"}));
}

}  // namespace
}  // namespace irad::test::shader_suite
