// VkResult -> an error in words. Private to renderer/.
#pragma once

#include <volk.h>

#include <string_view>

namespace irad {

/// Throws DeviceError when memory ran out, WorkError otherwise (device loss included), unless `result` is VK_SUCCESS.
void vkCheck(VkResult result, std::string_view what);

}  // namespace irad
