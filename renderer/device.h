// The Vulkan instance, device, queue, and what they can do. Vulkan 1.3 with dynamic rendering, synchronization2, buffer
// device address, timeline semaphores, scalar block layout, 8/16-bit storage and int64 is the floor (lavapipe has it).
#pragma once

#include <volk.h>

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "renderer/counters.h"

namespace irad {

class Allocator;
struct SamplerDesc;

struct DeviceOptions {
  std::string select;         ///< index or part of a name (case-insensitive); empty: the best suitable device
  bool validate = false;      ///< core + synchronization validation; every message is counted and kept
  bool presentable = false;   ///< enable the surface and swapchain extensions (GLFW names them)
  bool poison = false;        ///< fill all fresh device memory with NaN bit patterns
  uint64_t memoryBudget = 0;  ///< bytes that may be taken of the device's own heap; 0: what the heap allows
  /// Bytes of freed memory that wait for what is made next; none: a share of the budget, on a CPU device 0.
  std::optional<uint64_t> keptMemory;
  // Failures to provoke, to see what follows. They are compared with `counters`; set again, they strike again.
  uint64_t failResource = 0;  ///< the buffer or image of this number finds no memory, from 1; 0: none
  uint64_t loseDevice = 0;    ///< the device is lost at the submission or wait of this number, from 1; 0: never
  bool operator==(const DeviceOptions&) const = default;
};

/// One physical device as `--list-devices` shows it.
struct DeviceInfo {
  uint32_t index = 0;
  std::string name, driver, type;  ///< type: "discrete", "integrated", "virtual", "cpu", "other"
  std::string apiVersion;
  uint64_t memoryBytes = 0;          ///< largest device-local heap
  std::vector<std::string> missing;  ///< needs it does not meet, in words; empty: suitable
};

class Device {
 public:
  /// Throws DeviceError listing every device and what it lacks when none is suitable.
  static std::unique_ptr<Device> create(const DeviceOptions& options);
  static std::vector<DeviceInfo> list();
  ~Device();
  Device(const Device&) = delete;

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice handle = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  uint32_t queueFamily = 0;
  DeviceOptions options;
  DeviceInfo info;
  VkPhysicalDeviceLimits limits{};
  VkDeviceSize maxAllocation = 0;  ///< maxMemoryAllocationSize
  uint32_t subgroupSize = 0;
  uint32_t timestampBits = 0;  ///< 0: the queue has no timestamps
  bool debugUtils = false;     ///< object names and labels reach a debugger
  bool anisotropy = false;     ///< samplers may be anisotropic
  bool memoryBudget = false;   ///< VK_EXT_memory_budget
  bool isCpu = false;          ///< Mesa's CPU driver: smaller defaults, and workarounds where they are needed
  bool int64Atomics = false;   ///< on buffers
  /// Few of its processors serve the graphics pipeline: two of an H100's 66 TPCs run vertex and fragment shaders
  /// (NVIDIA, "H100 Tensor Core GPU Architecture", 2022). No query tells, so such devices are known by name.
  bool narrowGraphics = false;
  mutable LiveCounters counters;

  Allocator& memory() const { return *allocator_; }

  void name(VkObjectType type, uint64_t object, const std::string& name) const;

  /// Runs `destroy` once every submission made so far, and every command buffer being recorded now, has finished on
  /// the device.
  void retire(std::function<void()> destroy) const;
  /// Called by frames around the recording of a command buffer, which may use what is retired meanwhile.
  void recordingBegan() const;
  void recordingEnded() const;
  // The next four throw WorkError once the device is lost (driver reset, hang, removal): nothing brings it back.
  /// Submits `commands`; returns the timeline value that `wait` takes. `presentWait`/`presentSignal` may be null.
  uint64_t submit(VkCommandBuffer commands, VkSemaphore presentWait = VK_NULL_HANDLE,
                  VkSemaphore presentSignal = VK_NULL_HANDLE) const;
  void wait(uint64_t timelineValue) const;
  bool finished(uint64_t timelineValue) const;
  void waitIdle() const;
  /// waitIdle for destructors. False: the device is lost, and runs nothing any more.
  bool settle() const noexcept;

  /// Validation messages of severity >= WARNING, PERFORMANCE and loader messages excluded. A test fails on any.
  std::vector<std::string> validationMessages() const;

 private:
  Device();
  bool losesHere() const;
  friend VkSampler sampler(const Device& device, const SamplerDesc& desc);
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::unique_ptr<Allocator> allocator_;
};

}  // namespace irad
