// Whether two points of surfaces in a voxel lie on the same side of them, so that one facet may stand for both
// (docs/method.md 4): their normals are alike, and a way from one to the other crosses no piece of a triangle.
#ifndef IRAD_SEEN_IN_VOXEL_H
#define IRAD_SEEN_IN_VOXEL_H
#include "forward/precise.h"
#include "gi/triangle_hit.h"
#include "shared/surface.h"
IRAD_BEGIN

struct VoxelPieces {
  Vec4Array corners;
  UintArray pieces, boxes;
  vec3 cell;  ///< the voxel's lower corner
  uint first, end;
  uint endLarge;  ///< of those that may stand on others or hide them
};

/// The first of some of a voxel's pieces that is not before `piece`.
IRAD_FN uint pieceFrom(UintArray pieces, uint first, uint end, uint piece) {
  while (first < end) {
    uint middle = (first + end) / 2u;
    if (pieces.at[middle] < piece) first = middle + 1u;
    else end = middle;
  }
  return first;
}

IRAD_FN VoxelPieces voxelPieces(Vec4Array corners, UintArray pieces, UintArray boxes, vec3 cell, uint first, uint end) {
  VoxelPieces voxel = {corners, pieces, boxes, cell, first, end,
                       end - first <= MOST_LARGE ? end : pieceFrom(pieces, first, end, PIECE_SMALL)};
  return voxel;
}

IRAD_CONST uint NO_PIECE = 0xFFFFFFFFu;

/// The piece of a triangle, or NO_PIECE.
IRAD_FN uint pieceIn(VoxelPieces voxel, uint triangle) {
  uint place = pieceFrom(voxel.pieces, voxel.first, voxel.endLarge, triangle);
  if (place < voxel.endLarge && voxel.pieces.at[place] == triangle) return place;
  place = pieceFrom(voxel.pieces, voxel.endLarge, voxel.end, triangle | PIECE_SMALL);
  return place < voxel.end && voxel.pieces.at[place] == (triangle | PIECE_SMALL) ? place : NO_PIECE;
}

IRAD_CONST float SAME_SIDE_COSINE = 0.7f;            ///< least between normals
IRAD_CONST float SAME_SIDE_LEVEL = 0.02f;            ///< voxels: a face this far above another is another
IRAD_CONST float ABOVE_SURFACE = 1.0f / 256.0f;        ///< voxels: ways are at most this far above the surface
IRAD_CONST float AROUND_CELL = 2.0f * ABOVE_SURFACE;  ///< ways from points on a cell's border pass outside it

/// The boxes that a segment comes near, nearer than ways are above the surface: by the largest of each of their numbers
/// from 0 to 31, where those of upper corners are counted from 31 down. The six are in two words, ten bits apart, so that
/// all are compared at once.
struct NearBoxes {
  uint even, odd;
};
IRAD_CONST uint BOX_UPPER = 0x3FFF8000u;  ///< bits of a packed box's upper corner
IRAD_CONST uint BOX_EVEN = 0x01F07C1Fu;   ///< of its numbers 0, 2 and 4
IRAD_CONST uint BOX_ABOVE = 0x02008020u;  ///< the bits above these

/// What is cut off at the voxel's faces goes on beyond, and so may the segment.
IRAD_FN NearBoxes boxesNear(VoxelPieces voxel, vec3 a, vec3 b) {
  vec3 low = min(min(a, b) - voxel.cell, vec3(1.0f)) - AROUND_CELL;
  vec3 high = max(max(a, b) - voxel.cell, vec3(0.0f)) + AROUND_CELL;
  uvec3 lower = uvec3(min(floor(high * BOX_STEPS), vec3(BOX_STEPS - 1.0f)));
  uvec3 upper = uvec3(BOX_STEPS - max(ceil(low * BOX_STEPS), vec3(1.0f)));
  NearBoxes near = {lower.x | (lower.z << 10) | (upper.y << 20), lower.y | (upper.x << 10) | (upper.z << 20)};
  return near;
}

IRAD_FN bool isNear(NearBoxes near, uint box) {
  box ^= BOX_UPPER;
  uint even = (near.even | BOX_ABOVE) - (box & BOX_EVEN), odd = (near.odd | BOX_ABOVE) - ((box >> 5) & BOX_EVEN);
  return (even & odd & BOX_ABOVE) == BOX_ABOVE;
}

/// The large pieces whose boxes a segment comes near, a bit for each from the voxel's first on. Boxes are all asked
/// before any triangle, which costs much more: what runs side by side then takes turns at triangles alone.
IRAD_FN uint piecesNear(VoxelPieces voxel, vec3 a, vec3 b) {
  NearBoxes near = boxesNear(voxel, a, b);
  uint pieces = 0u;
  for (uint i = voxel.first; i < voxel.endLarge; ++i)
    pieces |= isNear(near, voxel.boxes.at[i]) ? 1u << (i - voxel.first) : 0u;
  return pieces;
}

