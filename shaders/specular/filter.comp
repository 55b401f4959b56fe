// "RE Specular": one step of an edge-aware a-trous filter over the traced radiance (Dammertz et al. 2010): 3 x 3 taps
// STEP pixels apart, weighted by plane, normal and roughness, at the listed pixels. Normals may differ by as much as
// those of the lobe's microfacets do, and places be as far apart as the lobe is wide where it meets what is reflected:
// further off another reflection is seen. The last step (RESOLVE) multiplies by the lobe's reflectance and blends with
// the reflection of the diffuse irradiance near max_roughness.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "specular/surface.glsl"
#include "shared/constants.h"

layout(local_size_x = PICKED_GROUP) in;
layout(constant_id = CONSTANT_FILTER_STEP) const int STEP = 1;  ///< pixels between taps; 0: no filter
layout(constant_id = CONSTANT_FILTER_RESOLVE) const bool RESOLVE = true;
layout(constant_id = CONSTANT_LEAST_ROUGHNESS) const float LEAST_ROUGHNESS = 0.0;  ///< smoother surfaces are left alone
layout(set = 0, binding = 0) uniform sampler2D depthTarget;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D normalTarget;
layout(set = 0, binding = 2, rgba16f) uniform readonly image2D geometricTarget;
layout(set = 0, binding = 3, rgba16f) uniform readonly image2D f0Target;
layout(set = 0, binding = 4, rgba32f) uniform readonly image2D indirectTarget;
layout(set = 0, binding = 5, rgba32f) uniform readonly image2D from;  ///< w: 1 / distance, voxels; -1: not traced
layout(set = 0, binding = 6, rgba32f) uniform writeonly image2D to;

/// Normals are known to half floats.
const float LEAST_LOBE = 0.01;

float viewDepthAt(GpuCamera camera, ivec2 pixel) { return viewDepth(camera, texelFetch(depthTarget, pixel, 0).r); }

void main() {
  GpuCamera camera = push.camera.at[0];  // before any branch: read once for all lanes
  ivec2 pixel;
  if (!pickedPixel(push.glossy, gl_GlobalInvocationID.x, pixel)) return;
  vec4 centre = imageLoad(from, pixel);
  vec4 normal = imageLoad(normalTarget, pixel);
  vec3 axis = viewAxis(camera);
  vec4 result = centre;
  float depth = viewDepthAt(camera, pixel);
  if (STEP > 0 && normal.w > LEAST_ROUGHNESS) {
    vec3 position = pixelPosition(camera, pixel, depth, axis);
    vec3 face = imageLoad(geometricTarget, pixel).xyz;
    // Length of a pixel at this distance: what a tap may lie off the plane.
    float footprint = 2.0 * length(camera.inverseViewProjection[1].xyz) / float(camera.size.y) *
                      (camera.orthographic != 0u ? 1.0 : depth);
    float tolerance = 1.0 / (footprint * float(STEP));
    float alpha = max(normal.w * normal.w, LEAST_LOBE);
    float sharpness = 1.0 / (alpha * alpha);
    float narrowness = centre.w * push.inverseEdge;  // x alpha^-1: 1 / width of the lobe
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int i = 0; i < 9; ++i) {
      ivec2 offset = ivec2(i % 3, i / 3) - 1;
      ivec2 at = pixel + offset * STEP;
      if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(camera.size)))) continue;
      vec4 tap = imageLoad(from, at);
      if (tap.w < 0.0) continue;
      vec4 other = imageLoad(normalTarget, at);
      vec3 turned = other.xyz - normal.xyz;
      vec3 way = pixelPosition(camera, at, viewDepthAt(camera, at), axis) - position;
      float plane = abs(dot(face, way)) * tolerance;
      float weight = (offset.x == 0 ? 2.0 : 1.0) * (offset.y == 0 ? 2.0 : 1.0) *
                     exp2(-(dot(turned, turned) + dot(way, way) * narrowness * narrowness) * sharpness) *
                     clamp(2.0 - plane, 0.0, 1.0) *
                     clamp(1.0 - 8.0 * abs(other.w - normal.w), 0.0, 1.0);
      sum += weight * tap.rgb;
      total += weight;
    }
    result.rgb = total > 0.0 ? sum / total : centre.rgb;
  }
  if (RESOLVE) {
    vec3 view = towardsViewer(camera, pixelPosition(camera, pixel, depth, axis), axis);
    float nv = max(dot(normalize(normal.xyz), view), 1e-3);
    vec3 diffuse = imageLoad(indirectTarget, pixel).rgb * (1.0 / IRAD_PI);
    vec4 f0 = imageLoad(f0Target, pixel);
    vec3 radiance = mix(diffuse, result.rgb, tracedShare(f0, normal.w));
    result = vec4(radiance * environmentBrdf(f0.rgb, normal.w, nv), 1.0);
  }
  imageStore(to, pixel, result);
}
