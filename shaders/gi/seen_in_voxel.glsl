// Whether two points of surfaces in a voxel lie on the same side of them, so that one facet may stand for both
// (docs/method.md 4): their normals are alike, and a way from one to the other crosses no piece of a triangle.
#ifndef IRAD_SEEN_IN_VOXEL_GLSL
#define IRAD_SEEN_IN_VOXEL_GLSL
#include "gi/triangle_hit.glsl"
#include "shared/surface.h"

struct VoxelPieces {
  Vec4Array corners;
  UintArray pieces, boxes;
  vec3 cell;  ///< the voxel's lower corner
  uint first, end;
  uint endLarge;  ///< of those that may stand on others or hide them
};

/// The first of some of a voxel's pieces that is not before `piece`.
uint pieceFrom(UintArray pieces, uint first, uint end, uint piece) {
  while (first < end) {
    uint middle = (first + end) / 2u;
    if (pieces.at[middle] < piece) first = middle + 1u;
    else end = middle;
  }
  return first;
}

VoxelPieces voxelPieces(Vec4Array corners, UintArray pieces, UintArray boxes, vec3 cell, uint first, uint end) {
  return VoxelPieces(corners, pieces, boxes, cell, first, end,
                     end - first <= MOST_LARGE ? end : pieceFrom(pieces, first, end, PIECE_SMALL));
}

const uint NO_PIECE = 0xFFFFFFFFu;

/// The piece of a triangle, or NO_PIECE.
uint pieceIn(VoxelPieces voxel, uint triangle) {
  uint place = pieceFrom(voxel.pieces, voxel.first, voxel.endLarge, triangle);
  if (place < voxel.endLarge && voxel.pieces.at[place] == triangle) return place;
  place = pieceFrom(voxel.pieces, voxel.endLarge, voxel.end, triangle | PIECE_SMALL);
  return place < voxel.end && voxel.pieces.at[place] == (triangle | PIECE_SMALL) ? place : NO_PIECE;
}

const float SAME_SIDE_COSINE = 0.7;      ///< least between normals
const float SAME_SIDE_LEVEL = 0.02;      ///< voxels: a face this far above another is another
const float ABOVE_SURFACE = 1.0 / 256.0; ///< voxels: ways are at most this far above the surface

/// Whether a segment comes near a piece's box: nearer than ways are above the surface, for what is cut off at the voxel's
/// faces goes on beyond.
bool nearBox(VoxelPieces voxel, uint piece, vec3 a, vec3 b) {
  uint box = voxel.boxes.at[piece];
  vec3 low = min(a, b) - voxel.cell - 2.0 * ABOVE_SURFACE, high = max(a, b) - voxel.cell + 2.0 * ABOVE_SURFACE;
  return all(lessThanEqual(low, boxHigh(box))) && all(greaterThanEqual(high, boxLow(box)));
}

/// Whether the segment from `a` to `b` (voxel units) crosses no large piece but those of two triangles.
bool clearInVoxel(VoxelPieces voxel, vec3 a, vec3 b, uint except1, uint except2) {
  ShearedRay ray = shearedRay(a, b - a);
  for (uint i = voxel.first; i < voxel.endLarge; ++i) {
    uint triangle = voxel.pieces.at[i];
    if (triangle == except1 || triangle == except2 || !nearBox(voxel, i, a, b)) continue;
    float t;
    bool front;
    if (meetsTriangle(ray, triangleAt(voxel.corners, triangle), t, front) && t > 0.0 && t < 1.0)
      return false;
  }
  return true;
}

