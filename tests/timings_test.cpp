// Statistics of timings: percentiles by nearest rank, sums per frame, the CSV of T Tables 6-10; recordings read back;
// comparisons that find a change and pass over noise.
#include "renderer/base/timings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "renderer/base/compare_timings.h"
#include "renderer/base/csv.h"
#include "renderer/base/error.h"
#include "renderer/base/recording.h"
#include "tests/support.h"

namespace irad::timings_suite {
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
  EXPECT_EQ(rows[0].kind, WorkKind::Setup);
  EXPECT_DOUBLE_EQ(rows[0].stats.mean, 3);
  EXPECT_EQ(rows[1].stage, "RE Forward");
  EXPECT_EQ(rows[2].stage, "GI Solve");
  EXPECT_EQ(rows[2].kind, WorkKind::Frame);
  EXPECT_DOUBLE_EQ(rows[2].stats.mean, 7.5);
  EXPECT_EQ(rows[2].stats.samples, 2u);

  std::ostringstream csv;
  writeCsv(csv, timings.rows());
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
    EXPECT_EQ(row.stats.min, row.kind == WorkKind::Setup ? 107 : 17);
    EXPECT_EQ(row.stats.max, row.kind == WorkKind::Setup ? 109 : 19);
  }
  timings.reset();
  timings.endFrame(0, /*setup=*/false, 0);
  EXPECT_EQ(timings.frames().size(), 1u);
}

TEST(Timings, PassesOfAStageThatFollowEachOtherAreOneSpan) {
  Timings timings;
  timings.add("GI Solve", 1, 100);
  timings.add("GI Solve", 2, 101.01);
  timings.add("GI Scatter", 1, 103.02);
  timings.add("GI Solve", 1, 104.03);
  timings.add("GI Solve", 1, 110);  // later: another submission
  timings.endFrame(7, /*setup=*/false, 20);
  const FrameSample& frame = timings.frames().at(0);
  const std::vector<std::pair<double, double>> expected{{100, 103.01}, {103.02, 104.02}, {104.03, 105.03}, {110, 111}};
  ASSERT_EQ(frame.spans.size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_DOUBLE_EQ(frame.spans[i].began, expected[i].first);
    EXPECT_DOUBLE_EQ(frame.spans[i].ended, expected[i].second);
  }
  EXPECT_DOUBLE_EQ(frame.gpuMs(), 6);
  EXPECT_NEAR(frame.began + frame.cpuMs, timings.now(), 1000);
}

TEST(Csv, FieldsComeBack) {
  const std::vector<std::string> fields{"plain", "", "with, comma", "a \"quoted\" word", "\""};
  std::string line;
  for (const std::string& field : fields) {
    line += csvField(field);
    line += ',';
  }
  line.pop_back();
  EXPECT_EQ(csvFields(line), fields);
  EXPECT_EQ(csvFields("").size(), 1u);
}

// ---- Recordings -----------------------------------------------------------------------------------------------------

std::deque<FrameSample> threeFrames() {
  // The device's clock is 5000 ms ahead of the CPU's; in frame 1 the first pass begins as soon as its work does.
  return {{.frame = 0,
           .kind = WorkKind::Setup,
           .began = 10,
           .cpuMs = 30,
           .stages = {{"GI BuildMatrix", 25.5}},
           .spans = {{"GI BuildMatrix", 5012, 5037.5}}},
          {.frame = 1,
           .kind = WorkKind::Frame,
           .began = 50,
           .cpuMs = 0.75,
           .stages = {{"RE Forward", 4}, {"UI, panels", 0.125}},
           .spans = {{"RE Forward", 5050, 5054}, {"UI, panels", 5054, 5054.125}}},
          {.frame = 2,
           .kind = WorkKind::Frame,
           .began = 60,
           .cpuMs = 0.5,
           .stages = {{"UI, panels", 0.25}},
           .spans = {{"UI, panels", 5061, 5061.25}}}};
}

