// What irad needs from a device, in words, and which optional features a device has.
#include <algorithm>
#include <string_view>

#include "renderer/base/error.h"
#include "renderer/instance.h"

namespace irad {
namespace {

struct Feature {
  const char* name;
  VkBool32* (*member)(FeatureChain&);
  bool needed;
};

// One row per feature; needed ones make a device unsuitable when absent, the others are enabled when present.
#define ROW(part, member, needed)                                    \
  Feature {                                                          \
#member, [](FeatureChain & c) { return &c.part.member; }, needed \
  }
constexpr bool kNeed = true, kWish = false;
const Feature kFeatures[] = {
    ROW(core.features, fragmentStoresAndAtomics, kNeed),
    ROW(core.features, vertexPipelineStoresAndAtomics, kNeed),
    ROW(core.features, imageCubeArray, kNeed),
    ROW(core.features, independentBlend, kNeed),
    ROW(core.features, shaderInt64, kNeed),
    ROW(core.features, shaderInt16, kNeed),
    ROW(core.features, shaderStorageImageExtendedFormats, kNeed),
    ROW(v11, storageBuffer16BitAccess, kNeed),
    ROW(v12, storageBuffer8BitAccess, kNeed),
    ROW(v12, shaderInt8, kNeed),
    ROW(v12, shaderFloat16, kNeed),
    ROW(v12, scalarBlockLayout, kNeed),
    ROW(v12, bufferDeviceAddress, kNeed),
    ROW(v12, timelineSemaphore, kNeed),
    ROW(v12, hostQueryReset, kNeed),
    ROW(v13, dynamicRendering, kNeed),
    ROW(v13, synchronization2, kNeed),
    ROW(v13, maintenance4, kNeed),
    ROW(v13, shaderDemoteToHelperInvocation, kNeed),
    ROW(v13, shaderTerminateInvocation, kNeed),
    ROW(core.features, samplerAnisotropy, kWish),
    ROW(core.features, shaderFloat64, kWish),
    ROW(core.features, depthClamp, kWish),
    ROW(core.features, fillModeNonSolid, kWish),
    ROW(core.features, shaderImageGatherExtended, kWish),
    ROW(core.features, shaderStorageImageReadWithoutFormat, kWish),
    ROW(core.features, shaderStorageImageWriteWithoutFormat, kWish),
    ROW(core.features, multiDrawIndirect, kWish),
    ROW(core.features, drawIndirectFirstInstance, kWish),
    ROW(v11, uniformAndStorageBuffer16BitAccess, kWish),
    ROW(v11, shaderDrawParameters, kWish),
    ROW(v12, uniformAndStorageBuffer8BitAccess, kWish),
    ROW(v12, shaderBufferInt64Atomics, kWish),
    ROW(v12, shaderSharedInt64Atomics, kWish),
    ROW(v12, shaderSubgroupExtendedTypes, kWish),
    ROW(v12, shaderOutputLayer, kWish),
    ROW(v12, vulkanMemoryModel, kWish),
    ROW(v12, vulkanMemoryModelDeviceScope, kWish),
    ROW(v13, subgroupSizeControl, kWish),
    ROW(v13, computeFullSubgroups, kWish),
    ROW(v13, shaderZeroInitializeWorkgroupMemory, kWish),
    ROW(v13, shaderIntegerDotProduct, kWish),
};
#undef ROW

const char* typeName(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "cpu";
    default:
      return "other";
  }
}

}  // namespace

FeatureChain::FeatureChain() {
  v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  v12.pNext = &v13;
  v11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
  v11.pNext = &v12;
  core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  core.pNext = &v11;
}

bool hasExtension(VkPhysicalDevice device, const char* name) {
  uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const VkExtensionProperties& e) { return std::string_view(e.extensionName) == name; });
}

uint32_t graphicsComputeFamily(VkPhysicalDevice device) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  constexpr VkQueueFlags kBoth = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  for (uint32_t i = 0; i < count; ++i)
    if ((families[i].queueFlags & kBoth) == kBoth) return i;
  return UINT32_MAX;
}

