// A volume as cubes, slice, projection or isosurface along one ray, in voxel units. Results: rgb the value, alpha 0 where
// nothing is met, else the share of the display colour that remains under lines and shading.
#ifndef IRAD_VIEW_VOXEL_SHAPES_GLSL
#define IRAD_VIEW_VOXEL_SHAPES_GLSL
#include "shared/slice.h"
#include "view/voxel_values.glsl"

struct ViewRay {
  vec3 origin, direction;  ///< no component of the direction is 0
  float pixel;             ///< a pixel's size per unit of distance (perspective) or everywhere, voxels
  bool orthographic;
};

/// Where a ray enters and leaves the grid; `side` marks the axis through whose face it enters.
bool crossGrid(ViewRay ray, out float enter, out float leave, out vec3 side) {
  vec3 inverse = 1.0 / ray.direction;
  vec3 t0 = -ray.origin * inverse, t1 = (vec3(push.grid.dims) - ray.origin) * inverse;
  vec3 lo = min(t0, t1), hi = max(t0, t1);
  enter = max(0.0, max(lo.x, max(lo.y, lo.z)));
  leave = min(hi.x, min(hi.y, hi.z));
  side = vec3(equal(lo, vec3(enter)));
  return leave > enter;
}

/// From cell to cell (Amanatides and Woo 1987): the present one, the stretch of the ray in it, and the axis through
/// whose face it was entered.
struct Walk {
  vec3 cell, next, side;
  float t, until;
};
Walk beginWalk(ViewRay ray, float enter, vec3 side) {
  Walk w;
  w.cell = clamp(floor(ray.origin + ray.direction * enter), vec3(0.0), vec3(push.grid.dims) - 1.0);
  w.next = (w.cell + step(vec3(0.0), ray.direction) - ray.origin) / ray.direction;
  w.side = side;
  w.t = enter;
  w.until = min(w.next.x, min(w.next.y, w.next.z));
  return w;
}
bool inGrid(Walk w) {
  return all(greaterThanEqual(w.cell, vec3(0.0))) && all(lessThan(w.cell, vec3(push.grid.dims)));
}
void advance(ViewRay ray, inout Walk w) {
  w.side = vec3(lessThanEqual(w.next, vec3(w.until)));
  w.t = w.until;
  w.cell += sign(ray.direction) * w.side;
  w.next += abs(1.0 / ray.direction) * w.side;
  w.until = min(w.next.x, min(w.next.y, w.next.z));
}

/// What thin lines along a cell's edges leave of the colour; none where cells are a few pixels wide. `side`: the axis
/// across the face.
float cellLines(ViewRay ray, float t, vec3 cell, vec3 side) {
  vec3 f = ray.origin + ray.direction * t - cell;
  vec3 rim = min(f, 1.0 - f) + side;
  float pixel = ray.pixel * (ray.orthographic ? 1.0 : t);
  float line = 1.0 - smoothstep(0.6, 1.4, min(rim.x, min(rim.y, rim.z)) / max(0.03, 0.5 * pixel));
  return 1.0 - 0.3 * line * clamp(2.0 - pixel * 10.0, 0.0, 1.0);
}

vec4 drawCubes(FacetArrays facets, ViewRay ray) {
  float enter, leave;
  vec3 side;
  if (!crossGrid(ray, enter, leave, side)) return vec4(0.0);
  for (Walk w = beginWalk(ray, enter, side); inGrid(w); advance(ray, w)) {
    if (!isCube(facets, uvec3(w.cell))) continue;
    vec4 value = voxelValue(facets, uvec3(w.cell), ray.origin - (w.cell + 0.5));
    if (value.a == 0.0) return vec4(0.0);
    float ink = cellLines(ray, w.t, w.cell, w.side);
    if (VIEW == VIEW_VOXEL_ALBEDO || isFrom(FROM_ANY_FIELD)) ink *= 1.0 - 0.15 * w.side.x - 0.08 * w.side.z;
    return vec4(value.rgb, ink);
  }
  return vec4(0.0);
}

