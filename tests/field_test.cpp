// Distance fields against brute force (docs/method.md 3).
#include <cmath>
#include <cstring>
#include <random>

#include "gi/facets.h"
#include "gi/field.h"
#include "gi/grid.h"
#include "gi/oracle/fields.h"
#include "gi/subsystems.h"
#include "gi/thesis/jump_flood.h"
#include "gi/views/fields.h"
#include "shaders/shared/view.h"
#include "shaders/shared/voxelize.h"
#include "tests/support.h"

namespace irad::test::field_suite {
namespace {

class FieldTest : public GpuTest {
 protected:
  FacetList solids(const Grid& grid, const std::vector<bool>& solid) {
    std::vector<uint32_t> voxel;
    for (uint32_t i = 0; i < grid.voxels; ++i)
      if (solid[i]) voxel.push_back(packVoxel(voxelOf(i, grid.dims)));
    const std::vector<uint32_t> shape(voxel.size(), 1);
    const std::vector<glm::uvec2> albedo(voxel.size());
    return uploadFacets(context(), grid, voxel, shape, albedo, {}, NormalEncoding::oct16);
  }
  std::vector<uint8_t> chebyshev(const Grid& grid, const std::vector<bool>& solid) {
    Settings settings;
    settings.field.method = FieldMethod::chebyshev;
    const Field field = buildField(context(), solids(grid, solid), settings);
    EXPECT_EQ(field.chebyshev.bytes % 4, 0u);
    std::vector<uint8_t> bytes = downloadAs<uint8_t>(context(), field.chebyshev);
    bytes.resize(grid.voxels);
    return bytes;
  }
};

std::vector<bool> randomSolids(const Grid& grid, double share, uint32_t seed) {
  std::mt19937 engine(seed);
  std::bernoulli_distribution take(share);
  std::vector<bool> solid(grid.voxels);
  for (auto&& voxel : solid) voxel = take(engine);
  return solid;
}
std::vector<bool> shell(const Grid& grid) {
  std::vector<bool> solid(grid.voxels);
  for (uint32_t i = 0; i < grid.voxels; ++i) {
    const glm::uvec3 v = voxelOf(i, grid.dims);
    const bool padding = glm::any(glm::equal(v, glm::uvec3(0))) || glm::any(glm::equal(v, grid.dims - 1u));
    solid[i] = !padding && (glm::any(glm::equal(v, glm::uvec3(1))) || glm::any(glm::equal(v, grid.dims - 2u)));
  }
  return solid;
}

TEST_F(FieldTest, ChebyshevIsExact) {
  const Grid cube = makeGrid(glm::vec3(0), glm::vec3(1), 22);
  const Grid odd = makeGrid(glm::vec3(0), {3, 1, 0.6f}, 35);  // rows that are no multiple of four bytes
  ASSERT_NE(odd.dims.x % 4, 0u);
  for (const Grid& grid : {cube, odd}) {
    EXPECT_EQ(chebyshev(grid, shell(grid)), oracle::chebyshev(grid, shell(grid)));
    for (const double share : {0.0005, 0.005, 0.05, 0.5}) {
      const std::vector<bool> solid = randomSolids(grid, share, 11);
      EXPECT_EQ(chebyshev(grid, solid), oracle::chebyshev(grid, solid)) << share;
    }
  }
}

TEST_F(FieldTest, ChebyshevStopsAt255) {
  // One solid voxel at the end of a bar of 402 voxels, along each axis in turn.
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 extent(1);
    extent[axis] = 400;
    const Grid grid = makeGrid(glm::vec3(0), extent, 400);
    ASSERT_EQ(grid.dims[axis], 402u);
    std::vector<bool> solid(grid.voxels);
    solid[voxelIndex({1, 1, 1}, grid.dims)] = true;
    const std::vector<uint8_t> field = chebyshev(grid, solid);
    EXPECT_EQ(field, oracle::chebyshev(grid, solid));
    glm::uvec3 far(1);
    far[axis] = 400;
    EXPECT_EQ(field[voxelIndex(far, grid.dims)], 255);
    far[axis] = 200;
    EXPECT_EQ(field[voxelIndex(far, grid.dims)], 199);
  }
}

TEST_F(FieldTest, EmptyAndFullScenes) {
  const Grid grid = makeGrid(glm::vec3(0), glm::vec3(1), 9);
  EXPECT_EQ(chebyshev(grid, std::vector<bool>(grid.voxels, false)), std::vector<uint8_t>(grid.voxels, 255));
  EXPECT_EQ(chebyshev(grid, std::vector<bool>(grid.voxels, true)), std::vector<uint8_t>(grid.voxels, 0));
  Settings settings;
  settings.field.method = FieldMethod::jfa;
  const Field field = buildField(context(), solids(grid, std::vector<bool>(grid.voxels, false)), settings);
  for (const std::byte b : download(context(), field.jumpFlood.distance)) ASSERT_EQ(std::to_integer<int>(b), 255);
}

std::vector<uint32_t> words(const std::vector<std::byte>& bytes) {
  std::vector<uint32_t> out(bytes.size() / 4);
  std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}

TEST_F(FieldTest, JumpFloodAgainstBruteForce) {
  // Jump flooding is approximate (Rong and Tan 2006): a voxel may miss its nearest seed where another seed's region cut
  // the path of jumps. Measured over these 16 sets: at most 0.11 % of the voxels, by at most 0.77 voxels.
  const Grid grid = makeGrid(glm::vec3(0), {1, 0.7f, 0.9f}, 30);
  const uint32_t largest = std::max({grid.dims.x, grid.dims.y, grid.dims.z});
  Settings settings;
  settings.field.method = FieldMethod::jfa;
  double worstShare = 0, worstError = 0;
  for (uint32_t seed = 0; seed < 16; ++seed) {
    const double share = std::pow(10.0, -1.0 - 0.2 * seed);
    const std::vector<bool> solid = seed == 0 ? shell(grid) : randomSolids(grid, share, seed);
    const std::vector<uint32_t> exact = oracle::squaredDistance(grid, solid);
    const Field field = buildField(context(), solids(grid, solid), settings);
    EXPECT_EQ(field.jumpFlood.largest, static_cast<float>(largest));
    const std::vector<uint32_t> seeds = words(download(context(), field.jumpFlood.seeds));
    const std::vector<std::byte> distance = download(context(), field.jumpFlood.distance);
    ASSERT_EQ(seeds.size(), grid.voxels);
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < grid.voxels; ++i) {
      if (exact[i] == UINT32_MAX) {
        ASSERT_EQ(seeds[i], NO_SEED);
        continue;
      }
      ASSERT_NE(seeds[i], NO_SEED) << "every voxel learns of some seed";
      const glm::uvec3 nearest = unpackVoxel(seeds[i]);
      ASSERT_TRUE(solid[voxelIndex(nearest, grid.dims)]);
      const glm::ivec3 d = glm::ivec3(nearest) - glm::ivec3(voxelOf(i, grid.dims));
      const uint32_t found = static_cast<uint32_t>(d.x * d.x + d.y * d.y + d.z * d.z);
      ASSERT_GE(found, exact[i]);
      if (found != exact[i]) ++wrong;
      worstError = std::max(worstError, std::sqrt(found) - std::sqrt(exact[i]));
      // The 8-bit volume holds the distance to that seed, to half a step.
      ASSERT_NEAR(std::to_integer<int>(distance[i]), std::min(std::sqrt(found) / largest, 1.0) * 255, 0.501);
    }
    worstShare = std::max(worstShare, static_cast<double>(wrong) / grid.voxels);
  }
  std::printf("jump flood: at most %.4f %% of the voxels have a farther seed, by at most %.3f voxels\n",
              100 * worstShare, worstError);
  EXPECT_LT(worstShare, 0.002);
  EXPECT_LT(worstError, 1.0);
}

