// "RE Forward": what shadow maps let through where a wall is thinner than their texels. Where the facet of a pixel has no
// direct light and the pixel has, rays past the triangles decide (docs/method.md 7). gi/indirect_links.comp has listed
// these pixels.
#version 460
#pragma optimize(on)
#extension GL_GOOGLE_include_directive : require
#include "forward/camera_view.glsl"
#include "shared/indirect.h"
#include "shared/solve.h"
#define IRAD_LIGHT_CONSTANTS GATHER_LIGHTS
#include "forward/light.glsl"
#include "gi/seen_point.glsl"
#include "shared/constants.h"
#include "shared/passes.h"

layout(local_size_x = PICKED_GROUP) in;
layout(constant_id = CONSTANT_TARGETS) const uint TARGETS = TARGET_HIGHLIGHT;  ///< or none
layout(push_constant, scalar) uniform PushBlock {
  DirectSeenPush push;
};
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D indirectTarget;
layout(set = 0, binding = 1, rgba32f) uniform image2D directTarget;
layout(set = 0, binding = 2, rgba32f) uniform image2D highlightTarget;
layout(set = 0, binding = 3) uniform sampler2D depthTarget;

/// Whether any light reaches the visible point of a pixel.
bool seesLight(ivec2 pixel, uint triangle) {
  GpuCamera camera = push.camera.at[0];
  vec3 axis = viewAxis(camera);
  vec3 local = pixelPosition(camera, pixel, viewDepth(camera, texelFetch(depthTarget, pixel, 0).r), axis);
  SurfaceArrays surface = push.surface.at[0];
  TraceWorld world = TraceWorld(push.facets, push.chebyshev, push.dims, 0.0);
  SurfelPoint from =
      liftedSeen(surface, triangle, (local - push.origin) / push.edge, towardsViewer(camera, local, axis));
  GpuScene scene = push.scene.at[0];
  uvec2 shift = uvec2(hashUint(uint(pixel.x)), hashUint(~uint(pixel.y)));
  for (uint i = 0u; anyLight() && i < scene.lightCount; ++i) {
    GpuLight light = scene.lights.at[i];
    if (lightIrradiance(light, local, from.facing) == vec3(0.0)) continue;
    if (lightSeen(world, surface, from, light, local, push.edge, light.points, shift)) return true;
  }
  return false;
}

void main() {
  ivec2 pixel;
  if (!pickedPixel(push.doubted, gl_GlobalInvocationID.x, pixel)) return;
  if (seesLight(pixel, seenTriangle(imageLoad(indirectTarget, pixel).w))) return;
  imageStore(directTarget, pixel, vec4(vec3(0.0), imageLoad(directTarget, pixel).w));
  // Highlights share a target with emission: where there is that, they stay.
  if (TARGETS != 0u && imageLoad(highlightTarget, pixel).w == 0.0)
    imageStore(highlightTarget, pixel, vec4(0.0));
}
