// Rays on the device against the double-precision oracle (docs/method.md 3, 5); the traversals against each other are
// `irad check traversal`.
#include <bit>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "gi/host_facets.h"
#include "gi/ray_kernel.h"

#include "gi/oracle/rays.h"
#include "gi/subsystems.h"
#include "shaders/shared/trace.h"
#include "tests/gi_fixture.h"

namespace irad::test::trace_suite {
namespace {

class Trace : public GiTest {
 protected:
  std::vector<uint32_t> hits(const World& w, const MatrixParams& params) {
    const Buffer out(context().device, "hits", Subsystem::Matrix, 4ull * w.facets.count * params.rays);
    Frame frame = context().begin();
    traceRows(frame, rayKernel(w.facets, w.field, params), params, 0, w.facets.count, out);
    frame.submitAndWait();
    return downloadAs<uint32_t>(context(), out);
  }
  /// Compares what all rays of all facets meet, which it returns, with the oracle.
  std::vector<uint32_t> expectOracle(const World& w, const oracle::Facets& host, const MatrixParams& params) {
    const std::vector<uint32_t> met = hits(w, params);
    size_t wrong = 0, found = 0, open = 0;  // open: the oracle leaves it to the device
    for (uint32_t f = 0; f < w.facets.count; ++f)
      for (uint32_t k = 0; k < oracle::raysOf(host, f, params); ++k) {
        const oracle::Hit expected = oracle::trace(host, oracle::facetRay(host, f, k, params), params.hitRule);
        const uint32_t got = met[size_t{f} * params.rays + k];
        found += got <= TRACE_LAST_FACET;
        if (got == expected.facet) continue;
        if (expected.margin == 0) {
          ++open;
          continue;
        }
        ++wrong;
        // They may differ only where a decision is too close for fp32: 1e-3 voxels over paths of up to 50.
        EXPECT_LT(expected.margin, 1e-3) << "facet " << f << " ray " << k << ": met " << got << " instead of "
                                         << expected.facet << " at " << expected.t;
      }
    fmt::print("rule {}: {} of {} rays differ from the oracle, {} met a facet\n", nameOf(params.hitRule), wrong,
               met.size(), found);
    EXPECT_LE(wrong, met.size() / 10000);
    EXPECT_LE(open, met.size() / 50);
    EXPECT_GT(found, met.size() / 2);
    return met;
  }
};

TEST_F(Trace, HitsEqualTheOracle) {
  Settings settings = defaults();
  settings.voxel.resolution = 32;
  const World w = world(furnishedRoom(), settings);
  const oracle::Facets host = oracleFacets(context(), w.facets);
  MatrixParams params = settings.matrix.gpu;
  params.rays = 1 + 110000 / w.facets.count;
  params.traversal = TRAVERSAL_SDF;
  for (const HitRule rule : {HIT_RULE_ROBUST, HIT_RULE_THESIS}) {
    params.hitRule = rule;
    ASSERT_GE(expectOracle(w, host, params).size(), 100000u);
  }
}

TEST_F(Trace, TrianglesEqualTheOracle) {
  Settings settings = defaults();
  settings.voxel.resolution = 24;
  settings.matrix.gpu.hitRule = HIT_RULE_TRIANGLES;
  for (const Traversal traversal : {Traversal::sdf, Traversal::dda}) {
    settings.matrix.gpu.traversal = traversal;
    const World w = world(furnishedRoom(), settings);
    MatrixParams params = settings.matrix.gpu;
    params.rays = 1 + 50000 / w.facets.count;
    ASSERT_GE(expectOracle(w, oracleFacets(context(), w.facets), params).size(), 50000u);
  }
}

TEST_F(Trace, BetweenASheetAndTheWallBehindIt) {
  // A room of 32 voxels; under its ceiling, in the same voxels, a sheet of 16 x 16, .4 voxels apart (G).
  constexpr double kGap = 0.4;
  Settings settings = defaults();
  settings.voxel.resolution = 32;
  settings.voxel.facets = MAX_VOXEL_FACETS;
  SceneBuilder b;
  const uint32_t wall = b.material(glm::vec3(0.5f));
  const uint32_t sheet = b.material(glm::vec3(0.2f), glm::vec3(0), /*doubleSided=*/true);
  b.box({wall, wall, wall, wall, wall, wall}, glm::vec3(-16), {16, 15.7f, 16}, /*inward=*/true);
  const float y = 15.7f - static_cast<float>(kGap);
  b.quad(sheet, {-8, y, -8}, {8, y, -8}, {8, y, 8}, {-8, y, 8});
  const World w = world(b.finish("sheet"), settings);
  const oracle::Facets host = oracleFacets(context(), w.facets);
  const std::vector<glm::uvec2> albedo = downloadAs<glm::uvec2>(context(), w.facets.albedo);
  const auto onSheet = [&](uint32_t f) { return unpackAlbedo(albedo[f]).x < 0.3f; };
  MatrixParams params = settings.matrix.gpu;
  params.rays = 64;
  const std::vector<uint32_t> met = expectOracle(w, host, params);
  // Mean form factors to the sheet by rows of ceiling facets, across the sheet's edge far from its corners: of strips
  // one voxel wide below an edge of a half-plane at distance G, from s to s + 1 beyond the edge,
  // 1/2 (1 - sqrt((s + 1)^2 + G^2) + sqrt(s^2 + G^2)).
  std::map<int, std::pair<uint32_t, uint32_t>> strips;  // by s: rays, those that met the sheet
  for (uint32_t f = 0; f < w.facets.count; ++f) {
    const glm::ivec3 v(unpackVoxel(host.voxel[f]));
    if (onSheet(f) || host.normal(f).y > -0.5 || v.z < 13 || v.z > 20) continue;
    auto& [rays, hit] = strips[v.x - 25];  // the sheet ends at x = 25
    for (uint32_t k = 0; k < oracle::raysOf(host, f, params); ++k) {
      const uint32_t m = met[size_t{f} * params.rays + k];
      ++rays;
      hit += m <= TRACE_LAST_FACET && onSheet(m);
    }
  }
  for (int s = -3; s <= 3; ++s) {
    const auto [rays, hit] = strips[s];
    ASSERT_EQ(rays, 8 * params.rays) << s;
    const double expected = 0.5 * (1 - std::hypot(s + 1, kGap) + std::hypot(s, kGap));
    const double sigma = std::sqrt(expected * (1 - expected) / rays);
    EXPECT_NEAR(static_cast<double>(hit) / rays, expected, 3 * sigma) << "from " << s << " voxels beyond the edge";
  }
}

TEST_F(Trace, CornersAreMarkedWhereWallsMeet) {
  Settings settings = defaults();
  settings.voxel.resolution = 16;
  const World w = world(furnaceBox(0.5f), settings);
  const oracle::Facets host = oracleFacets(context(), w.facets);
  // A box of 16 voxels: exactly the cells that touch two walls are corners, and name voxels that hold the others, none
  // of which meets them convexly; the plane is clear up to two voxels before those.
  for (uint32_t f = 0; f < w.facets.count; ++f) {
    const glm::ivec3 v(unpackVoxel(host.voxel[f]));
    int walls = 0, nearest = 100;
    for (int a = 0; a < 3; ++a) {
      const int away = std::min(v[a] - 1, 16 - v[a]);
      walls += away == 0;
      if (std::abs(host.normal(f)[a]) < 0.5) nearest = std::min(nearest, away);
    }
    EXPECT_EQ((host.shape[f] & FACET_CORNER) != 0, walls >= 2) << v.x << ' ' << v.y << ' ' << v.z;
    EXPECT_EQ(host.around[f] >> AROUND_CONVEX_SHIFT, 0u) << v.x << ' ' << v.y << ' ' << v.z;
    const int named = std::popcount(host.around[f]);
    EXPECT_TRUE(walls == 3 ? named == 1 || named == 2 : named == walls - 1) << v.x << ' ' << v.y << ' ' << v.z;
    // The next wall's nearest recorded face may be one row further, where this wall records the edge itself.
    const int clear = static_cast<int>(facetClear(host.shape[f]));
    EXPECT_GE(clear, std::clamp(nearest - 2, 0, 2)) << v.x << ' ' << v.y << ' ' << v.z;
    EXPECT_LE(clear, std::clamp(nearest - 1, 0, 2)) << v.x << ' ' << v.y << ' ' << v.z;
  }
}

TEST_F(Trace, FacesEndAtConvexEdges) {
  // A block in a room: a ray that passes an edge of it outside meets neither the extension of its faces nor their
  // backs.
  Settings settings = defaults();
  settings.voxel.resolution = 32;
  const glm::dmat3 turn(glm::mat3(glm::rotate(glm::mat4(1.0f), 0.4f, glm::normalize(glm::vec3(1, 2, 3)))));
  SceneBuilder b;
  const uint32_t wall = b.material(glm::vec3(0.5f)), block = b.material(glm::vec3(0.2f));
  b.box({wall, wall, wall, wall, wall, wall}, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
  b.box({block, block, block, block, block, block}, glm::vec3(-0.4f), glm::vec3(0.4f), /*inward=*/false,
        glm::mat3(turn));
  const World w = world(b.finish("block"), settings);
  const oracle::Facets host = oracleFacets(context(), w.facets);
  const std::vector<glm::uvec2> albedo = downloadAs<glm::uvec2>(context(), w.facets.albedo);
  const auto onBlock = [&](uint32_t f) { return unpackAlbedo(albedo[f]).x < 0.3f; };
  MatrixParams params = settings.matrix.gpu;
  params.rays = 128;
  const std::vector<uint32_t> met = hits(w, params);
  const double half = 0.4 / w.facets.grid.edge;
  const glm::dvec3 centre = glm::dvec3(w.facets.grid.dims) * 0.5;
  size_t missing = 0, metBlock = 0, lost = 0, blockRays = 0, invalid = 0;
  for (uint32_t f = 0; f < w.facets.count; ++f)
    for (uint32_t k = 0; k < oracle::raysOf(host, f, params); ++k) {
      const uint32_t hit = met[size_t{f} * params.rays + k];
      if (onBlock(f)) {
        ++blockRays;
        invalid += hit == TRACE_INVALID;
        continue;
      }
      // How much of the ray lies within a voxel of the block, in the block's own axes.
      const oracle::Ray ray = oracle::facetRay(host, f, k, params);
      const glm::dvec3 o = glm::transpose(turn) * (ray.origin - centre), d = glm::transpose(turn) * ray.direction;
      double enter = 0, leave = 1e9;
      for (int a = 0; a < 3; ++a) {
        const double t0 = (-half - 1 - o[a]) / d[a], t1 = (half + 1 - o[a]) / d[a];
        enter = std::max(enter, std::min(t0, t1));
        leave = std::min(leave, std::max(t0, t1));
      }
      if (enter < leave || hit == TRACE_INVALID) continue;
      ++missing;
      lost += hit > TRACE_LAST_FACET;
      metBlock += hit <= TRACE_LAST_FACET && onBlock(hit);
    }
  fmt::print("{} rays pass the block: {} meet it, {} are lost; {} of its {} own rays are invalid\n", missing, metBlock,
             lost, invalid, blockRays);
  EXPECT_GT(missing, 100000u);
  EXPECT_LE(metBlock, missing / 1000);
  EXPECT_LE(lost, missing / 10000);
  EXPECT_LE(invalid, blockRays / 100);
}

}  // namespace
}  // namespace irad::test::trace_suite
