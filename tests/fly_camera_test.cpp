// The window's camera: turning about a point, framing a sphere, numbers there and back.
#include <gtest/gtest.h>

#if IRAD_UI

#include <cmath>
#include <numbers>

#include "ui/fly_camera.h"

namespace irad::test::fly_camera_suite {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

FlyCamera startedAt(Camera camera) {
  FlyCamera fly;
  fly.start(camera, 10);
  return fly;
}
/// A point in the camera's own axes.
glm::dvec3 seen(const FlyCamera& fly, const glm::dvec3& point) {
  const Camera& camera = fly.camera();
  return glm::inverse(glm::dquat(camera.orientation)) * (point - camera.position);
}

TEST(FlyCamera, TurnsAboutAPointThatStaysInThePicture) {
  FlyCamera fly = startedAt({.position = {1, 2, 8}});
  const glm::dvec3 about(0.5, 1, -2), before = seen(fly, about);
  for (int i = 0; i < 7; ++i) {
    fly.orbit(40, -25, about);
    EXPECT_LT(glm::distance(seen(fly, about), before), 1e-5);
  }
  EXPECT_GT(glm::distance(fly.camera().position, glm::dvec3(1, 2, 8)), 3);
  EXPECT_NEAR(glm::distance(fly.camera().position, about), glm::length(before), 1e-5);
}

TEST(FlyCamera, FramesASphereInTheSmallerSideLookingTheSameWay) {
  const glm::dvec3 centre(3, -1, 1e5);
  for (const float aspect : {0.5f, 1.0f, 1.7f}) {
    FlyCamera fly = startedAt({.yfov = 0.8f});
    fly.setAngles(130, -20);
    const glm::quat way = fly.camera().orientation;
    fly.frame(centre, 2, aspect);
    EXPECT_EQ(fly.camera().orientation, way);
    const glm::dvec3 at = seen(fly, centre);
    EXPECT_LT(std::hypot(at.x, at.y), 1e-4);
    // The sphere's outline, as a share of the half side that is smaller.
    const double outline = std::tan(std::asin(2 / -at.z)) / (std::tan(0.4) * std::min(aspect, 1.0f));
    EXPECT_GT(outline, 0.85) << aspect;
    EXPECT_LT(outline, 1.0) << aspect;
    FlyCamera flat = startedAt({.orthographic = true, .ymag = 5, .znear = 0.1f});
    flat.frame(centre, 2, aspect);
    EXPECT_NEAR(flat.camera().ymag * std::min(aspect, 1.0f), 2.2, 1e-5) << aspect;
    EXPECT_LT(seen(flat, centre).z, -2.1) << "the near plane cuts it";
  }
}

TEST(FlyCamera, GivesBackTheNumbersItIsSetTo) {
  FlyCamera fly = startedAt({});
  EXPECT_NEAR(fly.yaw(), 0, 1e-5);
  for (const float yaw : {-170.0f, -30.0f, 0.0f, 90.0f, 175.0f})
    for (const float pitch : {-80.0f, 0.0f, 45.0f}) {
      fly.setAngles(yaw, pitch);
      EXPECT_NEAR(fly.yaw(), yaw, 1e-3);
      EXPECT_NEAR(fly.pitch(), pitch, 1e-3);
      const glm::vec3 forward = fly.camera().orientation * glm::vec3(0, 0, -1);
      EXPECT_NEAR(forward.y, std::sin(pitch * kDegree), 1e-5);
      EXPECT_NEAR(forward.x, -std::sin(yaw * kDegree) * std::cos(pitch * kDegree), 1e-5);
      const FlyCamera again = startedAt(fly.camera());
      EXPECT_NEAR(again.yaw(), yaw, 1e-2);
      EXPECT_NEAR(again.pitch(), pitch, 1e-2);
    }
  fly.setAngles(0, 400);
  EXPECT_LT(fly.pitch(), 90) << "short of straight up";
  fly.setView(60);
  EXPECT_FLOAT_EQ(fly.camera().yfov, static_cast<float>(60 * kDegree));
  EXPECT_FLOAT_EQ(fly.view(), 60);
  FlyCamera flat = startedAt({.orthographic = true, .ymag = 5});
  flat.setView(3);
  EXPECT_EQ(flat.camera().ymag, 3);
}

}  // namespace
}  // namespace irad::test::fly_camera_suite

#else

TEST(FlyCamera, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_UI";
}

#endif
