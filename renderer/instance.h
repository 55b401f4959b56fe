// Instance creation and the physical devices in words. Private to renderer/.
#pragma once

#include <volk.h>

#include <mutex>
#include <string>
#include <vector>

#include "renderer/device.h"

namespace irad {

/// Messages of the validation layer that count: warnings and worse, without performance notes and the loader's own.
struct ValidationLog {
  mutable std::mutex mutex;
  std::vector<std::string> messages;
};

struct Instance {
  VkInstance handle = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  bool debugUtils = false;
};

/// `log` receives the validation messages and must outlive the instance; null: no validation.
Instance createInstance(ValidationLog* log, bool presentable);
void destroyInstance(Instance& instance);

std::vector<VkPhysicalDevice> physicalDevices(VkInstance instance);

/// Everything irad asks of a device, filled for vkCreateDevice or by vkGetPhysicalDeviceFeatures2.
struct FeatureChain {
  VkPhysicalDeviceFeatures2 core{};
  VkPhysicalDeviceVulkan11Features v11{};
  VkPhysicalDeviceVulkan12Features v12{};
  VkPhysicalDeviceVulkan13Features v13{};
  FeatureChain();
  FeatureChain(const FeatureChain&) = delete;
};

/// Needs that the device does not meet, in words.
std::vector<std::string> missingNeeds(VkPhysicalDevice device, bool presentable);
/// The needs plus what is available of the wishes.
void chooseFeatures(VkPhysicalDevice device, FeatureChain& chosen);
/// Device::narrowGraphics of a device of this name.
bool hasNarrowGraphics(std::string_view name);
bool hasExtension(VkPhysicalDevice device, const char* name);
/// A queue family for graphics, compute and transfer; UINT32_MAX if there is none.
uint32_t graphicsComputeFamily(VkPhysicalDevice device);

DeviceInfo describe(VkPhysicalDevice device, uint32_t index, bool presentable);
std::string toText(const std::vector<DeviceInfo>& devices);

}  // namespace irad
