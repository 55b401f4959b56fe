#version 460
#extension GL_GOOGLE_include_directive : require
#include "specular/trace_picture.glsl"
