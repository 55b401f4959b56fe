// "RE Specular" at a pixel by itself (T 5.11), in the fragment shader or a kernel over the picture: rays seeded by the
// point's position and the ray's index, their plain mean times the lobe's reflectance; rough surfaces take the diffuse
// irradiance.
#include "specular/trace.glsl"

layout(set = 0, binding = 0) uniform sampler2D depthTarget;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D normalTarget;
layout(set = 0, binding = 2, rgba16f) uniform readonly image2D geometricTarget;
layout(set = 0, binding = 3, rgba16f) uniform readonly image2D f0Target;
layout(set = 0, binding = 4, rgba32f) uniform readonly image2D indirectTarget;

/// The radiosity that ray `k` about the mirror direction meets; the normal is jittered by the roughness.
vec3 traceJittered(TraceWorld world, Surface s, uint seed, uint k) {
  uint a = hashUint(seed + k);
  vec3 jitter = cosineDirection(vec2(unitFloat(a), unitFloat(hashUint(a))));
  vec3 n = normalize(mix(s.normal, toWorld(jitter, s.normal), s.roughness * s.roughness));
  vec3 direction = reflect(-s.view, n);
  float out_ = dot(direction, s.face);
  if (out_ < 0.05) direction = normalize(direction + s.face * (0.05 - out_));
  TraceHit hit = traceFrom(world, tracedSurface(), s, direction);
  vec3 open = letThrough();
  return open * (hit.facet <= TRACE_LAST_FACET ? push.radiosity.at[hit.facet].xyz : beyond(tracedSurface(), hit, direction));
}

struct Reflection {
  bool shows;   ///< there is a surface, with a lobe
  bool traces;  ///< rays, seeded by `seed`
  Surface surface;
  uint seed;
  vec3 diffuse;  ///< radiance of the irradiance
};

Reflection reflectionAt(ivec2 pixel) {
  GpuCamera camera = push.camera.at[0];
  float depth = texelFetch(depthTarget, pixel, 0).r;
  vec4 normal = imageLoad(normalTarget, pixel);
  vec4 f0 = imageLoad(f0Target, pixel);
  vec4 indirect = imageLoad(indirectTarget, pixel);
  vec3 irradiance = indirect.rgb;
  Reflection r;
  r.shows = depth > 0.0 && f0.w != 0.0;
  r.traces = r.shows && !tracesNothing(f0, normal.w, irradiance);
  if (!r.shows) return r;
  vec3 axis = viewAxis(camera);
  vec3 local = pixelPosition(camera, pixel, viewDepth(camera, depth), axis);
  Surface s;
  s.position = (local - push.origin) * push.inverseEdge;
  s.normal = normalize(normal.xyz);
  s.face = normalize(imageLoad(geometricTarget, pixel).xyz);
  s.view = towardsViewer(camera, local, axis);
  s.f0 = f0.rgb;
  s.roughness = normal.w;
  startRays(tracedSurface(), indirect.w, s);
  r.surface = s;
  r.seed = hashUint(floatBitsToUint(s.position.x) ^
                    hashUint(floatBitsToUint(s.position.y) ^ hashUint(floatBitsToUint(s.position.z))));
  r.diffuse = irradiance * (1.0 / IRAD_PI);
  return r;
}

TraceWorld reflectedWorld() { return TraceWorld(push.facets.at[0], push.chebyshev, push.dims, push.jfaMax); }

/// `met`: the sum of what its rays meet.
vec4 specularOf(Reflection r, vec3 met) {
  if (!r.shows) return vec4(0.0, 0.0, 0.0, 1.0);
  Surface s = r.surface;
  vec3 radiance = r.diffuse;
  if (r.traces)
    radiance = mix(radiance, met / (float(push.params.rays) * IRAD_PI), tracedShare(vec4(s.f0, 1.0), s.roughness));
  return vec4(radiance * environmentBrdf(s.f0, s.roughness, max(dot(s.normal, s.view), 1e-3)), 1.0);
}

/// The whole reflection by one invocation.
vec4 specularAt(ivec2 pixel) {
  Reflection r = reflectionAt(pixel);
  vec3 met = vec3(0.0);
  for (uint k = 0u; r.traces && k < push.params.rays; ++k) met += traceJittered(reflectedWorld(), r.surface, r.seed, k);
  return specularOf(r, met);
}
