// Sweeps that a solve still needs, from the bounds so far.
#include "gi/convergence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace irad::convergence_suite {
namespace {

std::vector<BoundSample> shrinking(double factor, uint64_t step, size_t count) {
  std::vector<BoundSample> out;
  for (size_t i = 0; i < count; ++i) out.push_back({step * (i + 1), std::pow(factor, static_cast<double>(step * i))});
  return out;
}

TEST(Convergence, AGeometricSeriesIsFollowedToItsTarget) {
  for (const uint64_t step : {1, 4}) {
    const std::vector<BoundSample> samples = shrinking(0.8, step, 12);
    const double last = samples.back().bound;
    EXPECT_NEAR(sweepsLeft(samples, last * std::pow(0.8, 7)).value(), 7, 1e-6);
    EXPECT_EQ(sweepsLeft(samples, last), 0);
    EXPECT_EQ(sweepsLeft(samples, 2 * last), 0);
  }
}

TEST(Convergence, OnlyTheLastSamplesCount) {
  std::vector<BoundSample> samples = shrinking(0.5, 1, 20);  // fast at first, then by a tenth per sweep
  for (int i = 0; i < 8; ++i) samples.push_back({samples.back().sweeps + 1, samples.back().bound * 0.9});
  EXPECT_NEAR(sweepsLeft(samples, samples.back().bound * std::pow(0.9, 10)).value(), 10, 1e-6);
}

TEST(Convergence, WhatDoesNotShrinkHasNoEnd) {
  EXPECT_FALSE(sweepsLeft({}, 1));
  EXPECT_FALSE(sweepsLeft(shrinking(0.8, 1, 1), 1e-3));
  EXPECT_FALSE(sweepsLeft(shrinking(1.1, 1, 10), 1e-3));
  EXPECT_FALSE(sweepsLeft(shrinking(1.0, 1, 10), 1e-3));
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(sweepsLeft(std::vector<BoundSample>{{1, infinite}, {2, infinite}}, 1));
}

}  // namespace
}  // namespace irad::convergence_suite
