// Voxelization against the double-precision oracle, and known answers for walls, sheets, masks and materials
// (METHOD section 2).
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "gi/oracle/voxels.h"
#include "gi/stages.h"
#include "renderer/error.h"
#include "shaders/shared/normals.h"
#include "shaders/shared/voxelize.h"
#include "tests/soup.h"
#include "tests/support.h"

namespace irad::test {
namespace {

struct Facet {
  glm::uvec3 voxel;
  uint32_t shape;
  glm::uvec2 albedo;
  glm::vec3 emission{0};
  glm::vec3 normal() const { return decodeNormal(shape & 0xFFFFu, NORMALS_OCT16); }
  auto key() const {
    return std::make_tuple(voxel.z, voxel.y, voxel.x, shape, albedo.x, albedo.y, emission.x, emission.y, emission.z);
  }
  bool operator==(const Facet& o) const { return key() == o.key(); }
};
/// For comparisons of sets: the two facets of a voxel may swap places.
std::vector<Facet> sorted(std::vector<Facet> facets) {
  std::sort(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) { return a.key() < b.key(); });
  return facets;
}

class VoxelsTest : public GpuTest {
 protected:
  struct Result {
    Grid grid;
    std::vector<uint32_t> keys;
    std::vector<bool> solid;
    std::vector<Facet> facets;
    uint32_t clamped = 0;
    uint32_t count(glm::uvec3 voxel) const {
      return static_cast<uint32_t>(
          std::count_if(facets.begin(), facets.end(), [&](const Facet& f) { return f.voxel == voxel; }));
    }
    uint32_t solidCount() const { return static_cast<uint32_t>(std::count(solid.begin(), solid.end(), true)); }
  };
  Settings with(uint32_t resolution, uint32_t slots = 2, VoxelMethod method = VoxelMethod::conservative) {
    Settings settings;
    settings.voxel.resolution = resolution;
    settings.voxel.facets = slots;
    settings.voxel.method = method;
    return settings;
  }
  Result run(const Scene& scene, const Settings& settings) {
    const SceneOnDevice device(context(), scene);
    Voxels voxels = voxelize(context(), device, settings);
    Result result;
    result.grid = voxels.grid;
    result.keys = downloadAs<uint32_t>(context(), voxels.keys);
    result.solid.resize(result.grid.voxels);
    for (uint32_t i = 0; i < result.grid.voxels; ++i) result.solid[i] = result.keys[i] != 0;
    const FacetList list = compactFacets(context(), voxels, settings);
    result.clamped = list.clampedAlbedo;
    const auto voxel = downloadAs<uint32_t>(context(), list.voxel), shape = downloadAs<uint32_t>(context(), list.shape);
    const auto albedo = downloadAs<glm::uvec2>(context(), list.albedo);
    const auto emission = list.hasEmission ? downloadAs<glm::vec3>(context(), list.emission)
                                           : std::vector<glm::vec3>(list.count, glm::vec3(0));
    for (uint32_t i = 0; i < list.count; ++i)
      result.facets.push_back({unpackVoxel(voxel[i]), shape[i], albedo[i], emission[i]});
    return result;
  }
};

bool inner(const Grid& grid, glm::uvec3 v) {
  return glm::all(glm::greaterThanEqual(v, glm::uvec3(1))) && glm::all(glm::lessThanEqual(v, grid.dims - 2u));
}
bool onShell(const Grid& grid, glm::uvec3 v) {
  return inner(grid, v) && (glm::any(glm::equal(v, glm::uvec3(1))) || glm::any(glm::equal(v, grid.dims - 2u)));
}

/// A rotation by 31 degrees about (1, 2, 3).
glm::vec3 tilted(glm::vec3 p) {
  const glm::vec3 axis = glm::normalize(glm::vec3(1, 2, 3));
  const float angle = glm::radians(31.0f);
  return p * std::cos(angle) + glm::cross(axis, p) * std::sin(angle) + axis * glm::dot(axis, p) * (1 - std::cos(angle));
}
Scene tiltedBox(bool inwards) {
  Soup soup;
  soup.box(soup.diffuse(glm::vec3(0.5f)), tilted({-1, -0.8f, -0.6f}), tilted({2, 0, 0}), tilted({0, 1.6f, 0}),
           tilted({0, 0, 1.2f}), inwards);
  return soup.build();
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
          const Result result = run(soup.build(), with(n, 2, method));
          for (uint32_t i = 0; i < result.grid.voxels; ++i)
            ASSERT_EQ(result.solid[i], onShell(result.grid, voxelOf(i, result.grid.dims)))
                << n << " voxel " << i << (inwards ? " inwards" : " outwards") << " method "
                << static_cast<int>(method);
          EXPECT_EQ(result.facets.size(), result.solidCount()) << "perpendicular walls in a corner are not opposed";
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
      const Result result = run(scene, with(n, 1));
      const glm::uvec3 middle(glm::vec3(result.grid.dims) * 0.5f);
      ASSERT_FALSE(result.solid[voxelIndex(middle, result.grid.dims)]) << n;
      const std::vector<bool> reached = oracle::floodFill(result.grid, result.solid, middle);
      EXPECT_FALSE(reached[0]) << "leaks at N = " << n;
      EXPECT_GT(std::count(reached.begin(), reached.end(), true), n * n * n / 20) << n;
    }
}

