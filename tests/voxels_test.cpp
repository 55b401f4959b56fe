// Which voxels are solid: against the double-precision oracle, and known answers for walls, bars and odd scenes
// (docs/method.md 2).
#include <random>

#include "gi/facets.h"
#include "gi/oracle/voxels.h"
#include "gi/voxelize.h"
#include "renderer/base/error.h"
#include "shaders/shared/voxelize.h"
#include "tests/voxels_fixture.h"

namespace irad::test::voxels_suite {
namespace {

bool inner(const Grid& grid, glm::uvec3 v) {
  return glm::all(glm::greaterThanEqual(v, glm::uvec3(1))) && glm::all(glm::lessThanEqual(v, grid.dims - 2u));
}
bool onShell(const Grid& grid, glm::uvec3 v) {
  return inner(grid, v) && (glm::any(glm::equal(v, glm::uvec3(1))) || glm::any(glm::equal(v, grid.dims - 2u)));
}

TEST_F(VoxelsTest, BoxHasWallsOneVoxelThick) {
  for (const VoxelMethod method : {VoxelMethod::conservative, VoxelMethod::raster})
    for (const bool inwards : {true, false})
      for (const glm::vec3 hi :
           {glm::vec3(1), glm::vec3(10.65f, 10.65f, 10.65f), glm::vec3(4, 2, 1), glm::vec3(3, 2, 1.7f)})
        for (const uint32_t n : {8u, 9u, 16u, 33u, 64u, 65u}) {
          if (n > 33 && hi.x < 10) continue;
          Soup soup;
          soup.box(soup.diffuse(glm::vec3(0.5f)), -0.5f * hi, 0.5f * hi, inwards);
          const Result result = run(soup.build(), with(n, method));
          for (uint32_t i = 0; i < result.grid.voxels; ++i)
            ASSERT_EQ(result.solid[i], onShell(result.grid, voxelOf(i, result.grid.dims)))
                << n << " voxel " << i << (inwards ? " inwards" : " outwards") << " method "
                << static_cast<int>(method);
          EXPECT_EQ(result.facets.size(), result.solidCount()) << n << " method " << static_cast<int>(method);
          for (const Facet& f : result.facets)
            EXPECT_GT(glm::dot(f.normal(), glm::vec3(f.voxel) + 0.5f - 0.5f * glm::vec3(result.grid.dims)) *
                          (inwards ? -1 : 1),
                      0.0f);
        }
}

TEST_F(VoxelsTest, WatertightAtEveryResolution) {
  Soup ball;
  ball.sphere(ball.diffuse(glm::vec3(0.5f)), {0, 0, 0}, 1, 24, true);
  const Scene scenes[] = {tiltedBox(true), ball.build()};
  for (uint32_t n = 8; n <= 65; n += n < 20 ? 1 : 9)
    for (const Scene& scene : scenes) {
      const Result result = run(scene, with(n));
      const glm::uvec3 middle(glm::vec3(result.grid.dims) * 0.5f);
      ASSERT_FALSE(result.solid[voxelIndex(middle, result.grid.dims)]) << n;
      const std::vector<bool> reached = oracle::floodFill(result.grid, result.solid, middle);
      EXPECT_FALSE(reached[0]) << "leaks at N = " << n;
      EXPECT_GT(std::count(reached.begin(), reached.end(), true), n * n * n / 20) << n;
    }
}

TEST_F(VoxelsTest, RasterLeavesPinHolesThatConservativeCloses) {
  // docs/method.md 2: pixel-centre coverage. Every voxel of the raster set lies on the surface; some of the surface's
  // miss.
  const Scene scene = tiltedBox(true);
  const Result raster = run(scene, with(48, VoxelMethod::raster)), whole = run(scene, with(48));
  const glm::uvec3 middle(glm::vec3(whole.grid.dims) * 0.5f);
  uint32_t missing = 0, outside = 0;
  for (uint32_t i = 0; i < whole.grid.voxels; ++i) {
    if (raster.solid[i] && !whole.solid[i]) ++outside;
    if (whole.solid[i] && !raster.solid[i]) ++missing;
  }
  EXPECT_LE(outside, whole.solidCount() / 1000) << "only where the rasterizer's 1/256 pixel snapping differs";
  EXPECT_GT(missing, whole.solidCount() / 10);
}

/// Compares with the oracle: sure cells must agree, unsure ones (within the band of oracle::cover) may be either.
void expectCovered(const Grid& grid, const std::vector<uint32_t>& keys, const Scene& scene) {
  const oracle::Coverage expected = oracle::voxelize(grid, scene.positions, scene.indices);
  uint32_t yes = 0, unsure = 0, wrong = 0, notBest = 0;
  for (uint32_t i = 0; i < grid.voxels; ++i) {
    const bool solid = keys[i] != 0;
    if (expected.cover[i] == oracle::Cover::Unsure) ++unsure;
    if (expected.cover[i] == oracle::Cover::Yes) ++yes;
    if (expected.cover[i] == oracle::Cover::Yes ? !solid : expected.cover[i] == oracle::Cover::No && solid) ++wrong;
    if (!solid) continue;
    const uint32_t t = keyTriangle(keys[i]);
    ASSERT_LT(t, scene.triangleCount());
    const double steps = keys[i] >> 25 & 63u;
    if (keys[i] & KEY_MIDDLE) {
      // The frontmost of those that cross the voxel's middle line wins, to a step of the key.
      if (steps < std::floor((expected.sureFront[i] - 0.004) * 64 + 32)) ++notBest;
      if (steps > std::floor((expected.possibleFront[i] + 0.004) * 64 + 32)) ++notBest;
    } else {
      // Where none does, the one with the largest area in the voxel wins, half a face being full.
      if (expected.sureFront[i] > -1) ++notBest;
      if (expected.possibleFront[i] == -1 && std::abs(steps - std::min(expected.area[i] * 126, 63.0)) > 1) ++notBest;
    }
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(notBest, 0u);
  EXPECT_GT(yes, 100u);
  EXPECT_LT(unsure, yes / 50 + 4) << "the rule must decide nearly all";
}

TEST_F(VoxelsTest, ExactSetsAgainstSeparatingAxes) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto random = [&] { return glm::vec3(uniform(engine), uniform(engine), uniform(engine)); };
  for (const float size : {2.0f, 0.3f, 0.04f}) {
    Soup soup;
    const uint32_t white = soup.diffuse(glm::vec3(0.5f));
    for (int i = 0; i < 150; ++i) {
      const glm::vec3 a = random();
      soup.triangle(white, a, a + size * random(), a + size * random());
    }
    const Scene scene = soup.build();
    for (const uint32_t n : {8u, 31u, 64u}) {
      const Result result = run(scene, with(n));
      expectCovered(result.grid, result.keys, scene);
    }
  }
  Soup ball;
  ball.sphere(ball.diffuse(glm::vec3(0.5f)), {0.1f, 0, 0}, 1, 24, false);
  for (const Scene& scene : {tiltedBox(false), ball.build()}) {
    const Result result = run(scene, with(40));
    expectCovered(result.grid, result.keys, scene);
  }
}

TEST_F(VoxelsTest, WallOnACellFaceIsOneVoxelThick) {
  // A room 8 voxels wide with a partition exactly on the face between voxels 4 and 5: half-open cells give it to one.
  Soup soup;
  const uint32_t white = soup.diffuse(glm::vec3(0.5f));
  soup.box(white, glm::vec3(-4), glm::vec3(4), true);
  soup.quad(white, {0, -4, -4}, {0, 8, 0}, {0, 0, 8});
  const Result result = run(soup.build(), with(8));
  const auto at = [&](uint32_t x) { return result.solid[voxelIndex({x, 4, 4}, result.grid.dims)]; };
  EXPECT_FALSE(at(4));
  EXPECT_TRUE(at(5));
  EXPECT_FALSE(at(6));
}

TEST_F(VoxelsTest, DegenerateAndRepeatedTrianglesChangeNothing) {
  const auto make = [](bool extra) {
    Soup soup;
    const uint32_t white = soup.diffuse(glm::vec3(0.5f)), red = soup.diffuse({0.9f, 0, 0});
    soup.box(white, glm::vec3(-4), glm::vec3(4), true);
    soup.sphere(white, {0, 0, 0}, 1.5f, 12, false);
    if (extra) {
      soup.triangle(red, glm::vec3(1), glm::vec3(1), glm::vec3(1));            // a point
      soup.triangle(red, {-3, 0.1f, 0.2f}, {3, 0.1f, 0.2f}, {0, 0.1f, 0.2f});  // a segment
      soup.triangle(red, {-3, -2.1f, 0.3f}, {3, 2.3f, 0.9f},
                    0.3f * glm::vec3(-3, -2.1f, 0.3f) + 0.7f * glm::vec3(3, 2.3f, 0.9f));
      soup.triangle(red, {-3, 3, 3}, {3, 3, 3}, {0, 3.000001f, 3});  // a sliver of 4 ulp
      soup.triangle(white, {-4, -4, -4}, {4, -4, -4}, {4, -4, -4});
      soup.box(white, glm::vec3(-4), glm::vec3(4), true);  // repeated
    }
    return soup.build();
  };
  const Result plain = run(make(false), with(32)), extra = run(make(true), with(32));
  EXPECT_EQ(plain.facets, extra.facets);
}

TEST_F(VoxelsTest, PowersOfTwoGiveTheSameBits) {
  const Scene scene = tiltedBox(true);
  const Result one = run(scene, with(40));
  for (const int exponent : {-10, 13}) {
    Scene scaled = scene;
    const float s = std::ldexp(1.0f, exponent);
    for (glm::vec3& p : scaled.positions) p *= s;
    scaled.boundsMin *= s;
    scaled.boundsMax *= s;
    const Result result = run(scaled, with(40));
    EXPECT_EQ(result.keys, one.keys) << exponent;
    EXPECT_EQ(result.facets, one.facets) << exponent;
  }
}

TEST_F(VoxelsTest, FarFromTheLocalOriginTheSetIsTheSame) {
  // The loader centres scenes; even where it does not, a box moved by a whole number of units keeps its voxels.
  Soup near, far;
  near.box(near.diffuse(glm::vec3(0.5f)), glm::vec3(-4), glm::vec3(4), true);
  far.box(far.diffuse(glm::vec3(0.5f)), glm::vec3(4092), glm::vec3(4100), true);
  EXPECT_EQ(run(near.build(), with(32)).solid, run(far.build(), with(32)).solid);
}

TEST_F(VoxelsTest, LiteralThesisLosesThreeWalls) {
  // T eq. 5-7 to the letter: the walls at p == max fall on index N, outside.
  Soup soup;
  soup.box(soup.diffuse(glm::vec3(0.5f)), glm::vec3(-1), glm::vec3(1), true);
  for (const VoxelMethod method : {VoxelMethod::raster, VoxelMethod::conservative}) {
    Settings settings = with(16, method);
    settings.thesis.literal = true;
    const Result result = run(soup.build(), settings);
    ASSERT_EQ(result.grid.dims, glm::uvec3(16));
    EXPECT_EQ(result.solidCount(), 16u * 16 * 16 - 15u * 15 * 15) << "three walls of six";
  }
}

TEST_F(VoxelsTest, EmptySceneAndPoint) {
  EXPECT_EQ(run(Soup().build(), with(16)).facets.size(), 0u);
  Soup point;
  point.triangle(point.diffuse(glm::vec3(0.5f)), glm::vec3(1), glm::vec3(1), glm::vec3(1));
  const Result result = run(point.build(), with(16));
  EXPECT_EQ(result.grid.dims, glm::uvec3(3));
  EXPECT_EQ(result.facets.size(), 0u) << "no area, no surface";
}

TEST_F(VoxelsTest, ThousandToOneBar) {
  Soup soup;
  soup.box(soup.diffuse(glm::vec3(0.5f)), glm::vec3(0), glm::vec3(1000, 1, 1), false);
  const Result result = run(soup.build(), with(200));
  EXPECT_EQ(result.grid.dims, glm::uvec3(202, 3, 3));
  EXPECT_EQ(result.solidCount(), 200u);
  EXPECT_EQ(result.facets.size(), 200u);
}

TEST_F(VoxelsTest, SponzaAtN64) {
  const auto shared = sharedScenes();
  if (!shared) GTEST_SKIP() << "no ../shared/scenes";
  const Scene scene = loadScene(*shared / "sponza" / "sponza.glb");
  const SceneOnDevice device(context(), scene);
  for (const VoxelMethod method : {VoxelMethod::conservative, VoxelMethod::raster}) {
    const Settings settings = with(64, method);
    Voxels voxels = voxelize(context(), device, settings);
    EXPECT_EQ(voxels.grid.dims, glm::uvec3(66, 29, 42));
    const std::vector<uint32_t> keys = downloadAs<uint32_t>(context(), voxels.keys);
    const FacetList list = compactFacets(context(), voxels, settings);
    std::printf("Sponza N = 64, method %d: %u facets in %u voxels, %u clamped\n", static_cast<int>(method), list.count,
                list.solidVoxels, list.clampedAlbedo);
    EXPECT_GT(list.solidVoxels, 15'000u);
    EXPECT_EQ(list.count, list.solidVoxels);
    EXPECT_FALSE(list.hasEmission);
  }
}

}  // namespace
}  // namespace irad::test::voxels_suite