/// Whether the segment from `a` to `b` (voxel units) crosses no large piece but those of two triangles.
IRAD_FN bool clearInVoxel(VoxelPieces voxel, vec3 a, vec3 b, uint except1, uint except2) {
  ShearedRay ray = shearedRay(a, b - a);
  for (uint near = piecesNear(voxel, a, b); near != 0u; near &= near - 1u) {
    uint triangle = voxel.pieces.at[voxel.first + uint(findLSB(near))];
    float t;
    bool front;
    if (triangle != except1 && triangle != except2 &&
        meetsTriangle(ray, triangleAt(voxel.corners, triangle), t, front) && t > 0.0f && t < 1.0f)
      return false;
  }
  return true;
}

/// Cuts off what of a segment is outside of a plane: it begins `at` inside and goes inward by `rate`. Whether any of it,
/// from `first` to `last`, is left.
IRAD_FN bool cutAtPlane(float at, float rate, IRAD_INOUT(float) first, IRAD_INOUT(float) last) {
  if (rate == 0.0f) return at >= 0.0f;
  if (rate > 0.0f) first = max(first, -at / rate);
  else last = min(last, -at / rate);
  return first < last;
}

/// Whether a triangle crosses the plane `above` another one's side, over that triangle, away from its edges and in a
/// box. `facing`: the side's unit normal.
IRAD_FN bool crossesAbove(vec3 low, vec3 high, Triangle standing, Triangle t, vec3 facing, float above) {
  vec3 other[3] = {standing.a, standing.b, standing.c};
  vec3 height = vec3(dot(facing, other[0] - t.a), dot(facing, other[1] - t.a), dot(facing, other[2] - t.a)) - above;
  bvec3 over = greaterThan(height, vec3(0.0f));
  if (all(over) || !any(over)) return false;
  // The corner that is alone on its side of the plane, and the segment in which the plane cuts the triangle.
  uint i = over.x != over.y ? (over.x != over.z ? 0u : 1u) : 2u;
  uint j = (i + 1u) % 3u, k = (i + 2u) % 3u;
  vec3 from = mix(other[i], other[j], height[i] / (height[i] - height[j]));
  vec3 along = mix(other[i], other[k], height[i] / (height[i] - height[k])) - from;
  float first = 0.0f, last = 1.0f;
  // The box's faces come first: they need no root, and most segments end at them.
  for (uint axis = 0u; axis < 3u; ++axis) {
    if (!cutAtPlane(from[axis] - low[axis], along[axis], first, last) ||
        !cutAtPlane(high[axis] - from[axis], -along[axis], first, last))
      return false;
  }
  vec3 corner[3] = {t.a, t.b, t.c};
  float edge = 0.5f * above + 1e-4f;  // what stands on the edge, and leans over it, is no cut
  for (uint e = 0u; e < 3u; ++e) {
    vec3 inward = normalize(cross(facing, corner[(e + 1u) % 3u] - corner[e]));
    if (dot(inward, corner[(e + 2u) % 3u] - corner[e]) < 0.0f) inward = -inward;
    if (!cutAtPlane(dot(inward, from - corner[e]) - edge, dot(inward, along), first, last)) return false;
  }
  return true;
}

/// Whether a triangle stands on another one's side in a box: it comes up to the surface, to what rounding leaves of
/// that, or to where ways pass over it.
IRAD_FN bool standsOn(vec3 low, vec3 high, Triangle standing, Triangle t, vec3 facing) {
  return crossesAbove(low, high, standing, t, facing, ABOVE_SURFACE / 64.0f) ||
         crossesAbove(low, high, standing, t, facing, ABOVE_SURFACE);
}

/// The same in a cell and around it, for the front of a triangle and, where it shows, the back.
IRAD_FN bool standsOnSides(vec3 cell, Triangle standing, Triangle t, bool back) {
  vec3 facing = facingOf(t, false), low = cell - AROUND_CELL, high = cell + (1.0f + AROUND_CELL);
  return standsOn(low, high, standing, t, facing) || (back && standsOn(low, high, standing, t, -facing));
}

/// Of the large pieces but `own` those that may stand on a triangle's sides, a bit for each (they are MOST_LARGE = 32 at
/// most) from the voxel's first on: by the heights of their corners alone, which is little beside standsOnSides().
IRAD_FN uint mayStandOn(VoxelPieces voxel, uint own, Triangle t, bool back) {
  vec3 facing = facingOf(t, false);
  uint pieces = 0u;
  for (uint i = voxel.first; i < voxel.endLarge; ++i) {
    Triangle other = triangleAt(voxel.corners, triangleOf(voxel.pieces, i));
    vec3 height = vec3(dot(facing, other.a - t.a), dot(facing, other.b - t.a), dot(facing, other.c - t.a));
    float low = min(height.x, min(height.y, height.z)), high = max(height.x, max(height.y, height.z));
    bool may = (high > ABOVE_SURFACE / 64.0f && low <= ABOVE_SURFACE) ||
               (back && -low > ABOVE_SURFACE / 64.0f && -high <= ABOVE_SURFACE);
    pieces |= may && i != own ? 1u << (i - voxel.first) : 0u;
  }
  return pieces;
}

