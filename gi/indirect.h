// Indirect diffuse light in pictures (docs/method.md 7): from the facets around each visible point, or the thesis's
// volume.
#pragma once

#include "renderer/forward.h"
#include "shaders/shared/gi_params.h"

namespace irad {

/// Where a picture finds indirect light. Null pointers: there is none, and no Targets::indirect.
struct IndirectInputs {
  const Buffer* grid = nullptr;           ///< one Grid
  const Buffer* reverse = nullptr;        ///< voxel -> facet
  const Buffer* voxel = nullptr;          ///< of the facets
  const Buffer* surface = nullptr;        ///< one SurfaceArrays: lookups go by its links
  const Buffer* shaded = nullptr;         ///< vec4 per facet: H
  const Buffer* shadedEmitted = nullptr;  ///< vec4 per facet: F M; null: not wanted, no Targets::emitted
  bool keepPosition = false;              ///< of the pixel, local space, in Targets::linear
  const Image* volume = nullptr;          ///< RGBA16F, the thesis's lookup, where there is no surface
  SampleParams sample{};
};

/// drawForward with the lookup of indirect light: in the facets by a pass of its own ("RE Forward", too).
void drawScene(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const IndirectInputs& indirect,
               const Buffer& camera, const ShadeParams& shade, Targets& targets, const ForwardEffects& effects = {});

}  // namespace irad
