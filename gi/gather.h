// Direct light onto the facets.
#pragma once

#include "gi/lighting.h"
#include "renderer/shadow.h"

namespace irad {

void gather(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const FacetList& facets,
            Lighting& light, const Settings& settings);

}  // namespace irad
