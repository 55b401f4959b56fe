// Which stage an error comes from, by numbers: estimates, the chain, the sentence. No device.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "gi/matrix.h"
#include "gi/study/attribution.h"
#include "gi/study/attribution_time.h"
#include "renderer/base/csv.h"
#include "renderer/base/number_text.h"
#include "renderer/metrics.h"
#include "tests/support.h"

namespace irad::test::attribution_suite {
namespace {

using Pixels = std::vector<glm::vec4>;

Pixels evenPicture(glm::uvec2 size, float value) {
  return Pixels(size_t{size.x} * size.y, glm::vec4(value, value, value, 1));
}

/// A truth of `blocks` blocks of 1, so that weights are 1 / (3 blocks 1.01).
struct EvenTruth {
  explicit EvenTruth(uint32_t blocks) : size{8 * blocks, 8}, truth(size, evenPicture(size, 1), {}), blocks(blocks) {}
  /// A picture whose block k is 1 + deviations[k].
  std::vector<double> picture(std::vector<double> deviations) const {
    std::vector<double> out;
    for (uint32_t k = 0; k < blocks; ++k) out.insert(out.end(), 3, 1 + (k < deviations.size() ? deviations[k] : 0));
    return out;
  }
  double weight() const { return 1 / (1.01 * blocks); }
  glm::uvec2 size;
  TruthBlocks truth;
  uint32_t blocks;
};

TEST(Estimates, OfOnePictureAreTheMetric) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> value(0.0f, 2.0f);
  const glm::uvec2 size(37, 26);  // with a margin that is left aside
  const auto picture = [&] {
    Pixels out;
    for (uint32_t i = 0; i < size.x * size.y; ++i) out.emplace_back(value(random), value(random), value(random), 1);
    return out;
  };
  const Pixels a = picture(), b = picture(), v = picture();
  for (const bool two : {false, true}) {
    const TruthBlocks truth(size, a, two ? b : Pixels{});
    const double expected = measurePicture(size, v, a, two ? b : Pixels{}).blockRelMse;
    EXPECT_NEAR(ErrorEstimates(truth).ofOne({{0, truth.of(v)}}), expected, 1e-6 * std::abs(expected)) << two;
  }
  Pixels broken = a;
  broken[0].x = NAN;  // the first block is left out
  const TruthBlocks truth(size, broken, {});
  EXPECT_NEAR(ErrorEstimates(truth).ofOne({{0, truth.of(v)}}), measurePicture(size, v, broken).blockRelMse, 1e-6);
}

TEST(Estimates, OfTwoSeedsByHand) {
  const EvenTruth world(1);
  const ErrorEstimates estimates(world.truth);
  const SeedPictures x{{0, world.picture({.1})}, {1, world.picture({.3})}},
      y{{0, world.picture({.2})}, {1, world.picture({.5})}};
  EXPECT_NEAR(estimates.ofOne(x), (.01 + .09) / 2 / 1.01, 1e-12);
  EXPECT_NEAR(estimates.ofMean(x), .1 * .3 / 1.01, 1e-12) << "the product of the two different ones";
  EXPECT_NEAR(estimates.variance(x), (.2 * .2) / 2 / 1.01, 1e-12) << "their sample variance";
  EXPECT_NEAR(estimates.squaredDifference(x, y), .1 * .2 / 1.01, 1e-12);
  EXPECT_NEAR(estimates.meanDifference(x, y), .15, 1e-12);
  EXPECT_NEAR(estimates.ofOne(x, 0), .09 / 1.01, 1e-12) << "without seed 0";
}

TEST(Estimates, AreUnbiasedAndTheirIntervalsCover) {
  // Eight seeds with noise of .2 in each of twelve blocks about .1 off: relMSE of the mean .01, of one .05.
  const EvenTruth world(12);
  const ErrorEstimates estimates(world.truth);
  std::mt19937 random(11);
  std::normal_distribution<double> noise(.1, .2);
  const int trials = 2000;
  double mean = 0, one = 0, variance = 0;
  int covered = 0;
  std::vector<double> means;
  for (int trial = 0; trial < trials; ++trial) {
    SeedPictures pictures;
    for (uint32_t seed = 0; seed < 8; ++seed) {
      std::vector<double> deviations(12);
      for (double& d : deviations) d = noise(random);
      pictures[seed] = world.picture(deviations);
    }
    const SeedPictures* const sets[] = {&pictures};
    const MeanInterval m =
        ErrorEstimates::interval(sets, [&](ErrorEstimates::Left left) { return estimates.ofMean(pictures, left); });
    means.push_back(m.mean);
    mean += m.mean / trials;
    one += estimates.ofOne(pictures) / trials;
    variance += estimates.variance(pictures) / trials;
    covered += std::abs(m.mean - .01 / 1.01) <= m.half;
  }
  double spread = 0;
  for (const double m : means) spread += (m - mean) * (m - mean) / trials;
  EXPECT_NEAR(mean, .01 / 1.01, 4 * std::sqrt(spread / trials));
  EXPECT_NEAR(variance, .04 / 1.01, .001);
  EXPECT_NEAR(one, .05 / 1.01, .001);
  EXPECT_GT(covered, .92 * trials);
  EXPECT_LT(covered, .99 * trials) << "as wide as need be";
}

// ---- Stages ----

/// Pictures in which each stage that is not ideal adds its own deviation. `noise`: of rays, alternating over eight
/// seeds in the last block.
struct Stages {
  std::map<ErrorStage, std::vector<double>> deviation;
  std::vector<double> model;
  double noise = 0;
  AttributionInput input(const EvenTruth& world) const {
    AttributionInput out;
    for (size_t i = 0; i < kErrorStages; ++i) {
      const auto stage = static_cast<ErrorStage>(i);
      const bool there = deviation.contains(stage) || (stage == ErrorStage::rays && noise > 0);
      out.presence[stage] = {there, there ? "made ideal" : "not in this scene, for a test"};
    }
    for (const Ideals& ideals : neededPictures(out.presence))
      for (uint32_t seed = 0; seed < 8; ++seed) {
        std::vector<double> sum(world.blocks, 0.0);
        const auto add = [&](const std::vector<double>& d) {
          for (size_t k = 0; k < d.size(); ++k) sum[k] += d[k];
        };
        add(model);
        for (const auto& [stage, d] : deviation)
          if (!ideals.has(stage)) add(d);
        if (!ideals.has(ErrorStage::rays)) sum.back() += (seed % 2 == 0 ? 1 : -1) * noise;
        out.pictures[ideals.name()][seed] = world.picture(sum);
      }
    return out;
  }
};

TEST(Split, AddsUpWhereErrorsHaveNothingInCommon) {
  const EvenTruth world(5);
  Stages stages;
  stages.deviation = {{ErrorStage::voxels, {.1}}, {ErrorStage::sweeps, {0, .3}}, {ErrorStage::lookup, {0, 0, -.2}}};
  stages.model = {0, 0, 0, .05};
  stages.noise = .1;
  const Attribution a = attribute(world.truth, stages.input(world));
  const auto row = [&](ErrorStage stage) { return a.stages[static_cast<size_t>(stage)]; };
  const double w = world.weight();
  EXPECT_NEAR(row(ErrorStage::voxels).gain.mean, .01 * w, 1e-12);
  EXPECT_NEAR(row(ErrorStage::sweeps).gain.mean, .09 * w, 1e-12);
  EXPECT_NEAR(row(ErrorStage::lookup).gain.mean, .04 * w, 1e-12);
  EXPECT_NEAR(row(ErrorStage::rays).gain.mean, .01 * w, 1e-12) << "of the seeds' mean";
  EXPECT_NEAR(a.variance.mean, .01 * w * 8 / 7, 1e-12) << "unbiased: as if the eight were drawn";
  EXPECT_NEAR(a.model.mean, .0025 * w - .01 * w / 7, 1e-12) << "the mean's own share of it taken out";
  EXPECT_NEAR(a.asIs.mean, (.01 + .09 + .04 + .0025 + .01) * w, 1e-12);
  EXPECT_NEAR(a.restOfGains, .0025 * w, 1e-12) << "the model's";
  EXPECT_NEAR(a.restOfSquares, 0, 1e-12);
  double steps = a.model.mean;
  for (const StageError& s : a.stages) steps += s.step.mean;
  EXPECT_NEAR(steps, a.asIs.mean, 1e-12) << "the chain's steps always add up";
  EXPECT_NEAR(row(ErrorStage::lookup).difference, -.2 / 5, 1e-12) << "signed";
  EXPECT_EQ(a.dominating, ErrorStage::sweeps);
  EXPECT_TRUE(contains(a.findings[0], "The error of sweeps dominates: ")) << a.findings[0];
  EXPECT_TRUE(contains(a.findings[0], "Next: lookup")) << a.findings[0];
}

TEST(Split, ShowsTheRestWhereErrorsMeet) {
  const EvenTruth world(1);
  Stages stages;
  stages.deviation = {{ErrorStage::voxels, {.1}}, {ErrorStage::lookup, {.2}}};
  const Attribution same = attribute(world.truth, stages.input(world));
  const double w = world.weight();
  EXPECT_NEAR(same.sumOfGains, ((.09 - .04) + (.09 - .01)) * w, 1e-12);
  EXPECT_NEAR(same.restOfGains, -.04 * w, 1e-12) << "2 x .1 x .2 is counted twice";
  EXPECT_NEAR(same.restOfSquares, .04 * w, 1e-12);
  // Of opposite sign: an error hides another.
  stages.deviation[ErrorStage::voxels] = {-.1};
  const Attribution opposite = attribute(world.truth, stages.input(world));
  EXPECT_NEAR(opposite.stages[0].gain.mean, (.01 - .04) * w, 1e-12);
  const std::string all = fmt::format("{}", fmt::join(opposite.findings, "\n"));
  EXPECT_TRUE(contains(all, "With voxels ideal the error is larger")) << all;
}

TEST(Split, GivesTheScatterToRaysWhateverHidesIt) {
  // A lookup that averages over many facets shows less noise; that is no error of the lookup's.
  const EvenTruth world(3);
  Stages stages;
  stages.deviation = {{ErrorStage::lookup, {.05}}};
  stages.noise = .3;
  AttributionInput input = stages.input(world);
  for (auto& [seed, blocks] : input.pictures.at("lookup")) blocks = world.picture({});
  const Attribution a = attribute(world.truth, input);
  EXPECT_NEAR(a.stages[static_cast<size_t>(ErrorStage::lookup)].gain.mean, (.0025 - .09 / 7) * world.weight(), 1e-12);
  EXPECT_NEAR(a.stages[static_cast<size_t>(ErrorStage::rays)].squared, a.variance.mean, 1e-12)
      << "of the picture as it is, not of the chain's";
  EXPECT_EQ(a.dominating, ErrorStage::rays) << a.findings[0];
  double steps = a.model.mean;
  for (const StageError& s : a.stages) steps += s.step.mean;
  EXPECT_NEAR(steps, a.asIs.mean, 1e-12);
}

TEST(Split, NamesNobodyWhereIntervalsOverlap) {
  const EvenTruth world(4);
  Stages stages;
  stages.deviation = {{ErrorStage::voxels, {.2}}, {ErrorStage::lookup, {0, .19}}};
  AttributionInput input = stages.input(world);
  EXPECT_EQ(attribute(world.truth, input).dominating, ErrorStage::voxels) << "without noise";
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, .05);
  for (auto& [name, pictures] : input.pictures)
    for (auto& [seed, blocks] : pictures)
      for (double& value : blocks) value += noise(random);
  const Attribution noisy = attribute(world.truth, input);
  EXPECT_EQ(noisy.dominating, std::nullopt);
  EXPECT_TRUE(contains(noisy.findings[0], "not distinguishable")) << noisy.findings[0];
  // Nothing but noise.
  stages.deviation = {{ErrorStage::voxels, {}}, {ErrorStage::lookup, {}}};
  input = stages.input(world);
  for (auto& [name, pictures] : input.pictures)
    for (auto& [seed, blocks] : pictures)
      for (double& value : blocks) value += noise(random);
  const Attribution nothing = attribute(world.truth, input);
  EXPECT_TRUE(contains(nothing.findings[0], "No stage dominates")) << nothing.findings[0];
  EXPECT_EQ(nothing.dominating, std::nullopt);
}

