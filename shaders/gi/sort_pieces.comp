// Sorts the pieces of each solid voxel: one workgroup per voxel. Where there are many, the small ones come last.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/triangle_hit.glsl"
#include "gi/voxel_clip.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SortPiecesPush push; };

/// Sizes by halves of powers of two, the largest first.
const uint SIZES = 64u;
shared uint ofSize[SIZES];

uint sizeOf(vec3 cell, uint triangle) {
  Triangle t = triangleAt(push.corners, triangle);
  vec3 centre;
  float area = clipToCell(t.a - cell, t.b - cell, t.c - cell, centre);
  return area > 0.0 ? uint(clamp(2.0 - 2.0 * log2(area), 0.0, float(SIZES - 1u))) : SIZES - 1u;
}

/// Marks all but the largest pieces, of which at most MOST_LARGE are not.
void markSmall(vec3 cell, uint first, uint end) {
  uint me = gl_LocalInvocationID.x;
  for (uint i = me; i < SIZES; i += gl_WorkGroupSize.x) ofSize[i] = 0u;
  barrier();
  for (uint i = first + me; i < end; i += gl_WorkGroupSize.x) atomicAdd(ofSize[sizeOf(cell, push.pieces.at[i])], 1u);
  barrier();
  uint large = 0u, count = 0u;
  while (large < SIZES && count + ofSize[large] <= MOST_LARGE) count += ofSize[large++];
  for (uint i = first + me; i < end; i += gl_WorkGroupSize.x)
    if (sizeOf(cell, push.pieces.at[i]) >= large) push.pieces.at[i] |= PIECE_SMALL;
}

/// How many of a sorted run are before `piece`.
uint before(UintArray pieces, uint first, uint end, uint piece) {
  uint from = first;
  while (first < end) {
    uint middle = (first + end) / 2u;
    if (pieces.at[middle] < piece) first = middle + 1u;
    else end = middle;
  }
  return first - from;
}

void between() {
  memoryBarrierBuffer();
  barrier();
}

void main() {
  uint voxel = irad_workgroup();
  if (voxel >= push.count) return;
  uint me = gl_LocalInvocationID.x;
  uint first = push.firstPiece.at[voxel], end = push.firstPiece.at[voxel + 1u];
  for (uint i = first + me; i < end; i += gl_WorkGroupSize.x) push.pieceVoxel.at[i] = voxel;
  if (end - first > MOST_LARGE) {
    markSmall(vec3(unpackVoxel(push.solid.at[voxel])), first, end);
    between();
  }
  if (end - first <= MOST_COUNTED) {
    // A piece's place is how many are before it.
    for (uint i = first + me; i < end; i += gl_WorkGroupSize.x) {
      uint piece = push.pieces.at[i];
      uint place = first;
      for (uint j = first; j < end; ++j) place += push.pieces.at[j] < piece ? 1u : 0u;
      push.sorted.at[place] = piece;
    }
    return;
  }
  // Pairs of sorted runs become one: each piece goes behind those of the other run that are before it.
  UintArray from = push.pieces, to = push.sorted;
  for (uint run = 1u; run < end - first; run *= 2u) {
    for (uint i = first + me; i < end; i += gl_WorkGroupSize.x) {
      uint pair = first + (i - first) / (2u * run) * (2u * run);
      bool second = i - pair >= run;
      uint other = min(pair + (second ? 0u : run), end);
      uint piece = from.at[i];
      to.at[i - (second ? run : 0u) + before(from, other, min(other + run, end), piece)] = piece;
    }
    between();
    UintArray swap = from;
    from = to;
    to = swap;
  }
  if (uint64_t(from) == uint64_t(push.sorted)) return;
  for (uint i = first + me; i < end; i += gl_WorkGroupSize.x) push.sorted.at[i] = from.at[i];
}
