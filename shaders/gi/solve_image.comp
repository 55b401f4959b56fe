#version 460
#extension GL_GOOGLE_include_directive : require
// "GI Solve": a vector of facets as the image that gi/solve_row_image.comp gathers from.
#include "shared/solve.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SolveImagePush p; };
layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D image;

void main() {
  uint i = irad_index();
  if (i < p.count) imageStore(image, solveTexel(i), p.vector.at[i]);
}
