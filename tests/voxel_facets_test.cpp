// What a solid voxel holds: the sides of walls and sheets, normals, offsets, albedo, emission, masks (docs/method.md
// 2).
#include <limits>
#include <random>

#include "gi/oracle/voxels.h"
#include "shaders/shared/voxelize.h"
#include "tests/voxels_fixture.h"

namespace irad::test::voxel_facets_suite {
namespace {

using VoxelFacetsTest = VoxelsTest;

TEST_F(VoxelFacetsTest, OrderOfTrianglesDecidesBetweenEqualsOnly) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto random = [&] { return glm::vec3(uniform(engine), uniform(engine), uniform(engine)); };
  Soup soup;
  const uint32_t white = soup.diffuse(glm::vec3(0.5f));
  for (int i = 0; i < 60; ++i) soup.triangle(white, random(), random(), random());
  const Result a = run(soup.build(), with(24)), b = run(soup.build(true), with(24));
  ASSERT_EQ(a.solid, b.solid);
  // The best key is the same in both orders; only its last bits, which decide between equals, name another triangle.
  uint32_t same = 0;
  for (uint32_t i = 0; i < a.grid.voxels; ++i) {
    if (!a.solid[i]) continue;
    ASSERT_EQ(a.keys[i] >> 24, b.keys[i] >> 24);
    if (keyTriangle(a.keys[i]) == 59 - keyTriangle(b.keys[i])) ++same;
  }
  EXPECT_GT(same, a.solidCount() * 9 / 10);
}

TEST_F(VoxelFacetsTest, ASheetHasItsFrontAlone) {
  for (const bool doubleSided : {false, true}) {
    Soup soup;
    soup.quad(soup.diffuse(glm::vec3(0.5f), doubleSided), {-4, 0, -4}, {0, 0, 8}, {8, 0, 0});  // faces +y
    const Result result = run(soup.build(), with(16));
    EXPECT_EQ(result.facets.size(), 256u);
    for (const Facet& f : result.facets) {
      EXPECT_EQ(f.normal(), glm::vec3(0, 1, 0));
      EXPECT_EQ(f.voxel.y, 1u) << "the one inner layer";
      EXPECT_NEAR(facetOffset(f.shape), 0.0f, 1e-4f) << "a flat scene lies in the middle of its voxels";
    }
  }
}

TEST_F(VoxelFacetsTest, PlaneOffsetIsTheDistanceFromTheVoxelsCentre) {
  Soup soup;
  const uint32_t white = soup.diffuse(glm::vec3(0.5f));
  soup.box(white, glm::vec3(-8), glm::vec3(8), true);
  soup.quad(white, {-6, 0.25f, -6}, {0, 0, 12}, {12, 0, 0});  // y = 0.25: a quarter of voxel 9 of [1, 17), centre 0.5
  const Result result = run(soup.build(), with(16));
  uint32_t seen = 0;
  for (const Facet& f : result.facets) {
    if (f.voxel.y != 9 || f.voxel.x < 4 || f.voxel.x > 13 || f.voxel.z < 4 || f.voxel.z > 13) continue;
    EXPECT_NEAR(facetOffset(f.shape), -0.25f, 0.5f / 127 + 1e-3f);
    ++seen;
  }
  EXPECT_EQ(seen, 100u);
}

TEST_F(VoxelFacetsTest, MaterialsGiveAlbedoAndExitance) {
  Soup soup;
  Material metal;
  metal.baseColor = {0.8f, 0.6f, 0.4f, 1};
  metal.metallic = 0.25f;
  metal.emission = {1, 2, 0};
  soup.quad(soup.material(metal), {-4, 0, -4}, {0, 0, 8}, {8, 0, 0});
  Scene scene = soup.build();
  for (glm::vec4& color : scene.colors) color = {0.5f, 1, 1, 1};
  const Result result = run(scene, with(8));
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

TEST_F(VoxelFacetsTest, AlbedoOutOfRangeIsClampedAndCounted) {
  Soup soup;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  soup.quad(soup.diffuse({1, 0.5f, 0.98f}), {-4, 0, -4}, {0, 0, 8}, {4, 0, 0});
  soup.quad(soup.diffuse({nan, -1, 7}), {0, 0, -4}, {0, 0, 8}, {4, 0, 0});
  const Result result = run(soup.build(), with(8));
  ASSERT_EQ(result.facets.size(), 64u);
  EXPECT_EQ(result.clamped, 64u);
  for (const Facet& f : result.facets) {
    const glm::vec3 expected = f.voxel.x <= 4 ? glm::vec3(0.98f, 0.5f, 0.98f) : glm::vec3(0, 0, 0.98f);
    EXPECT_EQ(f.albedo, packAlbedo(expected)) << f.voxel.x;
  }
}

TEST_F(VoxelFacetsTest, TexturesAreSampledAtTheVoxelsPlace) {
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
  const Scene scene = soup.build();
  for (const VoxelMethod method : {VoxelMethod::conservative, VoxelMethod::raster}) {
    const Result result = run(scene, with(8, method));
    ASSERT_EQ(result.facets.size(), 64u);
    for (const Facet& f : result.facets) {
      const uint32_t column = f.voxel.x - 1, row = f.voxel.z - 1;
      const glm::vec3 albedo = unpackAlbedo(f.albedo);
      // Cut by the diagonal, a voxel is sampled off its centre by up to a third of a texel, unless it is where its
      // fragment was; metalness blends there too.
      if (column == row && method == VoxelMethod::conservative) continue;
      EXPECT_NEAR(albedo.x, column < 4 ? 0.0f : 0.5f, 0.01f) << column << ' ' << row;
      if (column >= 4) {
        EXPECT_NEAR(albedo.y, row * 20 / 255.0f, 0.01f) << row;
      }
      EXPECT_NEAR(f.emission.x, row == 2 && column == 5 ? 3 * M_PI : 0.0, 0.1) << column << ' ' << row;
    }
  }
}

TEST_F(VoxelFacetsTest, AlphaMaskCutsAway) {
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
    const Result result = run(soup.build(), with(8, method));
    EXPECT_EQ(result.facets.size(), 32u);
    for (const Facet& f : result.facets) EXPECT_GE(f.voxel.x, 5u);
  }
}

}  // namespace
}  // namespace irad::test::voxel_facets_suite
