// What a pixel writes back (docs/method.md 8): the reflection that it shows, as radiosity, no more than leaves the loop
// of picture and light a gain below 1.
#include "forward/camera_view.glsl"
#include "shared/ggx.h"
#include "shared/grid.h"
#include "shared/writeback.h"

layout(push_constant, scalar) uniform PushBlock {
  WritebackPush push;
};
layout(set = 0, binding = 0) uniform sampler2D depthTarget;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D normalTarget;
layout(set = 0, binding = 2, rgba16f) uniform readonly image2D geometricTarget;
layout(set = 0, binding = 3, rgba16f) uniform readonly image2D albedoTarget;
layout(set = 0, binding = 4, rgba16f) uniform readonly image2D f0Target;
layout(set = 0, binding = 5, rgba32f) uniform readonly image2D specularTarget;

struct WrittenPixel {
  uint facet;      ///< NO_FACET: there is none to write to
  float distance_; ///< from the camera, m
  vec3 position;   ///< voxels
  vec3 face;       ///< geometric normal
  vec3 value;      ///< W/m^2
};

uint facetOf(GpuCamera camera, ivec2 pixel, vec3 v) {
  if (uint64_t(push.facet) != 0ul) return push.facet.at[uint(pixel.y) * camera.size.x + uint(pixel.x)];
  if (any(lessThan(v, vec3(0.0))) || any(greaterThanEqual(v, vec3(push.dims)))) return NO_FACET;
  uint entry = push.reverse.at[voxelIndex(uvec3(v), push.dims)];
  return entry == NO_FACET ? NO_FACET : firstFacet(entry);
}

WrittenPixel writtenPixel(GpuCamera camera, ivec2 pixel) {
  WrittenPixel w;
  w.facet = NO_FACET;
  w.value = vec3(0.0);
  float depth = texelFetch(depthTarget, pixel, 0).r;
  if (depth <= 0.0) return w;
  vec3 axis = viewAxis(camera);
  vec3 local = pixelPosition(camera, pixel, viewDepth(camera, depth), axis);
  w.position = (local - push.origin) * push.inverseEdge;
  w.distance_ = length(camera.position - local);
  w.face = normalize(imageLoad(geometricTarget, pixel).xyz);
  w.facet = facetOf(camera, pixel, w.position);
  vec4 f0 = imageLoad(f0Target, pixel);
  if (w.facet == NO_FACET || f0.w == 0.0) return w;
  vec4 normal = imageLoad(normalTarget, pixel);
  float nv = max(dot(normalize(normal.xyz), towardsViewer(camera, local, axis)), 1e-3);
  float occlusion = imageLoad(albedoTarget, pixel).a;
  vec3 reflected = IRAD_PI * occlusion * imageLoad(specularTarget, pixel).rgb;
  // s = min(reflectance, gain - rho): the picture's reflection has the reflectance as a factor.
  vec3 reflectance = environmentBrdf(f0.rgb, normal.w, nv);
  vec3 s = min(reflectance, max(push.gain - unpackAlbedo(push.albedo.at[w.facet]), vec3(0.0)));
  reflected *= mix(s / max(reflectance, vec3(1e-30)), vec3(1.0), equal(s, reflectance));
  // No mean of what rays meet is above the brightest of it, but for the noise of rays to emitters.
  vec3 value = min(reflected, s * uintBitsToFloat(push.counts.at[0].brightest));
  // What is no number is the numerical watch's to report where it arose; here it would stay for ever.
  w.value = mix(vec3(0.0), value, greaterThan(value, vec3(0.0)));
  return w;
}
