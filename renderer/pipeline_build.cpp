#include "renderer/pipeline_build.h"

#include <algorithm>

#include "renderer/base/error.h"
#include "renderer/pipeline_use.h"
#include "renderer/vulkan_check.h"

namespace irad {
namespace {

struct Stage {
  const char* extension;
  VkShaderStageFlagBits bit;
  VkPipelineStageFlags2 barrierStage;
};
constexpr Stage kStages[] = {
    {".comp", VK_SHADER_STAGE_COMPUTE_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT},
    {".vert", VK_SHADER_STAGE_VERTEX_BIT, VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT},
    {".frag", VK_SHADER_STAGE_FRAGMENT_BIT, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT},
};

const Stage& stageOf(const std::string& name) {
  for (const Stage& stage : kStages)
    if (name.ends_with(stage.extension)) return stage;
  invariantFailed(__FILE__, __LINE__, fmt::format("shader '{}' has no stage extension", name));
}

/// Bindings of set 0 over all stages; stages that name the same binding must agree on its kind.
std::vector<ShaderBinding> mergedBindings(const std::vector<ShaderModule>& modules, bool& material) {
  std::vector<ShaderBinding> merged;
  for (const ShaderModule& module : modules)
    for (const ShaderBinding& b : module.bindings) {
      if (b.set == 1) {
        IRAD_CHECK(b.binding < MATERIAL_TEXTURES && !b.storageImage && !b.uniformBlock,
                   "{}: set 1 binding {} ({}) is not a material's", module.name, b.binding, b.name);
        material = true;
        continue;
      }
      IRAD_CHECK(b.set == 0, "{}: {} is in set {}", module.name, b.name, b.set);
      const auto same =
          std::find_if(merged.begin(), merged.end(), [&](const auto& m) { return m.binding == b.binding; });
      if (same == merged.end())
        merged.push_back(b);
      else
        IRAD_CHECK(same->storageImage == b.storageImage && same->uniformBlock == b.uniformBlock,
                   "{}: binding {} ({}) differs from another stage's {}", module.name, b.binding, b.name, same->name);
    }
  std::sort(merged.begin(), merged.end(), [](const auto& a, const auto& b) { return a.binding < b.binding; });
  return merged;
}

VkPipelineColorBlendAttachmentState blendState(Blend blend) {
  VkPipelineColorBlendAttachmentState state{.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                                                              VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT};
  if (blend == Blend::None) return state;
  const bool alpha = blend == Blend::Alpha;
  state.blendEnable = VK_TRUE;
  state.srcColorBlendFactor = alpha ? VK_BLEND_FACTOR_SRC_ALPHA : VK_BLEND_FACTOR_ONE;
  state.dstColorBlendFactor = alpha ? VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA : VK_BLEND_FACTOR_ONE;
  state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  state.dstAlphaBlendFactor = alpha ? VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA : VK_BLEND_FACTOR_ONE;
  return state;
}

VkPipeline buildRaster(const Device& device, VkPipelineCache cache, const GpuPipeline& pipeline,
                       const std::vector<VkPipelineShaderStageCreateInfo>& stages, const RasterState& raster) {
  const VkPipelineVertexInputStateCreateInfo vertexInput{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};  // vertices are pulled
  const VkPipelineInputAssemblyStateCreateInfo assembly{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
      .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
  const VkPipelineViewportStateCreateInfo viewport{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, .viewportCount = 1, .scissorCount = 1};
  const VkPipelineRasterizationStateCreateInfo rasterization{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
      .polygonMode = VK_POLYGON_MODE_FILL,
      .frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE,
      .depthBiasEnable = raster.depthBias ? VK_TRUE : VK_FALSE,
      .lineWidth = 1.0f};
  const VkPipelineMultisampleStateCreateInfo samples{.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
                                                     .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
  const VkPipelineDepthStencilStateCreateInfo depth{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
      .depthTestEnable = raster.depth != VK_FORMAT_UNDEFINED ? VK_TRUE : VK_FALSE,
      .depthWriteEnable = raster.depthWrite ? VK_TRUE : VK_FALSE,
      .depthCompareOp = raster.compare};
  const std::vector<VkPipelineColorBlendAttachmentState> blends(raster.colors.size(), blendState(raster.blend));
  const VkPipelineColorBlendStateCreateInfo blend{.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                                                  .attachmentCount = static_cast<uint32_t>(blends.size()),
                                                  .pAttachments = blends.data()};
  const VkDynamicState dynamics[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR, VK_DYNAMIC_STATE_CULL_MODE,
                                     VK_DYNAMIC_STATE_DEPTH_BIAS};
  const VkPipelineDynamicStateCreateInfo dynamic{.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                                 .dynamicStateCount = static_cast<uint32_t>(std::size(dynamics)),
                                                 .pDynamicStates = dynamics};
  const VkPipelineRenderingCreateInfo rendering{.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                .colorAttachmentCount = static_cast<uint32_t>(raster.colors.size()),
                                                .pColorAttachmentFormats = raster.colors.data(),
                                                .depthAttachmentFormat = raster.depth};
  const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                          .pNext = &rendering,
                                          .stageCount = static_cast<uint32_t>(stages.size()),
                                          .pStages = stages.data(),
                                          .pVertexInputState = &vertexInput,
                                          .pInputAssemblyState = &assembly,
                                          .pViewportState = &viewport,
                                          .pRasterizationState = &rasterization,
                                          .pMultisampleState = &samples,
                                          .pDepthStencilState = &depth,
                                          .pColorBlendState = &blend,
                                          .pDynamicState = &dynamic,
                                          .layout = pipeline.layout};
  VkPipeline handle = VK_NULL_HANDLE;
  vkCheck(vkCreateGraphicsPipelines(device.handle, cache, 1, &info, nullptr, &handle),
          fmt::format("creating pipeline {}", pipeline.name));
  return handle;
}

}  // namespace

VkDescriptorType descriptorType(const ShaderBinding& binding) {
  if (binding.uniformBlock) return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  return binding.storageImage ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
}

bool PipelineRequest::compute() const {
  IRAD_CHECK(!shaders.empty(), "a pass without a shader");
  return stageOf(shaders.front()).bit == VK_SHADER_STAGE_COMPUTE_BIT;
}

std::map<uint32_t, uint32_t> PipelineRequest::allConstants() const {
  std::map<uint32_t, uint32_t> all = constants;
  for (const uint32_t id : leftOut) all[id] = 0;
  return all;
}

std::string PipelineRequest::key() const {
  std::string key;
  for (const std::string& name : shaders) key += name + "|";
  for (const auto& [id, value] : allConstants()) key += fmt::format("{}={}|", id, value);
  if (compute()) return key;
  for (const VkFormat format : raster.colors) key += fmt::format("c{}|", static_cast<int>(format));
  return key + fmt::format("d{} w{} b{} o{} a{}", static_cast<int>(raster.depth), raster.depthWrite, raster.depthBias,
                           static_cast<int>(raster.compare), static_cast<int>(raster.blend));
}

GpuPipeline::~GpuPipeline() {
  if (handle) device.retire([device = device.handle, handle = handle] { vkDestroyPipeline(device, handle, nullptr); });
}

PipelineParts gatherParts(const Device& device, const ShaderLibrary& shaders, const PipelineRequest& request) {
  PipelineParts parts{request, {}, std::make_unique<GpuPipeline>(device)};
  GpuPipeline& pipeline = *parts.pipeline;
  for (const std::string& name : request.shaders) {
    const ShaderModule& module = parts.modules.emplace_back(shaders.get(name));
    pipeline.name += (pipeline.name.empty() ? "" : " + ") + name;
    pipeline.stages |= stageOf(name).barrierStage;
    pipeline.pushBytes = std::max(pipeline.pushBytes, module.pushBytes);
    pipeline.addressOffsets.insert(pipeline.addressOffsets.end(), module.addressOffsets.begin(),
                                   module.addressOffsets.end());
  }
  IRAD_CHECK(pipeline.pushBytes <= kPushBytes, "{}: {} bytes of push constants", pipeline.name, pipeline.pushBytes);
  IRAD_CHECK(!request.compute() || parts.modules.size() == 1, "{}: a compute shader stands alone", pipeline.name);
  pipeline.bindPoint = request.compute() ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_GRAPHICS;
  pipeline.bindings = mergedBindings(parts.modules, pipeline.material);
  pipeline.localSize = parts.modules.front().localSize;
  for (int i = 0; i < 3; ++i)
    if (const auto it = request.constants.find(parts.modules.front().localSizeId[i]); it != request.constants.end())
      pipeline.localSize[i] = it->second;
  return parts;
}

std::unique_ptr<GpuPipeline> compile(PipelineParts parts, VkPipelineCache cache) {
  GpuPipeline& pipeline = *parts.pipeline;
  const Device& device = pipeline.device;
  std::map<uint32_t, uint32_t> constants = parts.request.allConstants();
  if (device.isCpu) {
    // Mesa's CPU driver and the validation layer go through what constants leave out, too, and keep nothing of it.
    for (ShaderModule& module : parts.modules) module.spirv = specialized(module.spirv, constants);
    constants.clear();
  }
  std::vector<VkSpecializationMapEntry> entries;
  std::vector<uint32_t> values;
  for (const auto& [id, value] : constants) {
    entries.push_back({id, static_cast<uint32_t>(values.size() * sizeof(uint32_t)), sizeof(uint32_t)});
    values.push_back(value);
  }
  const VkSpecializationInfo specialization{static_cast<uint32_t>(entries.size()), entries.data(),
                                            values.size() * sizeof(uint32_t), values.data()};
  // The modules live only while the pipeline is made.
  std::vector<VkPipelineShaderStageCreateInfo> stages;
  const auto destroyModules = [&] {
    for (const auto& stage : stages) vkDestroyShaderModule(device.handle, stage.module, nullptr);
  };
  try {
    for (const ShaderModule& module : parts.modules) {
      const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                          .codeSize = module.spirv.size() * sizeof(uint32_t),
                                          .pCode = module.spirv.data()};
      VkShaderModule handle = VK_NULL_HANDLE;
      vkCheck(vkCreateShaderModule(device.handle, &info, nullptr, &handle), module.name);
      device.name(VK_OBJECT_TYPE_SHADER_MODULE, reinterpret_cast<uint64_t>(handle), module.name);
      stages.push_back({.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                        .stage = stageOf(module.name).bit,
                        .module = handle,
                        .pName = "main",
                        .pSpecializationInfo = values.empty() ? nullptr : &specialization});
    }
    if (pipeline.compute()) {
      const VkComputePipelineCreateInfo info{
          .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO, .stage = stages.front(), .layout = pipeline.layout};
      vkCheck(vkCreateComputePipelines(device.handle, cache, 1, &info, nullptr, &pipeline.handle),
              fmt::format("creating pipeline {}", pipeline.name));
    } else {
      pipeline.handle = buildRaster(device, cache, pipeline, stages, parts.request.raster);
    }
  } catch (...) {
    destroyModules();
    throw;
  }
  destroyModules();
  ++device.counters.pipelines;
  device.name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(pipeline.handle), pipeline.name);
  return std::move(parts.pipeline);
}

}  // namespace irad
