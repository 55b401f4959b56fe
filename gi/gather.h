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

/// `onHost`: on CPU devices the host traces the rays, where this build can. At once, then: before what the frame has
/// recorded.
void gather(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const FacetList& facets,
            const Field& field, Lighting& light, const Settings& settings, bool onHost = true);

}  // namespace irad
