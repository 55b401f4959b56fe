// What the bumps of a normal map leave of an even sky on a piece (docs/method.md 9). After gi/voxel_material.glsl, in
// whose set 1 the map is.
#include "gi/piece_place.h"
#include "shared/normal_maps.h"
layout(set = 1, binding = 2) uniform sampler2D normalTexture;

/// A normal map on a triangle.
struct Bumps {
  TexturePlace place;
  float scale;
};

Bumps bumpsOf(SceneArray scenes, uint triangle, MaterialTriangle m) {
  uint material = scenes.at[0].triangleMaterials.at[triangle];
  return Bumps(texturePlace(scenes, m.vertex, material, 1.0, TEXTURE_NORMAL, ivec2(1)),
               scenes.at[0].materials.at[material].normalScale);
}

/// At one point. From the map's finest level: the mean of normals is flatter than they are.
float keptByBumps(Bumps bumps, vec3 weight) {
  vec3 s = textureLod(normalTexture, textureCoordinates(bumps.place, weight), 0.0).xyz;
  return keptOfEvenSky(tangentCosine(s, bumps.scale));
}

/// The mean over the points that putCutPoints() has left.
float keptByBumps(Bumps bumps, VoxelTriangle t, vec3 cell) {
  float sum = 0.0;
  for (uint k = 0u; k < CUT_POINTS; ++k) sum += keptByBumps(bumps, barycentrics(t, cell + cutPoint(k)));
  return sum / float(CUT_POINTS);
}
