// The times that the window plots and lists: what it keeps of them, and what one peak does to the scale.
#include <gtest/gtest.h>

#include "tests/support.h"

#if IRAD_UI

#include <cmath>

#include "ui/plot.h"
#include "ui/timing_history.h"
#include "ui/zoom.h"

namespace irad::timing_history_suite {
namespace {

TEST(TimingHistory, KeepsTheLastTimeOfAStageHoweverLongAgo) {
  Timings timings;
  TimingHistory history;
  timings.add("GI Gather", 7);
  timings.add("RE Forward", 2);
  timings.endFrame(0, /*setup=*/false, 1);
  for (uint64_t i = 1; i < 50; ++i) {
    timings.add("RE Forward", 3);
    timings.endFrame(i, /*setup=*/false, 1);
  }
  history.update(timings);
  ASSERT_EQ(history.size(), 50u);
  TimingHistory::Stage& gather = history.stages().at(0);
  EXPECT_EQ(gather.name, "GI Gather");
  EXPECT_TRUE(std::isnan(gather.ms.back()));
  EXPECT_EQ(gather.last, 7);
  EXPECT_TRUE(history.times(gather, 49).empty());
  EXPECT_EQ(history.times(gather, 50), std::vector<double>{7});
  EXPECT_EQ(history.times(history.stages().at(1), 2), (std::vector<double>{3, 3}));
  // Longer than frames are kept.
  for (uint64_t i = 50; i < 3 * TimingHistory::kMost; ++i) {
    timings.add("RE Forward", 3);
    timings.endFrame(i, /*setup=*/false, 1);
    if (i % 1000 == 0) history.update(timings);
  }
  history.update(timings);
  EXPECT_EQ(history.stages().at(0).last, 7);
  EXPECT_TRUE(history.times(history.stages().at(0), SIZE_MAX).empty());
}

TEST(TimingHistory, OneTimeWorkIsListedBySceneAndResolution) {
  Timings timings;
  const auto build = [&](const char* of, double ms) {
    timings.about(of);
    timings.add("GI Voxelization", ms);
    timings.add("GI BuildMatrix", 10 * ms);
    timings.endFrame(0, /*setup=*/true, 1);
  };
  build("box, 64 voxels", 1);
  build("box, 96 voxels", 5);
  timings.add("RE Forward", 2);
  timings.endFrame(1, /*setup=*/false, 1);
  build("box, 64 voxels", 3);
  TimingHistory history;
  history.update(timings);
  EXPECT_EQ(history.size(), 1u) << "set-up is no frame";
  ASSERT_EQ(history.oneTime().size(), 4u);
  EXPECT_EQ(history.oneTime()[0].of, "box, 64 voxels") << "the last one is first";
  EXPECT_EQ(history.oneTime()[0].stage, "GI Voxelization");
  EXPECT_EQ(history.oneTime()[0].ms, (std::vector<double>{1, 3}));
  EXPECT_EQ(history.oneTime()[1].ms, (std::vector<double>{10, 30}));
  EXPECT_EQ(history.oneTime()[2].of, "box, 96 voxels");
  EXPECT_EQ(history.oneTime()[3].ms, std::vector<double>{50});
}

TEST(Plot, OnePeakIsCutTwoAreNot) {
  std::vector<float> y(20, 4.0f), other(20, std::nanf(""));
  const auto cut = [&] {
    const PlotLine lines[]{{"a", 0, y}, {"b", 0, other}};
    return outlier(lines);
  };
  EXPECT_FALSE(cut());
  y[3] = 11.9f;
  EXPECT_FALSE(cut()) << "less than three times the others";
  y[3] = 100;
  EXPECT_EQ(cut(), 100.0f);
  other[3] = 250;  // the same frame, another stage
  EXPECT_EQ(cut(), 250.0f);
  other[3] = std::nanf("");
  other[9] = 90;
  EXPECT_FALSE(cut()) << "two of them are no accident";
  EXPECT_FALSE(outlier({}));
}

TEST(Zoom, KeepsWhatIsUnderTheMouseAndStaysWithinThePicture) {
  const Rect window{{100, 50}, {660, 500}};
  Zoom zoom;
  EXPECT_EQ(zoom.picture(window).position, window.position);
  EXPECT_EQ(zoom.picture(window).size, window.size);
  const glm::vec2 mouse{430, 175};
  const auto under = [&] {
    const Rect all = zoom.picture(window);
    return (mouse - all.position) / all.size;
  };
  const glm::vec2 before = under();
  for (int i = 0; i < 30; ++i) {
    zoom.turn(window, mouse, 1);
    const glm::vec2 off = glm::abs(under() - before) * zoom.picture(window).size;
    EXPECT_LE(std::max(off.x, off.y), 1.0f) << "pixels of the screen, at " << zoom.scale;
  }
  EXPECT_EQ(zoom.scale, 128.0f);
  for (int i = 0; i < 30; ++i) zoom.turn(window, {100, 550}, -1);
  EXPECT_FALSE(zoom.on());
  EXPECT_EQ(zoom.corner, glm::vec2(0));
  zoom.turn(window, {100, 50}, 1);
  zoom.pan(window, {5000, -40});  // to the right: there is nothing on the left
  EXPECT_EQ(zoom.corner.x, 0);
  EXPECT_FLOAT_EQ(zoom.corner.y, 40.0f / 1000);
}

}  // namespace
}  // namespace irad::timing_history_suite

#endif
