// The emissive triangles in voxel units (shared/pixel_emitters.h), one invocation each. Texture and alpha mask are
// averaged over the triangle, the mask at the level of detail of a voxel and the texture at that of a sample.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "voxel_triangle.glsl"
#include "voxel_material.glsl"
#include "gi/triangle_hit.h"
#include "shared/pixel_emitters.h"
#include "shared/sampling.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  EmissiveTrianglesPush push;
};

const uint SAMPLES = 1024u;

/// A point of the triangle, uniform over its area for u uniform over the square.
vec3 pointOf(VoxelTriangle t, vec2 u) {
  float s = sqrt(u.x);
  return t.v[0] * (1.0 - s) + t.v[1] * (s * (1.0 - u.y)) + t.v[2] * (s * u.y);
}

void main() {
  uint i = irad_index();
  if (i >= push.count) return;
  uint triangle = push.first + i;
  VoxelTriangle t = loadTriangle(push.scene, push.grid, triangle);
  // Emission filtered over four times what a point stands for.
  MaterialTriangle m = materialTriangle(push.scene, triangle, 0.25 * float(SAMPLES));
  MaterialTriangle cover = materialTriangle(push.scene, triangle, areaOf(t));
  uint points = SAMPLES_TEXTURES != 0u ? SAMPLES : 1u;
  vec3 sum = vec3(0.0);
  // What repeats another triangle gives nothing: no ray meets it, and no facet is made of it.
  bool shines = !degenerate(t) && (push.hasCorners == 0u || firstInPlace(push.corners, triangle) == triangle);
  for (uint k = 0u; k < points && shines; ++k) {
    vec3 weight = barycentrics(t, pointOf(t, hammersley(k, points, uvec2(0u))));
    if ((m.flags & MATERIAL_BLEND) != 0u)
      sum += emittedRadianceAt(m, weight) * clamp(baseColorAt(cover, weight).a, 0.0, 1.0);
    else if ((m.flags & MATERIAL_ALPHA_MASK) == 0u || !cutAway(cover, weight)) sum += emittedRadianceAt(m, weight);
  }
  vec3 exitance = exitanceOf(sum / float(points));
  push.triangles.at[push.place + i] =
      EmissiveTriangle(t.v[0], t.v[1] - t.v[0], t.v[2] - t.v[0], exitance, m.flags & MATERIAL_DOUBLE_SIDED);
}
