#include "renderer/pipeline_use.h"

#include <spirv-tools/optimizer.hpp>

#include "renderer/base/error.h"
#include "renderer/shaders.h"

namespace irad {

uint64_t specializedInstructions(std::span<const uint32_t> spirv, const std::map<uint32_t, uint32_t>& constants) {
  // Sets the constants' values, then does what a driver does: inlines everything, and drops branches on constants and
  // whatever is unused.
  std::unordered_map<uint32_t, std::vector<uint32_t>> values;
  for (const auto& [id, value] : constants) values[id] = {value};
  std::string problem;
  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
  optimizer.SetMessageConsumer([&](spv_message_level_t level, const char*, const spv_position_t&, const char* text) {
    if (level <= SPV_MSG_ERROR) problem += std::string(text) + "\n";
  });
  optimizer.RegisterPass(spvtools::CreateStripDebugInfoPass())
      .RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
      .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
      .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
      .RegisterPerformancePasses();
  std::vector<uint32_t> optimized;
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);
  if (!optimizer.Run(spirv.data(), spirv.size(), &optimized, options))
    throw WorkError("SPIRV-Tools: specializing a module failed\n" + problem);
  return functionInstructions(optimized);
}

uint64_t specializedInstructions(const ShaderLibrary& shaders, std::span<const PipelineUse> pipelines) {
  uint64_t sum = 0;
  for (const PipelineUse& pipeline : pipelines)
    for (const std::string& name : pipeline.shaders)
      sum += specializedInstructions(shaders.get(name).spirv, pipeline.constants);
  return sum;
}

}  // namespace irad
