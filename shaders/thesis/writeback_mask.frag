#version 460
#extension GL_GOOGLE_include_directive : require
#include "thesis/writeback_mask.glsl"

void main() { writeBack(push.camera.at[0], ivec2(gl_FragCoord.xy)); }
