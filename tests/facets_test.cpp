// Prefix sum, Morton-ordered compaction, reverse map (docs/method.md 4).
#include <algorithm>
#include <numeric>

#include "gi/facets.h"
#include "gi/grid.h"
#include "gi/scan.h"
#include "gi/settings.h"
#include "gi/subsystems.h"
#include "renderer/base/error.h"
#include "renderer/gpu_scene.h"
#include "shaders/shared/normals.h"
#include "tests/soup.h"
#include "tests/support.h"

namespace irad::test::facets_suite {
namespace {

class Facets : public GpuTest {};

TEST_F(Facets, PrefixSumIsExact) {
  for (const uint32_t count :
       {0u, 1u, 2u, 63u, 64u, 2047u, 2048u, 2049u, 100'000u, 2048u * 2048u, 2048u * 2048u + 1u}) {
    std::vector<uint32_t> values(count);
    for (uint32_t i = 0; i < count; ++i) values[i] = i * 2654435761u >> 28;
    std::vector<uint32_t> expected(count);
    std::exclusive_scan(values.begin(), values.end(), expected.begin(), 0u);
    const uint32_t sum = std::accumulate(values.begin(), values.end(), 0u);
    const Buffer buffer = makeBuffer<uint32_t>(context(), "values", Subsystem::Facets, values);
    const Buffer total(context().device, "total", Subsystem::Facets, 4);
    Frame frame = context().begin();
    exclusiveScan(frame, "GI CompactList", buffer, count, total);
    frame.submitAndWait();
    EXPECT_EQ(downloadAs<uint32_t>(context(), total).at(0), sum) << count;
    if (count > 0) {
      EXPECT_EQ(downloadAs<uint32_t>(context(), buffer), expected) << count;
    }
  }
}

struct List {
  FacetList facets;
  std::vector<uint32_t> voxel, shape, reverse;
};
List compact(Context& context, const Scene& scene, const Settings& settings) {
  const SceneOnDevice device(context, scene);
  List list{makeFacets(context, device, settings), {}, {}, {}};
  list.voxel = downloadAs<uint32_t>(context, list.facets.voxel);
  list.shape = downloadAs<uint32_t>(context, list.facets.shape);
  list.reverse = downloadAs<uint32_t>(context, list.facets.reverse);
  return list;
}

TEST_F(Facets, MortonOrderAndReverseMap) {
  Soup soup;
  const uint32_t white = soup.diffuse(glm::vec3(0.5f));
  soup.box(white, {-4, -2, -1.3f}, {4, 2, 1.3f}, true);
  soup.sphere(white, {1, 0, 0}, 1, 12, false);
  soup.quad(soup.diffuse(glm::vec3(0.2f), true), {-3, -1, -1}, {2, 0.1f, 0}, {0, 1, 1});
  for (const HitRule rule : {HitRule::thesis, HitRule::triangles}) {
    Settings settings;
    settings.voxel.resolution = 37;
    settings.matrix.gpu.hitRule = rule;
    const List list = compact(context(), soup.build(), settings);
    const Grid& grid = list.facets.grid;
    ASSERT_GT(list.facets.count, 1000u);
    // Compaction of the reverse map on the CPU: voxels in Morton order.
    uint32_t next = 0, solid = 0, most = 0;
    const uint32_t bits = grid.mortonBits.x + grid.mortonBits.y + grid.mortonBits.z;
    for (uint32_t code = 0; code < 1u << bits; ++code) {
      const glm::uvec3 v = mortonDecode(code, grid.mortonBits);
      if (glm::any(glm::greaterThanEqual(v, grid.dims))) continue;
      const uint32_t entry = list.reverse[voxelIndex(v, grid.dims)];
      if (entry == NO_FACET) continue;
      ++solid;
      ASSERT_EQ(firstFacet(entry), next);
      most = std::max(most, facetsOf(entry));
      for (uint32_t i = 0; i < facetsOf(entry); ++i, ++next) ASSERT_EQ(list.voxel[next], packVoxel(v));
    }
    EXPECT_EQ(next, list.facets.count);
    EXPECT_EQ(solid, list.facets.solidVoxels);
    if (rule == HitRule::thesis)
      EXPECT_EQ(most, 1u);
    else
      EXPECT_GE(most, 3u) << "in the corners of the box";
    EXPECT_EQ(list.voxel.size(), list.facets.count);
    EXPECT_EQ(list.facets.voxel.bytes, 4ull * list.facets.count) << "exactly sized";
    EXPECT_FALSE(list.facets.hasEmission);
  }
}

TEST_F(Facets, TheSameBitsTwice) {
  Soup soup;
  soup.sphere(soup.diffuse(glm::vec3(0.5f)), {0, 0, 0}, 1, 20, true);
  Settings settings;
  const List a = compact(context(), soup.build(), settings), b = compact(context(), soup.build(), settings);
  EXPECT_EQ(a.voxel, b.voxel);
  EXPECT_EQ(a.shape, b.shape);
  EXPECT_EQ(a.reverse, b.reverse);
}

TEST_F(Facets, EmptySceneGivesAnEmptyList) {
  const List list = compact(context(), Soup().build(), Settings());
  EXPECT_EQ(list.facets.count, 0u);
  EXPECT_EQ(list.facets.solidVoxels, 0u);
  EXPECT_EQ(list.reverse, std::vector<uint32_t>(list.facets.grid.voxels, NO_FACET));
}

TEST_F(Facets, UploadedListHasItsReverseMap) {
  const Grid grid = makeGrid(glm::vec3(0), glm::vec3(1), 8);
  const std::vector<uint32_t> voxel{packVoxel({1, 2, 3}), packVoxel({1, 2, 3}), packVoxel({4, 4, 4})};
  const std::vector<uint32_t> shape{1, 2, 3};
  const std::vector<glm::uvec2> albedo(3, packAlbedo(glm::vec3(0.5f)));
  const FacetList list = uploadFacets(context(), grid, voxel, shape, albedo, {glm::vec3(0), glm::vec3(1), glm::vec3(0)},
                                      NormalEncoding::oct16);
  EXPECT_EQ(list.count, 3u);
  EXPECT_EQ(list.solidVoxels, 2u);
  EXPECT_TRUE(list.hasEmission);
  std::vector<uint32_t> expected(grid.voxels, NO_FACET);
  expected[voxelIndex({1, 2, 3}, grid.dims)] = facetEntryOf(0, 2);
  expected[voxelIndex({4, 4, 4}, grid.dims)] = facetEntryOf(2, 1);
  EXPECT_EQ(downloadAs<uint32_t>(context(), list.reverse), expected);
  const FacetArrays record = downloadAs<FacetArrays>(context(), list.record).at(0);
  Frame frame = context().begin();
  EXPECT_EQ(record.voxel.at, UintArray(frame.pass("Look").in(list.voxel)).at);
  EXPECT_EQ(record.reverse.at, UintArray(frame.pass("Look").in(list.reverse)).at);
  EXPECT_EQ(record.count, 3u);
  EXPECT_EQ(record.hasEmission, 1u);
}

}  // namespace
}  // namespace irad::test::facets_suite
