// The table of Vulkan devices.
#pragma once

namespace irad::app {
/// Prints every device and what it lacks to standard output.
void printDevices(bool json);
}  // namespace irad::app
