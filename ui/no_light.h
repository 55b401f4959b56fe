// A scene without any light makes a black picture: what there is of each kind of it.
#pragma once

#include <string>
#include <vector>

#include "gi/plan.h"

namespace irad {

/// A line per kind of light, by the plan: "no sun", "2 point lights, none with an intensity", "none of 3 materials emits".
/// None where any kind lights the scene.
std::vector<std::string> noLight(const EffectPlan& plan);

}  // namespace irad
