// Emissive triangles, and the pixels that look for them.
#pragma once

#include <span>

#include "renderer/resources.h"

namespace irad {

class Context;
class Frame;
class SceneOnDevice;
struct FacetList;
struct MaterialTraits;
struct Settings;
struct Targets;
struct ViewInputs;

/// The triangles of emissive materials, in voxel units, for pixels that look for emitters themselves
/// (shaders/shared/pixel_emitters.h). None where nothing emits, or more triangles than that takes.
struct EmissiveTriangles {
  uint32_t count = 0;
  Buffer triangles;  ///< an EmissiveTriangle each
};
EmissiveTriangles listEmissiveTriangles(Context& context, const SceneOnDevice& scene,
                                        std::span<const MaterialTraits> materials, const FacetList& facets,
                                        const Buffer& grid);

/// "RE Emitters": of every pixel the light that comes straight from emissive triangles, from their true outlines
/// (shaders/gi/emitters_light.comp), in place of what the facets around it have of it: in targets.emitted and within
/// targets.indirect. Between drawScene and traceSpecular; records nothing where there is no targets.emitted.
void lightByEmitters(Frame& frame, const ViewInputs& inputs, const Settings& settings, Targets& targets);

}  // namespace irad