TEST_F(VoxelsTest, RasterLeavesPinHolesThatConservativeCloses) {
  // METHOD section 2: pixel-centre coverage. Every voxel of the raster set lies on the surface; some of the surface's
  // miss.
  const Scene scene = tiltedBox(true);
  const Result raster = run(scene, with(48, 1, VoxelMethod::raster)), whole = run(scene, with(48, 1));
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
  uint32_t yes = 0, unsure = 0, wrong = 0, notLargest = 0;
  for (uint32_t i = 0; i < grid.voxels; ++i) {
    const bool solid = keys[i] != 0;
    if (expected.cover[i] == oracle::Cover::Unsure) ++unsure;
    if (expected.cover[i] == oracle::Cover::Yes) ++yes;
    if (expected.cover[i] == oracle::Cover::Yes ? !solid : expected.cover[i] == oracle::Cover::No && solid) ++wrong;
    if (!solid) continue;
    // The winner fills the voxel as no other does, half a face being full: to half a step of the key and rounding.
    const uint32_t t = keyTriangle(keys[i]);
    ASSERT_LT(t, scene.triangleCount());
    const double area = oracle::areaInside(
        oracle::toVoxels(grid, scene.positions[scene.indices[3 * t]], scene.positions[scene.indices[3 * t + 1]],
                         scene.positions[scene.indices[3 * t + 2]]),
        glm::ivec3(voxelOf(i, grid.dims)));
    if (std::min(area, 0.5) < std::min(expected.area[i], 0.5) - 1.0 / 62 - 1e-3) ++notLargest;
    EXPECT_NEAR(keys[i] >> 27, std::min(area * 62, 31.0), 1.0) << i;
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(notLargest, 0u);
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
      const Result result = run(scene, with(n, 1));
      expectCovered(result.grid, result.keys, scene);
    }
  }
  Soup ball;
  ball.sphere(ball.diffuse(glm::vec3(0.5f)), {0.1f, 0, 0}, 1, 24, false);
  for (const Scene& scene : {tiltedBox(false), ball.build()}) {
    const Result result = run(scene, with(40, 1));
    expectCovered(result.grid, result.keys, scene);
  }
}

TEST_F(VoxelsTest, WallOnACellFaceIsOneVoxelThick) {
  // A room 8 voxels wide with a partition exactly on the face between voxels 4 and 5: half-open cells give it to one.
  Soup soup;
  const uint32_t white = soup.diffuse(glm::vec3(0.5f));
  soup.box(white, glm::vec3(-4), glm::vec3(4), true);
  soup.quad(white, {0, -4, -4}, {0, 8, 0}, {0, 0, 8});
  const Result result = run(soup.build(), with(8, 2));
  const auto at = [&](uint32_t x) { return result.solid[voxelIndex({x, 4, 4}, result.grid.dims)]; };
  EXPECT_FALSE(at(4));
  EXPECT_TRUE(at(5));
  EXPECT_FALSE(at(6));
}

