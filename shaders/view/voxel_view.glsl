// Views drawn on the voxels themselves: a ray per pixel through the grid (Amanatides and Woo 1987), the first solid cell's
// face, and on it the facet that faces the viewer most.
#include "shared/debug_views.h"
#include "shared/normals.h"
#include "shared/passes.h"
#include "view/camera_ray.glsl"
#include "view/finish.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D linearTarget;
layout(set = 0, binding = 1, rgba8) uniform writeonly image2D displayTarget;
layout(push_constant, scalar) uniform PushBlock { ViewPush push; };

/// Distance of a cell to the nearest solid one, voxels.
float fieldAt(ivec3 cell, uint index) {
#ifdef IRAD_VOLUME
  return texelFetch(fieldVolume, cell, 0).r * push.jfaMax;
#else
  return float((push.chebyshev.at[index >> 2] >> (8u * (index & 3u))) & 255u);
#endif
}

/// Sum of a matrix row: hits times weight (shared/matrix.h).
float rowSum(MatrixArrays m, uint row) {
  uvec2 info = m.rowInfo.at[row];
  UintArray entries = m.segments.at[row >> m.segmentShift];
  uint count = rowEntries(info);
  if (push.padded != 0u) {
    float sum = 0.0;
    uint place = (row & ((1u << m.segmentShift) - 1u)) * m.stride;
    for (uint i = 0u; i < count; ++i) sum += uintBitsToFloat(entries.at[2u * (place + i) + 1u]);
    return sum;
  }
  uint start = m.rowStart.at[row];
  uint hits = 0u;
  for (uint i = 0u; i < count; ++i) hits += entries.at[start + i] >> m.columnBits;
  return float(hits) * uintBitsToFloat(info.y);
}

/// What the view shows for one facet of a voxel that holds `count`.
vec3 facetValue(FacetArrays facets, uint facet, uint count) {
  switch (push.view) {
    case VIEW_VOXEL_ALBEDO: return unpackAlbedo(facets.albedo.at[facet]);
    case VIEW_VOXEL_NORMAL: return decodeNormal(facets.shape.at[facet] & 0xFFFFu, push.normalEncoding);
    case VIEW_VOXEL_EMISSION: return facets.hasEmission != 0u ? facets.emission.at[facet] : vec3(0.0);
    case VIEW_VOXEL_IRRADIANCE:
    case VIEW_REFERENCE:
    case VIEW_RADIOSITY: return uvec2(push.values) != uvec2(0u) ? push.values.at[facet].xyz : vec3(0.0);
    case VIEW_FACET_COUNT: return vec3(float(count));
  }
  if (uvec2(push.matrix) == uvec2(0u)) return vec3(0.0);
  MatrixArrays m = push.matrix.at[0];
  uvec2 info = m.rowInfo.at[facet];
  switch (push.view) {
    case VIEW_ROW_OCCUPANCY: return vec3(float(rowEntries(info)) / float(push.rays));
    case VIEW_INVALID_RAYS: return vec3(float(rowInvalid(info)) / float(push.rays));
    case VIEW_ROW_SUM: return vec3(rowSum(m, facet));
  }
  return vec3(1.0, 0.0, 1.0);
}

void main() {
  GpuCamera camera = push.camera.at[0];
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(pixel, camera.size))) return;
  Grid grid = push.grid;
  FacetArrays facets = push.facets.at[0];

  // Enter the grid.
  vec3 origin, direction;
  cameraRay(camera, pixel, origin, direction);
  origin = (origin - grid.origin) * grid.inverseEdge;
  direction = mix(direction, vec3(1e-9), lessThan(abs(direction), vec3(1e-9)));
  vec3 inverse = 1.0 / direction;
  vec3 t0 = -origin * inverse;
  vec3 t1 = (vec3(grid.dims) - origin) * inverse;
  vec3 lo = min(t0, t1);
  vec3 hi = max(t0, t1);
  float enter = max(0.0, max(lo.x, max(lo.y, lo.z)));
  float leave = min(hi.x, min(hi.y, hi.z));
  vec3 value = vec3(0.0);
  bool drawn = false;
  float ink = 1.0;
  if (leave > enter) {
    // March from cell to cell; `side` tells through which faces the present one was entered.
    vec3 way = sign(direction);
    vec3 perCell = abs(inverse);
    vec3 cell = clamp(floor(origin + direction * enter), vec3(0.0), vec3(grid.dims) - 1.0);
    vec3 next = (cell + step(vec3(0.0), direction) - origin) * inverse;
    vec3 side = vec3(equal(lo, vec3(enter)));
    float t = enter;
    float sum = 0.0;
    uint entry = NO_FACET;
    while (all(greaterThanEqual(cell, vec3(0.0))) && all(lessThan(cell, vec3(grid.dims)))) {
      uint index = voxelIndex(uvec3(cell), grid.dims);
      float until = min(next.x, min(next.y, next.z));
      if (push.view == VIEW_DISTANCE) {
        // T Fig. 5c: the inverse of the field, summed along the whole ray; a solid cell counts as half a voxel away.
        sum += (until - t) / max(fieldAt(ivec3(cell), index), 0.5);
      } else {
        entry = facets.reverse.at[index];
        if (entry != NO_FACET) break;
      }
      side = vec3(lessThanEqual(next, vec3(until)));
      t = until;
      cell += way * side;
      next += perCell * side;
    }
    if (push.view == VIEW_DISTANCE) {
      value = vec3(sum);
      drawn = true;
    } else if (entry != NO_FACET) {
      // The facet that faces the viewer most; the same facet over the whole cell.
      uint facet = entry & ~SECOND_FACET;
      uint count = (entry & SECOND_FACET) != 0u ? 2u : 1u;
      if (count == 2u) {
        vec3 towards = origin - (cell + 0.5);
        float a = dot(decodeNormal(facets.shape.at[facet] & 0xFFFFu, push.normalEncoding), towards);
        float b = dot(decodeNormal(facets.shape.at[facet + 1u] & 0xFFFFu, push.normalEncoding), towards);
        if (b > a) ++facet;
      }
      value = facetValue(facets, facet, count);
      drawn = true;
      // Thin lines along the cell's edges, in the display picture only; none where cells are a few pixels wide.
      vec3 f = origin + direction * t - cell;
      vec3 rim = min(f, 1.0 - f) + side;
      float pixelSize = 2.0 * length(camera.inverseViewProjection[1].xyz) / float(camera.size.y);
      pixelSize *= camera.orthographic != 0u ? grid.inverseEdge : t;
      float line = 1.0 - smoothstep(0.6, 1.4, min(rim.x, min(rim.y, rim.z)) / max(0.03, 0.5 * pixelSize));
      ink = 1.0 - 0.3 * line * clamp(2.0 - pixelSize * 10.0, 0.0, 1.0);
      if (push.view == VIEW_VOXEL_ALBEDO) ink *= 1.0 - 0.15 * side.x - 0.08 * side.z;
    }
  }
  imageStore(linearTarget, ivec2(pixel), vec4(value, drawn ? 1.0 : 0.0));
  vec3 shown = displayColor(value, drawn, ink, push.kind, push.low, push.high, push.exposure, push.toneCurve);
  imageStore(displayTarget, ivec2(pixel), vec4(shown, 1.0));
}
