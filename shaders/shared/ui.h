// What the user-interface passes get: Dear ImGui's vertices as they are, and 32-bit indices, both pulled by address.
#ifndef IRAD_SHARED_UI_H
#define IRAD_SHARED_UI_H
#include "shared/types.h"
IRAD_BEGIN

struct UiVertex {
  vec2 position;  ///< pixels of the window image
  vec2 uv;
  uint color;  ///< RGBA8, red lowest, sRGB-encoded
};
IRAD_ARRAY(UiVertexArray, UiVertex, 4)

struct UiDraw {
  UiVertexArray vertices;
  UintArray indices;
  vec2 toClip;    ///< 2 / window size
  float opaque_;  ///< 1: the texture's alpha is not for blending (pictures); 0: it is (the font atlas)
};

/// The outline of what has left its depth in an image.
struct OutlinePush {
  uvec2 size;    ///< pixels
  vec2 color_;   ///< sRGB-encoded: red and green
  float blue;    ///< and blue
  int reach;     ///< its width, pixels
};

IRAD_END
#endif