TEST_F(VoxelsTest, ThinWallsKeepBothSidesInEitherOrder) {
  // A wall of 0 to 3 voxels between two rooms, at several phases: wherever the wall is, a facet faces each room, and
  // the list is the same whatever the triangles' order.
  constexpr uint32_t n = 24;
  for (const float thickness : {0.0f, 0.25f, 0.5f, 1.0f, 1.5f, 2.0f, 3.0f})
    for (const float phase : {0.0f, 0.3f, 0.5f, 0.9f}) {
      Soup soup;
      const uint32_t room = soup.diffuse(glm::vec3(0.5f)), left = soup.diffuse({0.9f, 0, 0}),
                     right = soup.diffuse({0, 0.9f, 0});
      soup.box(room, glm::vec3(-0.5f * n), glm::vec3(0.5f * n), true);
      const float x = phase - 0.37f;
      soup.quad(left, {x, -0.5f * n, -0.5f * n}, {0, 0, n}, {0, n, 0});               // faces -x
      soup.quad(right, {x + thickness, -0.5f * n, -0.5f * n}, {0, n, 0}, {0, 0, n});  // faces +x
      const Result result = run(soup.build(), with(n, 2));
      // Away from the room's own corners, where perpendicular walls tie.
      const auto wall = [](std::vector<Facet> facets) {
        std::erase_if(facets, [](const Facet& f) {
          return f.voxel.x < 8 || f.voxel.x > 18 || f.voxel.y < 3 || f.voxel.y > 22 || f.voxel.z < 3 || f.voxel.z > 22;
        });
        return sorted(facets);
      };
      const std::vector<Facet> facets = wall(result.facets);
      uint32_t toLeft = 0, toRight = 0;
      for (const Facet& f : facets) {
        const bool faces = f.normal() == glm::vec3(-1, 0, 0);
        ASSERT_TRUE(faces || f.normal() == glm::vec3(1, 0, 0));
        EXPECT_EQ(f.albedo, packAlbedo(faces ? glm::vec3(0.9f, 0, 0) : glm::vec3(0, 0.9f, 0)));
        ++(faces ? toLeft : toRight);
      }
      EXPECT_EQ(toLeft, 20u * 20u) << thickness << ' ' << phase;
      EXPECT_EQ(toRight, 20u * 20u) << thickness << ' ' << phase;
      EXPECT_EQ(wall(run(soup.build(true), with(n, 2)).facets), facets) << thickness << ' ' << phase;
    }
}

TEST_F(VoxelsTest, OrderOfTrianglesWithDistinctAreasDoesNotMatter) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto random = [&] { return glm::vec3(uniform(engine), uniform(engine), uniform(engine)); };
  Soup soup;
  const uint32_t white = soup.diffuse(glm::vec3(0.5f));
  for (int i = 0; i < 60; ++i) soup.triangle(white, random(), random(), random());
  const Result a = run(soup.build(), with(24, 2)), b = run(soup.build(true), with(24, 2));
  ASSERT_EQ(a.solid, b.solid);
  // The best key is the same in both orders. Only its last bits, which decide between equals, name another triangle:
  // one that fills the voxel as much (half a face being full) to the step of the key.
  const Scene scene = soup.build();
  const auto area = [&](uint32_t t, uint32_t voxel) {
    const glm::vec3* p = &scene.positions[3 * t];
    return std::min(
        0.5, oracle::areaInside(oracle::toVoxels(a.grid, p[0], p[1], p[2]), glm::ivec3(voxelOf(voxel, a.grid.dims))));
  };
  uint32_t same = 0;
  for (uint32_t i = 0; i < a.grid.voxels; ++i) {
    if (!a.solid[i]) continue;
    ASSERT_EQ(a.keys[i] >> 24, b.keys[i] >> 24);
    const uint32_t winner = keyTriangle(a.keys[i]), other = 59 - keyTriangle(b.keys[i]);
    if (winner == other)
      ++same;
    else
      EXPECT_NEAR(area(winner, i), area(other, i), 1.0 / 62 + 1e-4) << i;
  }
  EXPECT_GT(same, a.solidCount() / 2);
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

