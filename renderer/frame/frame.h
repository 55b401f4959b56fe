// A command buffer to which passes are recorded (renderer/frame/pass.h), and how often it is waited for.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "renderer/frame/context.h"
#include "renderer/frame/pass.h"
#include "renderer/frame/transfer.h"

namespace irad {

/// One command buffer. Move-only. Record one frame at a time. Dropping an unsubmitted frame (an error unwinds) runs
/// what was recorded, so that the resources' states stay true, and drops its readbacks and timings.
class Frame {
 public:
  Pass pass(std::string_view stage);  ///< stage: a name of docs/method.md 11, or a UI / transfer label
  /// Deferred: `done` is called with the bytes by whoever first notices that the frame has finished.
  void readback(const Buffer& buffer, uint64_t offset, uint64_t bytes,
                std::function<void(std::span<const uint8_t>)> done);
  /// The same of a part of a 2D image: texels from `corner` on, row by row, as the image stores them.
  void readback(const Image& image, glm::uvec2 corner, glm::uvec2 size,
                std::function<void(std::span<const uint8_t>)> done);
  /// At least `bytes` for the host to fill before the frame is submitted and for its passes to read, until the device
  /// has finished with the frame. Frames that ask for the same again use the memory of earlier ones.
  const Buffer& hostFilled(const char* name, SubsystemName subsystem, uint64_t bytes);
  /// Makes the frame a sample of its own in the timing table. It is closed when its times are collected, so nobody has
  /// to wait for it. Its CPU time runs from `began` until it is submitted.
  void sampled(uint64_t frameIndex, std::chrono::steady_clock::time_point began);
  void submit(VkSemaphore presentWait = VK_NULL_HANDLE, VkSemaphore presentSignal = VK_NULL_HANDLE);
  void submitAndWait();
  Context& context() const;
  VkCommandBuffer commands() const;
  ~Frame();
  Frame(Frame&&) noexcept;
  Frame& operator=(Frame&&) noexcept;  ///< what is overwritten is dropped

 private:
  friend class Context;
  friend class Pass;
  friend class Commands;
  Frame() = default;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace irad
