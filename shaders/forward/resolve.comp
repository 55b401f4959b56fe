// Indirect light from the facets around the point follows in forward/indirect.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
#define IRAD_LIGHTS_BINDING 2
#include "forward/resolve.glsl"
