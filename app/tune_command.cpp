// `irad tune`: the settings for a budget, on this scene and device. A coarse grid is measured, then the points around
// the best, until they are close; what is promised is measured anew, with seeds and repeats that had no part in the
// choice.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/devices.h"
#include "app/interrupts.h"
#include "app/study.h"
#include "gi/manifest.h"
#include "gi/study/tune.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/number_text.h"
#include "renderer/base/output_file.h"

namespace irad::app {
namespace {

namespace fs = std::filesystem;

struct TuneArguments {
  std::optional<std::string> scene, rounds;
  MeasureArguments measure;
  BudgetArguments budget;
};

constexpr uint32_t kReferenceSamples = 128;
/// Of the chosen point, for what is promised: doubled until the error is known to kKnownError of itself.
constexpr uint32_t kFreshSeeds = 8, kMostFreshSeeds = 128;
constexpr double kKnownError = 0.05;
/// A point whose fresh time is further above the budget was chosen by luck.
constexpr double kSlack = 1.02;

std::vector<std::string> coarseSweeps(bool cpuDevice) {
  if (cpuDevice) return {"voxel.resolution=16,32,64", "matrix.rays=16,64,256"};
  return {"voxel.resolution=64,128,256,512", "matrix.rays=32,128,512"};
}

/// Numbers that are swept: a round measures a point on either side of each, in all combinations.
size_t sidesOf(const SettingGrid& grid) {
  size_t points = 1;
  for (const Setting* setting : grid.swept())
    points *= setting->kind == SettingKind::integer || setting->kind == SettingKind::number ? 3 : 1;
  return points - 1;
}

/// All that a search may have to do: the grid by its trial, every further point as long as one of the grid on average,
/// the chosen one with twice the fewest fresh seeds.
WorkAhead searchAhead(StudyRun& run, uint32_t rounds, ProgressReport& progress) {
  const StudyTask& task = run.task();
  const size_t points = run.grid().size(), begun = run.grid().texts().size() - 1;
  const double further = static_cast<double>(sidesOf(run.grid())) * (rounds - std::min<double>(rounds, begun));
  progress.note(
      fmt::format("all in all, with up to {:.0f} points around the best of the grid ({} {}) and the chosen one "
                  "anew by {} to {} seeds ({} are counted):",
                  further, rounds, rounds == 1 ? "round" : "rounds", kFreshSeeds, kMostFreshSeeds, 2 * kFreshSeeds));
  WorkAhead out = run.picturesAhead();
  const double ofPicture = out.pictures > 0 ? out.seconds / out.pictures : run.tryRepeat(points / 2),
               pictures = further * (task.seeds + task.repeats + 1) + 2 * kFreshSeeds + task.repeats + 1;
  out.pictures += pictures, out.seconds += pictures * ofPicture;
  return out;
}

class Search {
 public:
  Search(const TuneArguments& arguments, StudyRun& run, uint32_t firstSeed, uint32_t seeds, uint32_t repeats,
         ProgressReport& progress)
      : budget_(arguments.budget.budget("irad tune")),
        cost_(arguments.budget.kind()),
        run_(run),
        firstSeed_(firstSeed),
        seeds_(seeds),
        repeats_(repeats),
        progress_(progress) {}

  /// Measures around the best point until no side is left, or `rounds` of them have been, those in the folder included.
  void refine(uint32_t rounds) {
    const auto began = std::chrono::steady_clock::now();
    run_.measure();
    while (run_.grid().texts().size() <= rounds) {
      const std::optional<size_t> best = nearest(points(), cost_, budget_);
      if (!best) return;
      const size_t before = run_.grid().size();
      const std::vector<std::string> sweeps = around(run_.grid(), *best);
      if (sweeps.empty()) return;
      run_.extend(sweeps);
      const size_t added = run_.grid().size() - before;
      if (added == 0) return;
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - began;
      progress_.note(fmt::format("around point {} ({}): {} more points, about {}", *best, run_.grid().label(*best),
                                 added,
                                 duration(spent.count() * static_cast<double>(added) / static_cast<double>(before))));
      run_.measure();
    }
  }

