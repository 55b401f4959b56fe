// "RE Forward", last step: indirect light from the facets around each visible point, which the fragment stage has left
// in the targets (position in `indirect`, w = 0 where nothing is drawn; normal in `linear`, which views fill later).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "forward/camera_view.glsl"
#include "forward/tile_pixel.glsl"
#include "gi/indirect.glsl"
#include "shared/constants.h"
#include "shared/indirect.h"

layout(local_size_x = 64) in;
layout(constant_id = CONSTANT_NORMALS) const uint NORMAL_ENCODING = NORMALS_OCT16;
layout(constant_id = CONSTANT_EMITTED) const bool EMITTED = true;          ///< F M too: there is a target for it
layout(constant_id = CONSTANT_KEEPS_POSITION) const bool KEEPS_POSITION = false;  ///< in the normal's place, for gi/emitters_seen.comp
layout(push_constant, scalar) uniform PushBlock {
  IndirectPush push;
};
layout(set = 0, binding = 0, rgba32f) uniform image2D indirectTarget;
layout(set = 0, binding = 1, rgba32f) uniform image2D lookupTarget;
layout(set = 0, binding = 2, rgba32f) uniform writeonly image2D emittedTarget;

void main() {
  Grid grid = push.grid.at[0];
  FacetMap map = FacetMap(push.shape, push.reverse, push.around, grid.dims, NORMAL_ENCODING);
  ivec2 pixel = tilePixel();
  if (any(greaterThanEqual(pixel, ivec2(push.size)))) return;
  vec4 position = imageLoad(indirectTarget, pixel);
  vec3 normal = imageLoad(lookupTarget, pixel).xyz;
  if (KEEPS_POSITION) imageStore(lookupTarget, pixel, position);
  if (position.w == 0.0) return;
  GpuCamera camera = push.camera.at[0];
  vec3 viewer = towardsViewer(camera, position.xyz, viewAxis(camera));
  Receiver r = receiverAt(map, (position.xyz - grid.origin) * grid.inverseEdge, normal, viewer);
  if (EMITTED) imageStore(emittedTarget, pixel, vec4(facetIndirect(map, push.shadedEmitted, push.sampling, r), 1.0));
  imageStore(indirectTarget, pixel, vec4(facetIndirect(map, push.shaded, push.sampling, r), 1.0));
}
