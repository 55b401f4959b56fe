// Surface shading: closed forms of direct light, the specular lobe's energy, materials, cameras.
#include <gtest/gtest.h>

#include <numbers>

#include "gi/check/pictures.h"
#include "shaders/shared/ggx.h"
#include "shaders/shared/passes.h"
#include "shaders/shared/sampling.h"
#include "tests/forward_support.h"

namespace irad::test::shading_suite {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

class Shading : public GpuTest {};

/// A 10 m floor facing up, albedo .5.
SceneBuilder floorScene() {
  SceneBuilder b;
  b.scene.materials[0].baseColor = {0.5f, 0.5f, 0.5f, 1};
  b.addQuad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
  b.addCamera({0, 3, 0}, {0, 0, 0}, 1.0f, {0, 0, -1});
  return b;
}

TEST_F(Shading, SunOnPlane) {
  // L = rho E cos(theta) / pi = .5 x 10 x cos 60 / pi.
  SceneBuilder b = floorScene();
  b.addLight(LightType::Sun, 10).direction = glm::normalize(glm::vec3(std::sqrt(3.0f), -1, 0));
  Stage stage(context(), b.finish());
  const Picture p = stage.draw(VIEW_LIT, {64, 64});
  for (const glm::vec4& c : p.linear) {
    EXPECT_NEAR(c.x, 0.5f * 10 * 0.5f / kPi, 1e-4f);
    EXPECT_EQ(c.w, 1);
  }
}

TEST_F(Shading, ManyLightsAddUp) {
  // As many suns as the uniform block holds, and one more, which are read by address: both sum up to one sun of 10 lux.
  Settings settings;
  settings.light.shadowResolution = 64;
  for (const uint32_t count : {UNIFORM_LIGHTS, UNIFORM_LIGHTS + 1}) {
    SceneBuilder b = floorScene();
    // Uneven shares, the last light being the strongest, so that a light that is read twice or left out shows.
    const float unit = 10.0f / (count * (count + 1) / 2);
    for (uint32_t i = 1; i <= count; ++i) b.addLight(LightType::Sun, i * unit).direction = {0, -1, 0};
    Stage stage(context(), b.finish(), settings);
    EXPECT_NEAR(stage.draw(VIEW_LIT, {16, 16}).at(8, 8).x, 0.5f * 10 / kPi, 1e-4f) << count;
  }
}

TEST_F(Shading, PointAndSpotBelowFollowTheInverseSquare) {
  // 50 cd at 2 m straight below: rho I / d^2 / pi; at 45 degrees cos^3 / sqrt(2)... = I cos^4 / h^2.
  for (const LightType type : {LightType::Point, LightType::Spot}) {
    SceneBuilder b = floorScene();
    Light& light = b.addLight(type, 50);
    light.position = {0, 2, 0};
    light.direction = {0, -1, 0};
    light.outerCos = std::cos(1.2f);
    light.innerCos = std::cos(1.1f);
    b.scene.cameras[0].position = {0, 3, 0};
    Stage stage(context(), b.finish());
    const Picture p = stage.draw(VIEW_LIT, {65, 65});
    EXPECT_NEAR(p.at(32, 32).x, 0.5f * 50 / 4 / kPi, 0.005f * 2);
    // A pixel to the right: where its ray meets the floor follows from the 1 radian field of view at height 3.
    const float x = 3 * std::tan(0.5f) * (52 - 32) / 32.5f;
    const float d2 = x * x + 4;
    EXPECT_NEAR(p.at(52, 32).x, 0.5f * 50 / d2 * (2 / std::sqrt(d2)) / kPi, 0.005f * 2);
  }
}

TEST_F(Shading, SpotRampIsSquared) {
  SceneBuilder b = floorScene();
  Light& light = b.addLight(LightType::Spot, 50);
  light.position = {0, 2, 0};
  light.direction = {0, -1, 0};
  light.innerCos = std::cos(0.1f);
  light.outerCos = std::cos(0.6f);
  Stage stage(context(), b.finish());
  const Picture p = stage.draw(VIEW_LIT, {65, 65});
  for (const int column : {32, 40, 44, 50, 58}) {
    const float x = 3 * std::tan(0.5f) * (column - 32) / 32.5f;
    const float d2 = x * x + 4, c = 2 / std::sqrt(d2);
    const float ramp = std::clamp((c - light.outerCos) / (light.innerCos - light.outerCos), 0.0f, 1.0f);
    EXPECT_NEAR(p.at(column, 32).x, 0.5f * 50 / d2 * c * ramp * ramp / kPi, 0.005f * 2) << column;
  }
}

TEST_F(Shading, RangeWindowEndsInZero) {
  SceneBuilder b = floorScene();
  Light& light = b.addLight(LightType::Point, 50);
  light.position = {0, 2, 0};
  light.range = 2.5f;
  Stage stage(context(), b.finish());
  const Picture p = stage.draw(VIEW_LIT, {65, 65});
  const float window = 1 - std::pow(2 / 2.5f, 4.0f);
  EXPECT_NEAR(p.at(32, 32).x, 0.5f * 50 / 4 * window / kPi, 0.005f);
  EXPECT_EQ(p.at(64, 32).x, 0);  // 1.61 m aside: 2.57 m away
}

TEST_F(Shading, ScaleByPowersOfTwoKeepsTheBits) {
  // Sizes, camera planes and 1 / sqrt(intensity) scale together; every picture must be the same.
  std::vector<glm::vec4> first;
  for (const int power : {0, -10, 13}) {
    const float s = std::ldexp(1.0f, power);
    SceneBuilder b = floorScene();
    b.addBox({-1, 0, -1}, {0.3f, 1, 0.2f});
    Light& spot = b.addLight(LightType::Spot, 50);
    spot.position = {1, 3, 1};
    spot.direction = glm::normalize(glm::vec3(-1, -3, -1));
    Light& point = b.addLight(LightType::Point, 20);
    point.position = {-2, 2, 1};
    b.addLight(LightType::Sun, 1).direction = glm::normalize(glm::vec3(1, -2, 0.5f));
    Stage stage(context(), scaled(b.finish(), s));
    const Picture p = stage.draw(VIEW_LIT, {96, 96});
    if (first.empty()) first = p.linear;
    EXPECT_TRUE(first == p.linear) << "x 2^" << power;
  }
}

TEST_F(Shading, RepeatIsBitEqual) {
  SceneBuilder b = floorScene();
  b.addBox({-1, 0, -1}, {0.3f, 1, 0.2f});
  b.addLight(LightType::Sun, 10).direction = glm::normalize(glm::vec3(1, -1, 0.3f));
  Stage stage(context(), b.finish());
  const Picture p = stage.draw(VIEW_LIT, {96, 96}), q = stage.draw(VIEW_LIT, {96, 96});
  EXPECT_TRUE(p.linear == q.linear);
  EXPECT_EQ(p.display, q.display);
}

TEST_F(Shading, CullsBackFacesUnlessDoubleSided) {
  for (const bool doubleSided : {false, true}) {
    SceneBuilder b;
    b.scene.materials[0].doubleSided = doubleSided;
    b.addQuad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10});  // faces up
    b.addCamera({0, -3, 0}, {0, 0, 0}, 1.0f, {0, 0, -1});
    b.addLight(LightType::Sun, kPi).direction = {0, 1, 0};  // from below
    Stage stage(context(), b.finish());
    const Picture p = stage.draw(VIEW_LIT, {32, 32});
    EXPECT_EQ(p.at(16, 16).w, doubleSided ? 1 : 0);
    EXPECT_NEAR(p.at(16, 16).x, doubleSided ? 1 : 0, 1e-4);  // the normal is turned towards the viewer
    if (doubleSided) {
      EXPECT_NEAR(stage.draw(VIEW_NORMAL, {32, 32}).at(16, 16).y, -1, 1e-3);
    }
  }
}

