#include "renderer/barrier.h"

namespace irad {
namespace {

constexpr VkAccessFlags2 kWrites = VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                                   VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                                   VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT |
                                   VK_ACCESS_2_HOST_WRITE_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;

bool covers(const Use& a, const Use& b) {
  return (b.stages & ~a.stages) == 0 && (b.access & ~a.access & ~kWrites) == 0;
}

}  // namespace

bool Use::writes() const {
  return (access & kWrites) != 0;
}

Dependency dependency(const ResourceState& state, const Use& next) {
  const Use& written = state.lastWrite;
  const Use& read = state.readsSince;

  if (!next.writes()) {
    // Read after write; reads that an earlier barrier has served need nothing. The destination repeats the earlier
    // reads so that every pair (stage, access) of the union `readsSince` really has been made visible.
    if (written.stages == 0 || covers(read, next)) return {};
    return {written, {read.stages | next.stages, read.access | next.access}};
  }
  // Write after read: whoever read has already waited for the write before, so waiting for the readers suffices, unless
  // `next` also reads what has not been made visible to it. The destination names the access: a write before the read
  // is ordered before `next` by the chain of the two.
  if (read.stages != 0) {
    const bool alsoReads = (next.access & ~kWrites) != 0;
    if (written.stages == 0 || !alsoReads || covers(read, next)) return {{read.stages, 0}, next};
    return {{written.stages | read.stages, written.access}, next};
  }
  // Write after write. Of passes that commute only the first waits.
  if (next.commutes && written == Use{next.stages, next.access & kWrites, true}) return {};
  if (written.stages != 0) return {written, next};
  return {};
}

ResourceState advance(const ResourceState& state, const Use& next) {
  ResourceState after = state;
  after.defined = true;
  if (next.writes()) {
    after.lastWrite = {next.stages, next.access & kWrites, next.commutes};
    after.readsSince = {};
  } else {
    after.readsSince.stages |= next.stages;
    after.readsSince.access |= next.access;
  }
  return after;
}

}  // namespace irad
