// GLSL -> SPIR-V at run time, with the options of shaders/CMakeLists.txt.
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>

#include "renderer/base/error.h"
#include "renderer/shaders.h"

namespace irad {
namespace {

std::optional<std::string> readText(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// #include "..." beside the including file first, then below the root: as glslangValidator -I does.
class Includer : public glslang::TShader::Includer {
 public:
  explicit Includer(std::filesystem::path root) : root_(std::move(root)) {}

  IncludeResult* includeLocal(const char* header, const char* includer, size_t) override {
    const std::filesystem::path beside = std::filesystem::path(includer).parent_path() / header;
    if (IncludeResult* result = open(beside)) return result;
    return open(root_ / header);
  }
  IncludeResult* includeSystem(const char* header, const char*, size_t) override { return open(root_ / header); }
  void releaseInclude(IncludeResult* result) override {
    if (!result) return;
    delete static_cast<std::string*>(result->userData);
    delete result;
  }

 private:
  static IncludeResult* open(const std::filesystem::path& path) {
    std::optional<std::string> text = readText(path);
    if (!text) return nullptr;
    auto* kept = new std::string(std::move(*text));
    return new IncludeResult(path.lexically_normal().string(), kept->data(), kept->size(), kept);
  }
  std::filesystem::path root_;
};

EShLanguage languageOf(const std::string& name) {
  const std::string extension = std::filesystem::path(name).extension().string();
  if (extension == ".comp") return EShLangCompute;
  if (extension == ".vert") return EShLangVertex;
  if (extension == ".frag") return EShLangFragment;
  throw WorkError(fmt::format("{}: not a shader stage (.comp, .vert, .frag)", name));
}

/// glslang's process-wide tables, for as long as the process uses them.
struct GlslangProcess {
  GlslangProcess() { glslang::InitializeProcess(); }
  ~GlslangProcess() { glslang::FinalizeProcess(); }
};

}  // namespace

std::vector<uint32_t> compileGlsl(const std::filesystem::path& sources, const std::string& name,
                                  std::string_view definition) {
  static const GlslangProcess process;
  const std::filesystem::path path = sources / name;
  const std::optional<std::string> source = readText(path);
  if (!source) throw WorkError(fmt::format("{}: cannot be read", path.string()));
  const EShLanguage stage = languageOf(name);

  glslang::TShader shader(stage);
  const char* text = source->c_str();
  const int length = static_cast<int>(source->size());
  const std::string pathText = path.string();
  const char* label = pathText.c_str();
  shader.setStringsWithLengthsAndNames(&text, &length, &label, 1);
  std::string preamble;
  if (!definition.empty()) {
    preamble = fmt::format("#define {}\n", definition);
    std::ranges::replace(preamble, '=', ' ');
  }
  shader.setPreamble(preamble.c_str());
  shader.setEnvInput(glslang::EShSourceGlsl, stage, glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
  const auto messages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules | EShMsgDebugInfo);
  Includer includer(sources);
  const auto fail = [&](const char* what, const char* log) {
    throw WorkError(fmt::format("{}: {} failed\n{}", name, what, log));
  };
  if (!shader.parse(GetDefaultResources(), 460, ENoProfile, false, false, messages, includer))
    fail("compilation", shader.getInfoLog());
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(messages)) fail("linking", program.getInfoLog());

  std::vector<uint32_t> spirv;
  spv::SpvBuildLogger logger;
  glslang::SpvOptions options;
  options.generateDebugInfo = true;
  options.optimizeSize = source->find("\n#pragma optimize(on)\n") != std::string::npos;
  options.disableOptimizer = !options.optimizeSize;
  glslang::GlslangToSpv(*program.getIntermediate(stage), spirv, &logger, &options);
  if (spirv.empty()) fail("code generation", logger.getAllMessages().c_str());
  return spirv;
}

}  // namespace irad
