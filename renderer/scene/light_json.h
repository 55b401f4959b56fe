// Lights as JSON: what --lights takes, manifests and sidecars hold. Fields: name; type, a kind's name (sun, point,
// spot: scene/light_kind.h); on (absent: true); position [x, y, z] (world; a distant light's is where its handle is
// drawn); color (linear); intensity (distant: lux, else candela); and where the kind has them direction [x, y, z], the
// way it shines, range (absent: unlimited), innerConeAngle and outerConeAngle (half-angles, radians), angle (across,
// degrees) or radius (m; both absent: a point). What is absent has KHR_lights_punctual's value. Numbers keep their
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
