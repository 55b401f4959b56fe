// "RE Shadow" for variance shadow maps (Donnelly and Lauritzen 2006, "Variance Shadow Maps"): per texel its own depth, and
// the first two moments of distance over taps x taps texels around it. Distances are shares of the map's far plane, so
// that a scene's scale does not matter; where there is nothing it is 1.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/raster.h"
#ifdef IRAD_CUBE
#include "forward/cube_direction.glsl"
#endif

layout(local_size_x = 16, local_size_y = 16) in;
layout(push_constant, scalar) uniform PushBlock { ShadowMomentsPush push; };
#ifdef IRAD_CUBE
layout(set = 0, binding = 0) uniform samplerCubeArray depths;
layout(set = 0, binding = 1, rgba32f) uniform writeonly imageCubeArray moments;
#else
layout(set = 0, binding = 0) uniform sampler2DArray depths;
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2DArray moments;
#endif

/// Reversed depth; past a face's rim that of the next face.
float depthAt(vec2 texel, float size) {
  vec2 at = (texel + 0.5) / size;
#ifdef IRAD_CUBE
  return textureLod(depths, vec4(cubeDirection(uint(push.face), 2.0 * at - 1.0), float(push.layer)), 0.0).r;
#else
  return textureLod(depths, vec3(at, float(push.layer)), 0.0).r;
#endif
}

float distanceOf(float depth) {
  if (push.nearShare == 0.0) return 1.0 - depth;
  return depth > 0.0 ? min(push.nearShare / depth, 1.0) : 1.0;
}

void main() {
  ivec2 size = imageSize(moments).xy;
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, size))) return;
  int reach = int(push.taps / 2u);
  vec2 sum = vec2(0.0);
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) {
      float d = distanceOf(depthAt(vec2(texel + ivec2(x, y)), float(size.x)));
      sum += vec2(d, d * d);
    }
#ifdef IRAD_CUBE
  ivec3 place = ivec3(texel, 6 * push.layer + push.face);
#else
  ivec3 place = ivec3(texel, push.layer);
#endif
  imageStore(moments, place, vec4(depthAt(vec2(texel), float(size.x)), sum / float(push.taps * push.taps), 0.0));
}
