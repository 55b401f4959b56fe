// Views of the voxels: a ray per pixel through the grid.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shared/constants.h"
#include "shared/debug_views.h"
#include "shared/view.h"
#include "view/camera_ray.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
// Constants, so that no view pays for what the others read, nor a shape for the loops of the others (a factor of 4 to
// 10 on Mesa's CPU driver).
layout(constant_id = CONSTANT_VIEW) const uint VIEW = 0u;
layout(constant_id = CONSTANT_VIEW_SHAPE) const uint SHAPE = 0u;
layout(constant_id = CONSTANT_VIEW_FROM) const uint FROM = FROM_FACETS;
layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D linearTarget;
layout(push_constant, scalar) uniform PushBlock { VoxelViewPush push; };

#include "view/voxel_shapes.glsl"

void main() {
  GpuCamera camera = push.camera.at[0];
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(pixel, camera.size))) return;

  ViewRay ray;
  cameraRay(camera, pixel, ray.origin, ray.direction);
  ray.origin = (ray.origin - push.grid.origin) * push.grid.inverseEdge;
  ray.direction = mix(ray.direction, vec3(1e-9), lessThan(abs(ray.direction), vec3(1e-9)));
  ray.orthographic = camera.orthographic != 0u;
  ray.pixel = 2.0 * length(camera.inverseViewProjection[1].xyz) / float(camera.size.y);
  if (ray.orthographic) ray.pixel *= push.grid.inverseEdge;

  FacetArrays facets = push.facets.at[0];
  vec4 drawn = vec4(0.0);
  switch (SHAPE) {
    case SHAPE_CUBES: drawn = drawCubes(facets, ray); break;
    case SHAPE_SLICE: {
      uvec2 middle = camera.size / 2u;
      drawn = drawSlice(facets, ray, unproject(camera, middle, 0.0) - unproject(camera, middle, 1.0));
      break;
    }
    case SHAPE_PROJECTION: drawn = drawProjection(facets, ray); break;
    case SHAPE_ISOSURFACE: drawn = drawIsosurface(facets, ray); break;
  }
  imageStore(linearTarget, ivec2(pixel), drawn);
}
