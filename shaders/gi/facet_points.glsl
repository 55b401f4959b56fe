// The points that make up a facet.
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

#endif
