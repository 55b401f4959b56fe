// What the voxel views show of one voxel. The including shader declares `push` (VoxelViewPush), VIEW and FROM.
#ifndef IRAD_VIEW_VOXEL_VALUES_GLSL
#define IRAD_VIEW_VOXEL_VALUES_GLSL
#include "shared/debug_views.h"
#include "shared/normals.h"
#include "shared/view.h"
#include "shared/voxelize.h"

uint rowRays() { return push.row & 0xFFFFu; }
bool rowsPadded() { return ((push.row >> 16) & 1u) != 0u; }
vec3 facetNormal(FacetArrays facets, uint facet) {
  return decodeNormal(facets.shape.at[facet] & 0xFFFFu, push.row >> 17);
}

/// Sum of a matrix row: hits times weight (shared/matrix.h).
float rowSum(MatrixArrays m, uint row) {
  uvec2 info = m.rowInfo.at[row];
  UintArray entries = m.segments.at[row >> m.segmentShift];
  uint count = rowEntries(info);
  if (rowsPadded()) {
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

bool isFrom(uint sources) { return (FROM & sources) != 0u; }

/// What the view shows for one facet of a voxel that holds `count`.
vec3 facetValue(FacetArrays facets, uint facet, uint count) {
  if (isFrom(FROM_FACET_VALUES)) {
    if (uvec2(push.values) == uvec2(0u)) return vec3(0.0);
    vec4 value = push.values.at[facet];
    // One number: of the colour channel where it is largest.
    if (isFrom(FROM_STANDARD_ERROR)) return vec3(max(value.x, max(value.y, value.z)));
    return VIEW == VIEW_WRITEBACK_WRITERS ? value.www : value.xyz;
  }
  switch (VIEW) {
    case VIEW_VOXEL_ALBEDO: return unpackAlbedo(facets.albedo.at[facet]);
    case VIEW_VOXEL_NORMAL: return facetNormal(facets, facet);
    case VIEW_VOXEL_EMISSION: return facets.hasEmission != 0u ? facets.emission.at[facet] : vec3(0.0);
    case VIEW_FACET_COUNT: return vec3(float(count));
  }
  if (uvec2(push.matrix) == uvec2(0u)) return vec3(0.0);
  MatrixArrays m = push.matrix.at[0];
  uvec2 info = m.rowInfo.at[facet];
  switch (VIEW) {
    case VIEW_ROW_OCCUPANCY: return vec3(float(rowEntries(info)) / float(rowRays()));
    case VIEW_INVALID_RAYS: return vec3(float(rowInvalid(info)) / float(rowRays()));
    case VIEW_ROW_SUM: return vec3(rowSum(m, facet));
  }
  return vec3(1.0, 0.0, 1.0);
}

/// The stored distance field, voxels.
float storedDistance(uint index) {
  return float((push.bytes.at[index >> 2] >> (8u * (index & 3u))) & 255u) * push.byteScale;
}

/// Distance to the seed that jump flooding has found for a voxel, voxels; < 0: none yet.
float seedDistance(uvec3 voxel, uint index) {
  uint seed = push.seeds.at[index];
  if (seed == NO_SEED) return -1.0;
  ivec3 d = ivec3(unpackVoxel(seed)) - ivec3(voxel);
  return sqrt(float(d.x * d.x + d.y * d.y + d.z * d.z));
}

/// The exact distance in the metric of the view's field, voxels; < 0: nothing is solid.
float exactDistance(uint index) {
  uint d = push.exact.at[index];
  if (d == NO_DISTANCE) return -1.0;
  return isFrom(FROM_CHEBYSHEV) ? float(min(d, 255u)) : sqrt(float(d));  // that field ends at 255
}

/// By what a field view's cubes and isosurface are cut out, voxels.
float levelDistance(uvec3 voxel) {
  const float far = 1e4;
  uint index = voxelIndex(voxel, push.grid.dims);
  if (viewIsDistance(FROM)) return storedDistance(index);
  float d = isFrom(FROM_EXACT) ? exactDistance(index) : seedDistance(voxel, index);
  return d < 0.0 ? far : d;
}

vec4 fieldValue(uvec3 voxel) {
  uint index = voxelIndex(voxel, push.grid.dims);
  if (viewIsDistance(FROM)) return vec4(vec3(storedDistance(index)), 1.0);
  if (!isFrom(FROM_EXACT)) {
    uint seed = push.seeds.at[index];
    return seed == NO_SEED ? vec4(0.0) : vec4(vec3(unpackVoxel(seed)), 1.0);
  }
  float exact = exactDistance(index);
  float found = isFrom(FROM_JUMP_FLOOD) ? seedDistance(voxel, index) : storedDistance(index);
  return exact < 0.0 || found < 0.0 ? vec4(0.0) : vec4(vec3(found - exact), 1.0);
}

/// The value of a voxel, as seen from `towards` (relative to its centre): of its facets the one that faces there more.
/// Alpha 0: it has none.
vec4 voxelValue(FacetArrays facets, uvec3 voxel, vec3 towards) {
  if (isFrom(FROM_ANY_FIELD)) return fieldValue(voxel);
  uint entry = facets.reverse.at[voxelIndex(voxel, push.grid.dims)];
  if (entry == NO_FACET) return vec4(0.0);
  uint facet = firstFacet(entry);
  uint count = facetsOf(entry);
  float most = dot(facetNormal(facets, facet), towards);
  for (uint i = firstFacet(entry) + 1u; i < firstFacet(entry) + count; ++i) {
    float cosine = dot(facetNormal(facets, i), towards);
    if (cosine <= most) continue;
    most = cosine;
    facet = i;
  }
  return vec4(facetValue(facets, facet, count), 1.0);
}

/// Whether a voxel is drawn as a cube.
bool isCube(FacetArrays facets, uvec3 voxel) {
  if (isFrom(FROM_ANY_FIELD)) return levelDistance(voxel) <= push.isovalue;
  return facets.reverse.at[voxelIndex(voxel, push.grid.dims)] != NO_FACET;
}

#endif
