// Through a jump-flood field, which is a volume.
#version 460
#extension GL_GOOGLE_include_directive : require
#define TRACE_JFA_TEXTURE fieldVolume
layout(set = 0, binding = 6) uniform sampler3D fieldVolume;
#include "specular/trace_picture.glsl"
