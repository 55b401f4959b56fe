// Pipelines, cached by shaders, specialization constants, raster state and formats. Private to renderer/.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/device.h"
#include "renderer/shaders.h"

namespace irad {

constexpr VkShaderStageFlags kAllStages = VK_SHADER_STAGE_ALL_GRAPHICS | VK_SHADER_STAGE_COMPUTE_BIT;
constexpr uint32_t kPushBytes = 128;  ///< what every device has
constexpr uint32_t kMaterialTextures = 5;

enum class Blend { None, Additive, Alpha };

VkDescriptorType descriptorType(const ShaderBinding& binding);

struct RasterState {
  std::vector<VkFormat> colors;
  VkFormat depth = VK_FORMAT_UNDEFINED;
  bool depthWrite = false, depthBias = false;
  VkCompareOp compare = VK_COMPARE_OP_LESS_OR_EQUAL;
  Blend blend = Blend::None;
};

/// (irad::Pipeline is the method, in gi/.)
struct GpuPipeline {
  std::string name;
  VkPipeline handle = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkDescriptorSetLayout set0 = VK_NULL_HANDLE;
  VkPipelineBindPoint bindPoint = VK_PIPELINE_BIND_POINT_COMPUTE;
  VkPipelineStageFlags2 stages = 0;   ///< shader stages, for barriers
  std::vector<ShaderBinding> bindings;  ///< set 0, merged over the stages, sorted by binding
  bool material = false;              ///< some stage declares set 1
  uint32_t pushBytes = 0;             ///< the largest push-constant block of the stages
  std::array<uint32_t, 3> localSize{1, 1, 1};
  bool compute() const { return bindPoint == VK_PIPELINE_BIND_POINT_COMPUTE; }
};

class PipelineCache {
 public:
  PipelineCache(const Device& device, const ShaderLibrary& shaders);
  ~PipelineCache();
  PipelineCache(const PipelineCache&) = delete;

  /// `raster` is ignored for compute. The reference stays valid until the shaders' generation changes.
  GpuPipeline& get(const std::vector<std::string>& shaders, const std::map<uint32_t, uint32_t>& constants,
                const RasterState& raster);
  VkDescriptorSetLayout materialLayout() const { return material_; }

 private:
  std::unique_ptr<GpuPipeline> build(const std::vector<std::string>& shaders,
                                  const std::map<uint32_t, uint32_t>& constants, const RasterState& raster);
  VkDescriptorSetLayout setLayout(const std::vector<ShaderBinding>& bindings);
  VkPipelineLayout pipelineLayout(VkDescriptorSetLayout set0, bool material);
  void dropPipelines();

  const Device& device_;
  const ShaderLibrary& shaders_;
  uint64_t generation_ = 0;
  VkPipelineCache cache_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout material_ = VK_NULL_HANDLE;
  std::map<std::string, std::unique_ptr<GpuPipeline>> pipelines_;
  std::map<std::string, VkDescriptorSetLayout> setLayouts_;
  std::map<std::pair<VkDescriptorSetLayout, bool>, VkPipelineLayout> layouts_;
};

}  // namespace irad
