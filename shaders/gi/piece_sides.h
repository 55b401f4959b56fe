// Which facet each side of a piece belongs to, and where facets are: of the first point of each class.
#ifndef IRAD_PIECE_SIDES_H
#define IRAD_PIECE_SIDES_H
#include "gi/piece_cuts.h"
#include "shared/grid.h"
IRAD_BEGIN

/// Facets at a point, as in SurfaceArrays::sides.
IRAD_FN uint facetOfPoint(UintArray classes, uint point) {
  uint class_ = classes.at[point];
  return class_ == NO_CLASS ? PIECE_UNKNOWN : class_ & ~CLASS_LEADER;
}

IRAD_FN void findSides(PieceSidesPush push, SurfaceArrays surface, uint piece) {
  uint voxel = push.pieceVoxel.at[piece];
  uint packedVoxel = push.solid.at[voxel];
  uint base = push.facetStart.at[voxel];
  uint end = push.facetStart.at[voxel + 1u];
  uint first = push.firstPoint.at[piece], points = push.firstPoint.at[piece + 1u] - first;
  uint sides = surface.sides.at[piece];
  uint perSide = (sides & PIECE_CUT) != 0u ? CUT_POINTS : 1u;
  bool back = points > perSide;
  if (perSide == 1u) {
    surface.sides.at[piece] =
        facetOfPoint(push.classes, first) | (back ? facetOfPoint(push.classes, first + 1u) : PIECE_BLACK) << 8;
  } else {
    PieceCuts cuts = cutsOf(surface.cuts, sides);
    for (uint s = first; s < first + points; ++s) {
      uint class_ = push.classes.at[s];
      if (!isOfPart(class_)) continue;
      uint k = class_ & 31u;
      push.classes.at[s] =
          k < CUT_POINTS ? push.classes.at[s - (s - first) % CUT_POINTS + k] & ~CLASS_LEADER : NO_CLASS;
    }
    for (uint i = cuts.parts; i < cuts.endParts; ++i) {
      uint part = surface.cuts.at[i], point = first + (part & 0xFFFFu);
      surface.cuts.at[i] = (part & 0xFFFF0000u) | facetOfPoint(push.classes, point) |
                           (back ? facetOfPoint(push.classes, point + CUT_POINTS) : PIECE_BLACK) << 8;
    }
  }
  // A side's area is that of its points which have a facet; where a mask leaves nothing there is none.
  bool mask = perSide > 1u && (surface.cuts.at[sides & ~PIECE_CUT] & CUT_MASKED) != 0u;
  float there = 1.0f;
  if (mask && (surface.cuts.at[sides & ~PIECE_CUT] & CUT_SCREEN) != 0u) {
    uint place = (sides & ~PIECE_CUT) + 1u;
    there = float(bitCount(surface.cuts.at[place]) + bitCount(surface.cuts.at[place + 1u])) /
            float(MASK_EDGE * MASK_EDGE);
    mask = false;
  }
  for (uint s = first; s < first + points; s += perSide) {
    uint counted = 0u;
    for (uint k = s; k < s + perSide; ++k) counted += push.classes.at[k] != NO_CLASS ? 1u : 0u;
    float share = there * push.pieceArea.at[piece] / float(mask ? CUT_POINTS : max(counted, 1u));
    for (uint k = s; k < s + perSide; ++k) push.pointArea.at[k] = push.classes.at[k] != NO_CLASS ? share : 0.0f;
  }
  for (uint i = first; i < first + points; ++i) {
    uint class_ = push.classes.at[i];
    if ((class_ & CLASS_LEADER) == 0u) continue;
    uint facet = base + (class_ & ~CLASS_LEADER);
    push.voxel.at[facet] = packedVoxel;
    push.facetPiece.at[facet] = push.firstPiece.at[voxel];
    if (facet == base)
      push.reverse.at[voxelIndex(unpackVoxel(packedVoxel), push.grid.at[0].dims)] = facetEntryOf(base, end - base);
  }
}

IRAD_END
#endif
