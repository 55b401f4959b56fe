// Alpha-masked surfaces: texels below the cutoff leave no depth. Blended ones leave it where anything of them is there or,
// in shadow maps, in the share alpha of the texels. IRAD_PEEL: those behind what has been drawn before alone.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "forward/material.glsl"
#include "shared/glass.h"
#include "shared/passes.h"

layout(push_constant, scalar) uniform PushBlock { DepthPush push; };
#ifdef IRAD_PEEL
layout(set = 0, binding = 0) uniform sampler2D peeled;  ///< depth that the last layer has left
#endif

layout(location = 0) in vec4 uv;
layout(location = 1) in vec4 tint;
layout(location = 2) flat in uint corner;

void main() {
  uvDx = dFdx(uv);
  uvDy = dFdy(uv);
  GpuMaterial m = push.scene.at[0].materials.at[push.material];
#ifdef IRAD_PEEL
  bool before = gl_FragCoord.z >= texelFetch(peeled, ivec2(gl_FragCoord.xy), 0).x;
  if (before && (m.flags & MATERIAL_BLEND) != 0u) discard;
#endif
  uvec2 texel = uvec2(gl_FragCoord.xy);
  float threshold = push.screens != 0u ? texelThreshold(texel.x, texel.y, corner) : 0.0;
  uint channel = push.screens != 0u ? push.screens - 1u : PANE_WHOLE;
  if (materialCutOut(m, materialCover(m, uv, materialBaseColor(m, uv, tint), channel), threshold)) discard;
}
