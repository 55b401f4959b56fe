// Normal encodings (docs/method.md 2): known maxima and means of the error, exact axes, all codes.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "shaders/shared/facets.h"
#include "shaders/shared/normals.h"
#include "shaders/thesis/oct8_literal.h"

namespace irad::normals_suite {
namespace {

struct Known {
  NormalEncoding encoding;
  const char* name;
  uint32_t codes;
  double meanDegrees, maxDegrees;  // docs/method.md 2, over 10^6 random normals
};
const Known kEncodings[] = {{NORMALS_AXIS6, "axis6", 6, 31.9, 54.7},
                            {NORMALS_AXIS26, "axis26", 26, 15.5, 27.6},
                            {NORMALS_OCT8, "oct8", 255, 5.7, 15.8},
                            {NORMALS_OCT16, "oct16", 65279, .34, .95}};

double degrees(glm::vec3 a, glm::vec3 b) {
  const glm::dvec3 x(a), y(b);
  return std::atan2(glm::length(glm::cross(x, y)), glm::dot(x, y)) * 180 / M_PI;
}

TEST(Normals, ErrorsAreAsMeasured) {
  for (const Known& known : kEncodings) {
    std::mt19937 engine(7);
    std::normal_distribution<float> gauss;
    double sum = 0, worst = 0;
    constexpr int kCount = 1'000'000;
    for (int i = 0; i < kCount; ++i) {
      const glm::vec3 n = glm::normalize(glm::vec3(gauss(engine), gauss(engine), gauss(engine)));
      const uint32_t code = encodeNormal(n, known.encoding);
      ASSERT_GE(code, 1u);
      ASSERT_LE(code, known.codes);
      const double error = degrees(n, decodeNormal(code, known.encoding));
      sum += error;
      worst = std::max(worst, error);
    }
    std::printf("%s: mean %.3f, max %.3f degrees\n", known.name, sum / kCount, worst);
    EXPECT_NEAR(sum / kCount, known.meanDegrees, 0.01 * known.meanDegrees) << known.name;
    EXPECT_LE(worst, known.maxDegrees + 0.05) << known.name;
    EXPECT_GE(worst, 0.98 * known.maxDegrees) << known.name;
  }
}

TEST(Normals, EveryCodeRoundTrips) {
  for (const Known& known : kEncodings) {
    for (uint32_t code = 1; code <= known.codes; ++code) {
      // oct16 is a grid of 255 x 255 in two bytes: the value 255 never occurs in either.
      if (known.encoding == NORMALS_OCT16 && ((code - 1) & 255u) == 255u) continue;
      const glm::vec3 n = decodeNormal(code, known.encoding);
      ASSERT_NEAR(glm::length(n), 1.0f, 1e-5f) << known.name << ' ' << code;
      const glm::vec3 again = decodeNormal(encodeNormal(n, known.encoding), known.encoding);
      ASSERT_LT(degrees(n, again), 1e-3) << known.name << ' ' << code;
    }
  }
}

TEST(Normals, LatticeDirections) {
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const glm::vec3 n = glm::normalize(glm::vec3(x, y, z));
        const bool axis = std::abs(x) + std::abs(y) + std::abs(z) == 1;
        // axis26 holds all 26, oct16 the axes exactly and all 26 to its step.
        EXPECT_LT(degrees(decodeNormal(encodeNormal(n, NORMALS_AXIS26), NORMALS_AXIS26), n), 1e-3);
        const glm::vec3 fine = decodeNormal(encodeNormal(n, NORMALS_OCT16), NORMALS_OCT16);
        if (axis) {
          EXPECT_EQ(fine, n);
        } else {
          EXPECT_LT(degrees(fine, n), 0.95);
        }
        if (axis) {
          EXPECT_EQ(decodeNormal(encodeNormal(n, NORMALS_AXIS6), NORMALS_AXIS6), n);
        }
      }
}

TEST(Normals, MinusZIsMinusZInOct8) {
  // docs/method.md 2: the remapped code 0 costs nothing, and no sign(0).
  const glm::vec3 minusZ(0, 0, -1);
  EXPECT_LT(degrees(decodeNormal(encodeNormal(minusZ, NORMALS_OCT8), NORMALS_OCT8), minusZ), 1e-3);
  // The thesis's own arithmetic turns -Z around, and its code 1 instead of 0 costs about 8.75 degrees.
  EXPECT_GT(degrees(decodeNormal(encodeOct8Literal(minusZ), NORMALS_OCT8), minusZ), 170.0);
  const glm::vec3 nearly = glm::normalize(glm::vec3(-1e-3f, -1e-3f, -1.0f));
  EXPECT_EQ(encodeOct8Literal(nearly), 1u);
  EXPECT_NEAR(degrees(decodeNormal(1u, NORMALS_OCT8), minusZ), 8.75, 0.3);
}

TEST(NormalsOfFacets, OffsetsAndAlbedoRoundTrip) {
  for (float offset = -1.0f; offset <= 1.0f; offset += 0.001f)
    ASSERT_NEAR(facetOffset(packFacetOffset(offset)), offset, 0.5f / 127 + 1e-6f);
  EXPECT_EQ(facetOffset(packFacetOffset(0)), 0.0f);
  EXPECT_EQ(facetOffset(packFacetOffset(-2)), -1.0f);
  for (const float a : {0.0f, 0.1f, 0.5f, 0.95f, 0.98f, 1.0f}) {
    const glm::vec3 back = unpackAlbedo(packAlbedo({a, a * 0.5f, a * 0.25f}));
    EXPECT_NEAR(back.x, a, 0.51f / 65535);
    EXPECT_NEAR(back.y, a * 0.5f, 0.51f / 65535);
    EXPECT_NEAR(back.z, a * 0.25f, 0.51f / 65535);
  }
}

}  // namespace
}  // namespace irad::normals_suite
