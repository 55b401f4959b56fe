// "RE Emitters", step 2: irradiance of a visible point from the emissive triangles, by Lambert's formula, times the
// share of it that is seen, averaged over the pixels around on the same surface. It takes the place of F M of the
// facets around, which know of a lamp's rim and of the distance to it no better than to a voxel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/pixel_emitters.glsl"

layout(set = 0, binding = 3, rgba16f) uniform readonly image2D seenTarget;
layout(set = 0, binding = 4, rgba32f) uniform image2D indirectTarget;
layout(set = 0, binding = 5, rgba32f) uniform image2D emittedTarget;

const int RADIUS = 2;             ///< pixels
const float SAME_SURFACE = 0.25;  ///< voxels that a point around may lie off the plane

void main() {
  ivec2 pixel = tilePixel();
  if (!inPicture(pixel)) return;
  vec4 position = imageLoad(positionTarget, pixel);
  vec4 emitted = imageLoad(emittedTarget, pixel);
  float share = shareOfPixel(emitted);
  if (position.w == 0.0 || share == 0.0) return;
  vec3 p = inVoxels(position.xyz);
  vec3 n = normalize(imageLoad(normalTarget, pixel).xyz);
  vec3 light = vec3(0.0);
  for (uint i = 0u; i < push.count; ++i) {
    EmissiveTriangle t = push.triangles.at[i];
    light += formFactor(t, p, n) * t.exitance;
  }

  if (light != vec3(0.0)) {
    vec3 face = imageLoad(geometricTarget, pixel).xyz;
    vec4 seen = vec4(0.0);
    for (int y = -RADIUS; y <= RADIUS; ++y) {
      for (int x = -RADIUS; x <= RADIUS; ++x) {
        ivec2 at = pixel + ivec2(x, y);
        if (!inPicture(at)) continue;
        float facing = max(dot(face, imageLoad(geometricTarget, at).xyz), 0.0);
        facing *= facing;
        float plane = abs(dot(face, inVoxels(imageLoad(positionTarget, at).xyz) - p));
        vec4 found = imageLoad(seenTarget, at);
        seen += facing * facing * clamp(2.0 - plane / SAME_SURFACE, 0.0, 1.0) * found.w * vec4(found.rgb, 1.0);
      }
    }
    if (seen.w == 0.0) return;  // no ray was asked: the facets' value is kept
    light *= seen.rgb / seen.w;
  }
  vec4 indirect = imageLoad(indirectTarget, pixel);
  light = mix(emitted.rgb, light, share);
  imageStore(indirectTarget, pixel, indirect + vec4(push.gain * (light - emitted.rgb), 0.0));
  imageStore(emittedTarget, pixel, vec4(light, 1.0));
}
