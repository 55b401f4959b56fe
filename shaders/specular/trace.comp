// "RE Specular": LOBE_LANES invocations per listed pixel. Writes the mean reflected radiance (without the lobe's
// reflectance) and how near what is reflected is: the mean of 1 / distance, 1 / voxels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "specular/trace.glsl"

layout(local_size_x_id = CONSTANT_LOBE_WORKGROUP) in;
layout(set = 0, binding = 0) uniform sampler2D depthTarget;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D normalTarget;
layout(set = 0, binding = 2, rgba16f) uniform readonly image2D geometricTarget;
layout(set = 0, binding = 3, rgba16f) uniform readonly image2D f0Target;
layout(set = 0, binding = 4, rgba32f) uniform readonly image2D indirectTarget;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image2D tracedTarget;

shared vec4 lobes[gl_WorkGroupSize.x];
shared float nearness[gl_WorkGroupSize.x];

/// What a lane finds (traceLobe) for a pixel at view depth `z`.
vec4 reflectedAt(GpuCamera camera, ivec2 pixel, float z, uint lane, out float near_) {
  TraceWorld world = TraceWorld(push.facets.at[0], push.chebyshev, push.dims, push.jfaMax);
  SurfaceArrays surface = tracedSurface();
  vec4 normal = imageLoad(normalTarget, pixel);
  vec3 axis = viewAxis(camera);
  vec3 local = pixelPosition(camera, pixel, z, axis);
  Surface s;
  s.position = (local - push.origin) * push.inverseEdge;
  s.normal = normalize(normal.xyz);
  s.face = normalize(imageLoad(geometricTarget, pixel).xyz);
  s.view = towardsViewer(camera, local, axis);
  s.f0 = imageLoad(f0Target, pixel).rgb;
  s.roughness = normal.w;
  startRays(surface, imageLoad(indirectTarget, pixel).w, s);
  // Shifts of neighbouring pixels follow the R2 lattice (Roberts 2018), so that any few of them cover the lobe evenly.
  // The shifts of rays to emitters follow another permutation of it.
  uvec2 first = uvec2(pixel.x * 3242174889u + pixel.y * 2447445414u, pixel.x * 2447445414u + pixel.y * 1847517997u);
  uvec4 shift =
      uvec4(first, pixel.x * 2447445414u + pixel.y * 3242174889u, pixel.x * 1847517997u + pixel.y * 2447445414u);
  return traceLobe(world, surface, s, shift, lane, near_);
}

void main() {
  GpuCamera camera = push.camera.at[0];  // before any branch: read once for all lanes
  uint at = gl_LocalInvocationIndex, lane = at % LOBE_LANES;
  ivec2 pixel;
  bool listed = pickedPixel(push.glossy, gl_GlobalInvocationID.x / LOBE_LANES, pixel);
  float z = viewDepth(camera, texelFetch(depthTarget, pixel, 0).r);
  lobes[at] = vec4(0.0);
  nearness[at] = 0.0;
  if (listed) lobes[at] = reflectedAt(camera, pixel, z, lane, nearness[at]);
  barrier();
  if (!listed || lane != 0u) return;
  vec4 lobe = lobes[at];
  float near_ = nearness[at];
  for (uint i = 1u; i < LOBE_LANES; ++i) {
    lobe += lobes[at + i];
    near_ += nearness[at + i];
  }
  imageStore(tracedTarget, pixel, lobe.w > 0.0 ? vec4(lobe.xyz / IRAD_PI, near_) / lobe.w : vec4(0.0));
}
