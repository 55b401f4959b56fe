// The window's camera: flies with WASD + QE, looks with the mouse, turns about a point, frames a sphere; the projection
// is that of the scene's camera it began as, until a field of view is set.
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
  /// The same, about a point (world) that stays where it is in the picture.
  void orbit(float pixelsX, float pixelsY, const glm::dvec3& about);
  /// Goes to where a sphere (world, radius > 0) fills a picture of this shape (width by height), looking the same way.
  void frame(const glm::dvec3& centre, double radius, float aspect);
  /// Of where it looks, degrees: yaw about world Y, 0 along -Z and positive to the left; pitch, positive upwards.
  float yaw() const;
  float pitch() const;
  void setAngles(float yaw, float pitch);  ///< degrees; short of straight up and down
  void setPosition(const glm::dvec3& position) { camera_.position = position; }
  /// The vertical angle, degrees, of a perspective camera; half the picture's height, scene units, of an orthographic
  /// one.
  float view() const;
  void setView(float value);
  /// Right, up (world), forward: seconds of movement along each at `gain` times the speed.
  void move(const glm::vec3& seconds, float gain);
  /// Wheel notches: each changes the speed by a fifth.
  void changeSpeed(float notches);
  float unitsPerSecond() const { return speed_ * diagonal_; }

 private:
  void turn();
  Camera camera_;
  float yaw_ = 0, pitch_ = 0;  ///< radians; yaw 0 looks along -Z
  float diagonal_ = 1;
  float speed_ = 0.15f;  ///< scene diagonals per second
};

}  // namespace irad