TEST_F(VoxelsTest, SheetsHaveTheSidesTheirMaterialHas) {
  const auto sheet = [&](bool doubleSided, uint32_t slots) {
    Soup soup;
    soup.quad(soup.diffuse(glm::vec3(0.5f), doubleSided), {-4, 0, -4}, {0, 0, 8}, {8, 0, 0});  // faces +y
    return run(soup.build(), with(16, slots));
  };
  for (const uint32_t slots : {1u, 2u}) {
    const Result single = sheet(false, slots);
    EXPECT_EQ(single.facets.size(), 256u);
    for (const Facet& f : single.facets) {
      EXPECT_EQ(f.normal(), glm::vec3(0, 1, 0));
      EXPECT_EQ(f.voxel.y, 1u) << "the one inner layer";
      EXPECT_EQ(f.shape & FACET_DOUBLE_SIDED, 0u);
      EXPECT_NEAR(facetOffset(f.shape), 0.0f, 1e-4f) << "a flat scene lies in the middle of its voxels";
    }
  }
  EXPECT_EQ(sheet(true, 1).facets.size(), 256u);
  const Result both = sheet(true, 2);
  ASSERT_EQ(both.facets.size(), 512u);
  for (size_t i = 0; i < 512; i += 2) {
    EXPECT_EQ(both.facets[i].normal(), glm::vec3(0, 1, 0));
    EXPECT_EQ(both.facets[i + 1].normal(), glm::vec3(0, -1, 0));
    EXPECT_EQ(both.facets[i].voxel, both.facets[i + 1].voxel);
    EXPECT_NE(both.facets[i].shape & FACET_DOUBLE_SIDED, 0u);
  }
}

TEST_F(VoxelsTest, PlaneOffsetIsTheDistanceFromTheVoxelsCentre) {
  Soup soup;
  const uint32_t white = soup.diffuse(glm::vec3(0.5f));
  soup.box(white, glm::vec3(-8), glm::vec3(8), true);
  soup.quad(white, {-6, 0.25f, -6}, {0, 0, 12}, {12, 0, 0});  // y = 0.25: a quarter of voxel 9 of [1, 17), centre 0.5
  const Result result = run(soup.build(), with(16, 1));
  uint32_t seen = 0;
  for (const Facet& f : result.facets) {
    if (f.voxel.y != 9 || f.voxel.x < 4 || f.voxel.x > 13 || f.voxel.z < 4 || f.voxel.z > 13) continue;
    EXPECT_NEAR(facetOffset(f.shape), -0.25f, 0.5f / 127 + 1e-3f);
    ++seen;
  }
  EXPECT_EQ(seen, 100u);
}

TEST_F(VoxelsTest, MaterialsGiveAlbedoAndExitance) {
  Soup soup;
  Material metal;
  metal.baseColor = {0.8f, 0.6f, 0.4f, 1};
  metal.metallic = 0.25f;
  metal.emission = {1, 2, 0};
  soup.quad(soup.material(metal), {-4, 0, -4}, {0, 0, 8}, {8, 0, 0});
  Scene scene = soup.build();
  for (glm::vec4& color : scene.colors) color = {0.5f, 1, 1, 1};
  const Result result = run(scene, with(8, 1));
  ASSERT_EQ(result.facets.size(), 64u);
  for (const Facet& f : result.facets) {
    // base colour x vertex colour x (1 - metallic); M = pi x radiance.
    EXPECT_NEAR(unpackAlbedo(f.albedo).x, 0.8f * 0.5f * 0.75f, 2e-5f);
    EXPECT_NEAR(unpackAlbedo(f.albedo).y, 0.45f, 2e-5f);
    EXPECT_NEAR(unpackAlbedo(f.albedo).z, 0.3f, 2e-5f);
    EXPECT_NEAR(f.emission.x, M_PI, 1e-5);
    EXPECT_NEAR(f.emission.y, 2 * M_PI, 1e-5);
    EXPECT_EQ(f.emission.z, 0.0f);
  }
  EXPECT_EQ(result.clamped, 0u);
}

TEST_F(VoxelsTest, AlbedoOutOfRangeIsClampedAndCounted) {
  Soup soup;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  soup.quad(soup.diffuse({1, 0.5f, 0.98f}), {-4, 0, -4}, {0, 0, 8}, {4, 0, 0});
  soup.quad(soup.diffuse({nan, -1, 7}), {0, 0, -4}, {0, 0, 8}, {4, 0, 0});
  const Result result = run(soup.build(), with(8, 1));
  ASSERT_EQ(result.facets.size(), 64u);
  EXPECT_EQ(result.clamped, 64u);
  for (const Facet& f : result.facets) {
    const glm::vec3 expected = f.voxel.x <= 4 ? glm::vec3(0.98f, 0.5f, 0.98f) : glm::vec3(0, 0, 0.98f);
    EXPECT_EQ(f.albedo, packAlbedo(expected)) << f.voxel.x;
  }
}

