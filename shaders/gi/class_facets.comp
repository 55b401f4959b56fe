// The facets of a voxel (docs/method.md 4): one workgroup per solid voxel. Points are spread over both sides of its
// pieces by area; a facet is a class of those that lie on the same side of the surface as the first of them. Runs
// twice: to count the facets, and to make them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/seen_in_voxel.glsl"
#include "gi/voxel_clip.glsl"
#include "shared/sampling.h"
#include "shared/surface.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ClassFacetsPush push; };

const uint POINTS = 64u;
const uint BACK = 0x80000000u;       ///< of a piece
const uint NO_CLASS = 0xFFFFFFFFu;
const float LEAST_AREA = 1e-6;       ///< voxel faces: smaller pieces get no point

shared vec3 pointAt[POINTS], pointFacing[POINTS];
shared uint pointPiece[POINTS];  ///< | BACK
shared uint pointPlace[POINTS];  ///< Surfel::place
shared uint pointClass[POINTS];
shared float pointWeight[POINTS];
shared uint leader[POINTS];  ///< of each class, its first point
shared uint next;

bool doubleSided(uint triangle) {
  GpuScene scene = push.scene.at[0];
  return (scene.materials.at[scene.triangleMaterials.at[triangle]].flags & MATERIAL_DOUBLE_SIDED) != 0u;
}

/// Weights of the second and third corner at a point of the triangle.
vec2 weightsAt(Triangle t, vec3 p) {
  vec3 b = t.b - t.a, c = t.c - t.a, d = p - t.a, n = cross(b, c);
  return vec2(dot(cross(d, c), n), dot(cross(b, d), n)) / dot(n, n);
}

/// A point of the clipped polygon, uniform over its area for u uniform over the square.
vec3 polygonPoint(uint from, uint n, float area, vec2 u) {
  vec3 first = clipCorners[clipPlace(from, 0u)];
  float left = u.x * area;
  vec3 d = vec3(0.0), e = vec3(0.0);
  [[dont_unroll]] for (uint i = 2u; i < n; ++i) {
    d = clipCorners[clipPlace(from, i - 1u)] - first;
    e = clipCorners[clipPlace(from, i)] - first;
    float fan = 0.5 * length(cross(d, e));
    if (left < fan || i + 1u == n) {
      float x = fan > 0.0 ? clamp(left / fan, 0.0, 1.0) : 0.5;
      // Along the fan by x, from its tip by the root of u.y: uniform.
      float r = sqrt(u.y);
      return first + r * mix(d, e, x);
    }
    left -= fan;
  }
  return first;
}

/// The class of a piece's side on which no point fell: the one on whose side its middle lies; in a voxel of more pieces
/// than points that of the nearest point.
uint withoutPoints(VoxelPieces pieces, vec3 cell, uint classes, uint piece, Triangle t, vec3 facing) {
  uint from;
  uint corners = clipPolygon(t.a - cell, t.b - cell, t.c - cell, 1e-4, from);
  vec3 middle = (t.a + t.b + t.c) * (1.0 / 3.0) - cell;
  if (corners > 0u) polygonArea(from, corners, middle);
  middle += cell;
  bool few = pieces.end - pieces.first <= POINTS / 2u;
  for (uint k = 0u; few && k < classes; ++k) {
    uint lead = leader[k];
    uint its = pieces.pieces.at[pointPiece[lead] & ~BACK];
    if (sameSide(pieces, pointAt[lead], pointFacing[lead], its, middle, facing, pieces.pieces.at[piece])) return k;
  }
  uint result = PIECE_BLACK;
  float nearest = 1e30;
  for (uint k = 0u; push.pieceArea.at[piece] >= LEAST_AREA && k < POINTS; ++k) {
    vec3 d = pointAt[k] - middle;
    float distance2 = dot(d, d) + (dot(pointFacing[k], facing) > 0.0 ? 0.0 : 3.0);
    if (distance2 >= nearest) continue;
    nearest = distance2;
    result = pointClass[k];
  }
  return result;
}

