// Faces of a cube map.
#ifndef IRAD_CUBE_DIRECTION_GLSL
#define IRAD_CUBE_DIRECTION_GLSL

/// The direction that a face's texel stands for; `at` is -1..1, y down (Vulkan's cube faces).
vec3 cubeDirection(uint face, vec2 at) {
  switch (face) {
    case 0u: return vec3(1.0, -at.y, -at.x);
    case 1u: return vec3(-1.0, -at.y, at.x);
    case 2u: return vec3(at.x, 1.0, at.y);
    case 3u: return vec3(at.x, -1.0, -at.y);
    case 4u: return vec3(at.x, -at.y, 1.0);
  }
  return vec3(-at.x, -at.y, -1.0);
}

#endif
