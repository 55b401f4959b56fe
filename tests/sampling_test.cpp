// The ray directions (shaders/shared/sampling.h, trace.h): the same functions run on the device.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "shaders/shared/sampling.h"
#include "shaders/shared/trace.h"

namespace irad::sampling_suite {
namespace {

TEST(Sampling, CoordinatesAreInsideTheOpenInterval) {
  for (const uint32_t shift : {0u, 1u, 255u, 256u, 0x7FFFFFFFu, 0x80000000u, 0xFFFFFF00u, 0xFFFFFFFFu})
    for (const uint32_t n : {1u, 2u, 3u, 128u, 384u, 4096u})
      for (uint32_t k = 0; k < n; ++k) {
        const vec2 u = hammersley(k, n, uvec2(shift, ~shift));
        ASSERT_GT(std::min(u.x, u.y), 0.0f) << k << " of " << n << " shifted by " << shift;
        ASSERT_LT(std::max(u.x, u.y), 1.0f) << k << " of " << n << " shifted by " << shift;
        const vec3 d = cosineDirection(u);
        ASSERT_TRUE(std::isfinite(d.x) && std::isfinite(d.y) && d.z > 0.0f);
        ASSERT_NEAR(glm::length(d), 1.0f, 2e-6f);
      }
}

TEST(Sampling, UnshiftedSetIsHammersley) {
  // Van der Corput's first eight, and (k + 1/2) / n.
  const float expected[] = {0, 0.5f, 0.25f, 0.75f, 0.125f, 0.625f, 0.375f, 0.875f};
  for (uint32_t k = 0; k < 8; ++k) {
    const vec2 u = hammersley(k, 8, uvec2(0));
    EXPECT_NEAR(u.x, (static_cast<float>(k) + 0.5f) / 8, 1e-6f);
    EXPECT_NEAR(u.y, expected[k], 1e-6f);
  }
}

TEST(Sampling, MeanDirectionIsTwoThirdsOfTheNormal) {
  // E[d] = 2/3 n for cosine-weighted directions. One random direction per shift: variances 1/4, 1/4 and 1/2 - 4/9.
  const int n = 200000;
  for (const vec3 normal : {vec3(0, 0, 1), vec3(0, 0, -1), vec3(1, 0, 0), glm::normalize(vec3(1, -2, -3))}) {
    glm::dvec3 sum(0);
    for (int i = 0; i < n; ++i) {
      const uvec4 s = rayShifts(static_cast<uint32_t>(i), 7, 1);
      sum += glm::dvec3(toWorld(cosineDirection(hammersley(5, 64, uvec2(s))), normal));
    }
    const glm::dvec3 error = sum / double{n} - 2.0 / 3 * glm::dvec3(normal);
    EXPECT_LT(std::abs(glm::dot(error, glm::dvec3(normal))), 3 * std::sqrt(1.0 / 18 / n));
    EXPECT_LT(glm::length(error), 4 * std::sqrt(0.25 / n));
  }
}

TEST(Sampling, SetsAreStratified) {
  // A shifted set of n still has one point in each n-th of [0, 1) along u1; so E[cos] is exact to 1/n per set.
  for (uint32_t voxel = 0; voxel < 50; ++voxel) {
    std::set<int> strata;
    const uvec4 s = rayShifts(voxel, 0, 1);
    for (uint32_t k = 0; k < 256; ++k) {
      const float u = hammersley(k, 256, uvec2(s)).x - static_cast<float>(s.x % (1u << 24)) / 4294967296.0f;
      strata.insert(static_cast<int>(std::floor((u + 1) * 256)) % 256);
    }
    EXPECT_EQ(strata.size(), 256u) << voxel;
  }
}

TEST(Sampling, ChiSquare) {
  // 64 x 64 equal cells of the square under the shifts of 409,600 voxels: chi^2 with 4095 degrees of freedom,
  // sigma 90.5.
  std::vector<int> cells(4096);
  const int n = 409600;
  for (int i = 0; i < n; ++i) {
    const uvec4 s = rayShifts(static_cast<uint32_t>(i), 1, 1);
    const vec2 u = hammersley(0, 1, uvec2(s));
    ++cells[static_cast<size_t>(u.x * 64) * 64 + static_cast<size_t>(u.y * 64)];
  }
  double chi2 = 0;
  for (const int c : cells) chi2 += (c - 100.0) * (c - 100.0) / 100.0;
  EXPECT_NEAR(chi2, 4095, 4 * 90.5);
}

TEST(Sampling, BasisIsOrthonormalForEveryNormal) {
  for (uint32_t i = 0; i < 2000; ++i) {
    vec3 n = i == 0 ? vec3(0, 0, -1) : i == 1 ? vec3(0, 0, 1) : cosineDirection(hammersley(i, 2000, uvec2(9, 77)));
    if (i % 2 && i > 1) n.z = -n.z;
    const vec3 t = toWorld(vec3(1, 0, 0), n), b = toWorld(vec3(0, 1, 0), n);
    EXPECT_NEAR(glm::dot(t, n), 0, 2e-6f);
    EXPECT_NEAR(glm::dot(b, n), 0, 2e-6f);
    EXPECT_NEAR(glm::dot(t, b), 0, 2e-6f);
    EXPECT_NEAR(glm::dot(glm::cross(t, b), n), 1, 4e-6f);
  }
}

TEST(Sampling, PointsOfAFacetLieOnItsPlaneInsideItsFootprint) {
  const uvec3 voxel(3, 40, 1000);
  for (uint32_t i = 0; i < 2000; ++i) {
    vec3 n = cosineDirection(hammersley(i, 2000, uvec2(5, 6)));
    if (i % 3 == 1) n = vec3(n.z, n.x, n.y);
    if (i % 3 == 2) n = vec3(n.x, -n.z, n.y);
    const float offset = (static_cast<float>(i % 11) - 5) / 10;
    const vec2 jitter = facetJitter(i, uvec2(i * 7919u, i));
    const vec3 p = facetPoint(voxel, n, offset, jitter) - (vec3(voxel) + 0.5f);
    EXPECT_NEAR(glm::dot(p, n), offset, 2e-4f);  // 1000.5 in fp32 has steps of 6e-5
    const vec3 a = glm::abs(n);
    const int major = a.z >= a.x && a.z >= a.y ? 2 : a.y >= a.x ? 1 : 0;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_TRUE(axis == major || std::abs(p[axis]) <= 0.5f + 1e-4f) << p[axis];
    }
  }
}

}  // namespace
}  // namespace irad::sampling_suite
