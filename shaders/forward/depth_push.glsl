// Push constants of the depth-only passes (shadow maps and depth prepass).
struct Projection {
  mat4 matrix;
};
IRAD_ARRAY(ProjectionArray, Projection, 16)
layout(push_constant, scalar) uniform Push {
  SceneArray scene;
  ProjectionArray projection;  ///< local position -> clip; a camera record starts with it
  uint material;
} push;