TEST_F(VoxelsTest, TexturesAreSampledAtTheVoxelsPlace) {
  // 8 x 8 texels over 8 x 8 voxels: base colour green = row, one lit texel in the emissive texture, metal in the left
  // half.
  std::vector<uint8_t> color, lit, metal;
  for (int row = 0; row < 8; ++row)
    for (int column = 0; column < 8; ++column) {
      color.insert(color.end(), {255, static_cast<uint8_t>(row * 20), 0, 255});
      const uint8_t on = row == 2 && column == 5 ? 255 : 0;
      lit.insert(lit.end(), {on, on, on, 255});
      metal.insert(metal.end(), {0, 255, static_cast<uint8_t>(column < 4 ? 255 : 0), 255});
    }
  Soup soup;
  Material m;
  m.baseColor = {0.5f, 1, 1, 1};
  m.baseColorTexture.image = soup.image(8, 8, color);
  m.metallicRoughnessTexture.image = soup.image(8, 8, metal);
  m.emissiveTexture.image = soup.image(8, 8, lit);
  m.emission = glm::vec3(3);
  soup.quad(soup.material(m), {-4, 0, -4}, {8, 0, 0}, {0, 0, 8});  // u along x, v along z; faces -y
  const Result result = run(soup.build(), with(8, 1));
  ASSERT_EQ(result.facets.size(), 64u);
  for (const Facet& f : result.facets) {
    const uint32_t column = f.voxel.x - 1, row = f.voxel.z - 1;
    const glm::vec3 albedo = unpackAlbedo(f.albedo);
    // Cut by the diagonal, a voxel is sampled off its centre by up to a third of a texel; metalness blends there too.
    if (column == row) continue;
    EXPECT_NEAR(albedo.x, column < 4 ? 0.0f : 0.5f, 0.01f) << column << ' ' << row;
    if (column >= 4) {
      EXPECT_NEAR(albedo.y, row * 20 / 255.0f, 0.01f) << row;
    }
    EXPECT_NEAR(f.emission.x, row == 2 && column == 5 ? 3 * M_PI : 0.0, 0.1) << column << ' ' << row;
  }
}

TEST_F(VoxelsTest, AlphaMaskCutsAway) {
  // Left half transparent; the cutoff is not the value half way between two texels.
  std::vector<uint8_t> rgba;
  for (int i = 0; i < 64; ++i) rgba.insert(rgba.end(), {255, 255, 255, static_cast<uint8_t>(i % 8 < 4 ? 0 : 255)});
  for (const VoxelMethod method : {VoxelMethod::conservative, VoxelMethod::raster}) {
    Soup soup;
    Material m;
    m.metallic = 0;
    m.alpha = AlphaMode::Mask;
    m.alphaCutoff = 0.6f;
    m.doubleSided = true;
    m.baseColorTexture.image = soup.image(8, 8, rgba);
    m.baseColorTexture.sampler.u = m.baseColorTexture.sampler.v = Wrap::Clamp;
    soup.quad(soup.material(m), {-4, 0, -4}, {8, 0, 0}, {0, 0, 8});
    const Result result = run(soup.build(), with(8, 2, method));
    EXPECT_EQ(result.facets.size(), 64u) << "32 voxels, two sides";
    for (const Facet& f : result.facets) EXPECT_GE(f.voxel.x, 5u);
  }
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
    Settings settings = with(16, 1, method);
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
  EXPECT_EQ(result.facets.size(), 400u) << "opposite walls share each voxel";
}

TEST_F(VoxelsTest, SponzaAtN64) {
  const auto shared = sharedScenes();
  if (!shared) GTEST_SKIP() << "no ../shared/scenes";
  const Scene scene = loadScene(*shared / "sponza" / "sponza.glb");
  const SceneOnDevice device(context(), scene);
  for (const VoxelMethod method : {VoxelMethod::conservative, VoxelMethod::raster}) {
    const Settings settings = with(64, 2, method);
    Voxels voxels = voxelize(context(), device, settings);
    EXPECT_EQ(voxels.grid.dims, glm::uvec3(66, 29, 42));
    const std::vector<uint32_t> keys = downloadAs<uint32_t>(context(), voxels.keys);
    const FacetList list = compactFacets(context(), voxels, settings);
    std::printf("Sponza N = 64, method %d: %u facets in %u voxels, %u clamped\n", static_cast<int>(method), list.count,
                list.solidVoxels, list.clampedAlbedo);
    EXPECT_GT(list.solidVoxels, 15'000u);
    EXPECT_GT(list.count, list.solidVoxels);
    EXPECT_FALSE(list.hasEmission);
  }
}

}  // namespace
}  // namespace irad::test
