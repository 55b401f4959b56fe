// Shadow maps: pictures of shadows against rays cast on the CPU, contacts, acne, layers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "shaders/shared/glass.h"
#include "tests/forward_support.h"

namespace irad::test::shadow_suite {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

class Shadow : public GpuTest {};

/// Slab test: does the segment from `p` towards the light meet the box?
bool blocked(glm::vec3 p, glm::vec3 towards, glm::vec3 lo, glm::vec3 hi) {
  float t0 = 1e-4f, t1 = 1;
  for (int a = 0; a < 3; ++a) {
    if (towards[a] == 0) {
      if (p[a] < lo[a] || p[a] > hi[a]) return false;
      continue;
    }
    const float u = (lo[a] - p[a]) / towards[a], v = (hi[a] - p[a]) / towards[a];
    t0 = std::max(t0, std::min(u, v));
    t1 = std::min(t1, std::max(u, v));
  }
  return t0 < t1;
}

constexpr glm::vec3 kLo(-0.6f, 0.4f, -0.5f), kHi(0.5f, 1.1f, 0.4f);

SceneBuilder occluderScene(float half = 3) {
  SceneBuilder b;
  b.addQuad({-half, 0, half}, {2 * half, 0, 0}, {0, 0, -2 * half});
  b.addBox(kLo, kHi);
  // From the far side of the light, low enough to see the floor around the box.
  b.addCamera({0, 6, 0}, {0, 0, 0}, 0.9f, {0, 0, -1});
  return b;
}

/// Compares the floor's pixels with cast rays: none may differ beyond a rim of `rim` metres around the shadow's edge.
void expectTruth(const Picture& lit, const Camera& camera, const std::function<glm::vec3(glm::vec3)>& towards,
                 float rim) {
  uint32_t compared = 0, dark = 0;
  for (uint32_t y = 0; y < lit.size.y; ++y)
    for (uint32_t x = 0; x < lit.size.x; ++x) {
      const float k = std::tan(camera.yfov / 2) * 2 / static_cast<float>(lit.size.y);
      const glm::vec3 eye(camera.position);
      const glm::vec3 ray((x + 0.5f - lit.size.x / 2.0f) * k, -1, (y + 0.5f - lit.size.y / 2.0f) * k);
      if (blocked(eye, ray * eye.y, kLo, kHi)) continue;  // sees the box, not the floor
      const glm::vec3 p = eye + ray * eye.y;
      int hits = 0;
      for (const float dx : {-rim, 0.0f, rim})
        for (const float dz : {-rim, 0.0f, rim}) {
          const glm::vec3 q = p + glm::vec3(dx, 0, dz);
          hits += blocked(q, towards(q), kLo, kHi) ? 1 : 0;
        }
      if (hits != 0 && hits != 9) continue;  // at the edge
      ++compared;
      dark += hits == 9 ? 1 : 0;
      const float value = lit.at(x, y).x;
      if (hits == 9) {
        ASSERT_EQ(value, 0) << x << " " << y;
      } else {
        ASSERT_GT(value, 0) << x << " " << y;
      }
    }
  EXPECT_GT(compared, lit.size.x * lit.size.y / 2);
  EXPECT_GT(dark, 50u);
}

TEST_F(Shadow, SunAgainstRays) {
  SceneBuilder b = occluderScene();
  const glm::vec3 d = glm::normalize(glm::vec3(0.7f, -1, 0.4f));
  b.addLight(LightType::Sun, 10).direction = d;
  Stage stage(context(), b.finish());
  expectTruth(
      stage.draw(VIEW_DIRECT, {160, 160}), stage.scene.cameras[0], [&](glm::vec3) { return -d * 100.0f; }, 0.02f);
}

// Texels are for what throws shadows: with the whole ground one would be a decimetre wide.
TEST_F(Shadow, FarGroundTakesNoTexelsFromWhatStandsOnIt) {
  for (const ShadowFilter filter : {ShadowFilter::pcf, ShadowFilter::hard, ShadowFilter::vsm}) {
    SceneBuilder b = occluderScene(100);
    const glm::vec3 d = glm::normalize(glm::vec3(0.7f, -1, 0.4f));
    b.addLight(LightType::Sun, 10).direction = d;
    Settings settings;
    settings.light.shadowFilter = filter;
    Stage stage(context(), b.finish(), settings);
    EXPECT_LT(stage.device.lightValues[0].shadowTexel, 0.003f);
    expectTruth(
        stage.draw(VIEW_DIRECT, {160, 160}), stage.scene.cameras[0], [&](glm::vec3) { return -d * 100.0f; }, 0.02f);
  }
}

// A second ground below may lie in the first one's shadow, and a map holds both.
TEST_F(Shadow, WhatTheGroundHidesStaysOnTheMap) {
  SceneBuilder b = occluderScene();
  b.addQuad({-20, -2, 20}, {40, 0, 0}, {0, 0, -40});
  b.addQuad({-20, -3, 20}, {40, 0, 0}, {0, 0, -40});
  b.addLight(LightType::Sun, 10).direction = {0, -1, 0};
  Stage stage(context(), b.finish());
  EXPECT_GT(stage.device.lightValues[0].shadowTexel, 40.0f / 2048);
}

TEST_F(Shadow, SpotAndPointAgainstRays) {
  for (const LightType type : {LightType::Spot, LightType::Point}) {
    SceneBuilder b = occluderScene();
    Light& light = b.addLight(type, 50);
    light.position = {1.6, 3, -1.1};
    light.direction = glm::normalize(glm::vec3(-1.6f, -3, 1.1f));
    light.outerCos = std::cos(1.21f);
    light.innerCos = std::cos(1.2f);
    const glm::vec3 at(light.position);
    // Two texels of the filter, stretched by the slant: the wide spot's texel is 1 cm there, the cube's 8 mm.
    const float rim = type == LightType::Spot ? 0.06f : 0.03f;
    Stage stage(context(), b.finish());
    expectTruth(
        stage.draw(VIEW_DIRECT, {160, 160}), stage.scene.cameras[0], [&](glm::vec3 p) { return at - p; }, rim);
  }
}

/// Of two panes one behind the other the light that passes is the product of what each lets through, and a filter of 4
/// x 4 texels knows what one pane does.
TEST(Screens, OfPanesAreIndependentAndEven) {
  constexpr uint32_t kTexels = 64, kPanes = 24;
  constexpr float kOne = 0.5f, kOther = 0.6f;
  double off = 0;
  int pairs = 0;
  for (uint32_t a = 0; a < kPanes; ++a)
    for (uint32_t b = 0; b < a; ++b, ++pairs) {
      int both = 0;
      for (uint32_t y = 0; y < kTexels; ++y)
        for (uint32_t x = 0; x < kTexels; ++x)
          both += texelThreshold(x, y, 3 * a) < kOne && texelThreshold(x, y, 3 * b) < kOther;
      off += std::abs(both / double{kTexels * kTexels} - double{kOne * kOther});
    }
  EXPECT_LT(off / pairs, 0.01);
  double square = 0;
  for (uint32_t a = 0; a < kPanes; ++a)
    for (uint32_t k = 0; k < 256; ++k) {
      constexpr std::array<double, 4> kWeights{0.5, 1, 1, 0.5};  // of texels, half-way between two
      double open = 0;
      for (uint32_t i = 0; i < 16; ++i)
        open += kWeights[i % 4] * kWeights[i / 4] * (texelThreshold(5 * k + i % 4, 3 * k + i / 4, 3 * a) < kOne);
      square += std::pow(open / 9 - double{kOne}, 2);
    }
  const double grain = std::sqrt(square / (256 * kPanes));
  fmt::print("two panes: {:.4f} off in the mean; one: grain {:.3f}\n", off / pairs, grain);
  EXPECT_LT(grain, 0.05);  // by chance it would be .14
}

TEST_F(Shadow, WideSpotUsesACube) {
  SceneBuilder b = occluderScene();
  Light& light = b.addLight(LightType::Spot, 50);
  light.position = {1.6, 3, -1.1};
  light.direction = {0, -1, 0};
  light.outerCos = std::cos(1.5f);
  light.innerCos = std::cos(1.4f);
  const glm::vec3 at(light.position);
  Stage stage(context(), b.finish());
  EXPECT_EQ(stage.shadows.cubes.desc.layers, 6u);
  expectTruth(
      stage.draw(VIEW_DIRECT, {160, 160}), stage.scene.cameras[0], [&](glm::vec3 p) { return at - p; }, 0.03f);
}

TEST_F(Shadow, NoAcneAtAnyAngle) {
  // A floor and far, lower ones that stretch the map: the sun from steep to grazing, all of the floor stays lit.
  for (const float degrees : {0.0f, 20.0f, 45.0f, 70.0f, 85.0f})
    for (const uint32_t pcf : {1u, 3u, 5u}) {
      SceneBuilder b;
      b.addQuad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
      b.addQuad({-20, -2, 20}, {40, 0, 0}, {0, 0, -40});
      b.addQuad({-20, -2.5f, 20}, {40, 0, 0}, {0, 0, -40});
      b.addCamera({0, 5, 0}, {0, 0, 0}, 0.9f, {0, 0, -1});
      const float a = glm::radians(degrees);
      b.addLight(LightType::Sun, kPi).direction = {std::sin(a) * 0.8f, -std::cos(a), std::sin(a) * 0.6f};
      Settings settings;
      settings.light.shadowResolution = 512;
      settings.camera.gpu.pcf = pcf;
      Stage stage(context(), b.finish(), settings);
      const Picture p = stage.draw(VIEW_DIRECT, {64, 64});
      // Relative to one step of the albedo target's fp16, which some devices round down.
      for (const glm::vec4& c : p.linear) ASSERT_NEAR(c.x / std::cos(a), 1, 1.0 / 1024) << degrees << " pcf " << pcf;
    }
}

TEST_F(Shadow, NoAcneUnderATiltedSpotOrAPoint) {
  // Straight below the light the floor faces it, but is slanted in the map of a spot that points aside.
  for (const LightType type : {LightType::Spot, LightType::Point}) {
    SceneBuilder b;
    b.addQuad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
    b.addCamera({0, 5, 0}, {0, 0, 0}, 0.9f, {0, 0, -1});
    Light& light = b.addLight(type, 9 * kPi);
    light.position = {0, 3, 0};
    light.direction = glm::normalize(glm::vec3(-0.5f, -1, -0.4f));
    light.outerCos = std::cos(1.2f);
    light.innerCos = std::cos(1.19f);
    Stage stage(context(), b.finish());
    const Picture p = stage.draw(VIEW_DIRECT, {101, 101});
    const float k = std::tan(0.45f) / 50.5f * 5;
    uint32_t compared = 0;
    for (uint32_t y = 0; y < 101; ++y)
      for (uint32_t x = 0; x < 101; ++x) {
        const glm::vec3 to((x - 50.0f) * k, -3, (y - 50.0f) * k);
        if (type == LightType::Spot && glm::dot(glm::normalize(to), light.direction) < light.innerCos) continue;
        ++compared;
        const float d2 = glm::dot(to, to);
        ASSERT_NEAR(p.at(x, y).x, 9 / d2 * 3 / std::sqrt(d2), 2e-3) << x << " " << y;
      }
    EXPECT_GT(compared, 5000u);
  }
}

TEST_F(Shadow, ContactStaysDark) {
  // A box on the floor, the sun at 45 degrees: the floor just behind it is dark up to the wall.
  SceneBuilder b;
  b.addQuad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  b.addBox({-1, 0, -1}, {0, 1, 1});
  b.addLight(LightType::Sun, kPi).direction = glm::normalize(glm::vec3(1, -1, 0));
  b.addCamera({0.5, 4, 0}, {0.5, 0, 0}, 0.5f, {0, 0, -1});
  Stage stage(context(), b.finish());
  const Picture p = stage.draw(VIEW_DIRECT, {201, 201});
  // The box's top ends at x = 0, seen at height 1; the shadow spans 0 < x < 1 on the floor.
  const float k = 100.5f / std::tan(0.25f);
  const auto column = [&](float x, float height) { return 100.5f + (x - 0.5f) / (4 - height) * k; };
  const auto first = static_cast<uint32_t>(column(0, 0) + 2), last = static_cast<uint32_t>(column(1, 0) - 3);
  for (uint32_t x = first; x <= last; ++x) ASSERT_EQ(p.at(x, 100).x, 0) << x;
  EXPECT_NEAR(p.at(static_cast<uint32_t>(column(1, 0) + 4), 100).x, std::sqrt(0.5f), 1e-3);
}

TEST_F(Shadow, LightsOfNoIntensityGetNoMap) {
  SceneBuilder b = occluderScene();
  b.addLight(LightType::Sun, 0);
  b.addLight(LightType::Sun, 1);
  b.addLight(LightType::Point, 1).position = {0, 3, 0};
  Stage stage(context(), b.finish());
  EXPECT_EQ(stage.device.lightValues[0].shadowLayer, -1);
  EXPECT_EQ(stage.device.lightValues[1].shadowLayer, 0);
  EXPECT_EQ(stage.device.lightValues[2].shadowLayer, 0);
  EXPECT_EQ(stage.shadows.flat.desc.layers, 1u);
  EXPECT_EQ(stage.shadows.cubes.desc.layers, 6u);
  EXPECT_EQ(stage.device.shining.size(), 2u);
}

TEST_F(Shadow, LightsThatDoNotShineGetNoMapAndNoDraw) {
  SceneBuilder b = occluderScene();
  b.addLight(LightType::Sun, 1);
  b.addLight(LightType::Point, 1).position = {0, 3, 0};
  const Scene scene = b.finish();
  SceneOnDevice device(context(), scene);
  const uint64_t used = context().device.memory().used();
  const auto drawn = [&](const LightFilter& shines) {
    const Counters before = context().counters();
    const ShadowMaps maps = drawShadows(context(), device, 64, {.shines = shines});
    EXPECT_EQ(static_cast<bool>(maps.flat), device.lightValues[0].shadowLayer >= 0);
    EXPECT_EQ(static_cast<bool>(maps.cubes), device.lightValues[1].shadowLayer >= 0);
    return context().counters().since(before);
  };
  // A flat map is one picture of the scene, a cube six.
  const uint64_t draws = drawn([](const GpuLight& l) { return l.type == LIGHT_SUN; }).draws;
  EXPECT_GT(draws, 0u);
  EXPECT_EQ(device.shining.size(), 1u);
  EXPECT_EQ(drawn([](const GpuLight& l) { return l.type == LIGHT_POINT; }).draws, 6 * draws);
  EXPECT_EQ(drawn(hasIntensity).draws, 7 * draws);
  // Nothing shines, so nothing is drawn or made. All lights are still there for the views, in their order.
  const Counters dark = drawn([](const GpuLight&) { return false; });
  EXPECT_EQ(dark.draws, 0u);
  EXPECT_EQ(dark.images, 0u);
  EXPECT_EQ(device.lightValues.size(), 2u);
  EXPECT_TRUE(device.shining.empty());
  context().device.waitIdle();
  EXPECT_LE(context().device.memory().used(), used);
}

}  // namespace
}  // namespace irad::test::shadow_suite