TEST(Split, EachStageIsNamedWhereItIsLargest) {
  const EvenTruth world(static_cast<uint32_t>(kErrorStages));
  for (size_t worst = 0; worst < kErrorStages; ++worst) {
    Stages stages;
    for (size_t i = 0; i < kErrorStages; ++i) {
      std::vector<double> deviation(world.blocks, 0.0);
      deviation[i] = i == worst ? .3 : .02;
      if (const auto stage = static_cast<ErrorStage>(i); stage == ErrorStage::rays)
        stages.noise = deviation[i];
      else
        stages.deviation[stage] = deviation;
    }
    const Attribution a = attribute(world.truth, stages.input(world));
    EXPECT_EQ(a.dominating, static_cast<ErrorStage>(worst)) << a.findings[0];
    EXPECT_TRUE(
        contains(a.findings[0], fmt::format("The error of {} dominates", nameOf(static_cast<ErrorStage>(worst)))));
  }
}

TEST(Split, NeedsEachPictureOnce) {
  std::map<ErrorStage, StagePresence> presence;
  for (const ErrorStage stage : {ErrorStage::voxels, ErrorStage::rays, ErrorStage::storage, ErrorStage::sweeps})
    presence[stage].present = true;
  std::vector<std::string> names, chain;
  for (const Ideals& ideals : neededPictures(presence)) names.push_back(ideals.name());
  EXPECT_EQ(names,
            (std::vector<std::string>{"as-is", "voxels", "rays", "sweeps", "storage+sweeps", "voxels+storage+sweeps"}));
  for (const auto& [stage, ideals] : chainOf(presence))
    chain.push_back(fmt::format("{}: {}", stage ? nameOf(*stage) : "model", ideals.name()));
  EXPECT_EQ(chain, (std::vector<std::string>{"model: voxels+storage+sweeps", "voxels: storage+sweeps",
                                             "rays: storage+sweeps", "storage: sweeps", "sweeps: as-is"}));
}

