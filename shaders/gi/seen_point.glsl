// Where rays of a pixel start, on the triangle that is seen there (docs/method.md 7 and 8), and whether rays arrive.
#ifndef IRAD_SEEN_POINT_GLSL
#define IRAD_SEEN_POINT_GLSL
#include "gi/trace.glsl"
#include "shared/surface.h"

/// A visible point `p` of a triangle, voxel units: put back into the triangle's plane, which interpolation has left by
/// a few roundings, and lifted off the side that is seen from the direction `viewer`.
SurfelPoint liftedSeen(SurfaceArrays surface, uint triangle, vec3 p, vec3 viewer) {
  triangle = firstInPlace(surface.corners, triangle);  // which rays may meet
  Triangle t = triangleAt(surface.corners, triangle);
  vec3 facing = facingOf(t, false);
  facing = dot(facing, viewer) < 0.0 ? -facing : facing;
  return SurfelPoint(liftedOff(surface, triangle, p - facing * dot(facing, p - t.a), facing), facing, triangle);
}

/// Whether a ray from a lifted point meets nothing before `reach`, where a triangle may be, but for panes: closedChannels.
bool reaches(TraceWorld world, SurfaceArrays surface, SurfelPoint from, vec3 direction, float reach) {
  return !blockedInScene(world, surface, from.position, direction, from.triangle, shortOf(reach));
}

#ifdef IRAD_FORWARD_LIGHT_GLSL
/// Whether a light reaches a lifted point, `position` in local space; `edge`: of a voxel.
bool lightReaches(TraceWorld world, SurfaceArrays surface, SurfelPoint from, GpuLight light, vec3 position, float edge) {
  return reaches(world, surface, from, lightDirection(light, position), inVoxels(lightReach(light, position), edge));
}

/// Whether point k of n of a light with a size reaches a lifted point. What lies below the surface's horizon does not.
bool lightPointReaches(TraceWorld world, SurfaceArrays surface, SurfelPoint from, GpuLight light, vec3 position,
                       float edge, uint k, uint n, uvec2 shift) {
  float reach;
  vec3 direction = lightPoint(light, position, k, n, shift, reach);
  return dot(direction, from.facing) > 0.0 &&
         reaches(world, surface, from, direction, inVoxels(reach, edge));
}

/// The share of points first, first + step ... of n of a light with a size that reach a lifted point, of all that it has.
/// A light without a size has one point. By channel: panes tint.
vec3 lightShare(TraceWorld world, SurfaceArrays surface, SurfelPoint from, GpuLight light, vec3 position, float edge,
                 uint first, uint step, uint n, uvec2 shift) {
  if (!hasSize(light))
    return lightReaches(world, surface, from, light, position, edge) ? letThrough() : vec3(0.0);
  vec3 seen = vec3(0.0);
  uint all = 0u;
  for (uint k = first; k < n; k += step, ++all)
    if (lightPointReaches(world, surface, from, light, position, edge, k, n, shift)) seen += letThrough();
  return seen / float(all);
}

/// Whether any of n points of a light reaches a lifted point.
bool lightSeen(TraceWorld world, SurfaceArrays surface, SurfelPoint from, GpuLight light, vec3 position, float edge,
               uint n, uvec2 shift) {
  if (!hasSize(light)) return lightReaches(world, surface, from, light, position, edge);
  for (uint k = 0u; k < n; ++k)
    if (lightPointReaches(world, surface, from, light, position, edge, k, n, shift)) return true;
  return false;
}
#endif

#endif
