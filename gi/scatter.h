// What shading samples, from the light of the facets.
#pragma once

#include "gi/lighting.h"

namespace irad {

/// `blurred` and `blurredEmitted`, with report.blurChange; and the volume where it exists (gi/thesis/volume.h). `light`
/// must stay where it is until the frame has finished: light.report.blurChange is read back. `watchBlur`: blurChange
/// also where the settings have no blur, without the copies.
void scatter(Frame& frame, const FacetList& facets, Lighting& light, const Settings& settings, bool watchBlur = false);

}  // namespace irad
