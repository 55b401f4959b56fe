// The voxel grid (docs/method.md 2): dimensions, padding, centring, range errors, Morton codes.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "gi/grid.h"
#include "gi/thesis/literal_grid.h"
#include "renderer/base/error.h"

namespace irad::grid_suite {
namespace {

glm::vec3 voxelCoordinates(const Grid& grid, glm::vec3 p) {
  return (p - grid.origin) * grid.inverseEdge;
}

TEST(Grid, CubeHasNVoxelsAndOneOfPadding) {
  for (const uint32_t n : {1u, 8u, 9u, 64u, 65u, 256u, 1022u}) {
    const Grid grid = makeGrid({-5, -5, -5}, {5, 5, 5}, n);
    EXPECT_EQ(grid.dims, glm::uvec3(n + 2)) << n;
    EXPECT_NEAR(grid.edge, 10.0 / n, 10.0 / n * 0.01 / n * 1.0 + 1e-9);
    // The walls lie in the outermost inner cells, alike on both sides.
    const glm::vec3 lo = voxelCoordinates(grid, {-5, -5, -5}), hi = voxelCoordinates(grid, {5, 5, 5});
    for (int a = 0; a < 3; ++a) {
      EXPECT_EQ(std::floor(lo[a]), 1.0f);
      EXPECT_EQ(std::floor(hi[a]), static_cast<float>(n));
      EXPECT_NEAR(lo[a] - 1.0f, n + 1 - hi[a], 1e-6 * n + 1e-6);
    }
  }
}

TEST(Grid, SponzaDimensions) {
  // T Table 2: 3720.85 x 1555.88 x 2288.23 at N = 256 has edge 14.535; ceil(107.05), ceil(157.43), + 2.
  const Grid grid = makeGrid(glm::vec3(0), {3720.854f, 1555.876f, 2288.233f}, 256);
  EXPECT_EQ(grid.dims, glm::uvec3(258, 110, 160));
  EXPECT_NEAR(grid.edge, 14.535, 1e-3);
  EXPECT_EQ(grid.voxels, 258u * 110u * 160u);
  EXPECT_EQ(grid.mortonBits, glm::uvec3(9, 7, 8));
}

TEST(Grid, WholeNumbersOfVoxelsAreNotRoundedUp) {
  // Halves and quarters of the longest axis, with rounding noise in the bounds.
  for (const float noise : {0.0f, 1e-6f, -1e-6f}) {
    const Grid grid = makeGrid({-4, -2, -1}, {4, 2 + noise, 1 - noise}, 64);
    EXPECT_EQ(grid.dims, glm::uvec3(66, 34, 18)) << noise;
  }
}

TEST(Grid, EveryCornerOfTheBoundsLiesInAnInnerCell) {
  // Awkward extents and positions, far from the origin too (fp32 local coordinates are all there is).
  uint32_t state = 1;
  const auto random = [&state] {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 8) / 16777216.0f;
  };
  for (int i = 0; i < 20000; ++i) {
    const float scale = std::pow(10.0f, random() * 8 - 4);
    const glm::vec3 lo = glm::vec3(random(), random(), random()) * scale - scale * 0.5f;
    const glm::vec3 extent = glm::vec3(random(), random() * random(), i % 3 == 0 ? 0.0f : random()) * scale;
    const uint32_t n = 1 + static_cast<uint32_t>(random() * 1021);
    const glm::vec3 hi = lo + extent;
    const Grid grid = makeGrid(lo, hi, n);
    for (int a = 0; a < 3; ++a) {
      ASSERT_GE(voxelCoordinates(grid, lo)[a], 1.0f) << n << " axis " << a;
      ASSERT_LT(voxelCoordinates(grid, hi)[a], static_cast<float>(grid.dims[a] - 1)) << n << " axis " << a;
      ASSERT_LE(grid.dims[a], n + 2);
    }
  }
}

TEST(Grid, FlatAndEmptyScenesHaveAMiddle) {
  const Grid flat = makeGrid({-1, 3, -1}, {1, 3, 1}, 64);
  EXPECT_EQ(flat.dims, glm::uvec3(66, 3, 66));
  EXPECT_NEAR(voxelCoordinates(flat, {0, 3, 0}).y, 1.5f, 1e-4f);
  const Grid point = makeGrid({7, 7, 7}, {7, 7, 7}, 64);
  EXPECT_EQ(point.dims, glm::uvec3(3));
  EXPECT_EQ(point.edge, 1.0f);
  EXPECT_EQ(voxelCoordinates(point, {7, 7, 7}), glm::vec3(1.5f));
}

TEST(Grid, PowersOfTwoScaleExactly) {
  const glm::vec3 lo(-3.1f, -0.7f, -2.9f), hi(5.3f, 1.1f, 0.2f);
  const Grid one = makeGrid(lo, hi, 100);
  for (const int exponent : {-10, -1, 1, 13}) {
    const float s = std::ldexp(1.0f, exponent);
    const Grid scaled = makeGrid(lo * s, hi * s, 100);
    EXPECT_EQ(scaled.dims, one.dims);
    EXPECT_EQ(scaled.edge, one.edge * s);
    EXPECT_EQ(scaled.origin, one.origin * s);
    EXPECT_EQ(voxelCoordinates(scaled, glm::vec3(0.3f) * s), voxelCoordinates(one, glm::vec3(0.3f)));
  }
}

TEST(Grid, ResolutionOutOfRangeIsAUsageError) {
  EXPECT_THROW(makeGrid(glm::vec3(0), glm::vec3(1), 1023), UsageError);
  EXPECT_THROW(makeGrid(glm::vec3(0), glm::vec3(1), 0), UsageError);
  EXPECT_NO_THROW(makeGrid(glm::vec3(0), glm::vec3(1), 1022));
}

TEST(Grid, LiteralGridLosesItsUpperWall) {
  // T eq. 5: floor, no padding; p == max maps to index N.
  const Grid grid = makeLiteralGrid(glm::vec3(0), {4, 2.1f, 1}, 64);
  EXPECT_EQ(grid.dims, glm::uvec3(64, 33, 16));
  EXPECT_EQ(std::floor(voxelCoordinates(grid, {4, 0, 0}).x), 64.0f);
}

TEST(Morton, EveryVoxelOnceInBlocksOf64) {
  const Grid grid = makeGrid({0, 0, 0}, {8, 3, 0}, 24);
  ASSERT_EQ(grid.dims, glm::uvec3(26, 11, 3));
  EXPECT_EQ(grid.mortonBits, glm::uvec3(5, 4, 2));
  std::vector<int> seen(32 * 16 * 4, 0);
  for (uint32_t code = 0; code < seen.size(); ++code) {
    const glm::uvec3 v = mortonDecode(code, grid.mortonBits);
    ASSERT_TRUE(v.x < 32 && v.y < 16 && v.z < 4);
    ++seen[v.x + 32 * (v.y + 16 * v.z)];
    // 64 consecutive codes are an aligned block of 4 x 4 x 4.
    EXPECT_EQ(v / 4u * 4u, mortonDecode(code / 64 * 64, grid.mortonBits));
  }
  for (const int count : seen) EXPECT_EQ(count, 1);
  EXPECT_EQ(mortonDecode(7, grid.mortonBits), glm::uvec3(1, 1, 1));
}

TEST(Grid, VoxelsPackAndIndexRoundTrip) {
  const glm::uvec3 dims(26, 11, 1024);
  for (const glm::uvec3 v : {glm::uvec3(0), glm::uvec3(25, 10, 1023), glm::uvec3(3, 7, 512)}) {
    EXPECT_EQ(unpackVoxel(packVoxel(v)), v);
    EXPECT_EQ(voxelOf(voxelIndex(v, dims), dims), v);
  }
}

}  // namespace
}  // namespace irad::grid_suite
