// Rays on the device against the double-precision oracle (docs/method.md 3, 5); the traversals against each other are
// `irad check traversal`.
#include <cmath>
#include <cstring>

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
  std::vector<uint32_t> hits(const World& w, const MatrixParams& params, const WaitingLists& waiting = {}) {
    const Buffer out(context().device, "hits", Subsystem::Matrix, 4ull * w.facets.count * params.rays);
    Frame frame = context().begin();
    traceRows(frame, rayKernel(w.facets, w.field, params), params, 0, w.facets.count, out, /*sky=*/false,
              "GI BuildMatrix", waiting);
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

TEST_F(Trace, RaysThatWaitMeetTheSame) {
  Settings settings = defaults();
  settings.voxel.resolution = 24;
  settings.matrix.gpu.rays = 64;
  const World w = world(furnishedRoom(), settings);
  const std::vector<uint32_t> expected = hits(w, settings.matrix.gpu);
  const WaitingLists enough = makeWaitingLists(context().device, expected.size()),
                     few = makeWaitingLists(context().device, 50);  // most go on for want of room
  for (const WaitingLists* waiting : {&enough, &few}) {
    EXPECT_EQ(hits(w, settings.matrix.gpu, *waiting), expected);
    for (size_t i = 0; i < waiting->lists.size(); ++i) {
      const std::vector<uint32_t> words = downloadAs<uint32_t>(context(), waiting->lists[i]);
      WaitingHead head{};
      std::memcpy(&head, words.data(), sizeof(head));
      // Of its last round. Which rays found room among the few, and so how long they wait, is a matter of order.
      if (waiting == &enough) {
        EXPECT_GT(head.count, 0u);
      }
      EXPECT_EQ(head.groups.x, (std::min(head.count, waiting->room[i]) + WAITING_GROUP - 1) / WAITING_GROUP);
    }
  }
}

TEST_F(Trace, TheThesissHitsEqualTheOracle) {
  Settings settings = defaults();
  settings.voxel.resolution = 32;
  settings.matrix.gpu.hitRule = HIT_RULE_THESIS;
  const World w = world(furnishedRoom(), settings);
  MatrixParams params = settings.matrix.gpu;
  params.rays = 1 + 110000 / w.facets.count;
  ASSERT_GE(expectOracle(w, oracleFacets(context(), w.facets), params).size(), 100000u);
}

TEST_F(Trace, TrianglesEqualTheOracle) {
  Settings settings = defaults();
  settings.voxel.resolution = 24;
  for (const Traversal traversal : {Traversal::sdf, Traversal::dda}) {
    settings.matrix.gpu.traversal = traversal;
    const World w = world(furnishedRoom(), settings);
    MatrixParams params = settings.matrix.gpu;
    params.rays = 1 + 50000 / w.facets.count;
    ASSERT_GE(expectOracle(w, oracleFacets(context(), w.facets), params).size(), 50000u);
  }
}

}  // namespace
}  // namespace irad::test::trace_suite
