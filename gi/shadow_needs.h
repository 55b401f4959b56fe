// What the settings ask of shadow maps.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "renderer/scene/scene.h"
#include "renderer/shadow.h"

namespace irad {

struct Settings;

/// Without what a scene's plan and the device decide: which lights shine, the alpha test, who rasterizes.
ShadowNeeds shadowNeeds(const Settings& settings);

/// "159 of 500 lights cast no shadow: lamp 342, lamp 343, … and 154 more. …", of these `without` a map.
std::string describeWithoutShadow(std::span<const Light> lights, std::span<const uint32_t> without);

}  // namespace irad
