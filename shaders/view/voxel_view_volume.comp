// The distance view of a jump-flood field, which is a volume.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference_uvec2 : require
#define IRAD_VOLUME
layout(set = 0, binding = 2) uniform sampler3D fieldVolume;
#include "view/voxel_view.glsl"
