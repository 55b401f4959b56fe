#include <algorithm>

#include "renderer/base/error.h"
#include "renderer/frame/frame_impl.h"
#include "renderer/frame/workgroups.h"

namespace irad {

VkCommandBuffer Commands::raw() const {
  return frame_->commands();
}

void Commands::bindMaterial(VkDescriptorSet set) {
  IRAD_CHECK(pipeline_->material, "{} declares no set 1", pipeline_->name);
  vkCmdBindDescriptorSets(raw(), pipeline_->bindPoint, pipeline_->layout, 1, 1, &set, 0, nullptr);
}

void Commands::pushBytes(const void* bytes, size_t size) {
  // A scalar-layout block may end before the C++ struct's tail padding, never after it.
  IRAD_CHECK(size % 4 == 0 && size >= pipeline_->pushBytes && size < pipeline_->pushBytes + 8,
             "{}: {} bytes pushed, the shader's block has {}", pipeline_->name, size, pipeline_->pushBytes);
  // An address that another pass gave, or that was taken from a record by hand, would be used without a barrier.
  for (const uint32_t offset : pipeline_->addressOffsets) {
    uint64_t address = 0;
    std::memcpy(&address, static_cast<const std::byte*>(bytes) + offset, sizeof(address));
    IRAD_CHECK(address == 0 || pass_->gave(address),
               "{}: the address at byte {} of what is pushed is none that the "
               "pass {} gave",
               pipeline_->name, offset, pass_->stage_);
  }
  vkCmdPushConstants(raw(), pipeline_->layout, kAllStages, 0, static_cast<uint32_t>(size), bytes);
  pushed_ = true;
}

void Commands::checkPushed() const {
  IRAD_CHECK(pushed_ || pipeline_->pushBytes == 0, "{}: nothing pushed, the shader's block has {} bytes",
             pipeline_->name, pipeline_->pushBytes);
}

void Commands::dispatch(uint64_t invocations) {
  groups(workgroupsFor(invocations, pipeline_->localSize, frame_->context().device.limits.maxComputeWorkGroupCount[0]));
}

void Commands::dispatch(glm::uvec2 invocations) {
  groups(workgroupsFor(invocations, pipeline_->localSize));
}

void Commands::dispatchWorkgroups(uint64_t count) {
  groups(foldedWorkgroups(count, frame_->context().device.limits.maxComputeWorkGroupCount[0]));
}

void Commands::groups(glm::uvec3 count) {
  checkPushed();
  const uint32_t* limit = frame_->context().device.limits.maxComputeWorkGroupCount;
  IRAD_CHECK(count.x <= limit[0] && count.y <= limit[1] && count.z <= limit[2],
             "{}: {}x{}x{} groups, the device allows {}x{}x{}", pipeline_->name, count.x, count.y, count.z, limit[0],
             limit[1], limit[2]);
  if (count.x == 0 || count.y == 0 || count.z == 0) return;
  vkCmdDispatch(raw(), count.x, count.y, count.z);
  ++frame_->context().device.counters.dispatches;
}

void Commands::dispatchIndirect(const Buffer& arguments, uint64_t offset) {
  checkPushed();
  IRAD_CHECK(offset + 12 <= arguments.bytes, "{}: arguments at {} of {} bytes", pipeline_->name, offset,
             arguments.bytes);
  vkCmdDispatchIndirect(raw(), arguments.handle, offset);
  ++frame_->context().device.counters.dispatches;
}

void Commands::draw(uint32_t vertexCount, uint32_t firstVertex, uint32_t instances) {
  checkPushed();
  if (vertexCount == 0 || instances == 0) return;
  vkCmdDraw(raw(), vertexCount, instances, firstVertex, 0);
  ++frame_->context().device.counters.draws;
}

void Commands::drawIndexed(uint32_t indexCount, uint32_t firstIndex) {
  checkPushed();
  if (indexCount == 0) return;
  vkCmdDrawIndexed(raw(), indexCount, 1, firstIndex, 0, 0);
  ++frame_->context().device.counters.draws;
}

void Commands::cull(VkCullModeFlags mode) {
  vkCmdSetCullMode(raw(), mode);
}

void Commands::viewport(float x, float y, float width, float height) {
  // y up: clip space as glTF and OpenGL have it, so counter-clockwise stays counter-clockwise.
  const VkViewport viewport{x, y + height, width, -height, 0.0f, 1.0f};
  const VkRect2D scissor{{static_cast<int32_t>(x), static_cast<int32_t>(y)},
                         {static_cast<uint32_t>(width), static_cast<uint32_t>(height)}};
  vkCmdSetViewport(raw(), 0, 1, &viewport);
  vkCmdSetScissor(raw(), 0, 1, &scissor);
}

void Commands::scissor(uint32_t x, uint32_t y, uint32_t width, uint32_t height) {
  const VkRect2D area{{static_cast<int32_t>(x), static_cast<int32_t>(y)}, {width, height}};
  vkCmdSetScissor(raw(), 0, 1, &area);
}

}  // namespace irad