void main() {
  uint voxel = irad_workgroup();
  if (voxel >= push.count) return;
  uint me = gl_LocalInvocationID.x;
  uint packedVoxel = push.solid.at[voxel];
  vec3 cell = vec3(unpackVoxel(packedVoxel));
  SurfaceArrays surface = push.surface.at[0];
  VoxelPieces pieces =
      VoxelPieces(surface.corners, push.pieces, push.firstPiece.at[voxel], push.firstPiece.at[voxel + 1u]);

  // How much there is of the surface; each piece gets points by its area, and one in two by being there.
  float whole = 0.0, sides = 0.0;
  for (uint i = pieces.first; i < pieces.end; ++i) {
    float area = push.pieceArea.at[i];
    if (area < LEAST_AREA) continue;
    float n = doubleSided(pieces.pieces.at[i]) ? 2.0 : 1.0;
    whole += n * area;
    sides += n;
  }
  bool any_ = sides > 0.0;
  float extra = any_ ? whole / sides : 0.0;
  float total = 2.0 * whole, step_ = total / float(POINTS);
  float wanted = (float(me) + 0.5) * step_;

  // This invocation's point.
  uint piece = 0u;
  bool back = false;
  float before = 0.0, share = 0.0, pieceArea = 0.0;
  {
    float upTo = 0.0;
    bool found = !any_;
    for (uint i = pieces.first; i < pieces.end && !found; ++i) {
      float area = push.pieceArea.at[i];
      if (area < LEAST_AREA) continue;
      uint n = doubleSided(pieces.pieces.at[i]) ? 2u : 1u;
      for (uint s = 0u; s < n && !found; ++s) {
        piece = i;
        back = s == 1u;
        before = upTo;
        share = area + extra;
        pieceArea = area;
        upTo += share;
        found = wanted < upTo;
      }
    }
  }
  uint triangle = any_ ? pieces.pieces.at[piece] : 0u;
  pointClass[me] = NO_CLASS;
  if (any_) {
    Triangle t = triangleAt(surface.corners, triangle);
    uint from;
    uint n = clipPolygon(t.a - cell, t.b - cell, t.c - cell, 0.0, from);
    uint shift = hashUint(packedVoxel ^ 0x2545F491u);
    float across = clamp((wanted - before) / share, 0.0, 1.0);
    vec3 point = cell + polygonPoint(from, n, pieceArea, vec2(across, unitFloat(reverseBits(me) + shift)));
    pointPlace[me] = packPlace(weightsAt(t, point));
    vec2 weights = unpackPlace(pointPlace[me]);
    pointAt[me] = t.a + (t.b - t.a) * weights.x + (t.c - t.a) * weights.y;
    pointFacing[me] = facingOf(t, back);
    pointPiece[me] = piece | (back ? BACK : 0u);
    // How many points share the piece's side.
    float first = ceil(before / step_ - 0.5), end = ceil((before + share) / step_ - 0.5);
    pointWeight[me] = pieceArea / max(end - first, 1.0);
  }

  // Classes, each about the first point that has none yet.
  uint classes = 0u;
  for (;;) {
    if (me == 0u) next = POINTS;
    barrier();
    if (any_ && pointClass[me] == NO_CLASS) atomicMin(next, me);
    barrier();
    uint lead = next;
    barrier();
    if (lead == POINTS) break;
    if (me == 0u) leader[classes] = lead;
    if (pointClass[me] == NO_CLASS &&
        (me == lead || sameSide(pieces, pointAt[lead], pointFacing[lead], pieces.pieces.at[pointPiece[lead] & ~BACK],
                                pointAt[me], pointFacing[me], triangle)))
      pointClass[me] = classes;
    ++classes;
    barrier();
  }
  if (push.makes == 0u) {
    if (me == 0u) push.facetStart.at[voxel] = classes;
    return;
  }
  if (classes == 0u) return;

  uint base = push.facetStart.at[voxel];
  // Which facet each side of a piece belongs to.
  for (uint i = pieces.first + me; i < pieces.end; i += POINTS) {
    uint of = pieces.pieces.at[i];
    Triangle t = triangleAt(surface.corners, of);
    uint found[2] = uint[2](PIECE_BLACK, PIECE_BLACK);
    uint n = doubleSided(of) ? 2u : 1u;
    for (uint s = 0u; s < n; ++s) {
      vec3 facing = facingOf(t, s == 1u);
      uint side = i | (s == 1u ? BACK : 0u);
      uint result = PIECE_BLACK;
      for (uint k = 0u; k < POINTS; ++k)
        if (pointPiece[k] == side)
          result = result == PIECE_BLACK || result == pointClass[k] ? pointClass[k] : PIECE_SPLIT;
      if (result == PIECE_BLACK) result = withoutPoints(pieces, cell, classes, i, t, facing);
      // What stands on it may hide a part on which no point fell.
      for (uint j = pieces.first; j < pieces.end && result < PIECE_SPLIT; ++j)
        if (j != i && standsOn(cell, triangleAt(surface.corners, pieces.pieces.at[j]), t, facing)) result = PIECE_SPLIT;
      found[s] = result;
    }
    surface.sides.at[i] = found[0] | (found[1] << 16);
  }

  // Surfels: points of equal shares of each class's area.
  for (uint i = me; i < classes * FACET_SURFELS; i += POINTS) {
    uint class_ = i / FACET_SURFELS, k = i % FACET_SURFELS;
    float area = 0.0, all_ = 0.0;
    for (uint j = 0u; j < POINTS; ++j) {
      area += pointClass[j] == class_ ? pointWeight[j] : 0.0;
      all_ += pointWeight[j];
    }
    float at = (float(k) + 0.5) / float(FACET_SURFELS) * area;
    uint chosen = leader[class_];
    float upTo = 0.0;
    for (uint j = 0u; j < POINTS; ++j) {
      if (pointClass[j] != class_) continue;
      chosen = j;
      upTo += pointWeight[j];
      if (at < upTo) break;
    }
    uint side = pointPiece[chosen];
    surface.surfels.at[FACET_SURFELS * base + i] =
        Surfel(pieces.pieces.at[side & ~BACK] | ((side & BACK) != 0u ? SURFEL_BACK : 0u), pointPlace[chosen]);
    if (k == 0u) {
      uint facet = base + class_;
      uint lead = pointPiece[leader[class_]];
      surface.area.at[facet] = area * (whole / all_);  // pieces that no point fell on have area, too
      surface.firstPiece.at[facet] = pieces.first;
      push.voxel.at[facet] = packedVoxel;
      push.triangle.at[facet] = pieces.pieces.at[lead & ~BACK] | ((lead & BACK) != 0u ? SURFEL_BACK : 0u);
    }
  }
  if (me == 0u) push.reverse.at[voxelIndex(uvec3(cell), push.grid.at[0].dims)] = facetEntryOf(base, classes);
}
