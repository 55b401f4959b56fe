// The points that make up a facet.
#ifndef IRAD_FACET_POINTS_H
#define IRAD_FACET_POINTS_H
#include "shared/facets.h"
#include "shared/surface.h"
IRAD_BEGIN

struct FacetPoints {
  uint first, end;  ///< points of the voxel
  uint own;         ///< the facet's class
};

IRAD_FN FacetPoints pointsOf(SurfaceArrays surface, UintArray firstPoint, uint facet, uint entry) {
  FacetPoints points = {firstPoint.at[surface.firstPiece.at[facet]],
                        firstPoint.at[surface.firstPiece.at[firstFacet(entry) + facetsOf(entry)]],
                        facet - firstFacet(entry)};
  return points;
}

IRAD_END
#endif
