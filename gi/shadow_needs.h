// What the settings ask of shadow maps.
#pragma once

#include "renderer/shadow.h"

namespace irad {

struct Settings;

/// Without what a scene's plan and the device decide: which lights shine, the alpha test, who rasterizes.
ShadowNeeds shadowNeeds(const Settings& settings);

}  // namespace irad
