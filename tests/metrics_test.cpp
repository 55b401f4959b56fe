// Metrics of pictures by hand, FLIP by its definition and its authors' program, Student's distribution by its tables.
#include "renderer/metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "renderer/base/student.h"
#include "renderer/flip.h"

namespace irad::test::metrics_suite {
namespace {

using Pixels = std::vector<glm::vec4>;

Pixels filled(glm::uvec2 size, const glm::vec3& color) {
  return Pixels(size_t{size.x} * size.y, glm::vec4(color, 1));
}

/// Pictures that other programs can make too: no two blocks alike, a little noise in one of them.
float wave(uint32_t x, uint32_t y, uint32_t c, uint32_t salt) {
  const uint32_t hash = (x * 73856093u) ^ (y * 19349663u) ^ ((c + 1) * 83492791u) ^ (salt * 2654435761u);
  return 0.25f + static_cast<float>(x + 2 * y + 5 * c) / 256.0f + static_cast<float>((hash >> 7) % 64) / 512.0f;
}
Pixels waves(glm::uvec2 size, uint32_t salt) {
  Pixels out;
  for (uint32_t y = 0; y < size.y; ++y)
    for (uint32_t x = 0; x < size.x; ++x)
      out.emplace_back(wave(x, y, 0, salt), wave(x, y, 1, salt), wave(x, y, 2, salt), 1);
  return out;
}

TEST(MetricsOfPictures, AreWhatHandsMakeOfThem) {
  // Two blocks and a rest of 3 pixels: references 1 and 3, values 1.5 and 3; the rest is 2 in both.
  const glm::uvec2 size(19, 8);
  Pixels values, reference;
  for (uint32_t y = 0; y < size.y; ++y)
    for (uint32_t x = 0; x < size.x; ++x) {
      const float r = x < 8 ? 1.0f : x < 16 ? 3.0f : 2.0f;
      reference.emplace_back(glm::vec3(r), 1);
      values.emplace_back(glm::vec3(x < 8 ? 1.5f : r), 1);
    }
  const PictureMetrics m = measurePicture(size, values, reference);
  const double mean = 2, epsilon = .04;  // (8 + 24 + 6) / 19 = 2; (.1 x 2)^2
  EXPECT_DOUBLE_EQ(m.pixels.meanReference, mean);
  EXPECT_DOUBLE_EQ(m.blockRelMse, (.25 / (1 + epsilon) + 0) / 2);
  EXPECT_NEAR(m.pixels.scaledRelMse, 8 * .25 / (1 + epsilon) / 19, 1e-15);
  EXPECT_DOUBLE_EQ(m.pixels.meanError, 8 * .5 / 19);
  EXPECT_DOUBLE_EQ(m.pixels.rmse, std::sqrt(8 * .25 / 19));
  // Noise that the means of blocks do not have does not count.
  Pixels noisy = reference;
  for (size_t i = 0; i < noisy.size(); ++i) noisy[i] += glm::vec4(i % 2 == 0 ? .25f : -.25f);
  noisy.back() = reference.back();  // an odd one
  EXPECT_GT(measurePicture(size, noisy, reference).pixels.scaledRelMse,
            100 * measurePicture(size, noisy, reference).blockRelMse);
}

TEST(MetricsOfPictures, TwoReferencesCancelTheirNoise) {
  // One block. References 1 + a and 1 - a around the truth 1, the value 1: (v - r)(v - s) = -a^2; with the mean of both
  // as the only reference 0.
  const glm::uvec2 size(8, 8);
  const Pixels value = filled(size, glm::vec3(1.5f)), low = filled(size, glm::vec3(.75f)),
               high = filled(size, glm::vec3(1.25f));
  EXPECT_DOUBLE_EQ(measurePicture(size, value, low, high).blockRelMse, .75 * .25 / 1.01);
  EXPECT_DOUBLE_EQ(measurePicture(size, value, low).blockRelMse, .75 * .75 / (.5625 + .005625));
}

TEST(MetricsOfPictures, AreThoseOfTheProjectsPythonTool) {
  // What ../shared/tools/compare_reference.py prints for the same pictures as EXR, with one and with two references.
  const glm::uvec2 size(40, 32);
  Pixels values = waves(size, 1);
  for (glm::vec4& v : values) v = glm::vec4(glm::vec3(v) * 1.5f, 1);
  const PictureMetrics one = measurePicture(size, values, waves(size, 2)),
                       two = measurePicture(size, values, waves(size, 2), waves(size, 3));
  EXPECT_NEAR(one.blockRelMse, .24842, 5e-6);
  EXPECT_NEAR(one.pixels.scaledRelMse, .26033, 5e-6);
  EXPECT_NEAR(two.blockRelMse, .25367, 5e-6);
}

TEST(MetricsOfPictures, IntervalsByTheReferencesNoiseHoldTheTruth) {
  // A picture a tenth too bright against pairs of references with noise of a known spread: of 95 % intervals about 95
  // in 100 hold the relMSE against the truth.
  const glm::uvec2 size(32, 16);
  const Pixels truth = waves(size, 4);
  Pixels value = truth;
  for (glm::vec4& v : value) v = glm::vec4(glm::vec3(v) * 1.1f, 1);
  const double exact = measurePicture(size, value, truth, {}, std::nullopt).blockRelMse;
  std::mt19937 random(3);
  std::normal_distribution<float> normal(0, .3f);
  const Pixels error(truth.size(), glm::vec4(glm::vec3(.3f / std::sqrt(2.0f)), 1));
  int held = 0;
  constexpr int kRounds = 400;
  for (int round = 0; round < kRounds; ++round) {
    Pixels a = truth, b = truth;
    for (Pixels* pixels : {&a, &b})
      for (glm::vec4& p : *pixels) p += glm::vec4(normal(random), normal(random), normal(random), 0);
    const PictureMetrics m = measurePicture(size, value, a, b, std::nullopt, error);
    EXPECT_TRUE(std::isnan(m.flip)) << "not asked for";
    held += std::abs(m.blockRelMse - exact) <= m.blockRelMseHalf;
  }
  // Three standard deviations of the binomial distribution, 1.1 %.
  EXPECT_NEAR(held, .95 * kRounds, 3 * std::sqrt(.95 * .05 * kRounds));
  EXPECT_TRUE(std::isnan(measurePicture(size, value, truth).blockRelMseHalf)) << "unknown without standard errors";
}

TEST(MetricsOfPictures, AgainstTwoReferencesAreWhatHandsMakeOfThem) {
  // One value: r = 1, s = 3, m = 2, v = 4: (v - r)(v - s) = 3; the other is 2, 2, 2, 3: 1. Mean m = 2, epsilon .04.
  const Pixels v{{4, 4, 4, 0}, {3, 3, 3, 9}}, r{{1, 1, 1, 0}, {2, 2, 2, 5}}, s{{3, 3, 3, 0}, {2, 2, 2, 7}};
  const PairedMetrics m = measurePaired(v, r, s);
  EXPECT_DOUBLE_EQ(m.rmse, std::sqrt(2.0));
  EXPECT_NEAR(m.relMse, 2 / 4.04, 1e-12);
  // Between the two: below 0, and no root of it.
  const PairedMetrics between = measurePaired(Pixels{{2, 2, 2, 0}}, Pixels{{1, 1, 1, 0}}, Pixels{{3, 3, 3, 0}});
  EXPECT_EQ(between.rmse, 0);
  EXPECT_NEAR(between.relMse, -1 / 4.04, 1e-12);
  EXPECT_TRUE(std::isnan(measurePaired(Pixels{}, Pixels{}, Pixels{}).relMse));
  Pixels nan = v;
  nan[0].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NEAR(measurePaired(nan, r, s).relMse, 1 / 4.04, 1e-12) << "the other element alone";
}

TEST(MetricsOfPictures, LeaveOutBlocksThatHoldNoNumber) {
  const glm::uvec2 size(16, 8);
  Pixels values = filled(size, glm::vec3(2)), reference = filled(size, glm::vec3(1));
  values[3].y = std::numeric_limits<float>::quiet_NaN();
  const PictureMetrics m = measurePicture(size, values, reference);
  EXPECT_EQ(m.pixels.leftOut, 1u);
  EXPECT_DOUBLE_EQ(m.blockRelMse, 1 / 1.01) << "the other block alone";
  EXPECT_TRUE(std::isfinite(m.flip));
  EXPECT_TRUE(
      std::isnan(measurePicture({4, 4}, filled({4, 4}, glm::vec3(1)), filled({4, 4}, glm::vec3(1))).blockRelMse));
}

TEST(Flip, ColorsAreAsFarApartAsThePaperHasThem) {
  // By hand from published L*a*b* (D65) of the sRGB primaries: green (87.735, -86.183, 83.180), blue (32.297, 79.188,
  // -107.860). Hunt's factors .01 L: (87.735, -75.613, 72.978) and (32.297, 25.575, -34.836).
  const double byHand = (87.735 - 32.297) + std::hypot(75.613 + 25.575, 72.978 + 34.836);
  EXPECT_NEAR(huntHyab({0, 1, 0}, {0, 0, 1}), byHand, .05);
  EXPECT_NEAR(huntHyab(glm::dvec3(1), glm::dvec3(0)), 100, 1e-9) << "white against black: L* alone";
  EXPECT_EQ(huntHyab({.2, .3, .4}, {.2, .3, .4}), 0);
}

TEST(Flip, PlainPicturesFollowItsCurve) {
  // Pictures of one colour have no features and survive the filter: only the curve of the colour difference is left.
  const glm::uvec2 size(32, 24);
  const double largest = std::pow(huntHyab({0, 1, 0}, {0, 0, 1}), .7), knee = .4 * largest;
  const auto curve = [&](const glm::dvec3& a, const glm::dvec3& b) {
    const double d = std::pow(huntHyab(a, b), .7);
    return d < knee ? .95 * d / knee : .95 + .05 * (d - knee) / (largest - knee);
  };
  EXPECT_NEAR(flip(size, filled(size, {0, 1, 0}), filled(size, {0, 0, 1})), 1, 1e-6) << "by definition the largest";
  EXPECT_NEAR(flip(size, filled(size, glm::vec3(1)), filled(size, glm::vec3(0))), curve(glm::dvec3(1), glm::dvec3(0)),
              1e-6);
  EXPECT_NEAR(flip(size, filled(size, glm::vec3(.25f)), filled(size, glm::vec3(.27f))),
              curve(glm::dvec3(.25f), glm::dvec3(.27f)), 1e-6);
  EXPECT_EQ(flip(size, waves(size, 1), waves(size, 1)), 0);
}

TEST(Flip, IsSymmetricAndSeesEdgesMoreThanTheirColors) {
  const glm::uvec2 size(64, 48);
  const Pixels a = waves(size, 1), b = waves(size, 2);
  EXPECT_NEAR(flip(size, a, b), flip(size, b, a), 1e-12);
  // An edge of a hundredth: the features raise what colours alone say, most where the edge is.
  Pixels plain = filled(size, glm::vec3(.5f)), edged = plain;
  for (uint32_t y = 0; y < size.y; ++y)
    for (uint32_t x = 32; x < size.x; ++x) edged[size_t{y} * size.x + x] = glm::vec4(.55f, .55f, .55f, 1);
  const std::vector<double> errors = flipErrors(size, edged, plain);
  EXPECT_NEAR(errors[24 * 64 + 2], 0, 1e-9) << "far from it on the side that is equal";
  EXPECT_GT(errors[24 * 64 + 32], errors[24 * 64 + 63]) << "at the edge more than in what differs by colour alone";
  EXPECT_NEAR(errors[10 * 64 + 40], errors[40 * 64 + 40], 1e-12) << "the same in every row";
  // The eye resolves broad patterns better than those of single pixels.
  Pixels fine = plain, broad = plain;
  for (uint32_t y = 0; y < size.y; ++y)
    for (uint32_t x = 0; x < size.x; ++x) {
      fine[size_t{y} * size.x + x] = glm::vec4(glm::vec3((x + y) % 2 == 0 ? .45f : .55f), 1);
      broad[size_t{y} * size.x + x] = glm::vec4(glm::vec3((x / 16 + y / 16) % 2 == 0 ? .45f : .55f), 1);
    }
  EXPECT_LT(flip(size, fine, plain), flip(size, broad, plain));
}

TEST(Flip, AnEdgesStrengthIsItsStep) {
  // At ppd 67 the edge filter reaches 9 pixels. Just left of a step of s, half of the positive weights but for the
  // middle see it: with x = 0 without weight, pixel 31 sees the step with all weights of k >= 1, which sum to -1.
  const glm::uvec2 size(64, 48);
  Pixels plain = filled(size, glm::vec3(.5f)), edged = plain;
  for (uint32_t y = 0; y < size.y; ++y)
    for (uint32_t x = 32; x < size.x; ++x) edged[size_t{y} * size.x + x] = glm::vec4(.54f, .54f, .54f, 1);
  const double error = flipErrors(size, edged, plain)[24 * 64 + 31];
  const double strength = std::sqrt((double{.54f} - .5) / std::sqrt(2.0));
  // error = color^(1 - strength): the colour that follows lies between none and the full step's.
  const double color = std::pow(error, 1 / (1 - strength));
  const double largest = std::pow(huntHyab({0, 1, 0}, {0, 0, 1}), .7);
  const double full = .95 * std::pow(huntHyab(glm::dvec3(.54f), glm::dvec3(.5)), .7) / (.4 * largest);
  EXPECT_GT(color, .3 * full);
  EXPECT_LT(color, .8 * full);
}

/// Pictures that any program can make to the bit, `test` and its reference: a gradient with noise, thin lines, stripes
/// that are shifted by three pixels, blocks of saturated colours.
glm::vec4 patternPixel(int pattern, bool test, uint32_t x, uint32_t y) {
  if (pattern == 0) {
    glm::vec3 color(static_cast<float>(x) / 64, static_cast<float>(y) / 64, static_cast<float>(63 - x + y) / 128);
    for (uint32_t c = 0; test && c < 3; ++c) {
      uint32_t hash = (x * 73856093u) ^ (y * 19349663u) ^ ((c + 1) * 83492791u);
      hash = ((hash ^ (hash >> 13)) * 2654435761u) >> 16;
      const int noise = static_cast<int>(hash % 64) - 32;
      color[static_cast<int>(c)] = std::clamp(color[static_cast<int>(c)] + static_cast<float>(noise) / 256, 0.0f, 1.0f);
    }
    return {color, 1};
  }
  if (pattern == 1) {
    const bool line = test ? y % 9 == 4 : x % 11 == 5;
    return glm::vec4(glm::vec3(!line ? .25f : test ? .75f : 1), 1);
  }
  if (pattern == 2)
    return (x + (test ? 3 : 0)) / 4 % 2 == 1 ? glm::vec4(.75f, .25f, .125f, 1) : glm::vec4(.125f, .5f, .625f, 1);
  const uint32_t corner = (x / 8 + 3 * (y / 8) + (test ? 3 : 0)) % 8;
  return {corner & 1, corner >> 1 & 1, corner >> 2 & 1, 1};
}

TEST(Flip, IsThatOfItsAuthorsProgram) {
  // Their program: NVlabs/flip on GitHub, src/cpp/FLIP.h as of commit 8144bd5, LDR-FLIP on the CPU with its default
  // 67.02 pixels per degree. It was typed anew outside of this project, operation by operation, and run in its single
  // precision (g++ -O2) on these patterns. The same in double precision is ours within 1e-6; single precision is up to
  // 7e-5 of a value away from that, most where the colours are equal and only its roundings differ.
  struct Theirs {
    glm::uvec2 size;
    double mean;
    double pixels[4];  ///< at kAt
  };
  constexpr glm::uvec2 kAt[] = {{13, 29}, {34, 24}, {41, 7}, {60, 46}};
  const Theirs theirs[] = {{{64, 48}, .1299487, {.0715756, .0709449, .1007613, .1470469}},
                           {{64, 48}, .2759014, {.1738392, .2165422, .0397710, .6284779}},
                           {{61, 47}, .4805271, {.5819032, .6777515, .5914895, .4781188}},
                           {{64, 48}, .9609234, {.9919590, .8732529, .9853295, .9838235}}};
  for (int pattern = 0; pattern < 4; ++pattern) {
    const auto& [size, mean, pixels] = theirs[pattern];
    Pixels test, reference;
    for (uint32_t y = 0; y < size.y; ++y)
      for (uint32_t x = 0; x < size.x; ++x) {
        test.push_back(patternPixel(pattern, true, x, y));
        reference.push_back(patternPixel(pattern, false, x, y));
      }
    EXPECT_NEAR(flip(size, test, reference), mean, 1e-4 * mean) << "pattern " << pattern;
    const std::vector<double> errors = flipErrors(size, test, reference);
    for (size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(errors[size_t{kAt[i].y} * size.x + kAt[i].x], pixels[i], 1e-4 * pixels[i])
          << "pattern " << pattern << ", pixel " << kAt[i].x << " " << kAt[i].y;
  }
}

TEST(Student, QuantilesAreThoseOfTheTables) {
  // Abramowitz and Stegun 1964, Table 26.10.
  EXPECT_NEAR(studentQuantile(.025, 1), 12.706, 5e-4);
  EXPECT_NEAR(studentQuantile(.025, 2), 4.303, 5e-4);
  EXPECT_NEAR(studentQuantile(.025, 7), 2.365, 5e-4);
  EXPECT_NEAR(studentQuantile(.025, 15), 2.131, 5e-4);
  EXPECT_NEAR(studentQuantile(.025, 120), 1.980, 5e-4);
  EXPECT_NEAR(studentQuantile(.005, 4), 4.604, 5e-4);
  EXPECT_NEAR(studentQuantile(.05, 1), std::tan(.45 * 3.14159265358979), 1e-9) << "Cauchy's distribution";
  const std::vector<double> samples{1, 2, 3, 4};
  const MeanInterval interval = meanInterval(samples);
  EXPECT_DOUBLE_EQ(interval.mean, 2.5);
  EXPECT_NEAR(interval.half, 3.1824 * std::sqrt(5.0 / 3 / 4), 1e-3);
  EXPECT_TRUE(std::isinf(meanInterval(std::vector<double>{1}).half));
}

}  // namespace
}  // namespace irad::test::metrics_suite
