// findSides() of every piece.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/piece_sides.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PieceSidesPush push; };

void main() {
  uint piece = irad_index();
  if (piece < push.count) findSides(push, push.surface.at[0], piece);
}
