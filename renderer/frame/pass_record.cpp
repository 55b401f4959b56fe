// A pass becomes commands: its barrier, its pipeline and bindings, and what it dispatches or draws.
#include "renderer/base/error.h"
#include "renderer/frame/pass_state.h"

namespace irad {

namespace {

/// The one barrier of a pass: all its dependencies merged into a global one, and the first-use transitions of images.
class BarrierBuilder {
 public:
  void add(ResourceState& state, const Image* image, const Use& use) {
    if (image && !state.defined) {
      // To GENERAL for good. The source is everything, because the memory may have been another image's; so is the
      // destination, so that later readers at other stages need no barrier.
      transitions_.push_back(
          {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
           .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
           .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
           .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
           .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
           .oldLayout = VK_IMAGE_LAYOUT_UNDEFINED,
           .newLayout = VK_IMAGE_LAYOUT_GENERAL,
           .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
           .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
           .image = image->handle,
           .subresourceRange = {aspect(*image), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS}});
      state = {.defined = true};
    }
    const Dependency d = dependency(state, use);
    if (d.needed()) {
      memory_.srcStageMask |= d.source.stages;
      memory_.srcAccessMask |= d.source.access;
      memory_.dstStageMask |= d.destination.stages;
      memory_.dstAccessMask |= d.destination.access;
    }
    state = advance(state, use);
  }

  void record(VkCommandBuffer commands) const {
    if (memory_.srcStageMask == 0 && transitions_.empty()) return;
    const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                .memoryBarrierCount = memory_.srcStageMask ? 1u : 0u,
                                .pMemoryBarriers = &memory_,
                                .imageMemoryBarrierCount = static_cast<uint32_t>(transitions_.size()),
                                .pImageMemoryBarriers = transitions_.data()};
    vkCmdPipelineBarrier2(commands, &info);
  }

