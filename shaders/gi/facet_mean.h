// Attributes of a facet, weighted by the areas of the pieces that it is made of (docs/method.md 4).
#ifndef IRAD_FACET_MEAN_H
#define IRAD_FACET_MEAN_H
#include "gi/facet_points.h"
#include "gi/surface_point.h"
IRAD_BEGIN

IRAD_FN void meanFacet(FacetMeanPush push, SurfaceArrays surface, uint facet) {
  uvec3 voxel = unpackVoxel(push.voxel.at[facet]);
  uint entry = push.reverse.at[voxelIndex(voxel, push.dims)];

  // Normal and plane from the surfels, which stand for equal areas.
  vec3 normal = vec3(0.0f), middle = vec3(0.0f);
  FacetSurfels surfels = surfelsOf(surface, facet);
  for (uint k = 0u; k < FACET_SURFELS; ++k) {
    SurfelPoint s = surfelOf(surface, surfels, k);
    normal += s.facing;
    middle += s.position - vec3(voxel) - 0.5f;
  }
  normal = normalize(normal);
  uint code = encodeNormal(normal, push.encoding);
  float offset = dot(middle * (1.0f / float(FACET_SURFELS)), decodeNormal(code, push.encoding));
  push.shape.at[facet] = code | packFacetOffset(offset);

  // Running means: those of equal values are these values to the bit. (A quotient of equal numbers need not be 1.)
  vec3 albedo = vec3(0.0f), emission = vec3(0.0f);
  float weights = 0.0f;
  FacetPoints points = pointsOf(surface, push.firstPoint, facet, entry);
  for (uint i = points.first; i < points.end; ++i) {
    if ((push.classes.at[i] & ~CLASS_LEADER) != points.own) continue;
    PiecePoint p = push.points.at[i];
    float weight = push.pointArea.at[i];
    if (!(weight > 0.0f)) continue;
    uint piece = p.side & ~SURFEL_BACK;
    weights += weight;
    float share = weights > weight ? weight / weights : 1.0f;
    albedo += share * (push.pieceAlbedo.at[piece] - albedo);
    if (push.hasEmission != 0u) emission += share * (push.pieceEmission.at[piece] - emission);
  }
  push.albedo.at[facet] = packAlbedo(albedo);
  if (push.hasEmission != 0u) push.emission.at[facet] = emission;
}

IRAD_END
#endif
