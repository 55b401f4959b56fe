#include "gi/host_pass.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "renderer/frame/frame.h"
#include "renderer/frame/transfer.h"

namespace irad {

void timedOnHost(Context& context, const char* stage, const std::function<void()>& work) {
  const double began = context.timings.now();
  work();
  context.timings.add(stage, context.timings.now() - began);
}

HostPass::HostPass(Frame& frame) : context_(frame.context()), frame_(&frame) {}

uint64_t HostPass::addressOf(const Buffer& buffer, bool written) {
  const auto found = std::ranges::find(used_, buffer.handle, [](const Used& used) { return used.buffer->handle; });
  Used& used = found != used_.end() ? *found : used_.emplace_back(Used{&buffer});
  used.written = used.written || written;
  if (buffer.mapped != nullptr) return reinterpret_cast<uint64_t>(buffer.mapped);
  used.copy.resize(buffer.bytes);
  return reinterpret_cast<uint64_t>(used.copy.data());
}

void HostPass::run(const char* stage, const std::function<void()>& work) {
  if (frame_ != nullptr) frame_->submit();
  receive();
  timedOnHost(context_, stage, [&] {
    work();
    giveBack();
  });
  if (frame_ != nullptr) *frame_ = context_.begin();
}

void HostPass::receive() {
  constexpr VkAccessFlags2 kReads = VK_ACCESS_2_HOST_READ_BIT, kWrites = kReads | VK_ACCESS_2_HOST_WRITE_BIT;
  Frame frame = context_.beginUntimed();
  Pass pass = frame.pass("Host");
  for (const Used& used : used_)
    if (used.buffer->mapped != nullptr)
      pass.declare(*used.buffer, {VK_PIPELINE_STAGE_2_HOST_BIT, used.written ? kWrites : kReads});
  pass.record([](VkCommandBuffer) {});
  for (Used& used : used_)
    if (used.buffer->mapped == nullptr)
      frame.readback(*used.buffer, 0, used.copy.size(), [&used](std::span<const uint8_t> bytes) {
        std::memcpy(used.copy.data(), bytes.data(), bytes.size());
      });
  frame.submitAndWait();
}

void HostPass::giveBack() {
  for (const Used& used : used_)
    if (used.written && used.buffer->mapped == nullptr) upload(context_, *used.buffer, used.copy);
}

}  // namespace irad
