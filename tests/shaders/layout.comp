// A struct whose layout is known, for the reflection.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/types.h"
layout(local_size_x_id = 3, local_size_y = 2) in;
struct Inner {
  uint8_t small;
  uint16_t medium;
  float value;
};
layout(push_constant, scalar) uniform Push {
  vec3 direction;      // 0
  UintArray address;   // 16
  Inner inner[2];      // 24, stride 8
  mat3 matrix;         // 40, 36 bytes
  uint last;           // 76
};
void main() {
  if (gl_GlobalInvocationID.x == 0)
    address.at[0] = uint(direction.x + inner[1].value + matrix[2][2]) + last + uint(inner[0].small);
}
