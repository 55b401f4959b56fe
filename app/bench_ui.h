// `irad bench --ui`: what the window's panels cost.
#pragma once

#include "app/arguments.h"

namespace irad::app {

class Machine;

/// CPU time per frame of all panels, open, while pictures follow each other; printed beside its mark. Throws
/// DeviceError where there is no display, UsageError in a build without a window.
void measureUi(Machine& machine, const std::optional<std::string>& scene, const std::optional<std::string>& view,
               const PictureArguments& picture, const SettingArguments& settings, const SceneArguments& sceneOptions,
               const DeviceArguments& device);

}  // namespace irad::app