/// Whether a triangle crosses the plane `above` another one's side, over that triangle, away from its edges and within a
/// cell. `facing`: the side's unit normal.
bool crossesAbove(vec3 cell, Triangle standing, Triangle t, vec3 facing, float above) {
  vec3 other[3] = vec3[3](standing.a, standing.b, standing.c);
  vec3 height = vec3(dot(facing, other[0] - t.a), dot(facing, other[1] - t.a), dot(facing, other[2] - t.a)) - above;
  bvec3 over = greaterThan(height, vec3(0.0));
  if (all(over) || !any(over)) return false;
  // The corner that is alone on its side of the plane, and the segment in which the plane cuts the triangle.
  uint i = over.x != over.y ? (over.x != over.z ? 0u : 1u) : 2u;
  uint j = (i + 1u) % 3u, k = (i + 2u) % 3u;
  vec3 from = mix(other[i], other[j], height[i] / (height[i] - height[j]));
  vec3 along = mix(other[i], other[k], height[i] / (height[i] - height[k])) - from;
  float first = 0.0, last = 1.0;
  vec3 corner[3] = vec3[3](t.a, t.b, t.c);
  for (uint e = 0u; e < 9u; ++e) {
    // Inside: of the triangle's three edges, and of the cell's six faces.
    vec3 inward, base;
    float least = 2e-3;
    if (e < 3u) {
      base = corner[e];
      inward = normalize(cross(facing, corner[(e + 1u) % 3u] - base));
      if (dot(inward, corner[(e + 2u) % 3u] - base) < 0.0) inward = -inward;
    } else {
      uint axis = (e - 3u) / 2u;
      bool upper = (e & 1u) == 0u;
      inward = vec3(axis == 0u ? 1.0 : 0.0, axis == 1u ? 1.0 : 0.0, axis == 2u ? 1.0 : 0.0) * (upper ? -1.0 : 1.0);
      base = upper ? cell + 1.0 : cell;
      least = 0.0;
    }
    float at = dot(inward, from - base) - least, rate = dot(inward, along);
    if (rate == 0.0) {
      if (at < 0.0) return false;
    } else if (rate > 0.0) {
      first = max(first, -at / rate);
    } else {
      last = min(last, -at / rate);
    }
  }
  return first < last;
}

/// Whether a triangle stands on another one's side within a cell: it comes up to the surface, to what rounding leaves of
/// that, or to where ways pass over it.
bool standsOn(vec3 cell, Triangle standing, Triangle t, vec3 facing) {
  return crossesAbove(cell, standing, t, facing, ABOVE_SURFACE / 64.0) ||
         crossesAbove(cell, standing, t, facing, ABOVE_SURFACE);
}

/// The same for the front of a triangle and, where it shows, the back.
bool standsOnSides(vec3 cell, Triangle standing, Triangle t, bool back) {
  vec3 facing = facingOf(t, false);
  return standsOn(cell, standing, t, facing) || (back && standsOn(cell, standing, t, -facing));
}

/// How far above a point of a surface ways from it begin: nothing is on the way there. Where a triangle leans over the
/// point that is less than ABOVE_SURFACE.
float clearAbove(VoxelPieces voxel, vec3 point, vec3 facing, uint own) {
  ShearedRay ray = shearedRay(point, facing);
  float clear = 2.0 * ABOVE_SURFACE;
  for (uint i = voxel.first; i < voxel.endLarge; ++i) {
    uint triangle = voxel.pieces.at[i];
    float t;
    bool front;
    if (triangle != own && nearBox(voxel, i, point, point + facing * clear) &&
        meetsTriangle(ray, triangleAt(voxel.corners, triangle), t, front) && t > 0.0)
      clear = min(clear, t);
  }
  return 0.5 * clear;
}

/// What two points and the unit normals of their sides say by themselves; `bulge`: how far a way from one to the other
/// has to be raised over what bulges between them, where it is convex.
bool mayBeSameSide(vec3 a, vec3 normalA, vec3 b, vec3 normalB, out float bulge) {
  bulge = 0.0;
  float alike = dot(normalA, normalB);
  if (alike < SAME_SIDE_COSINE) return false;
  vec3 chord = b - a;
  float above = dot(normalA, chord), below = -dot(normalB, chord);
  if (max(above, below) > SAME_SIDE_LEVEL && min(above, below) < -SAME_SIDE_LEVEL) return false;
  if (min(above, below) < 0.0) bulge = 0.3 * length(chord) * sqrt(max(0.0, 0.5 - 0.5 * alike));
  return true;
}

/// A point of a triangle's side from which ways to others begin `lift` above it (clearAbove).
struct SidePoint {
  vec3 position, facing;
  uint triangle;
  float lift;
};

/// Points of triangles in one voxel.
bool sameSide(VoxelPieces voxel, SidePoint a, SidePoint b) {
  float bulge;
  if (!mayBeSameSide(a.position, a.facing, b.position, b.facing, bulge)) return false;
  vec3 chord = b.position - a.position;
  if (dot(chord, chord) < 1e-10) return true;
  vec3 from = a.position + a.facing * a.lift, to = b.position + b.facing * b.lift;
  if (bulge > ABOVE_SURFACE) {
    vec3 fromHigh = from + a.facing * bulge, toHigh = to + b.facing * bulge;
    if (!clearInVoxel(voxel, from, fromHigh, a.triangle, b.triangle) ||
        !clearInVoxel(voxel, to, toHigh, a.triangle, b.triangle))
      return false;
    from = fromHigh;
    to = toHigh;
  }
  return clearInVoxel(voxel, from, to, a.triangle, b.triangle);
}

#endif
