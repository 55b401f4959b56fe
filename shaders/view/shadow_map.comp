// One light's shadow map, whole, in the middle of the picture: the distance from the light at which each texel's first
// surface lies, along the map's axis (a distant light's from where its map begins). A cube's faces lie +X -X +Y over -Y +Z -Z.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/view.h"
#include "forward/cube_direction.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2DArray flatMaps;
layout(set = 0, binding = 1) uniform samplerCubeArray cubeMaps;
layout(set = 0, binding = 2, rgba32f) uniform writeonly image2D linearTarget;
layout(push_constant, scalar) uniform PushBlock { ShadowViewPush push; };

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(pixel, push.size))) return;
  GpuLight light = push.lights.at[push.light];
  bool cube = lightUsesCube(light.type, light.outerCos);
  vec2 faces = cube ? vec2(3.0, 2.0) : vec2(1.0);
  vec2 size = vec2(push.size);
  float face = min(size.x / faces.x, size.y / faces.y);  // side in pixels
  vec2 at = (vec2(pixel) + 0.5 - 0.5 * size) / face + 0.5 * faces;
  float depth = 0.0;
  if (light.shadowLayer >= 0 && all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, faces))) {
    vec2 cell = floor(at);
    if (cube)
      depth = textureLod(cubeMaps, vec4(cubeDirection(uint(cell.x + 3.0 * cell.y), 2.0 * (at - cell) - 1.0),
                                        float(light.shadowLayer)), 0.0).r;
    else
      depth = textureLod(flatMaps, vec3(at, float(light.shadowLayer)), 0.0).r;
  }
  // Depths are reversed (forward/shadow.glsl); 0 is where the light meets nothing.
  float distance = lightHas(light.type, LIGHT_DISTANT) ? mix(light.shadowFar, light.shadowNear, depth)
                                                       : light.shadowNear / depth;
  imageStore(linearTarget, ivec2(pixel), depth > 0.0 ? vec4(vec3(distance), 1.0) : vec4(0.0));
}
