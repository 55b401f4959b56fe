// One pipeline: what it is made from, and how it is compiled. Private to renderer/.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "renderer/device.h"
#include "renderer/shaders.h"
#include "shaders/shared/scene_gpu.h"

namespace irad {

enum class Blend { None, Additive, Alpha };

constexpr VkShaderStageFlags kAllStages = VK_SHADER_STAGE_ALL_GRAPHICS | VK_SHADER_STAGE_COMPUTE_BIT;
constexpr uint32_t kPushBytes = 128;  ///< what every device has

VkDescriptorType descriptorType(const ShaderBinding& binding);

struct RasterState {
  std::vector<VkFormat> colors;  ///< UNDEFINED: what is written there is dropped
  VkFormat depth = VK_FORMAT_UNDEFINED;
  bool depthWrite = false, depthBias = false;
  VkCompareOp compare = VK_COMPARE_OP_LESS_OR_EQUAL;
  Blend blend = Blend::None;
};

/// What a pass asks for.
struct PipelineRequest {
  std::vector<std::string> shaders;
  std::map<uint32_t, uint32_t> constants;  ///< specialization: id -> value
  std::set<uint32_t> leftOut;              ///< ids of effects that are false (Pass::effect)
  RasterState raster;                      ///< ignored for compute
  bool compute() const;
  std::string key() const;
  std::map<uint32_t, uint32_t> allConstants() const;  ///< `leftOut` as zeros among them
};

/// (irad::Pipeline is the method, in gi/.)
struct GpuPipeline {
  explicit GpuPipeline(const Device& device) : device(device) {}
  ~GpuPipeline();
  GpuPipeline(const GpuPipeline&) = delete;

  const Device& device;
  std::string name;
  VkPipeline handle = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkDescriptorSetLayout set0 = VK_NULL_HANDLE;
  VkPipelineBindPoint bindPoint = VK_PIPELINE_BIND_POINT_COMPUTE;
  VkPipelineStageFlags2 stages = 0;      ///< shader stages, for barriers
  std::vector<ShaderBinding> bindings;   ///< set 0, merged over the stages, sorted by binding
  bool material = false;                 ///< some stage declares set 1
  uint32_t pushBytes = 0;                ///< the largest push-constant block of the stages
  std::vector<uint32_t> addressOffsets;  ///< where addresses lie in it, for any of the stages
  std::array<uint32_t, 3> localSize{1, 1, 1};
  bool compute() const { return bindPoint == VK_PIPELINE_BIND_POINT_COMPUTE; }
};

/// A pipeline's parts, copied from the shader library: any thread may compile them.
struct PipelineParts {
  PipelineRequest request;
  std::vector<ShaderModule> modules;
  std::unique_ptr<GpuPipeline> pipeline;  ///< all but its layouts and handle
};
PipelineParts gatherParts(const Device& device, const ShaderLibrary& shaders, const PipelineRequest& request);
/// `parts.pipeline` has its layouts by now.
std::unique_ptr<GpuPipeline> compile(PipelineParts parts, VkPipelineCache cache);

}  // namespace irad
