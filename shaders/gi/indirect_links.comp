// "RE Forward", last step: indirect light of each visible point from the facet that it lies on and those that continue
// its surface (docs/method.md 7), less what the bumps of a normal map keep from it. The forward pass has left position,
// triangle and that share in the targets (forward/shade.glsl). Run twice: pixels whose facet is not found at once are
// listed and left to a kernel that searches for it.
#version 460
#pragma optimize(on)
#extension GL_GOOGLE_include_directive : require
#include "forward/camera_view.glsl"
#include "forward/tile_pixel.glsl"
#include "shared/constants.h"
#include "shared/indirect.h"
#include "shared/passes.h"

layout(local_size_x = PICKED_GROUP) in;
layout(constant_id = CONSTANT_EMITTED) const bool EMITTED = true;  ///< F M too: there is a target for it
/// In the place of what the lookup needs; w: seenAs(), 0 where nothing is drawn.
layout(constant_id = CONSTANT_KEEPS_POSITION) const bool KEEPS_POSITION = false;
layout(constant_id = CONSTANT_SEEKS) const bool SEEKS = true;  ///< of the pixels of `sought`
layout(push_constant, scalar) uniform PushBlock {
  IndirectPush push;
};
layout(set = 0, binding = 0, rgba32f) uniform image2D indirectTarget;
layout(set = 0, binding = 1, rgba32f) uniform image2D lookupTarget;
layout(set = 0, binding = 2, rgba32f) uniform writeonly image2D emittedTarget;
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D directTarget;

#include "gi/sought_facet.glsl"
#include "gi/outer_irradiance.glsl"

/// What is known between two parts of a search is kept in the place of the lookup's y, whose 0 stands for no facet, and z.
vec4 keptCandidate(vec4 lookup, Candidate known) {
  return vec4(lookup.x, known.facet == NO_FACET ? 0.0 : seenAs(known.facet), known.rank, lookup.w);
}
Candidate candidateKept(vec4 lookup) {
  return lookup.y == 0.0 ? NO_CANDIDATE : Candidate(seenTriangle(lookup.y), lookup.z);
}

/// Of F M, over its mean: what one sees as blotches.
const float LEAST_NOISE = 0.05;

void keepFacet(ivec2 pixel, uint facet) {
  if (uint64_t(push.facet) != 0ul) push.facet.at[uint(pixel.y) * push.size.x + uint(pixel.x)] = facet;
}

void main() {
  Grid grid = push.grid.at[0];
  SurfaceArrays surface = push.surface.at[0];
  ivec2 pixel;
  bool listed = true;
  if (SEEKS) {
    listed = pickedPixel(push.sought, soughtPlace(), pixel);
  } else {
    pixel = tilePixel();
    if (any(greaterThanEqual(pixel, ivec2(push.size)))) return;
  }
  vec4 position = imageLoad(indirectTarget, pixel);
  vec4 lookup = imageLoad(lookupTarget, pixel);
  float seen = lookup.w;
  bool drawn = position.w != 0.0;
  if (!SEEKS && !drawn) {
    keepFacet(pixel, NO_FACET);
    if (KEEPS_POSITION) imageStore(lookupTarget, pixel, vec4(position.xyz, 0.0));
    return;
  }
  uint triangle = listed ? seenTriangle(seen) : 0u;
  GpuCamera camera = push.camera.at[0];
  vec3 viewer = towardsViewer(camera, position.xyz, viewAxis(camera));
  vec3 p = (position.xyz - grid.origin) * grid.inverseEdge;
  bool back = dot(triangleFacing(surface, triangle), viewer) < 0.0;
  uint side = triangle | (back ? SURFEL_BACK : 0u), facet;
  if (!SEEKS && beyondGrid(surface, grid.dims, p)) {
    if (KEEPS_POSITION) imageStore(lookupTarget, pixel, vec4(position.xyz, seen));
    keepFacet(pixel, NO_FACET);
    if (EMITTED) imageStore(emittedTarget, pixel, vec4(0.0));
    imageStore(indirectTarget, pixel, vec4(lookup.x * outerIrradiance(surface, side, p), seen));
    return;
  }
  if (SEEKS && SOUGHT_LANES == 1u) {
    if (!listed) return;
    Candidate known =
        soughtInPart(surface, push.reverse, grid.dims, p, viewer, side, push.part, candidateKept(lookup));
    facet = known.facet;
    if (push.part + 1u < SOUGHT_PARTS && (push.part > 0u || facet == NO_FACET)) {
      if (push.part == 0u) pick(push.soughtAround, pixel);
      imageStore(lookupTarget, pixel, keptCandidate(lookup, known));
      return;
    }
  } else if (SEEKS) {
    facet = soughtFacet(surface, push.reverse, grid.dims, p, viewer, side, listed);
    if (!listed || soughtLane() != 0u) return;
  } else {
    facet = facetAt(surface, push.reverse, grid.dims, p, side);
    if (facet == NO_FACET) {
      pick(push.sought, pixel);
      return;
    }
  }
  if (KEEPS_POSITION) imageStore(lookupTarget, pixel, vec4(position.xyz, seen));
  keepFacet(pixel, facet);
  vec3 h = vec3(0.0);
  vec4 e = vec4(0.0, 0.0, 0.0, 1.0);
  if (facet != NO_FACET) {
    SurfaceTaps taps = surfaceTaps(surface, push.reverse, push.voxel, grid.dims, facet, p, push.sampling.filter_);
    h = lookup.x * tapped(taps, push.shaded);
    if (EMITTED) {
      float spread, noise;
      vec3 emitted = tapped(taps, push.shadedEmitted, spread, noise);
      // How much of F M a pixel should look for itself: none where the facets around know it and agree on it within 3
      // tenths.
      e = vec4(lookup.x * emitted, max(smoothstep(0.3, 0.5, spread), smoothstep(LEAST_NOISE, 2.0 * LEAST_NOISE, noise)));
    }
  }
  if (EMITTED) imageStore(emittedTarget, pixel, e);
  imageStore(indirectTarget, pixel, vec4(h, seen));
  // Direct light of a pixel whose facet has none.
  if (uint64_t(push.direct) != 0ul && facet != NO_FACET && push.direct.at[facet].xyz == vec3(0.0) &&
      imageLoad(directTarget, pixel).rgb != vec3(0.0))
    pick(push.doubted, pixel);
}
