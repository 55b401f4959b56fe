// Work of the host in the place of a kernel, for devices that are CPUs: the same push constants, with the host's
// addresses of the same memory or, where the host cannot reach that, of copies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <vector>

#include "renderer/resources.h"

namespace irad {

class Context;
class Frame;

/// Work of the host, as the time of a stage.
void timedOnHost(Context& context, const char* stage, const std::function<void()>& work);

/// As a Pass (renderer/frame/pass.h) gives out addresses, which hold as long as it lives.
class HostPass {
 public:
  explicit HostPass(Context& context) : context_(context) {}
  /// In the middle of a frame: run() submits what has been recorded of it before, and begins it anew after.
  explicit HostPass(Frame& frame);
  HostPass(const HostPass&) = delete;
  HostPass& operator=(const HostPass&) = delete;
  uint64_t in(const Buffer& buffer) { return addressOf(buffer, /*written=*/false); }
  uint64_t inIfAny(const Buffer& buffer) { return buffer ? in(buffer) : 0; }
  /// Read, and written.
  uint64_t out(const Buffer& buffer, uint64_t offset = 0) { return addressOf(buffer, /*written=*/true) + offset; }
  uint64_t accumulate(const Buffer& buffer) { return out(buffer); }
  /// The work, as the time of a stage: what lies at the addresses is there now. Blocking: nothing that uses the buffers
  /// may be recorded and not submitted.
  void run(const char* stage, const std::function<void()>& work);

 private:
  struct Used {
    const Buffer* buffer;
    std::vector<std::byte> copy = {};  ///< of one that is not mapped
    bool written = false;
  };
  uint64_t addressOf(const Buffer& buffer, bool written);
  void receive();   ///< from the device
  void giveBack();  ///< what was written
  Context& context_;
  Frame* frame_ = nullptr;
  std::list<Used> used_;
};

}  // namespace irad