  /// The best point, by what chooses and by fresh seeds and repeats: where those are beyond the budget, the next best.
  PointSummary confirm() {
    std::vector<PointSummary> candidates = points();
    while (true) {
      const std::optional<size_t> best = pick(candidates, cost_, budget_);
      if (!best) throw WorkError(nothingWithin());
      const PointSummary fresh = measureFresh(*best);
      const bool late = budget_.ms && cost_.of(fresh) > kSlack * *budget_.ms;
      const bool wrong = budget_.error && fresh.relMse.mean - fresh.relMse.half > *budget_.error;
      if (!late && !wrong) return fresh;
      progress_.note(fmt::format("point {} does not hold: {} ms, relMSE {}", *best, milliseconds(cost_.of(fresh)),
                                 shortNumber(fresh.relMse.mean)));
      candidates[*best].failure = "does not hold";
    }
  }

  std::vector<PointSummary> points() const {
    return summarize(chosenBy(run_.results(), firstSeed_, seeds_, repeats_), run_.grid().labels());
  }

 private:
  PointSummary measureFresh(size_t point) {
    for (uint32_t seeds = kFreshSeeds;; seeds *= 2) {
      run_.measureMore(point, seeds, repeats_);
      PointSummary fresh =
          summarize(unseen(run_.results(), firstSeed_, seeds_, repeats_), run_.grid().labels()).at(point);
      if (seeds >= kMostFreshSeeds || !(fresh.relMse.half > kKnownError * fresh.relMse.mean)) return fresh;
    }
  }
  std::string nothingWithin() const {
    const std::vector<PointSummary> all = points();
    const std::optional<size_t> closest = nearest(all, cost_, budget_);
    if (!closest) return "irad tune: no point could be computed";
    const PointSummary& p = all[*closest];
    return fmt::format("irad tune: nothing is within that; the nearest is {}: {} ms, {:.1f} MiB, relMSE {}", p.label,
                       milliseconds(cost_.of(p)), p.deviceMib, shortNumber(p.relMse.mean));
  }

  const Budget budget_;
  const CostKind& cost_;
  StudyRun& run_;
  uint32_t firstSeed_, seeds_, repeats_;
  ProgressReport& progress_;
};

void run(const TuneArguments& a, Machine& machine) {
  if (a.measure.device.list) return printDevices(/*json=*/false);
  a.budget.budget("irad tune"), a.budget.kind();
  a.measure.check();
  const auto rounds = static_cast<uint32_t>(parseInteger("--rounds", a.rounds.value_or("3"), 0, 100));
  DeviceSession session(machine, a.measure.settings, a.measure.device);
  auto [scene, task] = a.measure.open(session, "irad tune", a.scene, kReferenceSamples);
  task.study = "tune";
  const fs::path out = task.out = a.measure.out.value_or("out/tune");
  const MadeFolder folder(out, kStudyLabels);
  const uint32_t seeds = task.seeds, repeats = task.repeats;
  const std::vector<std::string> sweeps =
      a.measure.sweeps.empty() ? coarseSweeps(session.device->isCpu) : a.measure.sweeps;
  const StopOnSignal stop;
  const auto began = std::chrono::steady_clock::now();
  StudyRun study(session, std::move(scene), SettingGrid(sweeps, session.settings), std::move(task),
                 [&](StudyRun& opened) { return searchAhead(opened, rounds, session.progress); });
  Search search(a, study, session.settings.matrix.gpu.seed, seeds, repeats, session.progress);
  search.refine(rounds);
  const PointSummary promised = search.confirm();
  finishStudy(out, study.grid(), study.results(), study.notes());
  printChoice(promised, search.points(), a.budget.kind());
  print(
      "confidence  error: half of a 95 % interval over {} seeds, time: {} repeats; none of them had a part in the "
      "choice\n",
      promised.seeds, repeats);
  const fs::path file = out / "tuned.json";
  writeFile(file, settingsFile(study.grid().settings(promised.point)));
  print("wrote       {} (for --config)\n", file.string());
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  session.progress.note(
      fmt::format("took {}; about {} was said", duration(took.count()), duration(study.ahead().all())));
  session.checkValidation();
}

}  // namespace

Command tuneCommand() {
  const auto arguments = std::make_shared<TuneArguments>();
  return {"tune", "Settings for a budget of time, memory or error, measured on this scene and device",
          [arguments](Options& options) {
            options.argument("SCENE", arguments->scene, sceneHelp());
            arguments->budget.declare(options, "");
            options.value("--rounds", "N", arguments->rounds,
                          "Times that the points around the best are measured (default 3)");
            arguments->measure.declare(options, "out/tune");
          },
          [arguments](Machine& machine) { run(*arguments, machine); }};
}

}  // namespace irad::app
