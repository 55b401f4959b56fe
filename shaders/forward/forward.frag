// Indirect light from the facets around the point.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "forward/shade.glsl"
