// The structs of shaders/shared, C++ against SPIR-V: every one's members, offsets and size.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "tests/shared_structs.h"
#include "tests/support.h"

namespace irad::test::layout_suite {
namespace {

namespace fs = std::filesystem;
const fs::path kRoot = sourceFolder();
const fs::path kShared = kRoot / "shaders/shared";
const std::string kProbe = "Probe_";

std::string read(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// A shader that has every struct in an array, by address: after two of them, `end`.
std::string probeSource(const std::vector<ReflectedStruct>& structs) {
  std::string blocks, uses;
  for (const ReflectedStruct& s : structs) {
    const std::string block = kProbe + s.name;
    blocks += fmt::format("layout(buffer_reference, scalar) buffer {} {{ {} at[2], end; }};\n", block, s.name);
    uses += fmt::format("  {0}(push.address).end = {0}(push.address).at[0];\n", block);
  }
  std::string includes;
  for (const std::string& header : sharedHeaders()) includes += fmt::format("#include \"{}\"\n", header);
  return "#version 460\n#extension GL_GOOGLE_include_directive : require\n" + includes + blocks +
         "layout(local_size_x = 1) in;\nlayout(push_constant, scalar) uniform Push { uint64_t address; } push;\n"
         "void main() {\n" +
         uses + "}\n";
}

/// The structs as GLSL lays them out, with the headers of `folder` as its shared/. Sizes are strides in arrays, as
/// C++'s are.
std::vector<ReflectedStruct> probe(const fs::path& folder) {
  const fs::path path = folder / "probe.comp";
  std::ofstream(path) << probeSource(sharedStructs());
  const std::vector<ReflectedStruct> found = reflectStructs(compileGlsl(folder, "probe.comp"));
  std::vector<ReflectedStruct> out;
  for (ReflectedStruct s : found) {
    if (s.name.starts_with(kProbe)) continue;
    for (const ReflectedStruct& block : found)
      if (block.name == kProbe + s.name) s.bytes = block.members.at(1).second / 2;
    out.push_back(std::move(s));
  }
  return out;
}

/// The structs of a copy of shaders/shared in which a header has `to` in place of `from`; without them, of the folder
/// as it is.
std::vector<ReflectedStruct> probeEdited(const char* header, const std::string& from, const std::string& to) {
  const TemporaryFolder folder;
  fs::copy(kShared, folder.path / "shared");
  if (header != nullptr) {
    std::string text = read(kShared / header);
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << header << " has no longer: " << from;
    if (at != std::string::npos) text.replace(at, from.size(), to);
    std::ofstream(folder.path / "shared" / header) << text;
  }
  return probe(folder.path);
}

/// In words, how the members of one differ from those of the other.
std::vector<std::string> memberDifferences(const ReflectedStruct& host, const ReflectedStruct& device) {
  std::vector<std::string> out;
  const size_t count = std::max(host.members.size(), device.members.size());
  const auto say = [](const ReflectedStruct& s, size_t i) {
    return i < s.members.size() ? fmt::format("{} at {}", s.members[i].first, s.members[i].second) : "nothing";
  };
  for (size_t i = 0; i < count; ++i)
    if (say(host, i) != say(device, i))
      out.push_back(fmt::format("{}, member {}: {} in C++, {} in SPIR-V", host.name, i, say(host, i), say(device, i)));
  return out;
}

/// Differences of every struct of `host`, which `device` may hold several times, or not at all, which is a difference,
/// too.
std::vector<std::string> differences(const std::vector<ReflectedStruct>& host,
                                     const std::vector<ReflectedStruct>& device) {
  std::vector<std::string> out;
  const auto say = [&](std::string difference) {  // once, also of a struct that is there twice
    if (std::find(out.begin(), out.end(), difference) == out.end()) out.push_back(std::move(difference));
  };
  for (const ReflectedStruct& h : host) {
    bool met = false;
    for (const ReflectedStruct& d : device) {
      if (d.name != h.name) continue;
      met = true;
      for (std::string& difference : memberDifferences(h, d)) say(std::move(difference));
      if (d.bytes != h.bytes) say(fmt::format("{}: {} B in C++, {} B in SPIR-V", h.name, h.bytes, d.bytes));
    }
    if (!met) say(fmt::format("{}: not in SPIR-V", h.name));
  }
  return out;
}

TEST(Layout, EveryStructIsTheSameInBothLanguages) {
  const std::vector<ReflectedStruct> host = sharedStructs();
  size_t members = 0;
  for (const ReflectedStruct& s : host) members += s.members.size();
  fmt::print("{} structs of {} headers, {} members\n", host.size(), sharedHeaders().size(), members);
  ASSERT_FALSE(host.empty());
  for (const std::string& difference : differences(host, probeEdited(nullptr, "", ""))) ADD_FAILURE() << difference;
}

TEST(Layout, EveryShaderLaysThemOutSo) {
  // A block that forgets `scalar` has other offsets, in that shader alone.
  const std::vector<ReflectedStruct> host = sharedStructs();
  const ShaderLibrary library;
  size_t compared = 0;
  for (const std::string& name : library.names())
    for (const ReflectedStruct& device : reflectStructs(library.get(name).spirv))
      for (const ReflectedStruct& h : host) {
        if (h.name != device.name) continue;
        ++compared;
        for (const std::string& difference : memberDifferences(h, device)) ADD_FAILURE() << name << ": " << difference;
      }
  fmt::print("{} structs in {} shaders\n", compared, library.names().size());
  EXPECT_GT(compared, library.names().size());
}

TEST(Layout, AnEditOfOneSideIsFound) {
  const std::vector<ReflectedStruct> host = sharedStructs();
  const char* header = "pixel_emitters.h";
  const std::string members = "  vec3 corner, edge1, edge2;\n";
  using Found = std::vector<std::string>;
  // Members of one type swapped, which leaves every offset and the size as they are.
  EXPECT_EQ(differences(host, probeEdited(header, members, "  vec3 edge1, corner, edge2;\n")),
            (Found{"EmissiveTriangle, member 0: corner at 0 in C++, edge1 at 0 in SPIR-V",
                   "EmissiveTriangle, member 1: edge1 at 12 in C++, corner at 12 in SPIR-V"}));
  // Members of two types swapped.
  const std::string last = "  vec3 exitance;  ///< M, W/m^2: the mean over the triangle\n  uint doubleSided;\n";
  EXPECT_EQ(differences(host, probeEdited(header, last, "  uint doubleSided;\n  vec3 exitance;\n")),
            (Found{"EmissiveTriangle, member 3: exitance at 36 in C++, doubleSided at 36 in SPIR-V",
                   "EmissiveTriangle, member 4: doubleSided at 48 in C++, exitance at 40 in SPIR-V"}));
  // One more, in the middle and at the end; one less; a wider one.
  EXPECT_EQ(differences(host, probeEdited(header, last, last + "  uint more;\n")),
            (Found{"EmissiveTriangle, member 5: nothing in C++, more at 52 in SPIR-V",
                   "EmissiveTriangle: 52 B in C++, 56 B in SPIR-V"}));
  EXPECT_FALSE(differences(host, probeEdited(header, last, "  float more;\n" + last)).empty());
  EXPECT_EQ(differences(host, probeEdited(header, "  uint doubleSided;\n", "")),
            (Found{"EmissiveTriangle, member 4: doubleSided at 48 in C++, nothing in SPIR-V",
                   "EmissiveTriangle: 52 B in C++, 48 B in SPIR-V"}));
  EXPECT_EQ(differences(host, probeEdited(header, "  uint doubleSided;\n", "  uvec2 doubleSided;\n")),
            (Found{"EmissiveTriangle: 52 B in C++, 56 B in SPIR-V"}));
}

TEST(Layout, AStructThatIsNotCoveredIsFound) {
  const std::vector<ReflectedStruct> host = sharedStructs();
  std::vector<ReflectedStruct> device = host;
  device.erase(device.begin());
  EXPECT_EQ(differences(host, device), std::vector<std::string>{host.front().name + ": not in SPIR-V"});

  // A header that the generator of the C++ side cannot read ends the build.
  const TemporaryFolder folder;
  const auto generate = [&](const std::string& text) {
    std::ofstream(folder.path / "a.h") << text;
    const std::string command =
        fmt::format("'{}' -DFOLDER='{}' -DOUTPUT='{}' -P '{}' 2>'{}'", IRAD_CMAKE, folder.path.string(),
                    (folder.path / "out.cpp").string(), (kRoot / "tests/shared_structs.cmake").string(),
                    (folder.path / "err").string());
    return std::system(command.c_str()) == 0 ? "" : read(folder.path / "err");
  };
  EXPECT_EQ(generate("struct A {\n  uint a, b[3];  // struct ; {\n};\n"), "");
  EXPECT_NE(read(folder.path / "out.cpp").find("{\"b\", offsetof(A, b)}"), std::string::npos);
  EXPECT_NE(generate("struct A {\n  uint a;\n};\nstruct B\n{\n  uint b;\n};\n").find("of 2 structs 1 read"),
            std::string::npos);
}

}  // namespace
}  // namespace irad::test::layout_suite
