// The window's camera: flies with WASD + QE, looks with the mouse, keeps the projection of the scene's camera it began
// as.
#pragma once

#include "renderer/scene/scene.h"

namespace irad {

class FlyCamera {
 public:
  /// Starts at `camera`; `sceneDiagonal` (scene units) sets the base speed.
  void start(const Camera& camera, float sceneDiagonal);
  const Camera& camera() const { return camera_; }

  /// Mouse movement in pixels: yaw about world Y, pitch about the camera's X, short of straight up and down.
  void look(float pixelsX, float pixelsY);
  /// Right, up (world), forward: seconds of movement along each at `gain` times the speed.
  void move(const glm::vec3& seconds, float gain);
  /// Wheel notches: each changes the speed by a fifth.
  void changeSpeed(float notches);
  float unitsPerSecond() const { return speed_ * diagonal_; }

 private:
  Camera camera_;
  float yaw_ = 0, pitch_ = 0;  ///< radians; yaw 0 looks along -Z
  float diagonal_ = 1;
  float speed_ = 0.15f;  ///< scene diagonals per second
};

}  // namespace irad
