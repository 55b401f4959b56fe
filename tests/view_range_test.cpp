// How the values of a view with a range become colours: the range itself, the maps, the marks.
#include <gtest/gtest.h>

#include "gi/settings.h"
#include "gi/views/passes.h"
#include "renderer/targets.h"
#include "shaders/shared/color_map.h"
#include "shaders/shared/view.h"
#include "tests/support.h"

namespace irad::test::view_range_suite {
namespace {

constexpr glm::uvec2 kSize{50, 20};
constexpr uint32_t kPixels = kSize.x * kSize.y;

double luminance(const glm::vec3& c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

struct Shown {
  ViewRange range;
  std::vector<glm::u8vec4> display;
};

class Ranges : public GpuTest {
 protected:
  /// What a view of these values shows.
  Shown show(const ViewInfo& info, const std::vector<glm::vec4>& values, const Settings& settings) {
    Targets targets(context(), kSize);
    upload(context(), targets.linear, std::as_bytes(std::span(values)));
    Frame frame = context().begin();
    findRange(frame, info, settings, targets);
    finishView(frame, info, settings, glm::uvec3(8), targets);
    frame.submitAndWait();
    Shown shown{downloadAs<ViewRange>(context(), targets.viewRange).at(0), std::vector<glm::u8vec4>(kPixels)};
    const std::vector<std::byte> display = download(context(), targets.display);
    std::memcpy(shown.display.data(), display.data(), display.size());
    return shown;
  }
  /// 1, 2, 3 ... shuffled.
  static std::vector<glm::vec4> ramp(float sign = 1) {
    std::vector<glm::vec4> values;
    for (uint32_t i = 0; i < kPixels; ++i)
      values.emplace_back(glm::vec3(sign * static_cast<float>(i * 337 % kPixels + 1)), 1.0f);
    return values;
  }
  const ViewInfo& scalar = *viewInfo(VIEW_DEPTH);
  const ViewInfo& withSign = *viewInfo(VIEW_JFA_FIELD_ERROR);
};

void expectColor(const glm::u8vec4& shown, const glm::vec3& linear) {
  const glm::vec3 expected = encodeSrgb(linear) * 255.0f;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(shown[c], expected[c], 1.01) << c;
}

TEST_F(Ranges, AutoIsFromTheSmallestToTheLargest) {
  Settings settings;
  settings.view.range = RangeMode::automatic;
  std::vector<glm::vec4> values = ramp();
  values[7] = glm::vec4(5000, 0, 0, 0);  // nothing is drawn there
  const Shown shown = show(scalar, values, settings);
  EXPECT_EQ(shown.range.low, 1);
  EXPECT_EQ(shown.range.high, 1000);
  EXPECT_EQ(shown.range.drawn, kPixels - 1);
  for (uint32_t i = 0; i < kPixels; ++i) {
    if (values[i].x == 1) expectColor(shown.display[i], colorMap(COLOR_MAP_VIOLET_YELLOW, 0));
    if (values[i].x == 1000) expectColor(shown.display[i], colorMap(COLOR_MAP_VIOLET_YELLOW, 1));
  }
  EXPECT_EQ(shown.display[7], glm::u8vec4(0, 0, 0, 255));
}

TEST_F(Ranges, PercentilesLeaveTheTailsOut) {
  Settings settings;
  settings.view.range = RangeMode::percentile;
  settings.view.percentile = 90;
  std::vector<glm::vec4> values = ramp();
  for (glm::vec4& v : values)
    if (v.x > 950) v.x = 1e30f;  // bright pixels
  const Shown shown = show(scalar, values, settings);
  // The 100th and the 901st of 1 to 1000, each to the bin's width of 2^-8.
  EXPECT_NEAR(shown.range.low, 100, 100.0 / 256 + 1);
  EXPECT_NEAR(shown.range.high, 901, 901.0 / 256 + 1);
  settings.view.percentile = 100;
  EXPECT_EQ(show(scalar, values, settings).range.high, 1e30f);
  EXPECT_EQ(show(scalar, values, settings).range.low, 1);
}

TEST_F(Ranges, ManualIsTheUsersAndStandardTheViews) {
  Settings settings;
  settings.view.range = RangeMode::manual;
  settings.view.low = 10;
  settings.view.high = -20;  // the map turned round
  Shown shown = show(scalar, ramp(), settings);
  EXPECT_EQ(shown.range.low, 10);
  EXPECT_EQ(shown.range.high, -20);
  expectColor(shown.display[0], colorMap(COLOR_MAP_VIOLET_YELLOW, 9.0f / 30));
  settings.view.range = RangeMode::standard;
  shown = show(*viewInfo(VIEW_ROW_SUM), ramp(), settings);
  EXPECT_EQ(shown.range.low, 0);
  EXPECT_EQ(shown.range.high, 1);
  EXPECT_EQ(show(scalar, ramp(), settings).range.high, 1000);  // depth has no range of its own
}

TEST_F(Ranges, LightExposesItselfByTheLuminanceThatMostOfItStaysBelow) {
  Settings settings;
  settings.camera.gpu.toneCurve = ToneCurve::linear;
  const ViewInfo &lit = *viewInfo(VIEW_LIT), &irradiance = *viewInfo(VIEW_IRRADIANCE);
  std::vector<glm::vec4> values = ramp();
  for (glm::vec4& v : values) v = glm::vec4(glm::vec3(v) * glm::vec3(2.0f, 0.5f, 1.0f), 1.0f);
  values[3] = glm::vec4(glm::vec3(1e9f), 0);  // nothing is drawn there
  const float one = static_cast<float>(luminance(glm::vec3(2.0f, 0.5f, 1.0f)));
  // Off: white all over but for the darkest.
  EXPECT_EQ(show(lit, values, settings).display[500], glm::u8vec4(255, 255, 255, 255));
  settings.camera.autoExposure = true;
  for (const ViewInfo* info : {&lit, &irradiance}) {
    const Shown shown = show(*info, values, settings);
    const float level = 950 * one;  // of 999
    EXPECT_NEAR(shown.range.high, level, level / 128) << info->name;
    for (uint32_t i = 0; i < kPixels; ++i) {
      if (i == 3 || luminance(values[i]) > 0.4 * level) continue;
      const glm::vec3 expected = encodeSrgb(glm::vec3(values[i]) * AUTO_EXPOSURE_LEVEL / level) * 255.0f;
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(shown.display[i][c], expected[c], 2) << info->name << " " << i;
    }
    EXPECT_EQ(shown.display, show(*info, values, settings).display) << "the same picture, the same bits";
  }
  // camera.exposure is on top.
  settings.camera.exposureEv = -2;
  const glm::u8vec4 darker = show(lit, values, settings).display[500];
  expectColor(darker, glm::vec3(values[500]) * AUTO_EXPOSURE_LEVEL / (950 * one) / 4.0f);
  // A picture that is black but for a few pixels shows those; one that is all black stays so.
  std::vector<glm::vec4> night(kPixels, glm::vec4(0, 0, 0, 1));
  EXPECT_EQ(show(lit, night, settings).display[9], glm::u8vec4(0, 0, 0, 255));
  night[8] = glm::vec4(1e-3f, 1e-3f, 1e-3f, 1);
  settings.camera.exposureEv = 0;
  expectColor(show(lit, night, settings).display[8], glm::vec3(AUTO_EXPOSURE_LEVEL));
}

TEST_F(Ranges, SignedViewsAreEvenAboutZero) {
  Settings settings;
  std::vector<glm::vec4> values = ramp(-1);
  values[0] = glm::vec4(0, 0, 0, 1);
  const Shown shown = show(withSign, values, settings);
  EXPECT_EQ(shown.range.low, -1000);
  EXPECT_EQ(shown.range.high, 1000);
  EXPECT_EQ(shown.range.negative, 0u);
  expectColor(shown.display[0], colorMap(COLOR_MAP_BLUE_RED, 0.5f));
  for (uint32_t i = 0; i < kPixels; ++i)
    if (values[i].x == -1000) expectColor(shown.display[i], colorMap(COLOR_MAP_BLUE_RED, 0));
  settings.view.range = RangeMode::manual;
  settings.view.low = -3;
  settings.view.high = 2;
  EXPECT_EQ(show(withSign, values, settings).range.high, 3);
}

TEST_F(Ranges, WhatHasNoPlaceIsMarkedAndCounted) {
  Settings settings;
  std::vector<glm::vec4> values = ramp();
  values[0].x = std::nanf("");
  values[1].x = values[2].x = INFINITY;
  values[3].x = values[4].x = values[5].x = -1;
  const Shown shown = show(scalar, values, settings);
  EXPECT_EQ(shown.range.nan, 1u);
  EXPECT_EQ(shown.range.infinite, 2u);
  EXPECT_EQ(shown.range.negative, 3u);
  EXPECT_EQ(shown.display[0], glm::u8vec4(255, 0, 0, 255));
  EXPECT_EQ(shown.display[1], glm::u8vec4(0, 255, 0, 255));
  EXPECT_EQ(shown.display[3], glm::u8vec4(0, 0, 255, 255));
  EXPECT_LE(shown.range.high, 1000);
  EXPECT_GE(shown.range.low, 1);
}

TEST_F(Ranges, APictureOfOneValueOrNone) {
  Settings settings;
  std::vector<glm::vec4> values(kPixels, glm::vec4(glm::vec3(7), 1));
  Shown shown = show(scalar, values, settings);
  EXPECT_EQ(shown.range.low, 7);
  EXPECT_EQ(shown.range.high, 7);
  expectColor(shown.display[0], colorMap(COLOR_MAP_VIOLET_YELLOW, 0.5f));
  for (const RangeMode mode : {RangeMode::automatic, RangeMode::percentile}) {
    settings.view.range = mode;
    shown = show(scalar, std::vector<glm::vec4>(kPixels, glm::vec4(0)), settings);
    EXPECT_EQ(shown.range.drawn, 0u);
    EXPECT_EQ(shown.range.low, 0);
    EXPECT_EQ(shown.range.high, 0);
    EXPECT_EQ(shown.display[0], glm::u8vec4(0, 0, 0, 255));
  }
}

/// OKLab's lightness of linear sRGB (Ottosson 2020).
double lightness(const glm::vec3& c) {
  const double l = std::cbrt(0.4122214708 * c.x + 0.5363325363 * c.y + 0.0514459929 * c.z);
  const double m = std::cbrt(0.2119034982 * c.x + 0.6806995451 * c.y + 0.1073969566 * c.z);
  const double s = std::cbrt(0.0883024619 * c.x + 0.2817188376 * c.y + 0.6299787005 * c.z);
  return 0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s;
}

TEST(ColorMaps, LightnessIsEven) {
  // Equal steps of the value are equal steps of lightness, to what clamping to the gamut costs.
  for (const ColorMap map : {COLOR_MAP_VIOLET_YELLOW, COLOR_MAP_HEAT, COLOR_MAP_GREY}) {
    const double low = lightness(colorMap(map, 0)), high = lightness(colorMap(map, 1));
    EXPECT_GT(high - low, 0.6) << nameOf(map);
    for (int i = 1; i < 32; ++i)
      EXPECT_NEAR(lightness(colorMap(map, static_cast<float>(i) / 32)), low + (high - low) * i / 32, 0.03)
          << nameOf(map) << ", " << i;
  }
  // The diverging one: the same to both sides, lightest at zero.
  for (int i = 0; i <= 16; ++i) {
    const float side = static_cast<float>(i) / 32;
    const double left = lightness(colorMap(COLOR_MAP_BLUE_RED, 0.5f - side));
    EXPECT_NEAR(left, lightness(colorMap(COLOR_MAP_BLUE_RED, 0.5f + side)), 0.03) << i;
    EXPECT_NEAR(left, 0.95 - side, 0.03) << i;
  }
  EXPECT_GT(luminance(colorMap(COLOR_MAP_BLUE_RED, 0.5f)), 0.8);
}

TEST(Shapes, ResolveToWhatAViewHas) {
  EXPECT_EQ(resolveShape(VIEW_LIT, ViewShape::slice), std::nullopt);
  EXPECT_EQ(resolveShape(VIEW_PIN_HOLES, ViewShape::cubes), std::nullopt);
  EXPECT_EQ(resolveShape(VIEW_RADIOSITY, ViewShape::automatic), SHAPE_CUBES);
  EXPECT_EQ(resolveShape(VIEW_RADIOSITY, ViewShape::isosurface), SHAPE_CUBES);
  EXPECT_EQ(resolveShape(VIEW_RADIOSITY, ViewShape::projection), SHAPE_PROJECTION);
  EXPECT_EQ(resolveShape(VIEW_DISTANCE, ViewShape::automatic), SHAPE_PROJECTION);
  EXPECT_EQ(resolveShape(VIEW_DISTANCE_JFA, ViewShape::automatic), SHAPE_SLICE);
  EXPECT_EQ(resolveShape(VIEW_DISTANCE_JFA, ViewShape::isosurface), SHAPE_ISOSURFACE);
  EXPECT_EQ(resolveShape(VIEW_JFA_SEEDS, ViewShape::projection), SHAPE_SLICE);
}

TEST(Presets, LeaveTheViewAlone) {
  Settings settings;
  settings.view.axis = Axis::z;
  settings.view.colorMap = ColorMap::heat;
  applyPreset(settings, "thesis");
  EXPECT_EQ(settings.view.axis, Axis::z);
  EXPECT_EQ(settings.view.colorMap, ColorMap::heat);
}

}  // namespace
}  // namespace irad::test::view_range_suite
