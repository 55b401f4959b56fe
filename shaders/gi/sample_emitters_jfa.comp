#version 460
#extension GL_GOOGLE_include_directive : require
// The same samples through the jump-flood distance volume.
layout(set = 0, binding = 0) uniform sampler3D jfaDistance;
#define TRACE_JFA_TEXTURE jfaDistance
#include "gi/sample_emitters.glsl"
