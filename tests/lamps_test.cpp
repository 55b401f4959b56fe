// What the window makes of lights by numbers alone: units, colours of black bodies, where a new light begins, and the
// surface that one is put down on.
#include <gtest/gtest.h>

#if IRAD_UI

#include <cmath>
#include <numbers>

#include "gi/check/scenes.h"
#include "renderer/scene/first_surface.h"
#include "renderer/scene/light_units.h"
#include "ui/new_light.h"

namespace irad::lamps_suite {
namespace {

constexpr double kPi = std::numbers::pi;

Light spot(double inner, double outer) {
  return {.type = LightType::Spot,
          .innerCos = static_cast<float>(std::cos(inner)),
          .outerCos = static_cast<float>(std::cos(outer))};
}

TEST(LightUnits, ASpotsSolidAngleIsTheIntegralOfItsFalloff) {
  EXPECT_DOUBLE_EQ(solidAngle({.type = LightType::Point}), 4 * kPi);
  EXPECT_EQ(solidAngle({.type = LightType::Sun}), 0);
  // Without a falloff a cap of the sphere.
  EXPECT_NEAR(solidAngle(spot(kPi / 3, kPi / 3)), kPi, 1e-6);
  EXPECT_NEAR(solidAngle(spot(kPi / 2, kPi / 2)), 2 * kPi, 1e-6);
  EXPECT_EQ(solidAngle(spot(0, 0)), 0);
  // With one by the midpoint rule, from the extension's formula.
  for (const auto& [inner, outer] : {std::pair(0.0, 0.5), std::pair(0.3, 0.9), std::pair(0.2, 1.5)}) {
    const Light light = spot(inner, outer);
    double sum = 0;
    constexpr int n = 200000;
    const double step = outer / n;
    for (int i = 0; i < n; ++i) {
      const double angle = (i + 0.5) * step;
      const double share = std::clamp((std::cos(angle) - light.outerCos) / (light.innerCos - light.outerCos), 0.0, 1.0);
      sum += share * share * 2 * kPi * std::sin(angle) * step;
    }
    EXPECT_NEAR(solidAngle(light), sum, 1e-6) << inner << ", " << outer;
  }
}

TEST(ColorTemperature, FollowsThePlanckianLocus) {
  // Chromaticities x, y of black bodies for the CIE 1931 observer, tabulated to 4 digits (of 2,856 K: illuminant A, CIE
  // 15, to 5). Krystek's formula is within 1e-4 in u and in v, and the rounding is worth half as much.
  struct Row {
    double kelvin, x, y;
  };
  for (const Row& row :
       {Row{1000, 0.6528, 0.3444}, Row{1500, 0.5857, 0.3931}, Row{2000, 0.5267, 0.4133}, Row{2856, 0.44757, 0.40745},
        Row{3000, 0.4369, 0.4041}, Row{4000, 0.3805, 0.3768}, Row{5000, 0.3451, 0.3516}, Row{6000, 0.3221, 0.3318},
        Row{6500, 0.3135, 0.3237}, Row{8000, 0.2952, 0.3048}, Row{10000, 0.2807, 0.2884}}) {
    const double weight = -2 * row.x + 12 * row.y + 3;
    EXPECT_NEAR(planckianUv(row.kelvin).x, 4 * row.x / weight, 1.5e-4) << row.kelvin;
    EXPECT_NEAR(planckianUv(row.kelvin).y, 6 * row.y / weight, 1.5e-4) << row.kelvin;
  }
}

/// C. Wyman, P.-P. Sloan and P. Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions",
/// Journal of Computer Graphics Techniques 2 (2013), the fit by several lobes; nm.
glm::dvec3 matchingFunctions(double nm) {
  const auto lobe = [nm](double peak, double below, double above) {
    const double t = (nm - peak) / (nm < peak ? below : above);
    return std::exp(-0.5 * t * t);
  };
  return {1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) - 0.065 * lobe(501.1, 20.4, 26.2),
          0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1),
          1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8)};
}
/// CIE 1960 u and v of a spectrum, a function of the wavelength (nm).
template <class Spectrum>
glm::dvec2 uvOf(const Spectrum& spectrum) {
  glm::dvec3 sum(0);
  for (int nm = 360; nm <= 830; ++nm) sum += spectrum(nm) * matchingFunctions(nm);
  return glm::dvec2(4 * sum.x, 6 * sum.y) / (sum.x + 15 * sum.y + 3 * sum.z);
}
/// Of a black body, with the second radiation constant `c2` (nm K).
glm::dvec2 blackBodyUv(double kelvin, double c2) {
  return uvOf([&](double nm) { return std::pow(nm / 560, -5) / std::expm1(c2 / (nm * kelvin)); });
}

TEST(ColorTemperature, TheLocusIsWhatPlancksLawIntegratesTo) {
  // How far off the fitted functions are is read from two spectra whose chromaticities are known without them: equal
  // energy, x = y = 1/3, and CIE 15's illuminant A, whose table is made with c2 = 1.435e7 nm K and 2,848 K. Redder
  // light than that hangs on the functions' ends, which the fit does not follow; the table above has it.
  const glm::dvec2 a = glm::dvec2(4 * 0.44757, 6 * 0.40745) / (-2 * 0.44757 + 12 * 0.40745 + 3);
  const double offEqual = glm::distance(uvOf([](double) { return 1.0; }), glm::dvec2(4, 6) / 19.0);
  const double offA = glm::distance(blackBodyUv(2848, 1.435e7), a);
  const double off = std::max(offEqual, offA);
  ASSERT_LT(off, 2e-3) << "the fit is mistyped";
  constexpr double kSecondRadiation = 1.438776877e7;  // h c / k of the SI, nm K
  for (double kelvin = 2856; kelvin <= kMostTemperature; kelvin *= 1.15)
    EXPECT_LT(glm::distance(planckianUv(kelvin), blackBodyUv(kelvin, kSecondRadiation)), off + 1e-4) << kelvin;
}

