// Statistics of timings: percentiles by nearest rank, sums per frame, the CSV of T Tables 6-10.
#include "renderer/timings.h"

#include <gtest/gtest.h>

#include <sstream>

namespace irad {
namespace {

TEST(Statistics, KnownAnswers) {
  // 1..10 in any order: mean 5.5, sample deviation sqrt(82.5 / 9), ranks 5, 10 and 10.
  const TimingStats s = statistics({10, 1, 9, 2, 8, 3, 7, 4, 6, 5});
  EXPECT_DOUBLE_EQ(s.mean, 5.5);
  EXPECT_DOUBLE_EQ(s.min, 1);
  EXPECT_DOUBLE_EQ(s.max, 10);
  EXPECT_NEAR(s.std, 3.0276503540974917, 1e-12);
  EXPECT_DOUBLE_EQ(s.p50, 5);
  EXPECT_DOUBLE_EQ(s.p95, 10);
  EXPECT_DOUBLE_EQ(s.p99, 10);
  EXPECT_EQ(s.samples, 10u);
}

TEST(Statistics, RanksOfAHundred) {
  std::vector<double> v;
  for (int i = 100; i >= 1; --i) v.push_back(i);
  const TimingStats s = statistics(v);
  EXPECT_DOUBLE_EQ(s.p50, 50);
  EXPECT_DOUBLE_EQ(s.p95, 95);
  EXPECT_DOUBLE_EQ(s.p99, 99);
}

TEST(Statistics, NoneAndOne) {
  EXPECT_EQ(statistics({}).samples, 0u);
  const TimingStats one = statistics({4});
  EXPECT_DOUBLE_EQ(one.mean, 4);
  EXPECT_DOUBLE_EQ(one.std, 0);
  EXPECT_DOUBLE_EQ(one.p50, 4);
  EXPECT_DOUBLE_EQ(one.p99, 4);
}

TEST(Timings, PassesOfAStageAddUpAndSetUpStaysApart) {
  Timings timings;
  timings.add("GI Solve", 1);
  timings.add("RE Forward", 10);
  timings.add("GI Solve", 2);
  timings.endFrame(0, /*setup=*/true, 20);
  for (int frame = 1; frame <= 2; ++frame) {
    timings.add("GI Solve", 5 * frame);
    timings.endFrame(frame, /*setup=*/false, 30);
  }
  const std::vector<Timings::Row> rows = timings.rows();
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].stage, "GI Solve");
  EXPECT_TRUE(rows[0].setup);
  EXPECT_DOUBLE_EQ(rows[0].stats.mean, 3);
  EXPECT_EQ(rows[1].stage, "RE Forward");
  EXPECT_EQ(rows[2].stage, "GI Solve");
  EXPECT_FALSE(rows[2].setup);
  EXPECT_DOUBLE_EQ(rows[2].stats.mean, 7.5);
  EXPECT_EQ(rows[2].stats.samples, 2u);

  std::ostringstream csv;
  writeCsv(csv, timings);
  EXPECT_EQ(csv.str().substr(0, csv.str().find('\n')),
            "subsystem,kind,mean_ms,min_ms,max_ms,std_ms,p50_ms,p95_ms,p99_ms,samples");
  EXPECT_NE(csv.str().find("\nGI Solve,setup,3.000000,3.000000,3.000000,0.000000,3.000000,3.000000,3.000000,1\n"),
            std::string::npos)
      << csv.str();
  timings.reset();
  EXPECT_TRUE(timings.rows().empty());
}

TEST(Timings, WorkGivenUpIsNoSample) {
  Timings timings;
  timings.add("GI BuildMatrix", 1000);
  timings.forget();
  timings.add("RE Forward", 1);
  timings.endFrame(0, /*setup=*/false, 1);
  ASSERT_EQ(timings.rows().size(), 1u);
  EXPECT_EQ(timings.rows()[0].stage, "RE Forward");
}

TEST(Timings, TheWindowKeepsTheLastOfEitherKind) {
  Timings timings(/*window=*/3);
  for (int i = 0; i < 10; ++i) {
    timings.add("GI BuildMatrix", 100 + i);
    timings.endFrame(i, /*setup=*/true, 0);
    for (int j = 0; j < 2; ++j) {
      timings.add("RE Forward", 2 * i + j);
      timings.endFrame(i, /*setup=*/false, 0);
    }
  }
  EXPECT_EQ(timings.frames().size(), 6u);
  EXPECT_EQ(timings.recorded(), 30u);
  const std::vector<Timings::Row> rows = timings.rows();
  ASSERT_EQ(rows.size(), 2u);
  for (const Timings::Row& row : rows) {
    EXPECT_EQ(row.stats.samples, 3u);
    EXPECT_EQ(row.stats.min, row.setup ? 107 : 17);
    EXPECT_EQ(row.stats.max, row.setup ? 109 : 19);
  }
  timings.reset();
  timings.endFrame(0, /*setup=*/false, 0);
  EXPECT_EQ(timings.frames().size(), 1u);
}

}  // namespace
}  // namespace irad
