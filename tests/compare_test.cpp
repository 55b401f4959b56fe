// Metrics by their definitions; two solutions voxel by voxel.
#include <cmath>
#include <limits>

#include "gi/compare.h"
#include "gi/export.h"
#include "gi/lighting.h"
#include "tests/gi_fixture.h"
#include "tests/scene_files.h"

namespace irad::test::compare_suite {
namespace {

TEST(Metrics, AreWhatTheirNamesSay) {
  const std::vector<glm::vec4> reference{{1, 2, 0, 9}, {0, 4, 1, 9}};
  const std::vector<glm::vec4> values{{2, 2, 0, 0}, {0, 1, 1, 0}};  // differences 1, 0, 0, 0, -3, 0; alpha is no light
  const Metrics m = measure(values, reference);
  EXPECT_DOUBLE_EQ(m.rmse, std::sqrt(10.0 / 6));
  EXPECT_DOUBLE_EQ(m.relMse, (1 / 1.01 + 9 / 16.01) / 6);
  EXPECT_DOUBLE_EQ(m.psnr, 20 * std::log10(4 / std::sqrt(10.0 / 6)));
  EXPECT_DOUBLE_EQ(m.meanError, -2.0 / 6);
  EXPECT_EQ(m.largest, 3);
  EXPECT_EQ(m.elements, 2u);
  EXPECT_EQ(m.leftOut, 0u);
  EXPECT_TRUE(std::isinf(measure(reference, reference).psnr));
}

TEST(Metrics, LeaveOutAndCountWhatIsNoNumber) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const std::vector<glm::vec4> reference{{1, 1, 1, 1}, {1, 1, 1, 1}, {inf, 1, 1, 1}, {1, 1, 1, 1}};
  const std::vector<glm::vec4> values{{1, nan, 1, 1}, {1, 1, -inf, 1}, {inf, 1, 1, 1}, {3, 1, 1, nan}};
  const Metrics m = measure(values, reference);
  EXPECT_EQ(m.leftOut, 3u);
  EXPECT_EQ(m.elements, 1u);
  EXPECT_DOUBLE_EQ(m.meanError, 2.0 / 3);
  EXPECT_EQ(measure({}, {}).elements, 0u);
}

class CompareVoxels : public GiTest {
 protected:
  struct Solved {
    World world;
    Lighting light;
  };
  /// H of every facet is `irradiance` of its voxel's centre.
  Solved lit(uint32_t resolution, const std::function<glm::vec3(const glm::vec3&)>& irradiance) {
    Solved s{world(lampRoom().finish("room"), at(resolution, 8)), {}};
    s.light = makeLighting(context(), s.world.facets, s.world.settings);
    const Grid& grid = s.world.facets.grid;
    std::vector<glm::vec4> h;
    for (const uint32_t packed : downloadAs<uint32_t>(context(), s.world.facets.voxel)) {
      if (h.size() == s.world.facets.count) break;
      h.emplace_back(irradiance(grid.origin + (glm::vec3(unpackVoxel(packed)) + 0.5f) * grid.edge), 0);
    }
    upload(context(), s.light.indirect, std::as_bytes(std::span(h)));
    return s;
  }
  VoxelMetrics compare(const Solved& values, const Solved& reference) {
    const auto irradiance = [&](const Solved& s) {
      return readVolume(context(), Volume::irradiance, s.world.facets, s.world.field, s.light);
    };
    return compareVoxels(irradiance(values), irradiance(reference));
  }
};

TEST_F(CompareVoxels, TheSameGridMatchesVoxelByVoxel) {
  const Solved a = lit(16, [](const glm::vec3& p) { return glm::vec3(1, 2, 3) + p.y; });
  const VoxelMetrics same = compare(a, a);
  EXPECT_EQ(same.irradiance.elements, a.world.facets.solidVoxels);
  EXPECT_EQ(same.irradiance.rmse, 0);
  EXPECT_EQ(same.onlyValues + same.onlyReference, 0u);

  const Solved b = lit(16, [](const glm::vec3& p) { return glm::vec3(1.5f, 2, 3) + p.y; });
  const VoxelMetrics brighter = compare(b, a);
  EXPECT_NEAR(brighter.irradiance.meanError, 0.5 / 3, 1e-6) << "of B against A: positive where B is brighter";
  EXPECT_NEAR(brighter.irradiance.largest, 0.5, 1e-6);
  EXPECT_NEAR(compare(a, b).irradiance.meanError, -0.5 / 3, 1e-6);
}

TEST_F(CompareVoxels, OtherGridsAreMatchedByPosition) {
  const auto slope = [](const glm::vec3& p) { return 10.0f + p; };
  const Solved coarse = lit(16, slope), fine = lit(32, slope);
  const VoxelMetrics m = compare(fine, coarse);
  EXPECT_EQ(m.irradiance.elements + m.onlyReference, coarse.world.facets.solidVoxels);
  EXPECT_GT(m.irradiance.elements, coarse.world.facets.solidVoxels / 2);
  EXPECT_GT(m.onlyValues, 0u);
  // The centres of a coarse voxel and of the fine one around it are at most half a coarse edge apart.
  EXPECT_LE(m.irradiance.largest, 0.5 * coarse.world.facets.grid.edge * 1.0001);
}

}  // namespace
}  // namespace irad::test::compare_suite
