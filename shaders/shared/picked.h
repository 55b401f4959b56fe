// A list of the pixels that take a step which few of them need, so that kernels run on these alone: three words of
// dispatch arguments, the number of pixels, then each pixel, x | y << 16, in no particular order.
#ifndef IRAD_SHARED_PICKED_H
#define IRAD_SHARED_PICKED_H
#include "shared/types.h"
IRAD_BEGIN

IRAD_CONST uint PICKED_COUNT = 3u;
IRAD_CONST uint PICKED_FIRST = 4u;
IRAD_CONST uint PICKED_GROUP = 64u;  ///< pixels per workgroup

#ifndef __cplusplus
uint packPixel(ivec2 pixel) { return uint(pixel.x) | (uint(pixel.y) << 16); }

/// Puts a pixel on a list: for few. (specular/classify.comp, which lists many, adds a workgroup's at once.)
void pick(UintArray list, ivec2 pixel) {
  uint place = atomicAdd(list.at[PICKED_COUNT], 1u);
  atomicMax(list.at[0], place / PICKED_GROUP + 1u);
  list.at[PICKED_FIRST + place] = packPixel(pixel);
}

/// The pixel of an invocation of a dispatch over a list; false past its end.
bool pickedPixel(UintArray list, uint invocation, out ivec2 pixel) {
  pixel = ivec2(0);
  if (invocation >= list.at[PICKED_COUNT]) return false;
  uint packed_ = list.at[PICKED_FIRST + invocation];
  pixel = ivec2(packed_ & 0xFFFFu, packed_ >> 16);
  return true;
}
#endif

IRAD_END
#endif
