#include "gi/host_pass.h"

#include <algorithm>

#include "renderer/frame/frame.h"
#include "renderer/frame/transfer.h"

namespace irad {

void timedOnHost(Context& context, const char* stage, const std::function<void()>& work) {
  const double began = context.timings.now();
  work();
  context.timings.add(stage, context.timings.now() - began);
}

namespace {
/// The host's turn with a buffer that lies in its memory: waits for what the device does with it.
void waitFor(Context& context, const Buffer& buffer, bool written) {
  Frame frame = context.beginUntimed();
  frame.pass("Host")
      .declare(buffer, {VK_PIPELINE_STAGE_2_HOST_BIT,
                        written ? VK_ACCESS_2_HOST_READ_BIT | VK_ACCESS_2_HOST_WRITE_BIT : VK_ACCESS_2_HOST_READ_BIT})
      .record([](VkCommandBuffer) {});
  frame.submitAndWait();
}
}  // namespace

uint64_t HostPass::addressOf(const Buffer& buffer, bool written) {
  const auto found = std::ranges::find(used_, buffer.handle, [](const Used& used) { return used.buffer->handle; });
  Used& used = found != used_.end() ? *found : used_.emplace_back(Used{&buffer});
  if (found == used_.end() && buffer.mapped == nullptr) used.copy = download(context_, buffer);
  if (buffer.mapped != nullptr && (found == used_.end() || (written && !used.written)))
    waitFor(context_, buffer, written);
  used.written = used.written || written;
  return reinterpret_cast<uint64_t>(buffer.mapped != nullptr ? buffer.mapped : used.copy.data());
}

void HostPass::finish() {
  for (const Used& used : used_)
    if (used.written && used.buffer->mapped == nullptr) upload(context_, *used.buffer, used.copy);
}

}  // namespace irad
