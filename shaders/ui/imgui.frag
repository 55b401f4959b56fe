// Colour times texture, in sRGB-encoded values like the window image itself; blending as Dear ImGui expects it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/ui.h"

layout(push_constant, scalar) uniform Push { UiDraw draw; };
layout(set = 0, binding = 0) uniform sampler2D texture0;  // font atlas
layout(set = 0, binding = 1) uniform sampler2D texture1;
layout(set = 0, binding = 2) uniform sampler2D texture2;
layout(set = 0, binding = 3) uniform sampler2D texture3;
layout(location = 0) in vec2 uv;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 result;

void main() {
  // A draw has one texture, so the branch is uniform; no descriptor indexing (METHOD's floor: no bindless).
  vec4 texel;
  if (draw.texture_ == 0u) {
    texel = textureLod(texture0, uv, 0.0);
  } else {
    // Pictures are opaque: their alpha channel is not for blending with the window.
    vec3 picture = draw.texture_ == 1u   ? textureLod(texture1, uv, 0.0).rgb
                   : draw.texture_ == 2u ? textureLod(texture2, uv, 0.0).rgb
                                         : textureLod(texture3, uv, 0.0).rgb;
    texel = vec4(picture, 1.0);
  }
  result = color * texel;
}
