// The private part of Device.
#pragma once

#include <deque>
#include <utility>

#include "renderer/instance.h"
#include "renderer/resources.h"

namespace irad {

struct Device::Impl {
  ValidationLog log;
  Instance instance;
  VkSemaphore timeline = VK_NULL_HANDLE;
  std::atomic<bool> lost = false;  ///< DeviceOptions::loseDevice has struck

  std::mutex mutex;  ///< guards what follows
  uint64_t submitted = 0;
  int recording = 0;  ///< open command buffers
  std::vector<std::function<void()>> retiredWhileRecording;
  std::deque<std::pair<uint64_t, std::function<void()>>> retired;  ///< (timeline value, destroy), values ascending

  std::mutex samplerMutex;
  std::vector<std::pair<SamplerDesc, VkSampler>> samplers;

  /// Runs what was retired at or before the timeline's present value.
  void collect(VkDevice device);
};

}  // namespace irad
