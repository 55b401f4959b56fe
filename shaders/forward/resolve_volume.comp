// Indirect light from the thesis's volume (sample.gated off).
#version 460
#extension GL_GOOGLE_include_directive : require
#define IRAD_VOLUME
layout(set = 0, binding = 2) uniform sampler3D indirectVolume;
#define IRAD_LIGHTS_BINDING 3
#include "forward/resolve.glsl"