 private:
  VkMemoryBarrier2 memory_{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  std::vector<VkImageMemoryBarrier2> transitions_;
};

/// Runs its function at the end of the scope, also when the pass's body throws.
template <class F>
struct AtEnd {
  F f;
  ~AtEnd() { f(); }
};
template <class F>
AtEnd(F) -> AtEnd<F>;

void checkBindings(const std::string& stage, const GpuPipeline& pipeline, size_t named) {
  IRAD_CHECK(named == pipeline.bindings.size(), "{}: the pass names {} images, {} declares {}", stage, named,
             pipeline.name, pipeline.bindings.size());
}

constexpr uint64_t kUniformBytes = 16384;

const char* kindName(VkDescriptorType type) {
  if (type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER) return "uniform block";
  return type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE ? "storage image" : "sampler";
}

}  // namespace

void Pass::record(const std::function<void(VkCommandBuffer)>& body) {
  // Without a shader the stages of in(), out() and the like are unknown, so all stages are taken.
  if (state_->pipeline.shaders.empty()) state_->resolveUses(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
  Frame::Impl& frame = *frame_->impl_;
  IRAD_CHECK(frame.slot, "pass {} after the frame was submitted", stage_);
  state_->recorded = true;
  const VkCommandBuffer commands = frame.slot->commands;
  if (frame.slot->timing && frame.slot->timers.back() != stage_) frame.stopTimer();
  BarrierBuilder barriers;
  for (const State::Declared& d : state_->declared) barriers.add(*d.state, d.image, d.use);
  frame.beginLabel(stage_);
  const AtEnd label{[&] { frame.endLabel(); }};
  barriers.record(commands);
  frame.startTimer(stage_);
  body(commands);
}

void Pass::run(const std::function<void(Commands&)>& body) {
  State& s = *state_;
  Context& context = frame_->context();
  for (const State::Color& c : s.colors)
    s.pipeline.raster.colors.push_back(c.image ? c.image->desc.format : VK_FORMAT_UNDEFINED);
  if (s.depth) s.pipeline.raster.depth = s.depth->desc.format;
  GpuPipeline& pipeline = context.impl->pipelines->get(s.pipeline);
  s.resolveUses(pipeline.stages);

  // The bindings of set 0, in the order in which the pass names them.
  checkBindings(stage_, pipeline, s.bound.size());
  VkDescriptorSet set = VK_NULL_HANDLE;
  if (!s.bound.empty()) {
    set = frame_->impl_->allocateSet(pipeline.set0);
    std::vector<VkDescriptorImageInfo> images(s.bound.size());
    std::vector<VkDescriptorBufferInfo> buffers(s.bound.size());
    std::vector<VkWriteDescriptorSet> writes(s.bound.size());
    for (uint32_t i = 0; i < s.bound.size(); ++i) {
      const State::Bound& bound = s.bound[i];
      const ShaderBinding& binding = pipeline.bindings[i];
      const std::string& name = bound.uniform ? bound.uniform->name : bound.image->desc.name;
      const VkDescriptorType given = bound.uniform   ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                                     : bound.sampler ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
                                                     : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
      IRAD_CHECK(binding.binding == i && binding.count == 1,
                 "{}: {} declares {} as binding {} x{}; the pass names {} as binding {}", stage_, pipeline.name,
                 binding.name, binding.binding, binding.count, name, i);
      IRAD_CHECK(descriptorType(binding) == given, "{}: {} is a {} in {}, but the pass gives {} as a {}", stage_,
                 binding.name, kindName(descriptorType(binding)), pipeline.name, name, kindName(given));
      if (bound.uniform)
        buffers[i] = {bound.uniform->handle, 0, std::min(bound.uniform->bytes, kUniformBytes)};
      else
        images[i] = {bound.sampler, bound.alias ? bound.image->aliasView : bound.image->view, VK_IMAGE_LAYOUT_GENERAL};
      writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                   .dstSet = set,
                   .dstBinding = i,
                   .descriptorCount = 1,
                   .descriptorType = given,
                   .pImageInfo = &images[i],
                   .pBufferInfo = &buffers[i]};
    }
    vkUpdateDescriptorSets(context.device.handle, static_cast<uint32_t>(writes.size()), writes.data(), 0, nullptr);
  }

  record([&](VkCommandBuffer cmd) {
    vkCmdBindPipeline(cmd, pipeline.bindPoint, pipeline.handle);
    if (set) vkCmdBindDescriptorSets(cmd, pipeline.bindPoint, pipeline.layout, 0, 1, &set, 0, nullptr);
    Commands commands;
    commands.frame_ = frame_;
    commands.pipeline_ = &pipeline;
    commands.pass_ = this;
    if (!pushed_.empty()) commands.pushBytes(pushed_.data(), pushed_.size());
    if (pipeline.compute())
      body(commands);
    else
      rasterize(cmd, commands, body);
  });
}

void Pass::rasterize(VkCommandBuffer cmd, Commands& commands, const std::function<void(Commands&)>& body) {
  const State& s = *state_;
  uint32_t width = s.width, height = s.height;
  const auto agree = [&](const Image& target) {
    if (width == 0) width = target.desc.width, height = target.desc.height;
    IRAD_CHECK(width <= target.desc.width && height <= target.desc.height, "{}: {}x{} on {} of {}x{}", stage_, width,
               height, target.desc.name, target.desc.width, target.desc.height);
  };
  std::vector<VkRenderingAttachmentInfo> colors;
  for (const State::Color& c : s.colors) {
    if (!c.image) {
      colors.push_back({.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO});
      continue;
    }
    agree(*c.image);
    VkRenderingAttachmentInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                   .imageView = c.image->layerViews.empty() ? c.image->view : c.image->layerViews[0],
                                   .imageLayout = VK_IMAGE_LAYOUT_GENERAL,
                                   .loadOp = c.clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD,
                                   .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    if (c.clear) info.clearValue.color = {{c.clear->r, c.clear->g, c.clear->b, c.clear->a}};
    colors.push_back(info);
  }
  VkRenderingAttachmentInfo depth{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  if (s.depth) {
    agree(*s.depth);
    const bool writes = s.pipeline.raster.depthWrite || s.depthClear;
    depth.imageView = s.depth->layerViews.empty() ? s.depth->view : s.depth->layerViews[s.depthLayer];
    depth.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    depth.loadOp = s.depthClear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
    depth.storeOp = writes ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_NONE;
    if (s.depthClear) depth.clearValue.depthStencil = {*s.depthClear, 0};
  }
  IRAD_CHECK(width > 0 && height > 0, "{}: a raster pass needs an attachment or an extent", stage_);
  const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                  .renderArea = {{0, 0}, {width, height}},
                                  .layerCount = 1,
                                  .colorAttachmentCount = static_cast<uint32_t>(colors.size()),
                                  .pColorAttachments = colors.data(),
                                  .pDepthAttachment = s.depth ? &depth : nullptr};
  vkCmdBeginRendering(cmd, &rendering);
  const AtEnd end{[&] { vkCmdEndRendering(cmd); }};
  commands.viewport(0, 0, static_cast<float>(width), static_cast<float>(height));
  commands.cull(VK_CULL_MODE_NONE);
  if (s.indices) vkCmdBindIndexBuffer(cmd, s.indices->handle, 0, VK_INDEX_TYPE_UINT32);
  vkCmdSetDepthBias(cmd, s.biasConstant, 0.0f, s.biasSlope);
  body(commands);
}

void Pass::dispatch(uint64_t invocations) {
  run([&](Commands& commands) { commands.dispatch(invocations); });
}
void Pass::dispatch(glm::uvec2 invocations) {
  run([&](Commands& commands) { commands.dispatch(invocations); });
}
void Pass::dispatchWorkgroups(uint64_t count) {
  run([&](Commands& commands) { commands.dispatchWorkgroups(count); });
}
Pass& Pass::indirect(const Buffer& arguments) {
  return declare(arguments, kIndirect);
}
void Pass::dispatchIndirect(const Buffer& arguments, uint64_t offset) {
  indirect(arguments).run([&](Commands& commands) { commands.dispatchIndirect(arguments, offset); });
}
void Pass::draw(uint32_t vertexCount, uint32_t instances) {
  run([&](Commands& commands) { commands.draw(vertexCount, 0, instances); });
}

}  // namespace irad
