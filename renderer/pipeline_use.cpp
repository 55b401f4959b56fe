#include "renderer/pipeline_use.h"

#include <spirv-tools/optimizer.hpp>

#include "renderer/base/error.h"
#include "renderer/shaders.h"

namespace irad {
namespace {

/// The module with these values of its specialization constants, which are constants like others then, after the passes
/// that `add` names to the optimizer.
std::vector<uint32_t> optimized(std::span<const uint32_t> spirv, const std::map<uint32_t, uint32_t>& constants,
                                const auto& add) {
  const std::vector<uint32_t> code = withConstants(spirv, constants);
  std::string problem;
  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
  optimizer.SetMessageConsumer([&](spv_message_level_t level, const char*, const spv_position_t&, const char* text) {
    if (level <= SPV_MSG_ERROR) problem += std::string(text) + "\n";
  });
  optimizer.RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
      .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass());
  add(optimizer);
  std::vector<uint32_t> out;
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);
  if (!optimizer.Run(code.data(), code.size(), &out, options))
    throw WorkError("SPIRV-Tools: specializing a module failed\n" + problem);
  return out;
}

}  // namespace

std::vector<uint32_t> specialized(std::span<const uint32_t> spirv, const std::map<uint32_t, uint32_t>& constants) {
  return optimized(spirv, constants, [](spvtools::Optimizer& optimizer) {
    optimizer.RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
  });
}

uint64_t specializedInstructions(std::span<const uint32_t> spirv, const std::map<uint32_t, uint32_t>& constants) {
  return functionInstructions(optimized(spirv, constants, [](spvtools::Optimizer& optimizer) {
    // Inlines everything, too. Lines would count as instructions.
    optimizer.RegisterPass(spvtools::CreateStripDebugInfoPass()).RegisterPerformancePasses();
  }));
}

uint64_t specializedInstructions(const ShaderLibrary& shaders, std::span<const PipelineUse> pipelines) {
  uint64_t sum = 0;
  for (const PipelineUse& pipeline : pipelines)
    for (const std::string& name : pipeline.shaders)
      sum += specializedInstructions(shaders.get(name).spirv, pipeline.constants);
  return sum;
}

}  // namespace irad
