#include "renderer/vulkan_check.h"

#include "renderer/base/error.h"

namespace irad {

void vkCheck(VkResult result, std::string_view what) {
  if (result == VK_SUCCESS) return;
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      throw DeviceError(fmt::format("{}: out of host memory", what));
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      throw DeviceError(fmt::format("{}: out of device memory", what));
    case VK_ERROR_DEVICE_LOST:
      throw WorkError(fmt::format("{}: the device was lost (its driver was reset, it hung, or it was removed)", what));
    case VK_ERROR_INITIALIZATION_FAILED:
      throw DeviceError(fmt::format("{}: initialization failed", what));
    case VK_ERROR_LAYER_NOT_PRESENT:
      throw DeviceError(fmt::format("{}: a layer is not present", what));
    case VK_ERROR_EXTENSION_NOT_PRESENT:
      throw DeviceError(fmt::format("{}: an extension is not present", what));
    case VK_ERROR_FEATURE_NOT_PRESENT:
      throw DeviceError(fmt::format("{}: a feature is not present", what));
    default:
      throw WorkError(fmt::format("{}: VkResult {}", what, static_cast<int>(result)));
  }
}

}  // namespace irad