std::vector<std::string> missingNeeds(VkPhysicalDevice device, bool presentable) {
  std::vector<std::string> missing;
  VkPhysicalDeviceSubgroupProperties subgroup{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
  VkPhysicalDeviceProperties2 all{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &subgroup};
  vkGetPhysicalDeviceProperties2(device, &all);
  const VkPhysicalDeviceProperties& properties = all.properties;
  if (properties.apiVersion < VK_API_VERSION_1_3)
    return {fmt::format("Vulkan 1.3 (it has {}.{})", VK_API_VERSION_MAJOR(properties.apiVersion),
                        VK_API_VERSION_MINOR(properties.apiVersion))};
  FeatureChain has;
  vkGetPhysicalDeviceFeatures2(device, &has.core);
  for (const Feature& feature : kFeatures)
    if (feature.needed && !*feature.member(has)) missing.push_back(fmt::format("feature {}", feature.name));
  if (graphicsComputeFamily(device) == UINT32_MAX) missing.emplace_back("a queue for both graphics and compute");

  constexpr VkSubgroupFeatureFlags kOperations = VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT |
                                                 VK_SUBGROUP_FEATURE_BALLOT_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
  if ((subgroup.supportedOperations & kOperations) != kOperations ||
      !(subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT))
    missing.emplace_back("subgroup arithmetic, ballot and shuffle in compute shaders");
  if (properties.limits.maxComputeWorkGroupInvocations < 256)
    missing.push_back(
        fmt::format("workgroups of 256 invocations (it has {})", properties.limits.maxComputeWorkGroupInvocations));
  if (presentable && !hasExtension(device, VK_KHR_SWAPCHAIN_EXTENSION_NAME))
    missing.emplace_back("presentation to a window (VK_KHR_swapchain)");
  return missing;
}

void chooseFeatures(VkPhysicalDevice device, FeatureChain& chosen) {
  FeatureChain has;
  vkGetPhysicalDeviceFeatures2(device, &has.core);
  for (const Feature& feature : kFeatures)
    if (*feature.member(has)) *feature.member(chosen) = VK_TRUE;
}

DeviceInfo describe(VkPhysicalDevice device, uint32_t index, bool presentable) {
  VkPhysicalDeviceDriverProperties driver{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
  vkGetPhysicalDeviceProperties2(device, &properties);
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(device, &memory);
  DeviceInfo info;
  info.index = index;
  info.name = properties.properties.deviceName;
  info.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
  info.type = typeName(properties.properties.deviceType);
  const uint32_t v = properties.properties.apiVersion;
  info.apiVersion = fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(v), VK_API_VERSION_MINOR(v), VK_API_VERSION_PATCH(v));
  for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
    if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
      info.memoryBytes = std::max<uint64_t>(info.memoryBytes, memory.memoryHeaps[i].size);
  info.missing = missingNeeds(device, presentable);
  return info;
}

bool hasNarrowGraphics(std::string_view name) {
  constexpr std::string_view kNarrow[] = {"H100", "H200", "H800", "H20"};  // the GH100 chip, alone or as a GH200
  return name.starts_with("NVIDIA") && std::any_of(std::begin(kNarrow), std::end(kNarrow), [&](std::string_view chip) {
           return name.find(chip) != std::string_view::npos;
         });
}

std::string toText(const std::vector<DeviceInfo>& devices) {
  if (devices.empty()) return "  (no Vulkan device)\n";
  std::string text;
  for (const DeviceInfo& d : devices) {
    text += fmt::format("  {}: {} ({}, Vulkan {}, {}): ", d.index, d.name, d.type, d.apiVersion, d.driver);
    text += d.missing.empty() ? "suitable" : "lacks ";
    for (size_t i = 0; i < d.missing.size(); ++i) text += (i ? ", " : "") + d.missing[i];
    text += "\n";
  }
  return text;
}

}  // namespace irad
