// The interactive window as subcommands open it.
#pragma once

#include "app/arguments.h"
#include "ui/window.h"

namespace irad::app {

class Machine;

/// Resolves the settings, opens the device and runs the window on it. WorkError with the validation messages, if there
/// are any.
void openWindow(Machine& machine, WindowOptions options, const Config& config, const SettingArguments& settings,
                const SceneArguments& scene, const DeviceArguments& device);

}  // namespace irad::app
