// Whether the solid voxels cover the surface that is seen: per pixel the distance in voxels from the surface's point to
// the nearest solid voxel's cube (the largest of the three axes' gaps). 0: covered. The rule of pixel centres (T 5.1.2)
// leaves gaps of less than half a voxel along slopes; where the gap is larger rays pass through: a pin-hole.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/view.h"
#include "view/camera_ray.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D depthTarget;
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D linearTarget;
layout(push_constant, scalar) uniform PushBlock { PinHolePush push; };

const int REACH = 2;  ///< voxels; larger gaps read as this

void main() {
  GpuCamera camera = push.camera.at[0];
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(pixel, camera.size))) return;
  float depth = texelFetch(depthTarget, ivec2(pixel), 0).r;
  if (!(depth > 0.0)) {
    imageStore(linearTarget, ivec2(pixel), vec4(0.0));
    return;
  }
  Grid grid = push.grid;
  vec3 p = (unproject(camera, pixel, depth) - grid.origin) * grid.inverseEdge;
  float nearest = float(REACH);
  for (int z = -REACH; z <= REACH; ++z)
    for (int y = -REACH; y <= REACH; ++y)
      for (int x = -REACH; x <= REACH; ++x) {
        vec3 cell = floor(p) + vec3(x, y, z);
        if (any(lessThan(cell, vec3(0.0))) || any(greaterThanEqual(cell, vec3(grid.dims)))) continue;
        if (push.reverse.at[voxelIndex(uvec3(cell), grid.dims)] == NO_FACET) continue;
        vec3 gap = max(cell - p, p - cell - 1.0);
        nearest = min(nearest, max(0.0, max(gap.x, max(gap.y, gap.z))));
      }
  imageStore(linearTarget, ivec2(pixel), vec4(vec3(nearest), 1.0));
}
