// What the two kernels of "RE Emitters" share: the visible point and the emissive triangles above its horizon.
#include "forward/tile_pixel.glsl"
#include "shared/emitters.h"
#include "shared/pixel_emitters.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform PushBlock {
  PixelEmittersPush push;
};
/// Local space; w: seenAs(), or 0 where nothing is drawn.
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D positionTarget;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D normalTarget;
layout(set = 0, binding = 2, rgba16f) uniform readonly image2D geometricTarget;

/// A point this near a triangle's plane is taken to lie in it, where it gets nothing; voxels.
const float IN_PLANE = 0.01;

bool inPicture(ivec2 pixel) {
  return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, ivec2(push.size)));
}

/// Voxel units.
vec3 inVoxels(vec3 position) {
  return (position - push.grid.origin) * push.grid.inverseEdge;
}

/// How much a pixel goes by what it finds itself; `emitted`: of Targets::emitted as gi/indirect_links.comp left it.
float shareOfPixel(vec4 emitted) { return push.everywhere != 0u ? 1.0 : emitted.w; }

/// F to the whole triangle from point `p` with normal `n`; 0 behind it.
float formFactor(EmissiveTriangle t, vec3 p, vec3 n) {
  vec3 a = t.corner - p;
  vec3 facing = cross(t.edge1, t.edge2);
  float height = -dot(a, facing);  // of p above its plane, x |facing|
  if (abs(height) <= IN_PLANE * length(facing) || (height < 0.0 && t.doubleSided == 0u)) return 0.0;
  return triangleFormFactor(a, a + t.edge1, a + t.edge2, n);
}
