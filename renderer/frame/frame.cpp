#include "renderer/frame/frame.h"

#include <algorithm>
#include <utility>

#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/format.h"
#include "renderer/frame/frame_impl.h"
#include "renderer/vulkan_check.h"

namespace irad {

namespace {

void memoryBarrier(VkCommandBuffer commands, const Use& source, const Use& destination) {
  const VkMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                 .srcStageMask = source.stages,
                                 .srcAccessMask = source.access,
                                 .dstStageMask = destination.stages,
                                 .dstAccessMask = destination.access};
  const VkDependencyInfo info{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &barrier};
  vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace

void everythingBarrier(VkCommandBuffer commands) {
  constexpr Use kAll{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
  memoryBarrier(commands, kAll, kAll);
}

Frame::Frame(Frame&&) noexcept = default;

Frame& Frame::operator=(Frame&& other) noexcept {
  Frame dropped(std::move(*this));
  impl_ = std::move(other.impl_);
  return *this;
}

Frame::~Frame() {
  if (!impl_ || !impl_->slot) return;
  // Dropped: run what was recorded, deliver nothing.
  FrameSlot& slot = *impl_->slot;
  impl_->stopTimer();
  slot.timers.clear();
  slot.readbacks.clear();
  slot.sample.reset();
  try {
    impl_->submit(VK_NULL_HANDLE, VK_NULL_HANDLE, /*awaited=*/false);
  } catch (const Error& error) {
    tell("irad: dropping a frame: {}\n", error.what());
  }
}

Context& Frame::context() const {
  return *impl_->context;
}

VkCommandBuffer Frame::commands() const {
  IRAD_CHECK(impl_ && impl_->slot, "the frame has been submitted");
  return impl_->slot->commands;
}

void Frame::sampled(uint64_t frameIndex, std::chrono::steady_clock::time_point began) {
  IRAD_CHECK(impl_ && impl_->slot, "the frame has been submitted");
  impl_->slot->sample = {frameIndex, began};
}

void Frame::submit(VkSemaphore presentWait, VkSemaphore presentSignal) {
  IRAD_CHECK(impl_ && impl_->slot, "the frame has been submitted");
  impl_->submit(presentWait, presentSignal, /*awaited=*/false);
}

void Frame::submitAndWait() {
  IRAD_CHECK(impl_ && impl_->slot, "the frame has been submitted");
  impl_->submit(VK_NULL_HANDLE, VK_NULL_HANDLE, /*awaited=*/true);
  Context& context = *impl_->context;
  context.device.wait(context.impl->inFlight.back()->timelineValue);
  context.impl->collect(context.timings);
}

void Frame::readback(const Buffer& buffer, uint64_t offset, uint64_t bytes,
                     std::function<void(std::span<const uint8_t>)> done) {
  IRAD_CHECK(offset + bytes <= buffer.bytes, "readback of {} + {} from {} of {} bytes", offset, bytes, buffer.name,
             buffer.bytes);
  const std::byte* mapped = nullptr;
  const auto [staging, stagingOffset] = impl_->stage(bytes, mapped);
  pass("Readback")
      .declare(buffer, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT})
      .record([&, staging = staging, stagingOffset = stagingOffset](VkCommandBuffer commands) {
        const VkBufferCopy region{offset, stagingOffset, bytes};
        if (bytes > 0) vkCmdCopyBuffer(commands, buffer.handle, staging->handle, 1, &region);
      });
  impl_->slot->readbacks.push_back({mapped, bytes, std::move(done)});
}

void Frame::readback(const Image& image, glm::uvec2 corner, glm::uvec2 size,
                     std::function<void(std::span<const uint8_t>)> done) {
  const ImageDesc& d = image.desc;
  IRAD_CHECK(corner.x + size.x <= d.width && corner.y + size.y <= d.height && size.x > 0 && size.y > 0,
             "readback of {} x {} from {}, {} of {}, {} x {}", size.x, size.y, corner.x, corner.y, d.name, d.width,
             d.height);
  const FormatInfo format = formatInfo(d.format);
  const uint64_t bytes = uint64_t{size.x} * size.y * format.bytes;
  const std::byte* mapped = nullptr;
  const auto [staging, stagingOffset] = impl_->stage(bytes, mapped);
  pass("Readback")
      .declare(image, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT})
      .record([&, staging = staging, stagingOffset = stagingOffset](VkCommandBuffer commands) {
        const VkImageAspectFlags aspect =
            format.kind == TexelKind::Depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
        const VkBufferImageCopy region{.bufferOffset = stagingOffset,
                                       .imageSubresource = {aspect, 0, 0, 1},
                                       .imageOffset = {static_cast<int32_t>(corner.x), static_cast<int32_t>(corner.y)},
                                       .imageExtent = {size.x, size.y, 1}};
        vkCmdCopyImageToBuffer(commands, image.handle, VK_IMAGE_LAYOUT_GENERAL, staging->handle, 1, &region);
      });
  impl_->slot->readbacks.push_back({mapped, bytes, std::move(done)});
}

void Frame::Impl::submit(VkSemaphore presentWait, VkSemaphore presentSignal, bool awaited) {
  stopTimer();
  std::unique_ptr<FrameSlot> finished = std::move(slot);
  const Device& device = context->device;
  if (!finished->readbacks.empty()) {
    // The host reads what was copied.
    memoryBarrier(finished->commands, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                  {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
  }
  const auto discard = [&] {
    device.recordingEnded();
    context->impl->destroy(*finished);
  };
  try {
    vkCheck(vkEndCommandBuffer(finished->commands), "ending a command buffer");
    finished->awaited = awaited;
    finished->submitted = std::chrono::steady_clock::now();
    finished->timelineValue = device.submit(finished->commands, presentWait, presentSignal);
  } catch (...) {
    discard();
    throw;
  }
  device.recordingEnded();
  context->impl->inFlight.push_back(std::move(finished));
}

VkDescriptorSet Frame::Impl::allocateSet(VkDescriptorSetLayout layout) {
  const VkDevice device = context->device.handle;
  for (;;) {
    if (slot->descriptorPool == slot->descriptorPools.size()) {
      const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 512},
                                            {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 512},
                                            {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 64}};
      const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                            .maxSets = 256,
                                            .poolSizeCount = std::size(sizes),
                                            .pPoolSizes = sizes};
      VkDescriptorPool pool = VK_NULL_HANDLE;
      vkCheck(vkCreateDescriptorPool(device, &info, nullptr, &pool), "creating a descriptor pool");
      slot->descriptorPools.push_back(pool);
    }
    const VkDescriptorSetAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                               .descriptorPool = slot->descriptorPools[slot->descriptorPool],
                                               .descriptorSetCount = 1,
                                               .pSetLayouts = &layout};
    VkDescriptorSet set = VK_NULL_HANDLE;
    const VkResult result = vkAllocateDescriptorSets(device, &allocate, &set);
    if (result == VK_SUCCESS) return set;
    if (result != VK_ERROR_OUT_OF_POOL_MEMORY && result != VK_ERROR_FRAGMENTED_POOL)
      vkCheck(result, "allocating a descriptor set");
    ++slot->descriptorPool;
  }
}

