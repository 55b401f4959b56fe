// Direct light onto the facets: past the triangles where they are pieces of the true surface (Surface), through the
// shadow maps where they are planes.
#pragma once

namespace irad {

class Frame;
class SceneOnDevice;
struct FacetList;
struct Field;
struct Lighting;
struct Settings;
struct ShadowMaps;

void gather(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const FacetList& facets,
            const Field& field, Lighting& light, const Settings& settings);

}  // namespace irad
