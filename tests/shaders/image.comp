// Storage image 0 receives twice the texels of mip level `lod` of image 1.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant) uniform Push { int lod; };
layout(set = 0, binding = 0, r32f) uniform image2D result;
layout(set = 0, binding = 1) uniform sampler2D source;
void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(result)))) return;
  imageStore(result, at, 2.0 * texelFetch(source, at, lod));
}
