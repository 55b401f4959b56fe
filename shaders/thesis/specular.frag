#version 460
#extension GL_GOOGLE_include_directive : require
#include "thesis/specular_pixel.glsl"
layout(location = 0) out vec4 outSpecular;

void main() { outSpecular = specularAt(ivec2(gl_FragCoord.xy)); }
