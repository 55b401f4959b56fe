// Specular rays of one pixel through the voxels (docs/method.md 8). Radiance at a hit is B / pi; rays that
// escape bring the sky's, if there is one.
#include "gi/emitter_point.glsl"
#include "gi/seen_point.glsl"
#include "gi/sky.glsl"
#include "gi/surface_lookup.glsl"
#include "gi/trace.glsl"
#include "shared/constants.h"
#include "shared/passes.h"
#include "shared/sampling.h"
#include "specular/surface.glsl"

/// traceLobe sends rays to emitters too; with rule `triangles` alone.
layout(constant_id = CONSTANT_TRACE_EMITTERS) const bool EMITTERS = false;

layout(constant_id = CONSTANT_SKY) const bool SKY = false;

/// Start of the rays where voxels are met: off the surface, so that its own are behind them.
const float RAY_LIFT = 1.5;

/// Of what a ray meets, voxels.
const float LEAST_DISTANCE = 0.01;

struct Surface {
  vec3 position;  ///< voxel units
  vec3 normal;    ///< shading
  vec3 face;      ///< geometric
  vec3 view;      ///< unit, towards the viewer
  vec3 f0;
  float roughness;
  vec3 start;     ///< of rays that meet triangles: on the own one, lifted
  uint triangle;  ///< the own one
};

SurfaceArrays tracedSurface() {
  SurfaceArrays surface;
  if (TRACE_HIT_RULE == HIT_RULE_TRIANGLES) surface = push.surface.at[0];
  return surface;
}

/// The start of rays that meet triangles. `seen`: seenAs(triangle).
void startRays(SurfaceArrays surface, float seen, inout Surface s) {
  if (TRACE_HIT_RULE != HIT_RULE_TRIANGLES) return;
  SurfelPoint p = liftedSeen(surface, seenTriangle(seen), s.position, s.view);
  s.start = p.position;
  s.face = p.facing;
  s.triangle = p.triangle;
}

vec3 rayStart(Surface s) {
  return TRACE_HIT_RULE == HIT_RULE_TRIANGLES ? s.start : s.position + s.face * RAY_LIFT;
}

TraceHit traceFrom(TraceWorld world, SurfaceArrays surface, Surface s, vec3 direction) {
  if (TRACE_HIT_RULE == HIT_RULE_TRIANGLES) return traceScene(world, surface, s.start, direction, s.triangle);
  return traceThesis(world, traceStart(s.position + s.face * RAY_LIFT, direction));
}

/// B where a ray has met a facet at a point.
vec3 radiosityAt(TraceWorld world, SurfaceArrays surface, uint facet, vec3 at) {
  if (TRACE_HIT_RULE != HIT_RULE_TRIANGLES) return push.radiosity.at[facet].xyz;
  return tapped(surfaceTaps(surface, world.facets.reverse, world.facets.voxel, world.dims, facet, at, FILTER_LINEAR),
                push.radiosity);
}

/// pi x the radiance of what a ray that has met no facet has met instead: as a radiosity.
vec3 beyond(SurfaceArrays surface, TraceHit hit, vec3 direction) {
  if (TRACE_HIT_RULE == HIT_RULE_TRIANGLES && isOuter(hit.facet))
    return IRAD_PI * surface.outer.at[0].bins.at[hit.facet - TRACE_SKY].xyz;
  if (!SKY || hit.facet != TRACE_ESCAPED) return vec3(0.0);
  return IRAD_PI * skyRadiance(push.sky.at[0], direction);
}

/// Invocations that share a pixel's rays: as many run side by side, and few wait for long ones. (Mesa's CPU driver ends
/// loops after 65,535 rounds of an invocation, which is a bound on what its rays may meet together.)
layout(constant_id = CONSTANT_LOBE_LANES) const uint LOBE_LANES = 4u;

/// Reflected radiance before the lobe's reflectance, times pi and the sum of the weights (w), of one lane's rays; the
/// pixel's mean is the quotient of the lanes' sums. Rays follow visible normals of GGX (Heitz 2018), each
/// weighted with F G2 / G1 and the sum divided by the weights; with emitters a quarter as many more go to points of
/// these, and what either kind finds there is weighted by the balance heuristic (Veach and Guibas 1995): a small bright
/// face in the lobe's tail is otherwise met by few rays, each of which is a white dot. `shift` decorrelates pixels.
/// `nearness`: the sum of weight / distance of what the lobe's rays meet, 1 / voxels.
vec4 traceLobe(TraceWorld world, SurfaceArrays surface, Surface s, uvec4 shift, uint lane, out float nearness) {
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
  nearness = 0.0;
  for (uint k = lane; k < rays + aimed; k += LOBE_LANES) {
    vec3 direction, l;
    // Of a ray to an emitter:
    float reach = 0.0;
    uint emitter = NO_FACET;
    vec3 facing = vec3(0.0);
    if (EMITTERS && k >= rays) {
      float x;
      emitter = emitterFacet(table, shift.z + (2u * (k - rays) + 1u) * (0x80000000u / aimed), x);
      SurfelPoint to = liftedSurfel(surface, emitter, uint(x * float(FACET_SURFELS)));
      facing = to.facing;
      direction = to.position - s.start;
      reach = length(direction);
      direction /= reach;
      if (!(dot(direction, s.face) > 0.0 && dot(direction, facing) < 0.0)) continue;
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
    TraceHit hit;
    if (EMITTERS && reach > 0.0) {
      if (!reaches(world, surface, SurfelPoint(s.start, s.face, s.triangle), direction, reach)) continue;
      hit.facet = emitter;
      hit.t = reach;
    } else {
      hit = traceFrom(world, surface, s, direction);
      if (hit.facet > TRACE_LAST_FACET) {
        sum += weight * letThrough() * beyond(surface, hit, direction);
        continue;
      }
    }
    if (reach == 0.0) nearness += weight / max(hit.t, LEAST_DISTANCE);
    vec3 open = letThrough();
    vec3 at = rayStart(s) + direction * hit.t;
    vec3 n = decodeNormal(world.facets.shape.at[hit.facet] & 0xFFFFu, TRACE_NORMALS);
    float exitance = EMITTERS ? luminance(world.facets.emission.at[hit.facet]) : 0.0;
    if (EMITTERS && exitance > 0.0) {
      // Expected rays per solid angle of either kind.
      float lobe = density * ggxDistribution(dot(h.xy, h.xy), max(alpha, 1e-3));
      float cosine = max(-dot(n, direction), 1e-4);
      weight *= lobe / (lobe + float(aimed) * exitance * hit.t * hit.t / (cosine * table.power));
      // The heuristic goes by the facet's normal for both kinds; the points are drawn by the area of the true surface.
      if (reach > 0.0) weight *= -dot(facing, direction) / cosine;
    }
    sum += weight * open * radiosityAt(world, surface, hit.facet, at);
  }
  return vec4(sum, weights);
}
