// shapePiece() of every piece.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/piece_shape.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PieceShapePush push; };

void main() {
  uint piece = irad_index();
  if (piece < push.count) shapePiece(push, piece);
}