/// One pass of jump flooding as Rong and Tan have it: the nearest of the seeds known `step` away, the first of equals.
std::vector<uint32_t> floodOnce(const Grid& grid, const std::vector<uint32_t>& from, int step) {
  const glm::ivec3 dims(grid.dims);
  std::vector<uint32_t> to = from;
  for (uint32_t i = 0; i < grid.voxels; ++i) {
    const glm::ivec3 at(voxelOf(i, grid.dims));
    const auto distance2 = [&](uint32_t seed) {
      const glm::ivec3 d = glm::ivec3(unpackVoxel(seed)) - at;
      return seed == NO_SEED ? INT32_MAX : d.x * d.x + d.y * d.y + d.z * d.z;
    };
    for (int z = -step; z <= step; z += step)
      for (int y = -step; y <= step; y += step)
        for (int x = -step; x <= step; x += step) {
          const glm::ivec3 other = at + glm::ivec3(x, y, z);
          if (glm::any(glm::lessThan(other, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(other, dims))) continue;
          const uint32_t seed = from[voxelIndex(glm::uvec3(other), grid.dims)];
          if (distance2(seed) < distance2(to[i])) to[i] = seed;
        }
  }
  return to;
}

TEST_F(FieldTest, EveryPassOfJumpFloodingIsThatOfTheProcessor) {
  const Grid grid = makeGrid(glm::vec3(0), {1, 0.7f, 0.9f}, 20);  // 22 x 16 x 20
  const std::vector<bool> solid = randomSolids(grid, 0.004, 3);
  const FacetList facets = solids(grid, solid);
  const Buffer record = makeBuffer<Grid>(context(), "grid", Subsystem::Field, std::span(&grid, 1));
  std::vector<uint32_t> seeds(grid.voxels, NO_SEED);
  for (uint32_t i = 0; i < grid.voxels; ++i)
    if (solid[i]) seeds[i] = packVoxel(voxelOf(i, grid.dims));
  ASSERT_EQ(jumpFloodPasses(grid), 5u);  // steps 16, 8, 4, 2, 1
  for (uint32_t passes = 0; passes <= 5; ++passes) {
    if (passes > 0) seeds = floodOnce(grid, seeds, 32 >> passes);
    Frame frame = context().begin();
    const Buffer flood = recordJumpFlood(frame, "test", facets, record, passes);
    frame.submitAndWait();
    EXPECT_EQ(downloadAs<uint32_t>(context(), flood), seeds) << "after pass " << passes;
  }
  // The last is the field's.
  Settings settings;
  settings.field.method = FieldMethod::jfa;
  const Field field = buildField(context(), facets, settings);
  EXPECT_EQ(words(download(context(), field.jumpFlood.seeds)), seeds);
  EXPECT_FALSE(field.chebyshev);
}

TEST_F(FieldTest, ExactDistancesAreThoseOfBruteForce) {
  const Grid grid = makeGrid(glm::vec3(0), {1, 0.7f, 0.9f}, 26);
  for (uint32_t seed = 0; seed < 6; ++seed) {
    const std::vector<bool> solid =
        seed == 0 ? shell(grid) : randomSolids(grid, std::pow(10.0, -1.0 - 0.5 * seed), seed);
    const FacetList facets = solids(grid, solid);
    ViewFields fields;
    Frame frame = context().begin();
    const Buffer& euclidean = fields.exact(frame, facets, METRIC_EUCLIDEAN);
    const Buffer& chebyshev = fields.exact(frame, facets, METRIC_CHEBYSHEV);
    frame.submitAndWait();
    EXPECT_EQ(downloadAs<uint32_t>(context(), euclidean), oracle::squaredDistance(grid, solid)) << seed;
    std::vector<uint32_t> capped = downloadAs<uint32_t>(context(), chebyshev);
    const std::vector<uint8_t> expected = oracle::chebyshev(grid, solid);
    for (uint32_t i = 0; i < grid.voxels; ++i) ASSERT_EQ(std::min(capped[i], 255u), expected[i]) << seed << ", " << i;
  }
}

}  // namespace
}  // namespace irad::test::field_suite
