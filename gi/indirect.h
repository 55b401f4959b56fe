// Indirect diffuse light in pictures (docs/method.md 7): from the facets around each visible point, or the thesis's
// volume.
#pragma once

#include "renderer/forward.h"
#include "shaders/shared/gi_params.h"

namespace irad {

struct FacetList;
struct Field;

/// Where a picture finds indirect light. Null pointers: there is none, and no Targets::indirect.
struct IndirectInputs {
  const Buffer* grid = nullptr;           ///< one Grid
  const FacetList* facets = nullptr;      ///< lookups go by their surface, where they have one
  const Field* field = nullptr;           ///< for rays that check the shadow maps
  const Buffer* direct = nullptr;         ///< vec4 per facet: D
  const Buffer* shaded = nullptr;         ///< vec4 per facet: H
  const Buffer* shadedEmitted = nullptr;  ///< vec4 per facet: F M; null: not wanted, no Targets::emitted
  bool keepFacet = false;                 ///< of the pixel, in Targets::facet
  bool keepPosition = false;              ///< of the pixel, local space, in Targets::linear
  const Image* volume = nullptr;          ///< RGBA16F, the thesis's lookup, where there is no surface
  SampleParams sample{};
  /// Invocations that share the search for a pixel's facet: 1, 32, or 0, as the device calls for.
  uint32_t searchers = 0;
};

/// drawForward with the lookup of indirect light: in the facets by a pass of its own ("RE Forward", too). What shadow
/// maps let through walls that are thinner than their texels is taken out where the facets know better.
void drawScene(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const IndirectInputs& indirect,
               const Buffer& camera, const ShadeParams& shade, Targets& targets, const ForwardEffects& effects = {});

}  // namespace irad
