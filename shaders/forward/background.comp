#version 460
#extension GL_GOOGLE_include_directive : require
// "RE Forward": the targets that are there are zero where the depth prepass left nothing. Clearing whole targets would
// go through the raster units, of which some devices have few.
#include "shared/constants.h"
#include "shared/passes.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = CONSTANT_TARGETS) const uint TARGETS = TARGETS_ALL;  ///< those that are there
layout(set = 0, binding = 0) uniform sampler2D depthTarget;
layout(set = 0, binding = 1, rgba16f) uniform writeonly image2D normalTarget;
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2D geometricTarget;
layout(set = 0, binding = 3, rgba16f) uniform writeonly image2D albedoTarget;
layout(set = 0, binding = 4, rgba16f) uniform writeonly image2D f0Target;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image2D directTarget;
layout(set = 0, binding = 6, rgba32f) uniform writeonly image2D highlightTarget;
layout(set = 0, binding = 7, rgba32f) uniform writeonly image2D indirectTarget;
layout(set = 0, binding = 8, rgba32f) uniform writeonly image2D emittedTarget;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, textureSize(depthTarget, 0)))) return;
  if (texelFetch(depthTarget, pixel, 0).r > 0.0) return;
  imageStore(normalTarget, pixel, vec4(0.0));
  imageStore(geometricTarget, pixel, vec4(0.0));
  imageStore(albedoTarget, pixel, vec4(0.0));
  if ((TARGETS & TARGET_F0) != 0u) imageStore(f0Target, pixel, vec4(0.0));
  imageStore(directTarget, pixel, vec4(0.0));
  if ((TARGETS & TARGET_HIGHLIGHT) != 0u) imageStore(highlightTarget, pixel, vec4(0.0));
  if ((TARGETS & TARGET_INDIRECT) != 0u) imageStore(indirectTarget, pixel, vec4(0.0));
  if ((TARGETS & TARGET_EMITTED) != 0u) imageStore(emittedTarget, pixel, vec4(0.0));
}
