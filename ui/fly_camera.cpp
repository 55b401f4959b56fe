#include "ui/fly_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace irad {

namespace {
constexpr float kRadiansPerPixel = 0.0035f;
constexpr float kSteepest = 1.55f;  ///< radians, just short of the poles
constexpr float kDegree = std::numbers::pi_v<float> / 180.0f;
}  // namespace

void FlyCamera::start(const Camera& camera, float sceneDiagonal) {
  camera_ = camera;
  diagonal_ = sceneDiagonal > 0 ? sceneDiagonal : 1.0f;
  const glm::vec3 forward = camera.orientation * glm::vec3(0, 0, -1);
  yaw_ = std::atan2(-forward.x, -forward.z);
  pitch_ = std::asin(std::clamp(forward.y, -1.0f, 1.0f));
}

void FlyCamera::turn() {
  pitch_ = std::clamp(pitch_, -kSteepest, kSteepest);
  camera_.orientation = glm::angleAxis(yaw_, glm::vec3(0, 1, 0)) * glm::angleAxis(pitch_, glm::vec3(1, 0, 0));
}

void FlyCamera::look(float pixelsX, float pixelsY) {
  yaw_ -= pixelsX * kRadiansPerPixel;
  pitch_ -= pixelsY * kRadiansPerPixel;
  turn();
}

void FlyCamera::orbit(float pixelsX, float pixelsY, const glm::dvec3& about) {
  // Where the point is seen from the camera stays; a camera that was rolled is upright from then on, as look() has it.
  const glm::dvec3 seen = glm::inverse(glm::dquat(camera_.orientation)) * (about - camera_.position);
  look(pixelsX, pixelsY);
  camera_.position = about - glm::dquat(camera_.orientation) * seen;
}

void FlyCamera::frame(const glm::dvec3& centre, double radius, float aspect) {
  constexpr double margin = 1.1;
  const double narrow = std::min(1.0, static_cast<double>(aspect));  // of the smaller side against the height
  double distance = margin * radius;
  if (camera_.orthographic) {
    camera_.ymag = static_cast<float>(margin * radius / narrow);
    distance += camera_.znear;
  } else {
    distance = margin * radius / std::sin(std::atan(narrow * std::tan(0.5 * static_cast<double>(camera_.yfov))));
  }
  camera_.position = centre - glm::dquat(camera_.orientation) * glm::dvec3(0, 0, -distance);
}

float FlyCamera::yaw() const {
  return std::remainder(yaw_, 2 * std::numbers::pi_v<float>) / kDegree;
}
float FlyCamera::pitch() const {
  return pitch_ / kDegree;
}
void FlyCamera::setAngles(float yaw, float pitch) {
  yaw_ = yaw * kDegree;
  pitch_ = pitch * kDegree;
  turn();
}
float FlyCamera::view() const {
  return camera_.orthographic ? camera_.ymag : camera_.yfov / kDegree;
}
void FlyCamera::setView(float value) {
  (camera_.orthographic ? camera_.ymag : camera_.yfov) = camera_.orthographic ? value : value * kDegree;
}

void FlyCamera::move(const glm::vec3& seconds, float gain) {
  const glm::vec3 direction = camera_.orientation * glm::vec3(seconds.x, 0, -seconds.z) + glm::vec3(0, seconds.y, 0);
  camera_.position += glm::dvec3(direction * (unitsPerSecond() * gain));
}

void FlyCamera::changeSpeed(float notches) {
  speed_ = std::clamp(speed_ * std::pow(1.2f, notches), 1e-4f, 10.0f);
}

}  // namespace irad
