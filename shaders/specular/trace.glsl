// Specular rays of one pixel through the voxels (docs/method.md 8). Radiance at a hit is B / pi; rays that
// escape bring nothing.
#include "gi/emitter_point.glsl"
#include "gi/indirect.glsl"
#include "gi/trace.glsl"
#include "shared/constants.h"
#include "shared/sampling.h"
#include "specular/surface.glsl"

layout(constant_id = CONSTANT_TRACE_EMITTERS) const bool EMITTERS = false;  ///< traceLobe sends rays to emitters too

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

/// Mean reflected radiance before the lobe's reflectance. Rays follow visible normals of GGX (Heitz 2018), each
/// weighted with F G2 / G1 and the sum divided by the weights; with emitters a quarter as many more go to points of
/// these, and what either kind finds there is weighted by the balance heuristic (Veach and Guibas 1995): a small bright
/// face in the lobe's tail is otherwise met by few rays, each of which is a white dot. `shift` decorrelates pixels.
vec3 traceLobe(TraceWorld world, Surface s, uvec4 shift) {
  FacetMap map =
      FacetMap(world.facets.shape, world.facets.reverse, world.facets.around, world.dims, TRACE_NORMALS);
  float alpha = s.roughness * s.roughness;
  bool mirror = alpha < 1e-3;
  uint rays = mirror ? 1u : push.params.rays;
  // Weights only steer the mean, whose reflectance is environmentBrdf's: one number for the three channels.
  vec3 reflectance = vec3(max(luminance(s.f0), 0.04));
  // Local frame about the shading normal.
  vec3 tx = toWorld(vec3(1.0, 0.0, 0.0), s.normal);
  vec3 ty = toWorld(vec3(0.0, 1.0, 0.0), s.normal);
  vec3 v = normalize(vec3(dot(s.view, tx), dot(s.view, ty), max(dot(s.view, s.normal), 1e-3)));
  uint aimed = EMITTERS && !mirror ? (rays + 3u) / 4u : 0u;
  EmitterTable table;
  if (EMITTERS) table = push.emitters.at[0];
  float density = float(rays) / (4.0 * v.z * (1.0 + ggxLambda(v.z, max(alpha, 1e-3))));
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (uint k = 0u; k < rays + aimed; ++k) {
    vec3 direction, l;
    float reach = 0.0;  // of a ray to an emitter
    if (EMITTERS && k >= rays) {
      vec3 point;
      uvec2 u = shift.zw + uvec2((2u * (k - rays) + 1u) * (0x80000000u / aimed), reverseBits(k - rays));
      uint emitter;
      vec3 facing;
      if (!emitterPoint(table, world.facets, TRACE_NORMALS, u, emitter, point, facing)) continue;
      direction = point - (s.position + s.face * RAY_LIFT);
      reach = length(direction);
      direction /= reach;
      if (!(dot(direction, s.face) > 0.0)) continue;
      l = vec3(dot(direction, tx), dot(direction, ty), dot(direction, s.normal));
    } else {
      vec3 h = mirror ? vec3(0.0, 0.0, 1.0) : ggxVisibleNormal(v, alpha, hammersley(k, rays, shift.xy));
      l = 2.0 * dot(v, h) * h - v;
      direction = normalize(tx * l.x + ty * l.y + s.normal * l.z);
      // A normal map may send rays below the surface: lift them to graze it.
      float out_ = dot(direction, s.face);
      if (out_ < 0.05) direction = normalize(direction + s.face * (0.05 - out_));
    }
    if (l.z <= 0.0) continue;
    vec3 h = normalize(v + l);
    float weight = fresnelSchlick(reflectance, clamp(dot(v, h), 0.0, 1.0)).x * ggxWeight(l.z, v.z, max(alpha, 1e-3));
    if (reach == 0.0) weights += weight;
    TraceHit hit = traceFrom(world, s, direction);
    if (hit.facet > TRACE_LAST_FACET) continue;
    vec3 at = s.position + s.face * RAY_LIFT + direction * hit.t;
    vec3 n = decodeNormal(world.facets.shape.at[hit.facet] & 0xFFFFu, TRACE_NORMALS);
    float exitance = EMITTERS ? luminance(world.facets.emission.at[hit.facet]) : 0.0;
    if (reach > 0.0 && (!(exitance > 0.0) || abs(hit.t - reach) > 1.0)) continue;  // something else is in the way
    if (EMITTERS && exitance > 0.0) {
      // Expected rays per solid angle of either kind.
      float lobe = density * ggxDistribution(dot(h.xy, h.xy), max(alpha, 1e-3));
      float emitter = float(aimed) * exitance * hit.t * hit.t / (max(-dot(n, direction), 1e-4) * table.power);
      weight *= lobe / (lobe + emitter);
    }
    sum += weight * facetValueAround(map, push.radiosity, hit.facet, at, n, -direction);
  }
  return weights > 0.0 ? sum / (weights * IRAD_PI) : vec3(0.0);
}