std::pair<const Buffer*, uint64_t> Frame::Impl::stage(uint64_t bytes, const std::byte*& mapped) {
  constexpr uint64_t kChunk = 1024 * 1024;
  FrameSlot::Chunk* chunk = nullptr;
  for (FrameSlot::Chunk& candidate : slot->staging)
    if (candidate.used + bytes <= candidate.buffer.bytes) chunk = &candidate;
  if (!chunk) {
    slot->staging.push_back(
        {Buffer(context->device, "readback", Subsystem::Staging, std::max(bytes, kChunk), Access::Readback), 0});
    chunk = &slot->staging.back();
  }
  const uint64_t offset = chunk->used;
  chunk->used = (offset + bytes + 15) / 16 * 16;
  mapped = static_cast<const std::byte*>(chunk->buffer.mapped) + offset;
  return {&chunk->buffer, offset};
}

const Buffer& Frame::hostFilled(const char* name, SubsystemName subsystem, uint64_t bytes) {
  FrameSlot& slot = *impl_->slot;
  if (slot.filledUsed == slot.filled.size()) slot.filled.emplace_back();
  Buffer& buffer = slot.filled[slot.filledUsed++];
  if (!buffer || buffer.name != name || buffer.bytes < bytes)  // a quarter more: what grows does so by little
    buffer = Buffer(impl_->context->device, name, subsystem, bytes + bytes / 4, Access::Upload);
  return buffer;
}

void Frame::Impl::beginLabel(const std::string& name) {
  if (!context->device.debugUtils) return;
  const VkDebugUtilsLabelEXT label{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pLabelName = name.c_str()};
  vkCmdBeginDebugUtilsLabelEXT(slot->commands, &label);
}

void Frame::Impl::endLabel() {
  if (context->device.debugUtils) vkCmdEndDebugUtilsLabelEXT(slot->commands);
}

void Frame::Impl::startTimer(const std::string& stage) {
  if (!timed || slot->timing) return;
  const auto timer = static_cast<uint32_t>(slot->timers.size());
  slot->timers.push_back(stage);
  slot->timing = true;
  const Device& device = context->device;
  if (device.timestampBits == 0) return;
  const uint32_t pool = timer / FrameSlot::kTimersPerPool, index = timer % FrameSlot::kTimersPerPool;
  if (pool == slot->queryPools.size()) {
    const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                     .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                     .queryCount = 2 * FrameSlot::kTimersPerPool};
    VkQueryPool created = VK_NULL_HANDLE;
    vkCheck(vkCreateQueryPool(device.handle, &info, nullptr, &created), "creating a query pool");
    slot->queryPools.push_back(created);
  }
  if (index == 0) vkCmdResetQueryPool(slot->commands, slot->queryPools[pool], 0, 2 * FrameSlot::kTimersPerPool);
  // Both timestamps wait for all earlier commands: a stage's time is what it adds to the frame.
  vkCmdWriteTimestamp2(slot->commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, slot->queryPools[pool], 2 * index);
  // Lavapipe batches graphics work past the timestamp unless a barrier follows it.
  if (device.isCpu) everythingBarrier(slot->commands);
}

void Frame::Impl::stopTimer() {
  if (!slot->timing) return;
  slot->timing = false;
  if (context->device.timestampBits == 0) return;
  const auto timer = static_cast<uint32_t>(slot->timers.size()) - 1;
  const uint32_t pool = timer / FrameSlot::kTimersPerPool, index = timer % FrameSlot::kTimersPerPool;
  vkCmdWriteTimestamp2(slot->commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, slot->queryPools[pool], 2 * index + 1);
}

}  // namespace irad
