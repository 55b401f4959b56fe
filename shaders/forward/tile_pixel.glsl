// The pixel of an invocation where workgroups of 64 take tiles of 8 x 8. Neighbours in a subgroup are neighbours in the
// picture: 4 x 2 pixels, of which 2 x 4 make a group.
#ifndef IRAD_FORWARD_TILE_PIXEL_GLSL
#define IRAD_FORWARD_TILE_PIXEL_GLSL

ivec2 tilePixel() {
  uint i = gl_LocalInvocationIndex;
  return ivec2(8u * gl_WorkGroupID.xy + uvec2((i & 3u) | ((i >> 1) & 4u), ((i >> 2) & 1u) | ((i >> 3) & 6u)));
}

#endif
