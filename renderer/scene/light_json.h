// Lights as JSON: what --lights takes, manifests and sidecars hold. Fields: name; type sun, point or spot; position
// [x, y, z] (world; a sun's is where its handle is drawn); direction [x, y, z] of suns and spots, the way they shine;
// color (linear); intensity (sun: lux, else candela); range (point, spot; absent: unlimited); innerConeAngle and
// outerConeAngle of spots (half-angles, radians). What is absent has KHR_lights_punctual's value. Numbers keep their
// bits.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "renderer/scene/scene.h"

namespace irad {

/// An array.
std::string lightsToJson(const std::vector<Light>& lights);
/// UsageError "LABEL[2]: FIELD: ...".
std::vector<Light> lightsFromJson(std::string_view json, const std::string& label = "lights");

}  // namespace irad
