#version 460
#extension GL_GOOGLE_include_directive : require
#include "specular/trace_pixel.glsl"
layout(location = 0) out vec4 outSpecular;

void main() {
  Reflection r = reflectionAt(ivec2(gl_FragCoord.xy));
  vec3 met = vec3(0.0);
  for (uint k = 0u; r.traces && k < push.params.rays; ++k) met += traceJittered(reflectedWorld(), r.surface, r.seed, k);
  outSpecular = specularOf(r, met);
}
