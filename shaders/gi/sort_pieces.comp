// Sorts the pieces of each solid voxel: one workgroup per voxel. Where there are many, the small ones come last.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/piece_size.h"
#include "gi/seen_in_voxel.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SortPiecesPush push; };

const uint SHORT_RUN = 16u;
shared uint ofSize[PIECE_SIZES];

/// Marks all but the largest pieces, of which at most MOST_LARGE are not.
void markSmall(vec3 cell, uint first, uint end) {
  uint me = gl_LocalInvocationID.x;
  for (uint i = me; i < PIECE_SIZES; i += gl_WorkGroupSize.x) ofSize[i] = 0u;
  barrier();
  for (uint i = first + me; i < end; i += gl_WorkGroupSize.x) atomicAdd(ofSize[pieceSize(push.corners, cell, push.pieces.at[i])], 1u);
  barrier();
  uint large = 0u, count = 0u;
  while (large < PIECE_SIZES && count + ofSize[large] <= MOST_LARGE) count += ofSize[large++];
  for (uint i = first + me; i < end; i += gl_WorkGroupSize.x)
    if (pieceSize(push.corners, cell, push.pieces.at[i]) >= large) push.pieces.at[i] |= PIECE_SMALL;
}

/// Makes invocations see what the others have written.
void between() {
  memoryBarrierBuffer();
  barrier();
}

/// How many of `count` ascending pieces are before `piece`.
uint before(UintArray pieces, uint first, uint count, uint piece) {
  return pieceFrom(pieces, first, first + count, piece) - first;
}

void main() {
  uint voxel = irad_workgroup();
  if (voxel >= push.count) return;
  uint me = gl_LocalInvocationID.x;
  uint first = push.firstPiece.at[voxel], end = push.firstPiece.at[voxel + 1u];
  uint count = end - first;
  for (uint i = first + me; i < end; i += gl_WorkGroupSize.x) push.pieceVoxel.at[i] = voxel;
  if (count > MOST_LARGE && count <= MOST_COUNTED) {
    markSmall(vec3(unpackVoxel(push.solid.at[voxel])), first, end);
    between();
  }
  // A piece's place in its run is how many of the run are before it.
  uint run = count <= MOST_COUNTED ? count : SHORT_RUN;
  uint all = count <= MOST_COUNTED ? 0u : PIECE_SMALL;
  for (uint i = first + me; i < end; i += gl_WorkGroupSize.x) {
    uint piece = push.pieces.at[i];
    uint start = first + (i - first) / run * run, place = start;
    for (uint j = start; j < min(start + run, end); ++j) place += push.pieces.at[j] < piece ? 1u : 0u;
    push.sorted.at[place] = piece | all;
  }
  // Pairs of runs become one: each piece goes behind those of the other run that are before it. Twice, back and forth.
  for (; run < count; run *= 4u) {
    for (uint step = 0u; step < 2u; ++step) {
      UintArray from = step == 0u ? push.sorted : push.pieces, to = step == 0u ? push.pieces : push.sorted;
      uint length_ = run << step;
      between();
      for (uint i = me; i < count; i += gl_WorkGroupSize.x) {
        uint pair = i / (2u * length_) * (2u * length_);
        bool second = i - pair >= length_;
        uint other = min(second ? pair : pair + length_, count);
        uint piece = from.at[first + i];
        uint others = before(from, first + other, min(length_, count - other), piece);
        to.at[first + i - (second ? length_ : 0u) + others] = piece;
      }
    }
  }
}
