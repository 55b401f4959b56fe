// Colour times texture, in sRGB-encoded values like the window image itself; blending as Dear ImGui expects it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/ui.h"

layout(push_constant, scalar) uniform Push { UiDraw draw; };
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) in vec2 uv;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 result;

void main() {
  vec4 texel = textureLod(image, uv, 0.0);
  result = color * vec4(texel.rgb, max(texel.a, draw.opaque_));
}
