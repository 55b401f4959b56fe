// Dear ImGui's triangles over the window image: pixels (y down) to clip space (y up, as Commands::viewport has it),
// vertices pulled by address.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/ui.h"

layout(push_constant, scalar) uniform Push { UiDraw draw; };
layout(location = 0) out vec2 uv;
layout(location = 1) out vec4 color;

void main() {
  UiVertex v = draw.vertices.at[draw.indices.at[gl_VertexIndex]];
  uv = v.uv;
  color = unpackUnorm4x8(v.color);
  gl_Position = vec4(v.position.x * draw.toClip.x - 1.0, 1.0 - v.position.y * draw.toClip.y, 0.0, 1.0);
}
