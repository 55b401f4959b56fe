#include "ui/fly_camera.h"

#include <algorithm>
#include <cmath>

namespace irad {

namespace {
constexpr float kRadiansPerPixel = 0.0035f;
constexpr float kSteepest = 1.55f;  ///< radians, just short of the poles
}  // namespace

void FlyCamera::start(const Camera& camera, float sceneDiagonal) {
  camera_ = camera;
  diagonal_ = sceneDiagonal > 0 ? sceneDiagonal : 1.0f;
  const glm::vec3 forward = camera.orientation * glm::vec3(0, 0, -1);
  yaw_ = std::atan2(-forward.x, -forward.z);
  pitch_ = std::asin(std::clamp(forward.y, -1.0f, 1.0f));
}

void FlyCamera::look(float pixelsX, float pixelsY) {
  yaw_ -= pixelsX * kRadiansPerPixel;
  pitch_ = std::clamp(pitch_ - pixelsY * kRadiansPerPixel, -kSteepest, kSteepest);
  camera_.orientation = glm::angleAxis(yaw_, glm::vec3(0, 1, 0)) * glm::angleAxis(pitch_, glm::vec3(1, 0, 0));
}

void FlyCamera::move(const glm::vec3& seconds, float gain) {
  const glm::vec3 direction = camera_.orientation * glm::vec3(seconds.x, 0, -seconds.z) + glm::vec3(0, seconds.y, 0);
  camera_.position += glm::dvec3(direction * (unitsPerSecond() * gain));
}

void FlyCamera::changeSpeed(float notches) {
  speed_ = std::clamp(speed_ * std::pow(1.2f, notches), 1e-4f, 10.0f);
}

}  // namespace irad