/// The plane through the centres of one layer of cells; what lies before it is cut away. `forward`: where the camera
/// looks.
vec4 drawSlice(FacetArrays facets, ViewRay ray, vec3 forward) {
  vec3 across = vec3(equal(uvec3(sliceAxis(push.axis, forward)), uvec3(0u, 1u, 2u)));
  float layer = sliceLayer(dot(vec3(push.grid.dims), across), push.slice);
  float t = (layer + 0.5 - dot(ray.origin, across)) / dot(ray.direction, across);
  vec3 cell = floor(ray.origin + ray.direction * t);
  cell = mix(cell, vec3(layer), across);
  if (!(t > 0.0) || any(lessThan(cell, vec3(0.0))) || any(greaterThanEqual(cell, vec3(push.grid.dims))))
    return vec4(0.0);
  vec4 value = voxelValue(facets, uvec3(cell), ray.origin - (cell + 0.5));
  return vec4(value.rgb, value.a * cellLines(ray, t, cell, across));
}

/// Along the whole ray. Distances: the sum of their inverses (T Fig. 5c), a solid cell counting as half a voxel away;
/// errors: the one of largest magnitude; everything else: the mean over the length that has a value.
vec4 drawProjection(FacetArrays facets, ViewRay ray) {
  float enter, leave;
  vec3 side;
  if (!crossGrid(ray, enter, leave, side)) return vec4(0.0);
  vec3 sum = vec3(0.0);
  float extent = 0.0;
  for (Walk w = beginWalk(ray, enter, side); inGrid(w); advance(ray, w)) {
    vec4 value = voxelValue(facets, uvec3(w.cell), ray.origin - (w.cell + 0.5));
    if (value.a == 0.0) continue;
    float part = w.until - w.t;
    if (viewIsDistance(FROM)) {
      sum += part / max(value.x, 0.5);
    } else if (isFrom(FROM_EXACT)) {
      if (extent == 0.0 || abs(value.x) > abs(sum.x)) sum = value.rgb;
    } else {
      sum += part * value.rgb;
    }
    extent += part;
  }
  if (extent == 0.0) return vec4(0.0);
  return vec4(viewIsDistance(FROM) || isFrom(FROM_EXACT) ? sum : sum / extent, 1.0);
}

/// The field between the centres of its voxels, less the isovalue.
float level(vec3 p) {
  vec3 last = vec3(push.grid.dims) - 1.0;
  p = clamp(p - 0.5, vec3(0.0), last);
  vec3 low = min(floor(p), max(last - 1.0, vec3(0.0)));
  vec3 f = p - low;
  float sum = 0.0;
  for (uint k = 0u; k < 8u; ++k) {
    vec3 corner = vec3(float(k & 1u), float((k >> 1) & 1u), float(k >> 2));
    vec3 weight = mix(1.0 - f, f, corner);
    sum += weight.x * weight.y * weight.z * levelDistance(uvec3(min(low + corner, last)));
  }
  return sum - push.isovalue;
}

/// The surface where the field has the isovalue, lit from the eye. A distance grows by at most 1 per voxel and axis, and
/// so does what lies between: sphere tracing with steps of its value / sqrt(3).
vec4 drawIsosurface(FacetArrays facets, ViewRay ray) {
  float enter, leave;
  vec3 side;
  if (!crossGrid(ray, enter, leave, side)) return vec4(0.0);
  float outside = enter, t = enter;
  float value = level(ray.origin + ray.direction * t);
  while (value > 0.0 && t < leave) {
    outside = t;
    t += max(value * 0.577, 0.25);
    value = level(ray.origin + ray.direction * t);
  }
  if (value > 0.0) return vec4(0.0);
  for (uint i = 0u; i < 8u && t > enter; ++i) {
    float middle = 0.5 * (outside + t);
    if (level(ray.origin + ray.direction * middle) > 0.0)
      outside = middle;
    else
      t = middle;
  }
  vec3 at = ray.origin + ray.direction * t;
  vec3 slope = vec3(level(at + vec3(0.5, 0, 0)) - level(at - vec3(0.5, 0, 0)),
                    level(at + vec3(0, 0.5, 0)) - level(at - vec3(0, 0.5, 0)),
                    level(at + vec3(0, 0, 0.5)) - level(at - vec3(0, 0, 0.5)));
  float facing = t > enter && dot(slope, slope) > 0.0 ? abs(dot(normalize(slope), ray.direction)) : 1.0;
  uvec3 voxel = uvec3(clamp(floor(at), vec3(0.0), vec3(push.grid.dims) - 1.0));
  vec4 shown = voxelValue(facets, voxel, ray.origin - at);
  return vec4(shown.rgb, shown.a * (0.3 + 0.7 * facing));
}

#endif
