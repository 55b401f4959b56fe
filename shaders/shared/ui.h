// What the user-interface pass uploads: Dear ImGui's vertices as they are, and 32-bit indices, both pulled by address.
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

/// One draw of the pass: `texture_` picks one of the pass's images (uniform over the draw).
struct UiDraw {
  UiVertexArray vertices;
  UintArray indices;
  vec2 toClip;  ///< 2 / window size
  uint texture_;
};

/// Images that one pass can draw from. Slot 0 is the font atlas.
IRAD_CONST uint UI_TEXTURES = 4u;

IRAD_END
#endif
