// "RE Forward", fragment stage. Runs once per visible pixel, thanks to the depth prepass and the EQUAL test.
#version 460
#pragma optimize(on)
#extension GL_GOOGLE_include_directive : require
#include "forward/shade.glsl"

layout(location = 0) in vec3 local;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec4 uv;
layout(location = 4) in vec4 tint;
layout(location = 5) flat in vec3 faceNormal;
layout(location = 6) in vec3 towardsEye;
layout(location = 7) flat in uint triangle;

layout(location = 0) out vec4 outNormal;
layout(location = 1) out vec4 outGeometric;
layout(location = 2) out vec4 outAlbedo;
layout(location = 3) out vec4 outF0;
layout(location = 4) out vec4 outDirect;
layout(location = 5) out vec4 outHighlight;
layout(location = 6) out vec4 outIndirect;
#ifndef IRAD_VOLUME
layout(location = 7) out vec4 outLookup;
#endif

void main() {
  uvDx = dFdx(uv);
  uvDy = dFdy(uv);
  Shaded o = shade(Interpolants(local, normal, tangent, uv, tint, faceNormal, towardsEye, triangle));
  outNormal = o.normal;
  outGeometric = o.geometric;
  outAlbedo = o.albedo;
  if (F0) outF0 = o.f0;
  outDirect = o.direct;
  if (HIGHLIGHTS || EMISSION) outHighlight = o.highlight;
  if (!INDIRECT) return;
  outIndirect = o.indirect;
#ifndef IRAD_VOLUME
  outLookup = o.lookup;
#endif
}
