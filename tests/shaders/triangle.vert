#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/types.h"
layout(push_constant, scalar) uniform Push {
  Vec4Array vertices;
};
void main() { gl_Position = vertices.at[gl_VertexIndex]; }
