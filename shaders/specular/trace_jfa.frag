// Through a jump-flood field, which is a volume.
#version 460
#extension GL_GOOGLE_include_directive : require
#define TRACE_JFA_TEXTURE fieldVolume
layout(set = 0, binding = 5) uniform sampler3D fieldVolume;
#include "specular/trace_pixel.glsl"
layout(location = 0) out vec4 outSpecular;

void main() { outSpecular = specularAt(ivec2(gl_FragCoord.xy)); }
