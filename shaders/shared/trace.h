// What the ray traversals of shaders/gi/trace.glsl take and give (docs/method.md 3 and 5).
#ifndef IRAD_SHARED_TRACE_H
#define IRAD_SHARED_TRACE_H
#include "shared/facets.h"
#include "shared/sampling.h"
#include "shared/surface.h"
IRAD_BEGIN

// Specialization constant 0 of every shader that traces.
IRAD_CONST uint TRACE_DDA_REVERSE = 0u;  ///< cell by cell, solid where the reverse map has a facet
IRAD_CONST uint TRACE_DDA_FIELD = 1u;    ///< cell by cell, solid where the Chebyshev byte is 0 (a quarter of the bytes)
IRAD_CONST uint TRACE_SKIP = 2u;         ///< steps over the empty cube that the Chebyshev distance proves
IRAD_CONST uint TRACE_JFA = 3u;  ///< sphere-marches the UNORM8 Euclidean distance (T 5.2): only shaders that bind it

// What a ray met, in place of a facet index.
IRAD_CONST uint TRACE_ESCAPED = 0xFFFFFFFFu;     ///< left the grid
IRAD_CONST uint TRACE_BLOCKED = 0xFFFFFFFEu;     ///< the back of a single-sided face: absorbed
IRAD_CONST uint TRACE_INVALID = 0xFFFFFFFDu;     ///< not known which facet it met: does not count
IRAD_CONST uint TRACE_NOT_CAST = 0xFFFFFFFCu;    ///< a small facet has fewer rays (facetRays)
IRAD_CONST uint TRACE_LAST_FACET = 0x7FFFFFFFu;  ///< facets are at most this
IRAD_CONST uint TRACE_SKY = 0x80000000u;         ///< where it is asked for, from here on: left the grid, by bins (sky.h)

// A ray that panes have let through may have lost channels there: TINT_ bits of what it has met, 1 for each that is gone.
IRAD_CONST uint TINT_BITS = 3u;
IRAD_CONST uint TINT_NONE_LEFT = 7u;
IRAD_CONST uint TINT_SHIFT_SKY = 16u;    ///< of a bin; as many have room below it
IRAD_CONST uint TINT_SHIFT_FRAMES = 28u; ///< of a facet, where no matrix is made of it
/// 1 for each channel that is left.
IRAD_FN vec3 openChannels(uint closed) {
  return vec3((closed & 1u) == 0u ? 1.0f : 0.0f, (closed & 2u) == 0u ? 1.0f : 0.0f, (closed & 4u) == 0u ? 1.0f : 0.0f);
}

/// One byte per voxel: exact Chebyshev distance to the nearest solid voxel (Field::chebyshev).
#ifdef __cplusplus
using ByteArray = uint64_t;
#else
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ByteArray {
  uint8_t at[];
};
#endif

/// A point of a facet's plane, where facets are planes (rule `thesis`): spread over its cell's footprint along the
/// normal's largest axis. `jitter` in (0, 1)^2.
IRAD_FN vec3 facetPoint(uvec3 voxel, vec3 normal, float offset, vec2 jitter) {
  vec2 j = jitter - vec2(0.5f);
  vec3 a = abs(normal);
  vec3 p;
  if (a.z >= a.x && a.z >= a.y)
    p = vec3(j.x, j.y, (offset - normal.x * j.x - normal.y * j.y) / normal.z);
  else if (a.y >= a.x)
    p = vec3(j.x, (offset - normal.x * j.x - normal.z * j.y) / normal.y, j.y);
  else
    p = vec3((offset - normal.y * j.x - normal.z * j.y) / normal.x, j.x, j.y);
  return vec3(voxel) + vec3(0.5f) + p;
}

/// Point k of the R2 sequence (Roberts 2018), shifted: the jitter over a facet, independent of the directions.
IRAD_FN vec2 facetJitter(uint k, uvec2 shift) {
  return vec2(unitFloat(3242174889u * (k + 1u) + shift.x), unitFloat(2447445414u * (k + 1u) + shift.y));
}

/// The ray set of a facet: shifts of directions (xy) and of starts (zw). Without jitter every voxel has the same set.
IRAD_FN uvec4 rayShifts(uint packedVoxel, uint seed, uint jitter) {
  if (jitter == 0u) return uvec4(0u, 0u, 0x80000000u, 0x80000000u);
  uint a = hashUint(packedVoxel ^ hashUint(seed));
  uint b = hashUint(a ^ 0x9E3779B9u);
  uint c = hashUint(b ^ 0x85EBCA6Bu);
  return uvec4(a, b, c, hashUint(c ^ 0xC2B2AE35u));
}

/// Of rule `triangles`: the surfel that ray k starts from, counted from the facet's first, and the ray's direction.
IRAD_FN uint raySurfel(uint k, uvec4 shifts) {
  return uint(facetJitter(k, uvec2(shifts.z, shifts.w)).x * float(FACET_SURFELS));
}
IRAD_FN vec3 rayDirection(vec3 facing, uint k, uint rays, uvec4 shifts) {
  return toWorld(cosineDirection(hammersley(k, rays, uvec2(shifts.x, shifts.y))), facing);
}

/// A ray on its way, which waits until enough others do to go on beside it.
struct WaitingRay {
  uint ray;        ///< its place among the hits
  uint cell;       ///< packVoxel
  float t;         ///< where it enters the cell
  uint piece;      ///< the next one to ask there, or NOT_LOOKED_UP: which it holds is not known yet
  uint hitPiece;   ///< what it would meet if nothing else were nearer: WAITING_FRONT or 0, and one more than the piece; 0: none
  uint hitEntry;   ///< this and the following: of what it would meet (TriangleWalk)
  float hitT, nearest;
};
IRAD_CONST uint NOT_LOOKED_UP = 0xFFFFFFFFu;
IRAD_CONST uint WAITING_FRONT = 0x80000000u;
/// What a list of these begins with.
struct WaitingHead {
  uvec3 groups;  ///< of the dispatch over them, WAITING_GROUP rays each
  uint count;    ///< may be more than there is room for: those beyond have gone on
};
IRAD_CONST uint WAITING_GROUP = 128u;  ///< there is room for whole groups
#ifdef __cplusplus
using WaitingRays = uint64_t;
#else
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer WaitingRays {
  WaitingHead head;
  WaitingRay at[];
};
#endif

/// Pushed to gi/trace_rays.comp and gi/trace_triangle_rays.comp.
struct TraceRaysPush {
  FacetArrays facets;  ///< by value: lavapipe knows only pointers in push constants to be uniform
  ByteArray chebyshev;
  UintArray hits;  ///< rays x rows words: facet met, or TRACE_*
  uvec3 dims;
  float jfaMax;
  uint firstRow, rows, rays, seed;
  uint mostWaiting;  ///< that `waiting` has room for
  uint tintShift;  ///< where the channels go that panes keep off; 0: they are not told
  SurfaceRecord surface;
  WaitingRays resumed, waiting;  ///< rule `triangles`: those that go on, and those that are to wait
};

/// Where a ray to a point of a triangle ends: a ten-thousandth of its way is more than the roundings of that point.
IRAD_FN float shortOf(float reach) {
  return reach * (1.0f - 1e-4f);
}

IRAD_END
#endif
