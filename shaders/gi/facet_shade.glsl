// Attributes of the facets (docs/method.md 1-2): normal, plane offset, albedo = base colour x (1 - metallic) clamped to
// [0, .98], emitted exitance. One dispatch per textured material, whose set 1 is bound, and one for all facets that
// sample no texture.
#include "shared/energy.h"
#include "shared/normals.h"
#include "thesis/oct8_literal.h"
#include "gi/voxel_triangle.glsl"
#include "gi/voxel_material.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ShadeFacetsPush push; };

/// From the including shader: where in the cell the facet is sampled, relative to its lower corner.
vec3 sampledAt(VoxelTriangle t, uint triangle, vec3 cell);

bool finite(float x) { return abs(x) < 3.0e38; }

void main() {
  uint index = irad_index();
  if (index >= push.count) return;
  uint facet = push.order.at[push.first + index];
  uint triangle = push.triangle.at[facet];

  vec3 cell = vec3(unpackVoxel(push.voxel.at[facet]));
  VoxelTriangle t = loadTriangle(push.scene, push.grid, triangle);
  vec3 at = sampledAt(t, triangle, cell);
  MaterialTriangle m = materialTriangle(push.scene, triangle, areaOf(t));
  vec3 weight = barycentrics(t, at + cell);

  vec3 facing = normalize(t.normal);
  Vec3Array normals = push.scene.at[0].normals;
  vec3 normal =
      normals.at[m.vertex.x] * weight.x + normals.at[m.vertex.y] * weight.y + normals.at[m.vertex.z] * weight.z;
  float size = dot(normal, normal);
  normal = size > 1e-12 && finite(size) ? normal * inversesqrt(size) : facing;
  if (dot(normal, facing) < 0.0) normal = -normal;
  uint code = push.literal != 0u && push.encoding == NORMALS_OCT8 ? encodeOct8Literal(normal)
                                                                  : encodeNormal(normal, push.encoding);
  float offset = dot(at - vec3(0.5), decodeNormal(code, push.encoding));
  push.area.at[facet] = facetArea(decodeNormal(code, push.encoding), facetOffset(packFacetOffset(offset)));
  push.shape.at[facet] = code | packFacetOffset(offset);

  bool clamped;
  vec3 albedo = albedoAt(m, weight, clamped);
  if (clamped) atomicAdd(push.clamped.at[0], 1u);
  push.albedo.at[facet] = packAlbedo(albedo);

  if (push.hasEmission != 0u) push.emission.at[facet] = exitanceOf(emittedRadianceAt(m, weight));
}
