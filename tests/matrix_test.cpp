// The form-factor matrix on the device: hits, rows and sums against known answers (METHOD section 5, HARD_CASES).
#include <algorithm>
#include <bit>
#include <numeric>

#include "gi/check_scenes.h"
#include "gi/ray_kernel.h"
#include "gi/stages.h"
#include "renderer/error.h"
#include "tests/gi_fixture.h"

namespace irad::test {
namespace {

class Matrix : public GiTest {};

TEST_F(Matrix, FurnaceBoxRowSums) {
  const World w = world(furnaceBox(0.5f));
  const FormFactors m = buildMatrix(context(), w.facets, w.field, w.settings);
  const std::vector<HostRow> rows = hostRows(context(), m);
  double mean = 0, least = 2;
  for (const HostRow& r : rows) {
    mean += r.sum() / static_cast<double>(rows.size());
    least = std::min(least, r.sum());
  }
  fmt::print("facets {} mean {:.5f} min {:.5f} invalid {} escaped {}\n", rows.size(), mean, least, m.stats.invalid,
             m.stats.escaped);
  EXPECT_NEAR(mean, 1.0, 5e-5);
  EXPECT_GE(least, 0.99);
}

}  // namespace
}  // namespace irad::test