/// How far above a point of a surface ways from it begin: nothing is on the way there. Where a triangle leans over the
/// point that is less than ABOVE_SURFACE.
IRAD_FN float clearAbove(VoxelPieces voxel, vec3 point, vec3 facing, uint own) {
  ShearedRay ray = shearedRay(point, facing);
  float clear = 2.0f * ABOVE_SURFACE;
  for (uint near = piecesNear(voxel, point, point + facing * clear); near != 0u; near &= near - 1u) {
    uint piece = voxel.first + uint(findLSB(near)), triangle = voxel.pieces.at[piece];
    float t;
    bool front;
    if (triangle != own && isNear(boxesNear(voxel, point, point + facing * clear), voxel.boxes.at[piece]) &&
        meetsTriangle(ray, triangleAt(voxel.corners, triangle), t, front) && t > 0.0f)
      clear = min(clear, t);
  }
  return 0.5f * clear;
}

/// What a way from one point of a side to another has to do, by what the two say alone.
struct SideWay {
  bool open;          ///< there may be one
  float bulge;        ///< how far it is raised over what bulges between them, where that is convex
  uint pass1, pass2;  ///< triangles that it may pass through
};

/// Of normals. Many are as like to one another as the next ones, so that a rounding would choose.
IRAD_FN bool facesAlike(vec3 facing, vec3 other) { return preciseDot(facing, other) >= SAME_SIDE_COSINE; }

/// Whether two points may lie on one side, by what they say alone: their normals are alike, and neither stands above the
/// other's plane while that one lies below its own.
IRAD_FN bool mayContinue(SurfelPoint a, SurfelPoint b) {
  vec3 chord = b.position - a.position;
  float above = dot(a.facing, chord), below = -dot(b.facing, chord);
  return facesAlike(a.facing, b.facing) &&
         (max(above, below) <= SAME_SIDE_LEVEL || min(above, below) >= -SAME_SIDE_LEVEL);
}

/// In a box. Points are no nearer than CUT_WIDTH to what passes through their triangle.
IRAD_FN SideWay wayBetween(Vec4Array corners, vec3 low, vec3 high, SurfelPoint a, SurfelPoint b) {
  SideWay way = {false, 0.0f, a.triangle, b.triangle};
  if (!mayContinue(a, b)) return way;
  float alike = dot(a.facing, b.facing);
  vec3 chord = b.position - a.position;
  float above = dot(a.facing, chord), below = -dot(b.facing, chord);
  float most = max(above, below), least = min(above, below);
  if (least < 0.0f) way.bulge = 0.3f * length(chord) * sqrt(max(0.0f, 0.5f - 0.5f * alike));
  way.open = true;
  if (least > -0.5f * CUT_WIDTH) return way;
  if (most > 0.0f) {
    // One is behind the other: it is seen past that triangle's end.
    way.pass1 = way.pass2 = NO_PIECE;
  } else {
    // Over an edge between them; but triangles that go on through each other have no side in common there.
    Triangle ta = triangleAt(corners, a.triangle), tb = triangleAt(corners, b.triangle);
    way.open = !standsOn(low, high, tb, ta, a.facing) && !standsOn(low, high, ta, tb, b.facing);
  }
  return way;
}

/// A point from which ways to others begin `lift` above it (clearAbove).
struct SidePoint {
  SurfelPoint at;
  float lift;
};

/// The segments of a way: straight from above one point to above the other or, where it is raised, up from both and
/// across.
struct SidePath {
  vec3 begin, end;
  vec3 beginHigh, endHigh;
  bool raised;
};

IRAD_FN SidePath pathOf(SideWay way, SidePoint from, SidePoint to) {
  SidePath path;
  path.begin = from.at.position + from.at.facing * from.lift;
  path.end = to.at.position + to.at.facing * to.lift;
  path.raised = way.bulge > ABOVE_SURFACE;
  path.beginHigh = path.begin + from.at.facing * way.bulge;
  path.endHigh = path.end + to.at.facing * way.bulge;
  return path;
}

IRAD_FN uint segmentsOf(SidePath path) { return path.raised ? 3u : 1u; }

IRAD_FN void segmentAt(SidePath path, uint i, IRAD_INOUT(vec3) a, IRAD_INOUT(vec3) b) {
  a = i == 0u ? path.begin : (i == 1u ? path.end : path.beginHigh);
  b = i == 0u ? (path.raised ? path.beginHigh : path.end) : path.endHigh;
}

/// Points of triangles in one voxel.
IRAD_FN bool sameSide(VoxelPieces voxel, SidePoint from, SidePoint to) {
  SurfelPoint a = from.at, b = to.at;
  SideWay way = wayBetween(voxel.corners, voxel.cell - AROUND_CELL, voxel.cell + (1.0f + AROUND_CELL), a, b);
  if (!way.open) return false;
  vec3 chord = b.position - a.position;
  if (dot(chord, chord) < 1e-10f) return true;
  SidePath path = pathOf(way, from, to);
  for (uint i = 0u; i < segmentsOf(path); ++i) {
    vec3 p, q;
    segmentAt(path, i, p, q);
    if (!clearInVoxel(voxel, p, q, way.pass1, way.pass2)) return false;
  }
  return true;
}

IRAD_END
#endif