TEST(Recording, FramesComeBackFromTheirCsv) {
  const TemporaryFolder folder;
  const std::deque<FrameSample> frames = threeFrames();
  writeRecording(folder.path / "new", {.device = "a device", .scene = "box.glb", .frames = frames});
  EXPECT_EQ(test::slurp(folder.path / "new" / "frames.csv"),
            "frame,kind,began_ms,cpu_ms,GI BuildMatrix,RE Forward,\"UI, panels\"\n"
            "0,setup,10.000000,30.000000,25.500000,,\n"
            "1,frame,50.000000,0.750000,,4.000000,0.125000\n"
            "2,frame,60.000000,0.500000,,,0.250000\n");
  const std::deque<FrameSample> back = readRecording(folder.path / "new");
  ASSERT_EQ(back.size(), frames.size());
  for (size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(back[i].frame, frames[i].frame);
    EXPECT_EQ(back[i].kind, frames[i].kind);
    EXPECT_EQ(back[i].began, frames[i].began);
    EXPECT_EQ(back[i].cpuMs, frames[i].cpuMs);
    EXPECT_EQ(back[i].stages, frames[i].stages);
  }
  const std::string summary = test::slurp(folder.path / "new" / "summary.csv");
  EXPECT_NE(summary.find("\nRE Forward,frame,4.000000,"), std::string::npos) << summary;
  EXPECT_NE(summary.find("\n\"UI, panels\",frame,0.187500,0.125000,0.250000,"), std::string::npos) << summary;
}

TEST(Recording, ItsManifestIsBesideItAndInTheTrace) {
  test::TemporaryFolder folder;
  const std::string manifest = R"({"scene":{"path":"/a \"b\".glb"}})";
  writeRecording(folder.path / "new", {.device = "", .scene = "", .frames = threeFrames(), .manifest = manifest});
  EXPECT_EQ(test::slurp(folder.path / "new/manifest.json"), manifest);
  const auto trace = nlohmann::json::parse(test::slurp(folder.path / "new/trace.json"));
  EXPECT_EQ(trace["otherData"]["manifest"], nlohmann::json::parse(manifest));
  EXPECT_EQ(readRecording(folder.path / "new").size(), threeFrames().size());
}

