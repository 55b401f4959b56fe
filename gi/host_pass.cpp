#include "gi/host_pass.h"

#include "renderer/frame/transfer.h"

namespace irad {

void timedOnHost(Context& context, const char* stage, const std::function<void()>& work) {
  const double began = context.timings.now();
  work();
  context.timings.add(stage, context.timings.now() - began);
}

HostPass::Copy& HostPass::copyOf(const Buffer& buffer, bool written) {
  for (Copy& copy : copies_) {
    if (copy.buffer->handle != buffer.handle) continue;
    copy.written = copy.written || written;
    return copy;
  }
  copies_.push_back({&buffer, download(context_, buffer), written});
  return copies_.back();
}

void HostPass::finish() {
  for (const Copy& copy : copies_)
    if (copy.written) upload(context_, *copy.buffer, copy.bytes);
}

}  // namespace irad
