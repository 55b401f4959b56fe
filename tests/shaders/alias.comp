// Writes bytes 1, 2, 3, 4 + x to an rgba8 image through its r32ui alias.
#version 460
layout(local_size_x = 8) in;
layout(set = 0, binding = 0, r32ui) uniform uimage2D words;
void main() {
  const uint x = gl_GlobalInvocationID.x;
  if (x >= imageSize(words).x) return;
  imageAtomicExchange(words, ivec2(x, 0), 0x04030201u + (x << 24));
}
