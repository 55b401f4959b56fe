// "RE Forward" by kernels: one invocation per listed pixel of a material. The triangle that is seen there gives what
// the graphics pipeline would have interpolated; bindings follow those of forward/shade.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "forward/project.glsl"
#include "forward/shade.glsl"
#include "raster/corner_weights.glsl"

layout(local_size_x = RESOLVE_GROUP) in;
layout(constant_id = FORWARD_TARGETS) const uint TARGETS = TARGETS_ALL;
layout(set = 0, binding = SHADE_BINDINGS, rgba16f) uniform writeonly image2D normalTarget;
layout(set = 0, binding = SHADE_BINDINGS + 1, rgba16f) uniform writeonly image2D geometricTarget;
layout(set = 0, binding = SHADE_BINDINGS + 2, rgba16f) uniform writeonly image2D albedoTarget;
layout(set = 0, binding = SHADE_BINDINGS + 3, rgba16f) uniform writeonly image2D f0Target;
layout(set = 0, binding = SHADE_BINDINGS + 4, rgba32f) uniform writeonly image2D directTarget;
layout(set = 0, binding = SHADE_BINDINGS + 5, rgba32f) uniform writeonly image2D highlightTarget;
layout(set = 0, binding = SHADE_BINDINGS + 6, rgba32f) uniform writeonly image2D indirectTarget;
#ifndef IRAD_VOLUME
layout(set = 0, binding = SHADE_BINDINGS + 7, rgba32f) uniform writeonly image2D lookupTarget;
#endif

/// As forward/forward.vert, and the differences of uv within the block of 2 x 2 pixels.
Interpolants interpolate(uint triangle, ivec2 pixel) {
  GpuScene scene = push.scene.at[0];
  GpuCamera camera = push.camera.at[0];
  mat4 m = camera.viewProjection;
  uint a = scene.indices.at[3u * triangle], b = scene.indices.at[3u * triangle + 1u],
       c = scene.indices.at[3u * triangle + 2u];
  vec3 pa = scene.positions.at[a], pb = scene.positions.at[b], pc = scene.positions.at[c];
  PixelWeights w = pixelWeights(vec4[3](project(m, pa), project(m, pb), project(m, pc)), pixel, camera.size);
  Interpolants v;
  v.triangle = triangle;
  v.local = weighted(pa, pb, pc, w.here);
  v.normal = weighted(scene.normals.at[a], scene.normals.at[b], scene.normals.at[c], w.here);
  v.tangent = weighted(scene.tangents.at[a], scene.tangents.at[b], scene.tangents.at[c], w.here);
  v.tint = weighted(scene.colors.at[a], scene.colors.at[b], scene.colors.at[c], w.here);
  v.faceNormal = cross(pb - pa, pc - pa);
  v.towardsEye = camera.orthographic != 0u ? vec3(m[0][2], m[1][2], m[2][2]) : camera.position - v.local;
  vec4 ua = vec4(scene.uv0.at[a], scene.uv1.at[a]), ub = vec4(scene.uv0.at[b], scene.uv1.at[b]),
       uc = vec4(scene.uv0.at[c], scene.uv1.at[c]);
  v.uv = weighted(ua, ub, uc, w.here);
  vec4 first = weighted(ua, ub, uc, w.first);
  uvDx = weighted(ua, ub, uc, w.right) - first;
  uvDy = weighted(ua, ub, uc, w.below) - first;
  return v;
}

void main() {
  PixelList list = push.lists.at[push.material];
  uint i = irad_index();
  if (i >= list.count) return;
  uvec2 listed = push.listed.at[list.end - list.count + i];
  ivec2 pixel = ivec2(listed.x & 0xFFFFu, listed.x >> 16);
  Shaded o = shade(interpolate(listed.y, pixel));
  imageStore(normalTarget, pixel, o.normal);
  imageStore(geometricTarget, pixel, o.geometric);
  imageStore(albedoTarget, pixel, o.albedo);
  if ((TARGETS & TARGET_F0) != 0u) imageStore(f0Target, pixel, o.f0);
  imageStore(directTarget, pixel, o.direct);
  if ((TARGETS & TARGET_HIGHLIGHT) != 0u) imageStore(highlightTarget, pixel, o.highlight);
  if ((TARGETS & TARGET_INDIRECT) == 0u) return;
  imageStore(indirectTarget, pixel, o.indirect);
#ifndef IRAD_VOLUME
  imageStore(lookupTarget, pixel, o.lookup);
#endif
}