// ---- How long pictures will take ----

/// Seconds of a study whose many rays are 16 times as many, in order: what is told of each, and what it takes.
struct Foreseen {
  using enum ErrorStage;
  explicit Foreseen(SolverMethod method = SolverMethod::matrix) {
    asIs.matrix.gpu.rays = 32, many.matrix.gpu.rays = 512;
    asIs.solver.method = many.solver.method = method;
    asIs.solver.frames = 100, many.solver.frames = 1600;
  }
  Settings asIs, many;
  // voxels, field, matrix, materials, gather, solve, scatter
  PictureTime plain{.build = {2, 1, 10, 0, 1, 1.5, .5}, .draw = 1},
      exact{.build = {2, 1, 10, 0, 1, 3.5, .5}, .exact = 20, .draw = 1, .gather = 7},
      finer{.build = {8, 8, 40, 0, 4, 14, 2}, .exact = 80, .draw = 2, .gather = 9};
};

TEST(Foreseen, TriesThePictureWithMostIdealOfEachKindOfFacets) {
  using enum ErrorStage;
  const Ideals all{voxels, storage, sweeps, lookup}, most{storage, sweeps, lookup};
  EXPECT_EQ(AttributionTimes::toBeTried({{}, {voxels}, {rays}, {sweeps}, most, {lookup}, all}),
            (std::vector<Ideals>{most, all, {}}));
  EXPECT_EQ(AttributionTimes::toBeTried({{rays}}), std::vector<Ideals>{{rays}}) << "there is no other";
  EXPECT_TRUE(AttributionTimes::toBeTried({}).empty());
}

