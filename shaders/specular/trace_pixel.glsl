// "RE Specular" at a pixel by itself (T 5.11), in the fragment shader or a kernel over the picture: rays seeded by the
// point's position and the ray's index, mean radiance times the lobe's reflectance; rough surfaces take the diffuse
// irradiance.
#include "specular/trace.glsl"

layout(set = 0, binding = 0) uniform sampler2D depthTarget;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D normalTarget;
layout(set = 0, binding = 2, rgba16f) uniform readonly image2D geometricTarget;
layout(set = 0, binding = 3, rgba16f) uniform readonly image2D f0Target;
layout(set = 0, binding = 4, rgba32f) uniform readonly image2D indirectTarget;

vec4 specularOf(ivec2 pixel) {
  GpuCamera camera = push.camera.at[0];
  float depth = texelFetch(depthTarget, pixel, 0).r;
  vec4 normal = imageLoad(normalTarget, pixel);
  vec4 f0 = imageLoad(f0Target, pixel);
  vec3 irradiance = imageLoad(indirectTarget, pixel).rgb;
  if (depth >= 1.0 || f0.w == 0.0) return vec4(0.0, 0.0, 0.0, 1.0);
  Grid grid = push.grid;
  vec3 axis = viewAxis(camera);
  vec3 local = pixelPosition(camera, pixel, viewDepth(camera, depth), axis);
  Surface s;
  s.position = (local - grid.origin) * grid.inverseEdge;
  s.normal = normalize(normal.xyz);
  s.face = normalize(imageLoad(geometricTarget, pixel).xyz);
  s.view = towardsViewer(camera, local, axis);
  s.f0 = f0.rgb;
  s.roughness = normal.w;
  vec3 radiance = irradiance * (1.0 / IRAD_PI);
  if (!tracesNothing(f0, s.roughness, irradiance)) {
    uint seed = hashUint(floatBitsToUint(s.position.x) ^
                         hashUint(floatBitsToUint(s.position.y) ^ hashUint(floatBitsToUint(s.position.z))));
    TraceWorld world = TraceWorld(push.facets.at[0], push.chebyshev, grid.dims, push.jfaMax);
    radiance = mix(radiance, traceJittered(world, s, seed), tracedShare(s.roughness));
  }
  return vec4(radiance * environmentBrdf(s.f0, s.roughness, max(dot(s.normal, s.view), 1e-3)), 1.0);
}
