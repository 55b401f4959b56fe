// The round numbers of axes and legends.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/base/ticks.h"

namespace irad::ticks_suite {
namespace {

void expectTicks(const std::vector<double>& got, const std::vector<double>& expected) {
  ASSERT_EQ(got.size(), expected.size());
  for (size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], expected[i], 1e-12 * (1 + std::abs(expected[i])));
}

TEST(Ticks, AreRoundAndFewEnough) {
  expectTicks(ticks(0, 1, 5), {0, 0.5, 1});
  expectTicks(ticks(0, 1, 6), {0, 0.2, 0.4, 0.6, 0.8, 1});
  expectTicks(ticks(1, 0, 5), {0, 0.5, 1});
  expectTicks(ticks(0.1, 0.9, 5), {0.2, 0.4, 0.6, 0.8});
  expectTicks(ticks(-1000, 1000, 5), {-1000, -500, 0, 500, 1000});
  expectTicks(ticks(3e-7, 9e-7, 5), {4e-7, 6e-7, 8e-7});
  EXPECT_FALSE(std::signbit(ticks(-1, 1, 5).at(2)));
}

TEST(Ticks, NoneWhereThereIsNoRange) {
  EXPECT_TRUE(ticks(3, 3, 5).empty());
  EXPECT_TRUE(ticks(0, INFINITY, 5).empty());
  EXPECT_TRUE(ticks(NAN, 1, 5).empty());
}

}  // namespace
}  // namespace irad::ticks_suite