TEST(Foreseen, IsTheSumOfWhatIsNotThereYet) {
  using enum ErrorStage;
  const Foreseen f;
  AttributionTimes times(f.asIs, f.many);
  EXPECT_FALSE(times.predict({}, false, {}));
  const Ideals all{voxels, storage, sweeps, lookup}, most{storage, sweeps, lookup};
  times.took({}, f.plain), times.took(most, f.exact), times.took(all, f.finer);
  // From the voxels on; of the next seed; of the same matrix.
  EXPECT_DOUBLE_EQ(*times.predict({}, false, {}), 17);
  EXPECT_DOUBLE_EQ(*times.predict({}, false, Ideals{}), 14);
  EXPECT_DOUBLE_EQ(*times.predict({lookup}, true, Ideals{}), 4 + 7);
  // Light is that of the picture that solves as this one does; in double precision once for two.
  EXPECT_DOUBLE_EQ(*times.predict({sweeps}, true, Ideals{}), 6);
  EXPECT_DOUBLE_EQ(*times.predict({storage, sweeps}, true, Ideals{}), 26);
  EXPECT_DOUBLE_EQ(*times.predict(most, true, Ideals{storage, sweeps}), 6 + 7);
  EXPECT_DOUBLE_EQ(*times.predict(most, false, Ideals{storage, sweeps}), 10 + 26 + 7);
  EXPECT_DOUBLE_EQ(*times.predict({voxels}, true, Ideals{}), 8 + 8 + 40 + 20 + 2);
  // Many rays: 16^.93 times the matrix, 16^.74 the sweeps.
  EXPECT_NEAR(*times.predict({rays}, true, Ideals{}), 10 * std::pow(16, .93) + 1.5 * std::pow(16, .74) + 1.5 + 1, 1e-9);
  // What has been seen of the picture itself counts for more.
  times.took({rays}, {.build = {0, 0, 100, 0, 1, 2, 1}, .draw = 1});
  EXPECT_DOUBLE_EQ(*times.predict({rays}, true, Ideals{}), 105);
  EXPECT_DOUBLE_EQ(*times.predict({}, false, Ideals{rays}), 14);
}

