// What is said of the part of a scene that has voxels (gi/region.h).
#pragma once

#include <string>

#include "renderer/scene/scene.h"

namespace irad {

struct Settings;

/// What scene.region leaves out; where auto found a part that holds the detail and takes the whole all the same, why.
/// Else nothing. UsageError as regionOf() has it.
std::string regionLine(const Scene& scene, const Settings& settings);

}  // namespace irad
