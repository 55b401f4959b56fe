// Views composed from the targets of the forward pass (docs/method.md 1: radiance = albedo (D + H) / pi + ...).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "forward/camera_view.glsl"
#include "gi/sky.glsl"
#include "shared/constants.h"
#include "shared/passes.h"
#include "shared/view.h"
#include "shared/writeback.h"
#include "view/finish.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = CONSTANT_VIEW) const uint VIEW = 0u;  ///< a constant: no view pays for the others
layout(constant_id = CONSTANT_SKY) const bool SKY = false;
layout(constant_id = CONSTANT_TARGETS) const uint TARGETS = TARGETS_ALL;  ///< those that are there
layout(set = 0, binding = 0) uniform sampler2D depthTarget;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D normalTarget;
layout(set = 0, binding = 2, rgba16f) uniform readonly image2D geometricTarget;
layout(set = 0, binding = 3, rgba16f) uniform readonly image2D albedoTarget;
layout(set = 0, binding = 4, rgba32f) uniform readonly image2D directTarget;
layout(set = 0, binding = 5, rgba32f) uniform readonly image2D highlightTarget;
layout(set = 0, binding = 6, rgba32f) uniform readonly image2D indirectTarget;
layout(set = 0, binding = 7, rgba32f) uniform readonly image2D emittedTarget;
layout(set = 0, binding = 8, rgba32f) uniform readonly image2D specularTarget;
layout(set = 0, binding = 9, rgba32f) uniform writeonly image2D linearTarget;
layout(set = 0, binding = 10, rgba8) uniform writeonly image2D displayTarget;
layout(push_constant, scalar) uniform PushBlock { ViewPush push; };

/// A term of the picture; 0 where its target is absent.
#define IRAD_TERM(bit, target) ((TARGETS & bit) != 0u ? imageLoad(target, pixel).rgb : vec3(0.0))

/// What is behind the scene at a pixel.
vec3 skyBehind(GpuCamera camera, ivec2 pixel) {
  vec3 axis = viewAxis(camera);
  return skySeen(push.sky.at[0], -towardsViewer(camera, pixelPosition(camera, pixel, 1.0, axis), axis));
}

/// T Fig. 14: the fragments that the writeback's mask selects are red, the voxels' seams white.
vec3 maskAt(GpuCamera camera, ivec2 pixel, float depth) {
  vec3 axis = viewAxis(camera);
  float z = viewDepth(camera, depth);
  vec3 local = pixelPosition(camera, pixel, z, axis);
  vec3 v = (local - push.origin) * push.inverseEdge;
  vec3 face = normalize(imageLoad(geometricTarget, pixel).xyz);
  if (writebackSelects(length(camera.position - local), v, face, push.writeback)) return vec3(1.0, 0.0, 0.0);
  // A seam is as wide as a pixel, of the axes that the face crosses, where there are several pixels between two.
  float width = 2.0 * length(camera.inverseViewProjection[1].xyz) / float(camera.size.y) * push.inverseEdge *
                (camera.orthographic != 0u ? 1.0 : z);
  vec3 toSeam = abs(v - round(v));
  bvec3 seam = lessThan(toSeam, 0.5 * width * sqrt(max(1.0 - face * face, 0.0)));
  if (width < 0.25 && any(seam)) return vec3(1.0);
  return vec3(0.1 + 0.3 * max(dot(face, towardsViewer(camera, local, axis)), 0.0));
}

void main() {
  GpuCamera camera = push.camera.at[0];
  if (any(greaterThanEqual(gl_GlobalInvocationID.xy, camera.size))) return;
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  float depth = texelFetch(depthTarget, pixel, 0).r;
  bool drawn = depth > 0.0;
  vec4 albedo = imageLoad(albedoTarget, pixel);
  vec3 direct = imageLoad(directTarget, pixel).rgb;
  vec3 highlight = IRAD_TERM(TARGET_HIGHLIGHT, highlightTarget);
  vec3 indirect = IRAD_TERM(TARGET_INDIRECT, indirectTarget);

  vec3 value = vec3(0.0);
  switch (VIEW) {
    case VIEW_LIT:
      value = albedo.rgb * (direct + albedo.a * indirect) * (1.0 / IRAD_PI) + highlight +
              albedo.a * IRAD_TERM(TARGET_SPECULAR, specularTarget);
      break;
    case VIEW_NO_GI:
    case VIEW_DIRECT: value = albedo.rgb * direct * (1.0 / IRAD_PI) + highlight; break;
    case VIEW_INDIRECT: value = albedo.rgb * indirect * (albedo.a / IRAD_PI); break;
    case VIEW_SPECULAR: value = albedo.a * IRAD_TERM(TARGET_SPECULAR, specularTarget); break;
    case VIEW_ALBEDO: value = albedo.rgb; break;
    case VIEW_NORMAL: value = imageLoad(normalTarget, pixel).xyz; break;
    case VIEW_ROUGHNESS_METALLIC:
      value = vec3(imageLoad(normalTarget, pixel).w, metallicOf(imageLoad(geometricTarget, pixel).w), 0.0);
      break;
    case VIEW_DEPTH: {
      // Distance along the view direction.
      value = vec3(camera.orthographic != 0u
                       ? mix(camera.zfar, camera.znear, depth)
                       : camera.znear * camera.zfar / (camera.znear + depth * (camera.zfar - camera.znear)));
      if (!drawn) value = vec3(0.0);
      break;
    }
    case VIEW_DIRECT_IRRADIANCE: value = direct + IRAD_TERM(TARGET_EMITTED, emittedTarget); break;
    case VIEW_IRRADIANCE: value = indirect; break;
    case VIEW_EMITTER_IRRADIANCE: value = IRAD_TERM(TARGET_EMITTED, emittedTarget); break;
    case VIEW_WRITEBACK_MASK: value = drawn ? maskAt(camera, pixel, depth) : vec3(0.0); break;
    default: {
      // A view without a case here: magenta.
      imageStore(linearTarget, pixel, vec4(1.0, 0.0, 1.0, 1.0));
      imageStore(displayTarget, pixel, vec4(1.0, 0.0, 1.0, 1.0));
      return;
    }
  }
  if (SKY && !drawn && (VIEW == VIEW_LIT || VIEW == VIEW_NO_GI)) {
    value = skyBehind(camera, pixel);
    drawn = true;
  }
  imageStore(linearTarget, pixel, vec4(value, drawn ? 1.0 : 0.0));
  if (push.linearOnly != 0u) return;
  vec3 shown = displayColor(value, drawn, push.kind, push.exposure, push.toneCurve);
  imageStore(displayTarget, pixel, vec4(shown, 1.0));
}