TEST(ManyRays, AreAtMostWhatARowCountsBesideItsColumns) {
  // Of 32 bits 21 name one of 1.6 million facets, and 3 more which channels panes keep off.
  EXPECT_EQ(mostRaysOfRows(1'600'000, false), 2047u);
  EXPECT_EQ(mostRaysOfRows(1'600'000, true), 255u);
  EXPECT_EQ(mostRaysOfRows(1u << 20, false), 4095u);
  EXPECT_EQ(mostRaysOfRows(0, false), mostRaysOfRows(2, false)) << "there is no scene, and a row of one bit";
}

TEST(Foreseen, FramesOfBruteForceAreAsLongEach) {
  const Foreseen f(SolverMethod::bruteForce);
  AttributionTimes times(f.asIs, f.many);
  times.took({}, {.build = {2, 1, 0, 0, 0, 30, 0}, .draw = 1});
  EXPECT_DOUBLE_EQ(*times.predict({ErrorStage::rays}, true, Ideals{}), 16 * 30 + 1);
}

TEST(Split, TimesAndMemoryBelongToStages) {
  EXPECT_EQ(stageOfPass("GI Voxelization"), ErrorStage::voxels);
  EXPECT_EQ(stageOfPass("GI Solve Emitters"), ErrorStage::rays);
  EXPECT_EQ(stageOfPass("GI Solve Energy"), ErrorStage::sweeps);
  EXPECT_EQ(stageOfPass("RE Specular"), ErrorStage::reflections);
  EXPECT_EQ(stageOfPass("RE Forward"), std::nullopt);
  EXPECT_EQ(stageOfMemory("matrix", "matrix entries"), ErrorStage::rays);
  EXPECT_EQ(stageOfMemory("solver", "blurred H"), ErrorStage::lookup);
  EXPECT_EQ(stageOfMemory("targets", "linear"), std::nullopt);
}