TEST(ColorTemperature, OfAColorIsTheOneItWasMadeOf) {
  for (double kelvin = 2000; kelvin <= 15000; kelvin *= 1.1) {
    const glm::vec3 color = temperatureColor(kelvin);
    EXPECT_EQ(std::max({color.r, color.g, color.b}), 1.0f);
    EXPECT_GE(std::min({color.r, color.g, color.b}), 0.0f);
    const std::optional<double> back = colorTemperature(0.3f * color);
    ASSERT_TRUE(back) << kelvin;
    EXPECT_NEAR(*back / kelvin, 1, 1e-3) << kelvin;
  }
  // Where the gamut ends the colour is red to yellow, and its temperature still near.
  const glm::vec3 candle = temperatureColor(1500);
  EXPECT_EQ(candle.b, 0);
  EXPECT_NEAR(colorTemperature(candle).value_or(0), 1500, 150);
  EXPECT_EQ(temperatureColor(500), temperatureColor(kLeastTemperature));
  // White is D65, which lies near the locus; green and violet have none, nor has black.
  EXPECT_NEAR(colorTemperature(glm::vec3(1)).value_or(0), 6504, 20);
  EXPECT_FALSE(colorTemperature({0, 1, 0}));
  EXPECT_FALSE(colorTemperature({1, 0, 1}));
  EXPECT_FALSE(colorTemperature({0, 0, 0}));
}

/// A closed unit room, seen from within alone.
Scene room() {
  SceneBuilder b;
  const uint32_t wall = b.material(glm::vec3(0.5f));
  b.box({wall, wall, wall, wall, wall, wall}, {0, 0, 0}, {1, 1, 1}, /*inward=*/true);
  return b.finish("room");
}
Camera looking(glm::dvec3 from, glm::dvec3 to) {
  Camera camera;
  camera.position = from;
  camera.orientation = glm::quatLookAt(glm::vec3(glm::normalize(to - from)), glm::vec3(0, 1, 0));
  return camera;
}

TEST(FirstSurface, IsTheNearestThatShowsItsFront) {
  const Scene scene = room();
  const auto floor = firstSurface(scene, {0.3, 0.8, 0.4}, {0, -2, 0});
  ASSERT_TRUE(floor);
  EXPECT_NEAR(glm::distance(floor->position, {0.3, 0, 0.4}), 0, 1e-7);
  EXPECT_NEAR(glm::distance(floor->normal, {0, 1, 0}), 0, 1e-7);
  // From outside the near wall, which shows its back, lets the ray pass; both-sided it does not, and faces the ray.
  const auto far = firstSurface(scene, {0.3, 0.6, 5}, {0, 0, -1});
  ASSERT_TRUE(far);
  EXPECT_NEAR(far->position.z, 0, 1e-7);
  Scene both = scene;
  for (Material& material : both.materials) material.doubleSided = true;
  const auto near = firstSurface(both, {0.3, 0.6, 5}, {0, 0, -1});
  ASSERT_TRUE(near);
  EXPECT_NEAR(near->position.z, 1, 1e-7);
  EXPECT_NEAR(near->normal.z, 1, 1e-7);
  EXPECT_FALSE(firstSurface(scene, {0.3, 0.6, 5}, {0, 0, 1}));
  EXPECT_FALSE(firstSurface(Scene{}, {0, 0, 0}, {0, 0, 1}));
}

TEST(NewLight, BeginsInsideWhereTheCameraLooks) {
  const Scene scene = room();
  const auto light = [&](LightType type, const Camera& camera) { return newLight(lightKind(type), scene, camera); };
  // From within: half-way to the wall, which gets radiance 1 where it is white.
  const Camera within = looking({0.5, 0.5, 0.9}, {0.5, 0.5, 0});
  const Light lamp = light(LightType::Point, within);
  EXPECT_NEAR(glm::distance(lamp.position, {0.5, 0.5, 0.45}), 0, 1e-6);
  EXPECT_NEAR(lamp.intensity, kPi * 0.45 * 0.45, 1e-5);
  EXPECT_NEAR(light(LightType::Sun, within).intensity, kPi, 1e-6);
  EXPECT_NEAR(light(LightType::Spot, within).direction.z, -1, 1e-6);
  // From far outside: still in the room.
  const Light outside = light(LightType::Point, looking({0.5, 0.5, 8}, {0.5, 0.5, 0}));
  EXPECT_NEAR(glm::distance(outside.position, {0.5, 0.5, 0.5}), 0, 1e-5);
  // Past the scene: in its middle.
  const Light past = light(LightType::Point, looking({0.5, 0.5, 8}, {0.5, 20, 0}));
  EXPECT_NEAR(glm::distance(past.position, {0.5, 0.5, 0.5}), 0, 1e-6);
  for (const LightKind& kind : lightKinds()) EXPECT_EQ(unsound(newLight(kind, scene, within)), "") << kind.name;
}

}  // namespace
}  // namespace irad::lamps_suite

#else

TEST(Lamps, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_UI";
}

#endif
