// The points that make up a facet, and how much area each stands for.
#ifndef IRAD_FACET_POINTS_GLSL
#define IRAD_FACET_POINTS_GLSL
#include "shared/facets.h"
#include "shared/surface.h"

struct FacetPoints {
  uint first, end;  ///< points of the voxel
  uint own;         ///< the facet's class
};

FacetPoints pointsOf(SurfaceArrays surface, UintArray firstPoint, uint facet, uint entry) {
  return FacetPoints(firstPoint.at[surface.firstPiece.at[facet]],
                     firstPoint.at[surface.firstPiece.at[firstFacet(entry) + facetsOf(entry)]],
                     facet - firstFacet(entry));
}

/// Voxel faces; of the points of a cut piece those that are at a cut stand for none.
float areaOfPoint(SurfaceArrays surface, FloatArray pieceArea, UintArray firstPoint, UintArray classes, uint point,
                  PiecePoint p) {
  uint piece = p.side & ~SURFEL_BACK;
  float area = pieceArea.at[piece];
  uint sides = surface.sides.at[piece];
  if ((sides & PIECE_CUT) == 0u) return area;
  uint side = firstPoint.at[piece] + ((p.side & SURFEL_BACK) != 0u ? CUT_POINTS : 0u);
  uint counted = 0u;
  for (uint k = 0u; k < CUT_POINTS; ++k) counted += classes.at[side + k] != NO_CLASS ? 1u : 0u;
  return area / float(max(counted, 1u));
}

#endif
