// Specular rays of one pixel through the voxels (METHOD section 8, T 5.11). Radiance at a hit is B / pi; what escapes
// sees nothing.
#include "forward/indirect.glsl"
#include "gi/trace.glsl"
#include "shared/sampling.h"
#include "specular/surface.glsl"

/// Start of the rays: off the surface, so that its own voxels are behind them.
const float RAY_LIFT = 1.5;

struct Surface {
  vec3 position;  ///< voxel units
  vec3 normal;    ///< shading
  vec3 face;      ///< geometric
  vec3 view;      ///< unit, towards the viewer
  vec3 f0;
  float roughness;
};

TraceHit traceFrom(TraceWorld world, Surface s, vec3 direction) {
  return traceRay(world, s.position + s.face * RAY_LIFT, direction, s.face);
}

/// Mean reflected radiance before the lobe's reflectance: visible normals of GGX (Heitz 2018), each ray weighted with
/// F G2 / G1 and the sum divided by the weights. `shift` decorrelates pixels.
vec3 traceLobe(TraceWorld world, Surface s, uvec2 shift) {
  FacetMap map = FacetMap(world.facets.shape, world.facets.reverse, world.dims, TRACE_NORMALS);
  float alpha = s.roughness * s.roughness;
  bool mirror = alpha < 1e-3;
  uint rays = mirror ? 1u : push.params.rays;
  // Local frame about the shading normal.
  vec3 tx = toWorld(vec3(1.0, 0.0, 0.0), s.normal);
  vec3 ty = toWorld(vec3(0.0, 1.0, 0.0), s.normal);
  vec3 v = vec3(dot(s.view, tx), dot(s.view, ty), max(dot(s.view, s.normal), 1e-3));
  vec3 sum = vec3(0.0);
  vec3 weights = vec3(0.0);
  for (uint k = 0u; k < rays; ++k) {
    vec3 h = mirror ? vec3(0.0, 0.0, 1.0) : ggxVisibleNormal(normalize(v), alpha, hammersley(k, rays, shift));
    float vh = dot(v, h);
    vec3 l = 2.0 * vh * h - v;
    vec3 direction = normalize(tx * l.x + ty * l.y + s.normal * l.z);
    if (l.z <= 0.0) continue;
    // A normal map may send rays below the surface: lift them to graze it.
    float out_ = dot(direction, s.face);
    if (out_ < 0.05) direction = normalize(direction + s.face * (0.05 - out_));
    vec3 weight = fresnelSchlick(s.f0, clamp(vh, 0.0, 1.0)) * ggxWeight(l.z, v.z, max(alpha, 1e-3));
    weights += weight;
    TraceHit hit = traceFrom(world, s, direction);
    if (hit.facet > TRACE_LAST_FACET) continue;
    vec3 at = s.position + s.face * RAY_LIFT + direction * hit.t;
    vec3 n = decodeNormal(world.facets.shape.at[hit.facet] & 0xFFFFu, TRACE_NORMALS);
    sum += weight * facetValueAround(map, push.radiosity, hit.facet, at, n);
  }
  return sum / max(weights, vec3(1e-20)) * (1.0 / IRAD_PI);
}

/// T 5.11: rays about the mirror direction of the normal jittered by the roughness, plain mean, radiance of the voxel
/// met.
vec3 traceJittered(TraceWorld world, Surface s, uint seed) {
  vec3 sum = vec3(0.0);
  for (uint k = 0u; k < push.params.rays; ++k) {
    uint a = hashUint(seed + k);
    vec3 jitter = cosineDirection(vec2(unitFloat(a), unitFloat(hashUint(a))));
    vec3 n = normalize(mix(s.normal, toWorld(jitter, s.normal), s.roughness * s.roughness));
    vec3 direction = reflect(-s.view, n);
    float out_ = dot(direction, s.face);
    if (out_ < 0.05) direction = normalize(direction + s.face * (0.05 - out_));
    TraceHit hit = traceFrom(world, s, direction);
    if (hit.facet <= TRACE_LAST_FACET) sum += push.radiosity.at[hit.facet].xyz;
  }
  return sum / (float(push.params.rays) * IRAD_PI);
}
