// Attributes of each facet, weighted by the areas of the pieces that it is made of (docs/method.md 4).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/surface_point.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FacetMeanPush push; };

void main() {
  uint facet = irad_index();
  if (facet >= push.count) return;
  SurfaceArrays surface = push.surface.at[0];
  uvec3 voxel = unpackVoxel(push.voxel.at[facet]);
  uint entry = push.reverse.at[voxelIndex(voxel, push.dims)];
  uint own = facet - firstFacet(entry);
  float area = surface.area.at[facet];

  // Normal and plane from the surfels, which stand for equal areas.
  vec3 normal = vec3(0.0), middle = vec3(0.0);
  uint flags = 0u;
  for (uint k = 0u; k < FACET_SURFELS; ++k) {
    SurfelPoint s = surfelOf(surface, facet, k);
    normal += s.facing;
    middle += s.position - vec3(voxel) - 0.5;
    GpuScene scene = push.scene.at[0];
    flags |= scene.materials.at[scene.triangleMaterials.at[s.triangle]].flags;
  }
  normal = normalize(normal);
  uint code = encodeNormal(normal, push.encoding);
  float offset = dot(middle * (1.0 / float(FACET_SURFELS)), decodeNormal(code, push.encoding));
  push.shape.at[facet] =
      code | packFacetOffset(offset) | ((flags & MATERIAL_DOUBLE_SIDED) != 0u ? FACET_DOUBLE_SIDED : 0u);

  vec3 albedo = vec3(0.0), emission = vec3(0.0);
  float weights = 0.0;
  uint end = surface.firstPiece.at[firstFacet(entry) + facetsOf(entry)];
  for (uint i = surface.firstPiece.at[facet]; i < end; ++i) {
    uint sides = surface.sides.at[i];
    for (uint s = 0u; s < 2u; ++s) {
      uint of = s == 0u ? sides & 0xFFFFu : sides >> 16;
      float weight = of == own ? push.pieceArea.at[i] : 0.0;
      if (of == PIECE_SPLIT) {  // by how many of the facet's surfels lie there
        uint side = surface.pieces.at[i] | (s == 1u ? SURFEL_BACK : 0u);
        for (uint k = 0u; k < FACET_SURFELS; ++k)
          if (surface.surfels.at[FACET_SURFELS * facet + k].triangle == side) weight += area / float(FACET_SURFELS);
      }
      if (weight == 0.0) continue;
      weights += weight;
      albedo += weight * push.pieceAlbedo.at[i];
      if (push.hasEmission != 0u) emission += weight * push.pieceEmission.at[i];
    }
  }
  push.albedo.at[facet] = packAlbedo(weights > 0.0 ? albedo / weights : vec3(0.0));
  if (push.hasEmission != 0u) push.emission.at[facet] = weights > 0.0 ? emission / weights : vec3(0.0);
}