TEST(Recording, TheTraceHasATrackForEitherProcessorOnOneClock) {
  const auto trace = nlohmann::json::parse(traceJson({.device = "a \"device\"", .scene = "", .frames = threeFrames()}));
  EXPECT_EQ(trace["otherData"]["device"], "a \"device\"");
  EXPECT_FALSE(trace["otherData"].contains("manifest"));
  std::map<std::string, int> tracks;
  std::vector<nlohmann::json> cpu, gpu;
  for (const auto& event : trace["traceEvents"]) {
    EXPECT_EQ(event["pid"], 1);
    if (event["name"] == "thread_name") tracks[event["args"]["name"]] = event["tid"];
    if (event["ph"] == "X") (event["tid"] == tracks.at("CPU") ? cpu : gpu).push_back(event);
  }
  ASSERT_EQ(cpu.size(), 3u);
  EXPECT_EQ(cpu[1]["ts"], 50'000);
  EXPECT_EQ(cpu[1]["dur"], 750);
  EXPECT_EQ(cpu[1]["args"]["frame"], 1);
  // Microseconds; shifted by -5000 ms.
  ASSERT_EQ(gpu.size(), 4u);
  EXPECT_EQ(gpu[0]["name"], "GI BuildMatrix");
  EXPECT_EQ(gpu[0]["ts"], 12'000);
  EXPECT_EQ(gpu[0]["dur"], 25'500);
  EXPECT_EQ(gpu[1]["ts"], 50'000);
  EXPECT_EQ(gpu[3]["ts"], 61'000);
}

TEST(Recording, WhatIsNoneIsAnInputErrorThatNamesThePlace) {
  const TemporaryFolder folder;
  const auto problem = [&](const std::string& text) -> std::string {
    std::ofstream(folder.path / "frames.csv") << text;
    try {
      readRecording(folder.path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "(none)";
  };
  EXPECT_THROW(readRecording(folder.path / "absent"), InputError);
  const std::string head = "frame,kind,began_ms,cpu_ms,UI\n";
  EXPECT_EQ(problem(head), "(none)");
  EXPECT_EQ(problem(head + "0,frame,1,2,\n"), "(none)");
  for (const auto& [text, expected] : std::vector<std::pair<std::string, std::string>>{
           {"", "line 1: not the columns"},
           {"subsystem,kind,mean_ms\n", "line 1: not the columns"},
           {head + "0,frame,1,2,3\n1,frame,1,2\n", "line 3: 4 fields, expected 5"},
           {head + "0,picture,1,2,3\n", "line 2: kind: 'picture' is unknown"},
           {head + "0,frame,1,2,nan\n", "line 2: UI: 'nan' is no time"},
           {head + "0,frame,1,two,3\n", "line 2: cpu_ms: 'two' is no time"},
           {head + "0,frame,1,2,-3\n", "line 2: UI: '-3' is no time"}}) {
    EXPECT_NE(problem(text).find(expected), std::string::npos) << problem(text);
    EXPECT_NE(problem(text).find("frames.csv: "), std::string::npos) << problem(text);
  }
}

// ---- Comparison -----------------------------------------------------------------------------------------------------

/// Frames of one stage: 4 ms x `factor`, times log-normal noise of deviation `sigma`, successive ones correlated by
/// `memory`, with an outlier of three times its value in every hundred.
std::deque<FrameSample> noisy(size_t count, double factor, double sigma, double memory, uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::deque<FrameSample> frames;
  double noise = normal(random);
  for (size_t i = 0; i < count; ++i) {
    noise = memory * noise + std::sqrt(1 - memory * memory) * normal(random);
    const double ms = 4 * factor * std::exp(sigma * noise) * (random() % 100 == 0 ? 3 : 1);
    frames.push_back({.frame = i, .cpuMs = 1, .stages = {{"GI Solve", ms}}});
  }
  return frames;
}

const StageChange& changeOf(const std::vector<StageChange>& changes, const char* stage) {
  return *std::find_if(changes.begin(), changes.end(), [&](const StageChange& c) { return c.stage == stage; });
}

TEST(Comparison, FindsTenPercentAndPassesOverNoise) {
  constexpr int kPairs = 100;
  for (const double memory : {0.0, 0.8}) {
    int found = 0, holds = 0, alarms = 0;
    for (uint32_t i = 0; i < kPairs; ++i) {
      const auto first = noisy(300, 1, 0.05, memory, 2 * i), same = noisy(300, 1, 0.05, memory, 2 * i + 1);
      const StageChange unchanged = changeOf(compareTimings(first, same), "GI Solve");
      alarms += unchanged.verdict != Verdict::WithinNoise;
      const auto slower = noisy(300, 1.1, 0.05, memory, 1000 + i);
      const StageChange changed = changeOf(compareTimings(first, slower), "GI Solve");
      found += changed.verdict == Verdict::Slower;
      holds += changed.low <= 1.1 && 1.1 <= changed.high;
      EXPECT_EQ(changeOf(compareTimings(slower, first), "GI Solve").verdict,
                changed.verdict == Verdict::Slower ? Verdict::Faster : Verdict::WithinNoise);
    }
    fmt::print("memory {}: of {} pairs a change of 10 % found in {}, its size in the interval in {}, of 0 % in {}\n",
               memory, kPairs, found, holds, alarms);
    // 5 % for all three rows of the table together; of 100 pairs, 9 would be three deviations off that.
    EXPECT_LE(alarms, 8);
    EXPECT_GE(holds, 92);
    EXPECT_GE(found, 95);
  }
}

TEST(Comparison, AFewSamplesAreToldApartOrSaidToBeTooFew) {
  const auto few = compareTimings(noisy(kFewestSamples - 1, 1, 0.05, 0, 1), noisy(300, 2, 0.05, 0, 2));
  EXPECT_EQ(changeOf(few, "GI Solve").verdict, Verdict::TooFew);
  const auto enough = compareTimings(noisy(kFewestSamples, 1, 0.05, 0, 1), noisy(300, 2, 0.05, 0, 2));
  EXPECT_EQ(changeOf(enough, "GI Solve").verdict, Verdict::Slower);
  EXPECT_NEAR(changeOf(enough, "GI Solve").ratio, 2, 0.2);
}

TEST(Comparison, PairsStagesOfOneKindAndWholeGroupsOfTheCommonestWork) {
  std::deque<FrameSample> before, after;
  for (uint64_t i = 0; i < 40; ++i) {
    before.push_back({.frame = i, .cpuMs = 2, .stages = {{"RE Forward", 3}, {"UI", 1}}});
    after.push_back({.frame = i, .cpuMs = 2, .stages = {{"RE Forward", 6}, {"UI", 1}}});
    if (i % 4 == 0) after.push_back({.frame = i, .cpuMs = 90, .stages = {{"GI Solve", 80}}});
  }
  before.push_back({.frame = 99, .kind = WorkKind::Setup, .cpuMs = 1, .stages = {{"GI Solve", 80}}});
  const std::vector<StageChange> changes = compareTimings(before, after);
  ASSERT_EQ(changes.size(), 4u);  // GI Solve: of different kinds
  const auto expect = [&](const char* stage, double first, double second, Verdict verdict) {
    const StageChange& c = changeOf(changes, stage);
    EXPECT_EQ(c.before, first) << stage;
    EXPECT_EQ(c.after, second) << stage;
    EXPECT_EQ(c.verdict, verdict) << stage;
  };
  expect("RE Forward", 3, 6, Verdict::Slower);
  expect("UI", 1, 1, Verdict::WithinNoise);
  expect(kGpuTime, 4, 7, Verdict::Slower);
  expect(kCpuTime, 2, 2, Verdict::WithinNoise);
}

}  // namespace
}  // namespace irad::timings_suite