TEST_F(Shading, PictureIsUprightAndNotMirrored) {
  // Red to the right, green above, seen along -Z.
  SceneBuilder b;
  b.scene.materials[0].baseColor = {1, 0, 0, 1};
  b.addQuad({1, -0.5f, 0}, {1, 0, 0}, {0, 1, 0});
  b.newMaterial().baseColor = {0, 1, 0, 1};
  b.addQuad({-0.5f, 1, 0}, {1, 0, 0}, {0, 1, 0});
  b.addCamera({0, 0, 5}, {0, 0, 0}, 1.0f);
  Stage stage(context(), b.finish());
  const Picture p = stage.draw(VIEW_ALBEDO, {100, 100});
  // The quads' centres lie at 1.5 / (5 tan .5) = .549 of the half size.
  EXPECT_EQ(p.at(50 + 27, 50), glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(p.at(50, 50 - 27), glm::vec4(0, 1, 0, 1));
  EXPECT_EQ(p.at(50 - 27, 50).w, 0);
  EXPECT_EQ(p.at(50, 50 + 27).w, 0);
}

TEST_F(Shading, AlphaMaskCutsPictureAndShadow) {
  // A card half of whose texels are clear, above a floor, sun from above, seen from the side above.
  SceneBuilder b = floorScene();
  Material& m = b.newMaterial();
  m.alpha = AlphaMode::Mask;
  m.doubleSided = true;
  m.baseColor = {1, 0, 0, 1};
  m.baseColorTexture.image = 0;
  m.baseColorTexture.sampler.linearMag = m.baseColorTexture.sampler.linearMin = m.baseColorTexture.sampler.mips = false;
  b.scene.images.push_back({"half clear", 2, 1, true, {255, 255, 255, 255, 255, 255, 255, 0}});
  b.addQuad({-1, 1, 1}, {2, 0, 0}, {0, 0, -2});  // u along x: clear for x > 0
  b.addLight(LightType::Sun, 2 * kPi).direction = glm::normalize(glm::vec3(0, -1, 0));
  Stage stage(context(), b.finish());
  EXPECT_TRUE(stage.device.anyAlphaMask);
  const Picture p = stage.draw(VIEW_LIT, {65, 65});
  const float pixels = 32.5f / std::tan(0.5f);
  const auto column = [&](float x, float height) { return static_cast<uint32_t>(32.5f + x / (3 - height) * pixels); };
  EXPECT_NEAR(p.at(column(-0.5f, 1), 32).x, 2, 1e-3);  // the card, red
  EXPECT_EQ(p.at(column(-0.5f, 1), 32).y, 0);
  EXPECT_NEAR(p.at(column(0.5f, 0), 32).y, 1, 1e-3);  // through the clear half: lit floor
}

TEST_F(Shading, FurnaceOfTheLobeNeverGainsEnergy) {
  // White furnace: the mean of the visible-normal weights with F = 1 is the lobe's directional albedo, at most 1; for a
  // smooth surface it is 1. The fit that shading uses stays within 5 % of it.
  for (const float roughness : {0.1f, 0.3f, 0.5f, 0.8f, 1.0f})
    for (const float nv : {0.1f, 0.4f, 0.8f, 1.0f}) {
      const float alpha = roughness * roughness;
      const glm::vec3 v(std::sqrt(1 - nv * nv), 0, nv);
      double sum = 0;
      constexpr uint32_t kSamples = 20000;
      for (uint32_t k = 0; k < kSamples; ++k) {
        const glm::vec3 h = ggxVisibleNormal(v, alpha, hammersley(k, kSamples, {0, 0}));
        const glm::vec3 l = 2 * glm::dot(v, h) * h - v;
        if (l.z > 0) sum += ggxWeight(l.z, nv, alpha);
      }
      const double albedo = sum / kSamples;
      EXPECT_LE(albedo, 1 + 1e-5) << roughness << " " << nv;
      EXPECT_GT(albedo, roughness < 0.2f ? 0.97 : 0.3) << roughness << " " << nv;
      EXPECT_NEAR(environmentBrdf(glm::vec3(1), roughness, nv).x, albedo, 0.05) << roughness << " " << nv;
    }
}

TEST_F(Shading, LobeIntegratesAsItIsSampled) {
  // D V F under a uniform hemisphere of light, by quadrature, equals the sampled albedo.
  for (const float roughness : {0.4f, 0.7f})
    for (const float nv : {0.3f, 0.9f}) {
      const float alpha = roughness * roughness;
      const glm::vec3 v(std::sqrt(1 - nv * nv), 0, nv);
      double sampled = 0, quadrature = 0;
      constexpr uint32_t kSamples = 200000;
      for (uint32_t k = 0; k < kSamples; ++k) {
        const glm::vec2 u = hammersley(k, kSamples, {0, 0});
        const glm::vec3 h = ggxVisibleNormal(v, alpha, u);
        const glm::vec3 l = 2 * glm::dot(v, h) * h - v;
        if (l.z > 0) sampled += ggxWeight(l.z, nv, alpha);
        const glm::vec3 w = cosineDirection(u);
        const glm::vec3 half = glm::normalize(w + v);
        quadrature += kPi * ggxDistribution(half.x * half.x + half.y * half.y, alpha) * ggxVisibility(w.z, nv, alpha);
      }
      EXPECT_NEAR(sampled / quadrature, 1, 0.01) << roughness << " " << nv;
    }
}

TEST(Lobe, ANarrowOneIsNotInSteps) {
  // Half vectors within the narrowest lobe, rounded to floats as a shader has them, against the formula in doubles.
  const double alpha = GGX_LEAST_ALPHA, a2 = alpha * alpha;
  for (int i = 0; i < 2000; ++i) {
    const double angle = 3 * alpha * i / 2000;
    const glm::vec3 h(std::sin(angle), 0, std::cos(angle));
    const double sine = h.x, d = sine * sine * (1 - a2) + a2, exact = a2 / (kPi * d * d);
    EXPECT_NEAR(ggxDistribution(h.x * h.x + h.y * h.y, GGX_LEAST_ALPHA) / exact, 1, 1e-6) << angle;
  }
}

TEST_F(Shading, HighlightSitsWhereTheMirrorDirectionIs) {
  // A glossy dielectric floor, sun at 45 degrees: the highlight is brightest where the view mirrors it.
  SceneBuilder b = floorScene();
  Material& m = b.scene.materials[0];
  m.lambertian = false;
  m.roughness = 0.3f;
  m.baseColor = {0, 0, 0, 1};
  b.addLight(LightType::Sun, 10).direction = glm::normalize(glm::vec3(-0.3f, -1, 0));
  Stage stage(context(), b.finish());
  const Picture p = stage.draw(VIEW_DIRECT, {65, 65});
  uint32_t brightest = 0;
  for (uint32_t x = 0; x < 65; ++x)
    if (p.at(x, 32).x > p.at(brightest, 32).x) brightest = x;
  // Mirror: view leaves along (-.3, 1): the eye at height 3 sees it at x = +.9.
  const float expected = 32.5f + 0.9f / 3 * 32.5f / std::tan(0.5f);
  EXPECT_NEAR(brightest + 0.5f, expected, 1.5f);
  // Its height: F D V E with n.h = 1 at the peak.
  const float c = 1 / std::sqrt(1 + 0.09f), alpha = 0.09f;
  const float peak = 0.04f * ggxDistribution(0, alpha) * ggxVisibility(c, c, alpha) * 10 * c;
  EXPECT_NEAR(p.at(brightest, 32).x, peak, 0.02f * peak);
}

TEST_F(Shading, OrthographicCameraAndDepth) {
  SceneBuilder b = floorScene();
  Camera& camera = b.scene.cameras[0];
  camera.orthographic = true;
  camera.ymag = 4;
  Stage stage(context(), b.finish());
  const Picture p = stage.draw(VIEW_DEPTH, {64, 64});
  for (const glm::vec4& c : p.linear) EXPECT_NEAR(c.x, 3, 1e-3);
  camera.orthographic = false;
}

TEST_F(Shading, NormalMapTiltsTheNormal) {
  // A texel (1, .5, 1) / 255-coded: tangent-space (1, 0, 1) / sqrt 2, tangent along +x.
  SceneBuilder b = floorScene();
  Material& m = b.scene.materials[0];
  m.normalTexture.image = 0;
  b.scene.images.push_back({"tilt", 1, 1, false, {255, 128, 255, 255}});
  Stage stage(context(), b.finish());
  const glm::vec4 n = stage.draw(VIEW_NORMAL, {32, 32}).at(16, 16);
  EXPECT_NEAR(n.x, std::sqrt(0.5f), 0.01f);
  EXPECT_NEAR(n.y, std::sqrt(0.5f), 0.01f);
  EXPECT_NEAR(n.z, 0, 0.01f);
}

}  // namespace
}  // namespace irad::test::shading_suite
