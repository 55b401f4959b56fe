// Direct light onto the facets.
#pragma once

namespace irad {

class Frame;
class SceneOnDevice;
struct FacetList;
struct Lighting;
struct Settings;
struct ShadowMaps;

void gather(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const FacetList& facets,
            Lighting& light, const Settings& settings);

}  // namespace irad
