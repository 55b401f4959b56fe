// Work of the host in the place of a kernel, for devices that are CPUs: the same push constants, with copies in host
// memory behind their addresses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <vector>

namespace irad {

class Buffer;
class Context;

/// Work of the host, as the time of a stage.
void timedOnHost(Context& context, const char* stage, const std::function<void()>& work);

/// As a Pass (renderer/frame/pass.h) gives out addresses, of copies that live as long as it does. Blocking: nothing
/// that uses the buffers may be recorded and not submitted.
class HostPass {
 public:
  explicit HostPass(Context& context) : context_(context) {}
  HostPass(const HostPass&) = delete;
  HostPass& operator=(const HostPass&) = delete;
  uint64_t in(const Buffer& buffer) { return copyOf(buffer, /*written=*/false).address(); }
  /// Read, and written: finish() gives the device what is there then.
  uint64_t out(const Buffer& buffer) { return copyOf(buffer, /*written=*/true).address(); }
  uint64_t accumulate(const Buffer& buffer) { return out(buffer); }
  void finish();

 private:
  struct Copy {
    const Buffer* buffer;
    std::vector<std::byte> bytes;
    bool written;
    uint64_t address() const { return reinterpret_cast<uint64_t>(bytes.data()); }
  };
  Copy& copyOf(const Buffer& buffer, bool written);
  Context& context_;
  std::list<Copy> copies_;
};

}  // namespace irad
