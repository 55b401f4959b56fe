// Alpha-masked surfaces: texels below the cutoff leave no depth.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "forward/material.glsl"
#include "shared/passes.h"

layout(push_constant, scalar) uniform PushBlock { DepthPush push; };

layout(location = 0) in vec4 uv;
layout(location = 1) in float alpha;

void main() {
  uvDx = dFdx(uv);
  uvDy = dFdy(uv);
  GpuMaterial m = push.scene.at[0].materials.at[push.material];
  if (materialCutOut(m, materialBaseColor(m, uv, vec4(1.0, 1.0, 1.0, alpha)).a)) discard;
}
