// Buffers and images: move-only handles that free themselves once the device has finished with them. Memory is
// sub-allocated, named, and counted per subsystem (docs/method.md 10); a heap's budget is checked before allocation.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/barrier.h"
#include "renderer/device.h"

namespace irad {

/// Which part of the program a resource belongs to, by the name in the memory table and in messages.
struct SubsystemName {
  const char* text;
  bool operator==(const SubsystemName& other) const { return std::string_view(text) == other.text; }
};
/// The renderer's. Layers above add theirs (gi/subsystems.h).
namespace Subsystem {
inline constexpr SubsystemName Scene{"scene"}, Shadow{"shadow"}, Targets{"targets"}, Staging{"staging"};
}

/// Upload / Readback buffers are persistently mapped; on CPU devices all are.
enum class Access { Device, Upload, Readback };

/// What passes know of a buffer: where it lies and how it was last used, and likewise of all buffers whose addresses
/// its content holds (RecordMaker). Stays where it is when the buffer is moved.
struct BufferPlace {
  uint64_t address = 0;
  ResourceState state;
  std::vector<std::shared_ptr<BufferPlace>> holds;
};

class Buffer {
 public:
  Buffer() = default;
  /// Storage + transfer + device address (+ indirect). `bytes` of 0 allocates 16 so that an address always exists.
  /// Throws DeviceError naming the buffer, its subsystem, its size and what is free when memory does not suffice.
  Buffer(const Device& device, std::string name, SubsystemName subsystem, uint64_t bytes,
         Access access = Access::Device);
  ~Buffer();
  Buffer(Buffer&&) noexcept;
  Buffer& operator=(Buffer&&) noexcept;

  explicit operator bool() const { return handle != VK_NULL_HANDLE; }
  VkBuffer handle = VK_NULL_HANDLE;
  uint64_t bytes = 0;
  void* mapped = nullptr;
  std::string name;
  ResourceState& state() const { return place_->state; }  ///< last uses (renderer/barrier.h); not for empty buffers

 private:
  friend class Allocator;
  // Addresses are given out only where their use is tracked: by Pass::in and the like, and by RecordMaker::of.
  friend class Pass;
  friend class RecordMaker;
  std::shared_ptr<BufferPlace> place_;
  const Device* device_ = nullptr;
  uint64_t allocation_ = 0;
};

struct ImageDesc {
  std::string name;
  SubsystemName subsystem = Subsystem::Targets;
  VkFormat format = VK_FORMAT_UNDEFINED;
  uint32_t width = 1, height = 1, depth = 1;  ///< depth > 1, or volume = true: a 3D image
  uint32_t layers = 1, mips = 1;
  bool volume = false, cube = false;  ///< cube: layers is a multiple of 6, viewed as a cube array
  bool array = false;                 ///< view as a 2D array even with one layer
  /// STORAGE is dropped for depth and sRGB formats, which cannot have it; depth formats gain DEPTH_STENCIL_ATTACHMENT.
  VkImageUsageFlags usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                            VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  VkFormat aliasFormat = VK_FORMAT_UNDEFINED;  ///< also viewable in this format (MUTABLE_FORMAT), e.g. rgba8 as r32ui
};

/// Images stay in GENERAL layout; the transition from UNDEFINED happens at first use.
class Image {
 public:
  Image() = default;
  Image(const Device& device, const ImageDesc& desc);
  ~Image();
  Image(Image&&) noexcept;
  Image& operator=(Image&&) noexcept;

  explicit operator bool() const { return handle != VK_NULL_HANDLE; }
  VkImage handle = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;       ///< all mips and layers
  VkImageView aliasView = VK_NULL_HANDLE;  ///< in aliasFormat
  std::vector<VkImageView> layerViews;     ///< mip 0 of each layer, as a render target (layers > 1 or mips > 1)
  ImageDesc desc;
  mutable ResourceState state;
  uint64_t bytes() const;  ///< measured (allocator)

 private:
  friend class Allocator;
  const Device* device_ = nullptr;
  uint64_t allocation_ = 0;
};

/// One row of the memory table: measured by the allocator.
struct MemoryRow {
  std::string name;
  SubsystemName subsystem;
  std::string format;  ///< "buffer" or the image's format and extent
  uint64_t bytes;
  uint64_t texelBytes = 0;  ///< what an image's extent and format come to
};

class Allocator {
 public:
  explicit Allocator(const Device& device);
  ~Allocator();
  std::vector<MemoryRow> rows() const;  ///< live resources, largest first
  uint64_t used() const;
  uint64_t peak() const;  ///< the most that was used at once
  void forgetPeak();      ///< it begins again, from what is used now
  /// Bytes this process may use on the device-local heap: its size less a reserve, DeviceOptions::memoryBudget at most.
  uint64_t budget() const;
  /// Throws DeviceError "NAME (SUBSYSTEM) needs A MiB, B of C MiB are free" if `bytes` more would exceed the budget.
  void check(SubsystemName subsystem, const std::string& name, uint64_t bytes) const;
  struct Impl;

 private:
  friend class Buffer;
  friend class Image;
  std::unique_ptr<Impl> impl_;
};

enum class Wrap { Repeat, Mirror, Clamp };
struct SamplerDesc {
  Wrap u = Wrap::Repeat, v = Wrap::Repeat;
  bool linearMag = true, linearMin = true, mips = true, linearMips = true;
  bool anisotropic = false;  ///< where the device can; all filters linear
  bool operator==(const SamplerDesc&) const = default;
};
/// Cached by the device; never freed before it.
VkSampler sampler(const Device& device, const SamplerDesc& desc);
/// Nearest texel, no mips.
VkSampler pointSampler(const Device& device);

}  // namespace irad
