#include "renderer/instance.h"

#include <algorithm>
#include <cstring>

#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/vulkan_check.h"

namespace irad {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

/// An attachment without a format is unused: what the shader writes there is dropped (VkPipelineRenderingCreateInfo).
/// The layer of Vulkan 1.3.239 compares the types all the same.
bool isDroppedOutput(const VkDebugUtilsMessengerCallbackDataEXT* data) {
  return data->pMessageIdName && data->pMessage &&
         std::strcmp(data->pMessageIdName, "UNASSIGNED-CoreValidation-Shader-InterfaceTypeMismatch") == 0 &&
         std::strstr(data->pMessage, "VK_FORMAT_UNDEFINED");
}

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                         VkDebugUtilsMessageTypeFlagsEXT types,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  if (severity < VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT) return VK_FALSE;
  if (types & VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT) return VK_FALSE;
  if (data->pMessageIdName && std::strcmp(data->pMessageIdName, "Loader Message") == 0) return VK_FALSE;
  if (isDroppedOutput(data)) return VK_FALSE;
  auto* log = static_cast<ValidationLog*>(user);
  const std::lock_guard lock(log->mutex);
  log->messages.emplace_back(data->pMessage ? data->pMessage : "(no text)");
  tell("validation: {}\n", log->messages.back());
  return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(ValidationLog* log) {
  return {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
          .messageSeverity =
              VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
          .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
          .pfnUserCallback = onMessage,
          .pUserData = log};
}

std::vector<VkExtensionProperties> instanceExtensions(const char* layer) {
  uint32_t count = 0;
  vkEnumerateInstanceExtensionProperties(layer, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  vkEnumerateInstanceExtensionProperties(layer, &count, extensions.data());
  return extensions;
}

bool hasLayer(const char* name) {
  uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  vkEnumerateInstanceLayerProperties(&count, layers.data());
  return std::any_of(layers.begin(), layers.end(), [&](const auto& l) { return !std::strcmp(l.layerName, name); });
}

}  // namespace

Instance createInstance(ValidationLog* log, bool presentable) {
  if (volkInitialize() != VK_SUCCESS)
    throw DeviceError("no Vulkan loader: libvulkan.so.1 was not found (Debian package libvulkan1)");
  const uint32_t version = volkGetInstanceVersion();
  if (version < VK_API_VERSION_1_3)
    throw DeviceError(fmt::format("the Vulkan loader is version {}.{}; 1.3 is needed", VK_API_VERSION_MAJOR(version),
                                  VK_API_VERSION_MINOR(version)));
  if (log && !hasLayer(kValidationLayer))
    throw DeviceError(fmt::format("--validate: the layer {} is not installed (Debian package vulkan-validationlayers)",
                                  kValidationLayer));

  std::vector<VkExtensionProperties> available = instanceExtensions(nullptr);
  if (log)
    for (const auto& e : instanceExtensions(kValidationLayer)) available.push_back(e);
  std::vector<const char*> extensions;
  const auto enable = [&](const char* name) {
    const bool found = std::any_of(available.begin(), available.end(),
                                   [&](const auto& e) { return !std::strcmp(e.extensionName, name); });
    if (found) extensions.push_back(name);
    return found;
  };
  Instance instance;
  instance.debugUtils = enable("VK_EXT_debug_utils");
  if (log) enable("VK_EXT_validation_features");
  if (presentable) {
    if (!enable("VK_KHR_surface")) throw DeviceError("the Vulkan loader has no VK_KHR_surface: no window is possible");
    for (const char* name : {"VK_KHR_xcb_surface", "VK_KHR_xlib_surface", "VK_KHR_wayland_surface",
                             "VK_KHR_win32_surface", "VK_EXT_metal_surface"})
      enable(name);
  }

  const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                      .pApplicationName = "irad",
                                      .pEngineName = "irad",
                                      .apiVersion = VK_API_VERSION_1_3};
  const VkValidationFeatureEnableEXT enabled[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
  VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(log);
  const VkValidationFeaturesEXT features{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                         .pNext = &messenger,
                                         .enabledValidationFeatureCount = 1,
                                         .pEnabledValidationFeatures = enabled};
  const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                  .pNext = log ? &features : nullptr,
                                  .pApplicationInfo = &application,
                                  .enabledLayerCount = log ? 1u : 0u,
                                  .ppEnabledLayerNames = &kValidationLayer,
                                  .enabledExtensionCount = static_cast<uint32_t>(extensions.size()),
                                  .ppEnabledExtensionNames = extensions.data()};
  vkCheck(vkCreateInstance(&info, nullptr, &instance.handle), "creating the Vulkan instance");
  // The loader's trampolines serve every device of every instance; a per-device table would serve only the last one.
  volkLoadInstance(instance.handle);
  if (log) {
    IRAD_CHECK(instance.debugUtils, "the validation layer without VK_EXT_debug_utils");
    vkCheck(vkCreateDebugUtilsMessengerEXT(instance.handle, &messenger, nullptr, &instance.messenger),
            "creating the validation messenger");
  }
  return instance;
}

void destroyInstance(Instance& instance) {
  if (instance.messenger) vkDestroyDebugUtilsMessengerEXT(instance.handle, instance.messenger, nullptr);
  if (instance.handle) vkDestroyInstance(instance.handle, nullptr);
  instance = {};
}

std::vector<VkPhysicalDevice> physicalDevices(VkInstance instance) {
  uint32_t count = 0;
  vkCheck(vkEnumeratePhysicalDevices(instance, &count, nullptr), "listing the Vulkan devices");
  std::vector<VkPhysicalDevice> devices(count);
  if (count) vkCheck(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "listing the Vulkan devices");
  return devices;
}

}  // namespace irad