TEST(Split, IsWrittenForPeopleAndPrograms) {
  const EvenTruth world(2);
  Stages stages;
  stages.deviation = {{ErrorStage::sweeps, {.3}}, {ErrorStage::lookup, {0, -.2}}};
  stages.noise = .1;
  AttributionInput input = stages.input(world);
  input.cost[ErrorStage::sweeps] = {0, 12.5, 0, 3};
  input.other.frameMs = 4;
  const Attribution a = attribute(world.truth, input);
  const std::string csv = attributionCsv(a);
  std::vector<std::vector<std::string>> rows;
  for (size_t at = 0; at < csv.size();) {
    const size_t end = csv.find('\n', at);
    rows.push_back(csvFields(csv.substr(at, end - at)));
    at = end + 1;
  }
  ASSERT_EQ(rows.size(), 1 + 2 + kErrorStages + 4) << csv;
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size()) << fmt::format("{}", fmt::join(row, "|"));
  const auto cell = [&](const std::string& name, const std::string& column) -> std::string {
    for (const auto& row : rows)
      if (row[0] == name)
        for (size_t i = 0; i < row.size(); ++i)
          if (rows[0][i] == column) return row[i];
    return "none";
  };
  EXPECT_EQ(cell("sweeps", "relight_ms"), "12.5000");
  EXPECT_EQ(cell("picture", "relight_ms"), "12.5000");
  EXPECT_EQ(cell("other", "frame_ms"), "4.0000");
  EXPECT_EQ(cell("shadows", "gain"), "");
  EXPECT_EQ(cell("shadows", "words"), "not in this scene, for a test");
  EXPECT_NEAR(std::stod(cell("sweeps", "gain")), a.stages[static_cast<size_t>(ErrorStage::sweeps)].gain.mean, 1e-12);
  EXPECT_NEAR(std::stod(cell("rest", "gain")), a.restOfGains, 1e-12);
  EXPECT_NEAR(std::stod(cell("rest", "chain_squared")), a.restOfSquares, 1e-12);
  EXPECT_NEAR(std::stod(cell("rays.variance", "gain")), a.variance.mean, 1e-12);
  EXPECT_NEAR(std::stod(cell("model", "chain_step")), a.model.mean, 1e-12);

  for (const auto& row : attributionTable(a)) EXPECT_EQ(row.size(), 13u) << row[0];
  const std::string page = attributionReport(a, {"A fact & more"}, "nowhere", {16, 8}, {{"none", "not there"}});
  EXPECT_TRUE(contains(page, "The error of sweeps dominates")) << page;
  EXPECT_TRUE(contains(page, "A fact &amp; more"));
  EXPECT_TRUE(contains(
      page,
      fmt::format("<p class=\"finding\">Relight: {} ms, 100 % of it sweeps. Frame: {} ms, 100 % of "
                  "it of no stage alone. The stage whose ideal gains most, sweeps ({:.0f} % of "
                  "the error), has 76 % of these milliseconds.</p>",
                  milliseconds(12.5), milliseconds(4), 100 * a.stages[static_cast<size_t>(ErrorStage::sweeps)].share)))
      << page;
  EXPECT_TRUE(contains(errorBars(a), "along the chain") && contains(timeBars(a), "relight"));
  for (const std::string& text : {csv, page, errorBars(a), timeBars(a)}) EXPECT_FALSE(contains(text, "nan")) << text;
}

}  // namespace
}  // namespace irad::test::attribution_suite
