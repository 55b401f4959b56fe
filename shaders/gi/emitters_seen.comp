// "RE Emitters", step 1: how much of the light of the emissive triangles a visible point sees, by channel, from rays
// that the scene's triangles stop. They are drawn in proportion to what each triangle gives; the share of the weights that get
// through takes the place of their sum, which cancels the noise where all or none do (Heitz, Hill and McGuire 2018,
// "Combining analytic direct illumination and stochastic shadows").
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/pixel_emitters.glsl"
#include "gi/seen_point.glsl"
#include "gi/emitter_point.glsl"
#include "shared/passes.h"
#include "shared/sampling.h"

layout(set = 0, binding = 3, rgba32f) uniform readonly image2D emittedTarget;
layout(set = 0, binding = 4, rgba16f) uniform writeonly image2D seenTarget;  ///< w = 0: unknown

void main() {
  ivec2 pixel = tilePixel();
  if (!inPicture(pixel)) return;
  vec4 position = imageLoad(positionTarget, pixel);
  vec3 p = inVoxels(position.xyz);
  vec3 n = normalize(imageLoad(normalTarget, pixel).xyz);
  vec3 face = normalize(imageLoad(geometricTarget, pixel).xyz);
  float total = 0.0;
  bool looks = position.w != 0.0 && shareOfPixel(imageLoad(emittedTarget, pixel)) > 0.0;
  for (uint i = 0u; looks && i < push.count; ++i) {
    EmissiveTriangle t = push.triangles.at[i];
    total += formFactor(t, p, n) * luminance(t.exitance);
  }

  // Shifts of neighbouring pixels follow the R2 and R3 lattices (Roberts 2018), so that any few of them cover the lamp
  // evenly. (R2's second and third numbers add up to 1: together they would leave lines along diagonals.)
  uvec3 shift = uvec3(pixel.x * 3242174889u + pixel.y * 2447445414u, pixel.x * 3518319155u + pixel.y * 2882110345u,
                      pixel.x * 2447445414u + pixel.y * 3242174889u);
  float start = unitFloat(shift.x);
  TraceWorld world = TraceWorld(push.facets.at[0], push.chebyshev, push.grid.dims, 0.0);
  SurfaceArrays surface = push.surface.at[0];
  SurfelPoint from;
  if (total > 0.0) from = liftedSeen(surface, seenTriangle(position.w), p, face);
  vec3 seen = vec3(0.0), asked = vec3(0.0);
  float seenSum = 0.0, askedSum = 0.0;
  float upTo = 0.0;  // rays to this triangle and those before it
  uint k = 0u;
  for (uint i = 0u; total > 0.0 && i < push.count && k < push.rays; ++i) {
    EmissiveTriangle t = push.triangles.at[i];
    float share = formFactor(t, p, n) * luminance(t.exitance) / total;
    if (share == 0.0) continue;
    upTo += share * float(push.rays);
    vec3 facing = cross(t.edge1, t.edge2);
    float size = length(facing);
    for (; k < push.rays && float(k) + start < upTo; ++k) {
      vec2 u = facetJitter(k, shift.yz);
      float s = sqrt(u.x);
      vec3 way = t.corner + t.edge1 * (s * (1.0 - u.y)) + t.edge2 * (s * u.y) - from.position;
      float reach = length(way);
      vec3 direction = way / reach;
      float cosine = abs(dot(direction, facing)) / size;
      // The point's form factor over the density with which it is drawn.
      float weight = max(dot(n, direction), 0.0) * cosine * size / (reach * reach * share);
      if (weight == 0.0) continue;
      asked += weight * t.exitance;
      askedSum += weight;
      if (dot(from.facing, direction) <= 0.0 || !reaches(world, surface, from, direction, reach)) continue;
      seen += weight * t.exitance * letThrough();
      seenSum += weight;
    }
  }
  vec4 result = vec4(0.0);
  if (askedSum > 0.0) {
    result = vec4(vec3(seenSum / askedSum), 1.0);
    for (int c = 0; c < 3; ++c)
      if (asked[c] > 0.0) result[c] = seen[c] / asked[c];
  }
  imageStore(seenTarget, pixel, result);
}
