// Where lookups of light find the facets around a surface, and which of those walls hide from it (docs/method.md 7):
// the floor beyond a wall, or beneath it, says nothing about the floor in front.
#ifndef IRAD_FACET_MAP_GLSL
#define IRAD_FACET_MAP_GLSL
#include "shared/facets.h"
#include "shared/grid.h"
#include "shared/normals.h"
#include "shared/trace.h"

/// Held by value: data behind uniform pointers is read once for all lanes.
struct FacetMap {
  UintArray shape, reverse, around;  ///< of FacetArrays
  uvec3 dims;
  uint encoding;
};

/// A voxel's entry of the reverse map; NO_FACET outside the grid.
uint facetEntry(FacetMap map, ivec3 v) {
  if (any(lessThan(v, ivec3(0))) || any(greaterThanEqual(v, ivec3(map.dims)))) return NO_FACET;
  return map.reverse.at[voxelIndex(uvec3(v), map.dims)];
}

const float WALL_COSINE = 0.5f;  // faces are walls to one another where the cosine between them is below

/// A voxel whose centre is farther than this behind the plane of a face has no part before it, voxels.
float allBehind(vec3 facing) {
  return voxelExtent(facing) - TRACE_BEHIND;
}

/// A point of a surface that light is looked up for (voxel units), and walls that stand before it: voxels all of which
/// are behind one are not asked.
struct Receiver {
  vec3 position, normal;
  vec4 wall, otherWall;  ///< behind it: dot(xyz, voxel's centre) + w < 0
};

/// Whether a wall hides all of a voxel, whose centre is given, from the receiver.
bool hiddenVoxel(Receiver r, vec3 centre) {
  return min(dot(r.wall.xyz, centre) + r.wall.w, dot(r.otherWall.xyz, centre) + r.otherWall.w) < 0.0f;
}

/// The receiver at `p` on a surface with normal `n`, seen from the direction `viewer`. Its walls are the faces of the
/// voxel in front of it; of a sheet's two sides, the one that it is seen in front of.
Receiver receiverAt(FacetMap map, vec3 p, vec3 n, vec3 viewer) {
  Receiver r = Receiver(p, n, vec4(0.0f), vec4(0.0f));
  vec3 centre = floor(p + 0.5f * n) + 0.5f;
  uint entry = facetEntry(map, ivec3(centre));
  if (entry == NO_FACET) return r;
  float before = -TRACE_PLANE;
  for (uint i = 0u; i < facetsOf(entry); ++i) {
    uint shape = map.shape.at[firstFacet(entry) + i];
    vec3 facing = decodeNormal(shape & 0xFFFFu, map.encoding);
    // At a wall's foot the plane's code cannot tell the side, so a point a little towards the viewer is taken.
    float distance_ = dot(facing, p + TRACE_PLANE * viewer - centre) - facetOffset(shape);
    if (abs(dot(facing, n)) >= WALL_COSINE || distance_ < -TRACE_PLANE) continue;
    vec4 wall = vec4(facing, allBehind(facing) - facetOffset(shape) - dot(facing, centre));
    bool sheet = dot(facing, r.wall.xyz) < OPPOSED_COSINE;
    if (!sheet) r.otherWall = r.wall;
    if (!sheet || distance_ > before) r.wall = wall;
    before = distance_;
  }
  return r;
}

/// Whether the voxel's other face meets the facet of these neighbours (FacetArrays::around) convexly.
bool convexInVoxel(uint around) {
  int before = bitCount(around & (AROUND_SELF - 1u));
  return (around & AROUND_SELF) != 0u && before < 5 && ((around >> (AROUND_CONVEX_SHIFT + uint(before))) & 1u) != 0u;
}

/// Whether another face of the facet's voxel (`entry` of the reverse map) is a wall on it, and hides it from `point`,
/// given from the voxel's centre: the point is behind the wall, or all of the facet is. `shape`: the facet's.
bool hiddenByWalls(FacetMap map, uint entry, uint facet, uint shape, vec3 normal, vec3 point) {
  if (facetsOf(entry) == 1u || (shape & FACET_CORNER) == 0u || convexInVoxel(map.around.at[facet])) return false;
  uint first = firstFacet(entry);
  for (uint other = first; other < first + facetsOf(entry); ++other) {
    if (other == facet) continue;
    uint wallShape = map.shape.at[other];
    vec3 facing = decodeNormal(wallShape & 0xFFFFu, map.encoding);
    float offset = facetOffset(wallShape);
    if (abs(dot(facing, normal)) < WALL_COSINE &&
        (dot(facing, point) - offset < -TRACE_ON_PLANE || offset > allBehind(facing)))
      return true;
  }
  return false;
}

#endif
