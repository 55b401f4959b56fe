// What the bumps of a normal map leave of an even sky on a piece (docs/method.md 9). After gi/voxel_material.glsl, in
// whose set 1 the map is.
#include "gi/piece_place.h"
#include "shared/normal_maps.h"
layout(set = 1, binding = 2) uniform sampler2D normalTexture;

bool hasBumps(SceneArray scenes, uint triangle) {
  return SAMPLES_TEXTURES != 0u && (triangleFlags(scenes, triangle) & MATERIAL_NORMAL_TEXTURE) != 0u;
}

/// At one point. From the map's finest level: the mean of normals is flatter than they are.
float keptByBumps(SceneArray scenes, MaterialPoint p) {
  vec3 s = textureLod(normalTexture, textureCoordinates(scenes, p, TEXTURE_NORMAL, ivec2(1)).xy, 0.0).xyz;
  return keptOfEvenSky(tangentCosine(s, scenes.at[0].materials.at[p.material].normalScale));
}

/// The mean over the polygon that clipPolygon has left.
float keptByBumps(SceneArray scenes, VoxelTriangle t, uint triangle, uint piece, vec3 cell, uint from, uint n,
                  float area) {
  float sum = 0.0;
  for (uint k = 0u; k < CUT_POINTS; ++k) {
    vec3 at = polygonPoint(from, n, area, cutPlace(piece, k, 0u));
    sum += keptByBumps(scenes, materialPoint(scenes, t, triangle, at + cell));
  }
  return sum / float(CUT_POINTS);
}
