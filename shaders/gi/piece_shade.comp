// Albedo = base colour x (1 - metallic) clamped to [0, .98] and emitted exitance of each piece, at its middle
// (docs/method.md 1-2); of an emission texture the mean over the piece, so that all of its light is there. The albedo is
// what the surface gives back of an even sky: the bumps of a normal map take their share of it (docs/method.md 9). One
// dispatch per textured material, whose set 1 is bound, and one for all pieces that sample no texture.
#version 460
#pragma optimize(on)
#extension GL_GOOGLE_include_directive : require
#include "gi/voxel_triangle.glsl"
#include "gi/voxel_material.glsl"
#include "gi/piece_cuts.h"
#include "gi/piece_bumps.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PieceShadePush push; };

/// The mean over the points that putCutPoints() has left.
vec3 meanEmission(MaterialTriangle m, VoxelTriangle t, vec3 cell) {
  vec3 sum = vec3(0.0);
  for (uint k = 0u; k < CUT_POINTS; ++k) sum += emittedRadianceAt(m, barycentrics(t, cell + cutPoint(k)));
  return sum / float(CUT_POINTS);
}

void main() {
  uint index = irad_index();
  if (index >= push.count) return;
  uint piece = push.order.at[push.first + index];
  SurfaceArrays surface = push.surface.at[0];
  uint triangle = triangleOf(surface.pieces, piece);
  VoxelTriangle t = loadTriangle(push.scene, push.grid, triangle);
  vec3 cell = vec3(unpackVoxel(push.solid.at[push.pieceVoxel.at[piece]]));
  uint from;
  vec3 a = t.v[0] - cell, b = t.v[1] - cell, c = t.v[2] - cell;
  uint n = clipPolygon(a, b, c, 0.0, from);
  vec3 centre = (a + b + c) * (1.0 / 3.0);
  float area = 0.0;
  if (n != 0u) area = polygonArea(from, n, centre);
  MaterialTriangle m = materialTriangle(push.scene, triangle, areaOf(t));
  vec3 weight = barycentrics(t, centre + cell);
  bool hasBumps = samples(m.flags, MATERIAL_NORMAL_TEXTURE);
  Bumps bumps;
  if (hasBumps) bumps = bumpsOf(push.scene, triangle, m);
  float kept = 1.0;
  bool clamped;
  vec3 albedo = albedoAt(m, weight, clamped);
  bool shines = push.hasEmission != 0u && samples(m.flags, MATERIAL_EMISSIVE_TEXTURE);
  vec3 emission = vec3(0.0);
  if (push.hasEmission != 0u) emission = emittedRadianceAt(m, weight);
  if (samples(m.flags, MATERIAL_ALPHA_MASK)) {
    // The mean of what the mask leaves, filtered over squares.
    MaterialTriangle fine = materialTriangle(push.scene, triangle, areaOf(t) * float(MASK_EDGE * MASK_EDGE));
    vec3 sum = vec3(0.0), emissionSum = vec3(0.0);
    float left = 0.0, keptSum = 0.0;
    uint mask = (surface.sides.at[piece] & ~PIECE_CUT) + 1u;
    uvec2 squares = uvec2(surface.cuts.at[mask], surface.cuts.at[mask + 1u]);
    for (uint bit = 0u; bit < MASK_EDGE * MASK_EDGE; ++bit) {
      if ((((bit < 32u ? squares.x : squares.y) >> (bit % 32u)) & 1u) == 0u) continue;
      vec3 at = barycentrics(t, cell + maskPoint(t.normal, a, bit));
      bool clampedHere;
      sum += albedoAt(fine, at, clampedHere);
      clamped = clamped || clampedHere;
      if (hasBumps) keptSum += keptByBumps(bumps, at);
      if (shines) emissionSum += emittedRadianceAt(fine, at);
      left += 1.0;
    }
    if (left > 0.0) albedo = sum / left;
    if (left > 0.0 && hasBumps) kept = keptSum / left;
    if (left > 0.0 && shines) emission = emissionSum / left;
  } else if (n != 0u && (hasBumps || shines)) {
    putCutPoints(piece, from, n, area);
    if (hasBumps) kept = keptByBumps(bumps, t, cell);
    if (shines) emission = meanEmission(m, t, cell);
  }
  if (hasBumps) albedo *= kept;
  if (clamped) atomicAdd(push.clamped.at[0], 1u);
  push.albedo.at[piece] = albedo;
  if (push.hasEmission != 0u) push.emission.at[piece] = exitanceOf(emission);
}
