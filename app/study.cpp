#include "app/study.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "gi/check/path_tracer.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/near_match.h"
#include "renderer/base/number_text.h"

namespace irad::app {

uint32_t evenSamples(const std::string& option, const std::string& text) {
  const auto samples = static_cast<uint32_t>(parseInteger(option, text, 2, 10'000'000));
  if (samples % 2 != 0) throw UsageError(fmt::format("{}: '{}' is not even", option, text));
  return samples;
}

namespace {

TruthSource truthOf(const MeasureArguments& a, DeviceSession& session, const std::string& command,
                    std::optional<uint32_t> otherwise) {
  if (a.reference.file && a.referenceSamples)
    throw UsageError("--reference and --reference-samples: a study has one truth");
  const bool none = !a.reference.file && !a.referenceSamples;
  if (none && !(otherwise && hasPathTracer()))
    throw UsageError(command + ": no truth: --reference FILE, or --reference-samples N of the path tracer");
  if (a.secondReference && !a.reference.file) throw UsageError("--second-reference needs --reference");
  TruthSource out;
  if (none) {
    out.samples = otherwise;
    return out;
  }
  if (a.referenceSamples) {
    out.samples = evenSamples("--reference-samples", *a.referenceSamples);
    return out;
  }
  out.file = *a.reference.read(session.config, session.progress);
  if (a.secondReference) {
    out.secondFile = readReference(*a.secondReference);
    if (!out.secondFile->note.empty()) session.progress.note("warning: " + out.secondFile->note);
  }
  return out;
}

double parsePositive(const std::string& option, const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value) || value <= 0)
    throw UsageError(fmt::format("{}: '{}' is not allowed; expected a number above 0", option, text));
  return value;
}

}  // namespace

void MeasureArguments::declare(Options& options, const std::string& defaultFolder) {
  options.values("--sweep", "NAME=VALUES", sweeps,
                 "Setting to go through: a,b,c or FIRST..LAST*FACTOR or FIRST..LAST+STEP; several make a grid");
  options.value(
      "--out", "DIR", out,
      fmt::format("Folder of the study (default: {}); one that holds a part of it is gone on with", defaultFolder));
  options.value("--seeds", "N", seeds, "Seeds per point, from --seed on (default 4)");
  options.value("--repeats", "N", repeats, "Times that each point is timed (default 30, on CPU devices 5)");
  options.value("--view", "NAME", view,
                "View that is compared (default: lit; with the path tracer indirect; it can do lit with "
                "scene.lambertian)");
  reference.declare(options);
  options.value("--second-reference", "FILE", secondReference,
                "A second reference with independent noise: that of both then cancels in relMSE");
  options.value("--reference-samples", "N", referenceSamples,
                "The path tracer's picture with N samples per pixel as the reference, its noise cancelled by halves");
  picture.declare(options);
  sceneOptions.declare(options);
  settings.declare(options);
  device.declare(options);
}

void MeasureArguments::check() const {
  sceneOptions.check();
  picture.check();
  const Config early = settings.readConfig();
  SettingGrid(sweeps, settings.resolve(early, /*cpuDevice=*/true));
}

std::pair<Scene, StudyTask> MeasureArguments::open(DeviceSession& session, const std::string& command,
                                                   const std::optional<std::string>& scene,
                                                   std::optional<uint32_t> otherwise) const {
  StudyTask task;
  task.seeds = static_cast<uint32_t>(parseInteger("--seeds", seeds.value_or("4"), 1, 10'000));
  const char* const few = session.device->isCpu ? "5" : "30";
  task.repeats = static_cast<uint32_t>(parseInteger("--repeats", repeats.value_or(few), 1, 100'000));
  task.truth = truthOf(*this, session, command, otherwise);
  task.view = findViews({view.value_or(task.truth.samples ? "indirect" : "lit")}).at(0);
  if (task.view.isFrom(FROM_PICTURE))
    throw UsageError(
        fmt::format("--view {}: a study compares what the program draws with the reference", task.view.name));
  if (task.truth.samples) requirePathTracer(task.view, session.settings);
  Scene loaded = session.load(findScene(scene, session.config, std::nullopt), sceneOptions);
  session.tell(regionOrWhole(loaded, session.settings));
  task.camera = picture.resolveCameras(session.config, loaded).at(0);
  task.size = picture.resolveSize(session.config);
  if (task.truth.file && !picture.size && !session.config.size) task.size = task.truth.file->picture.size;
  return {std::move(loaded), std::move(task)};
}

void BudgetArguments::declare(Options& options, const std::string& prefix) {
  options.value("--budget-ms", "X", ms, prefix + "milliseconds to spend at most, of --cost");
  options.value("--budget-mib", "Y", mib, prefix + "device memory to take at most");
  options.value("--target-error", "E", error,
                prefix + "the cheapest with no more relMSE of 8 x 8 means (irad study --help defines it)");
  options.value("--cost", "NAME", cost, prefix + "first_picture (default), build, relight or frame");
}

Budget BudgetArguments::budget(const std::string& command) const {
  Budget budget;
  if (ms) budget.ms = parsePositive("--budget-ms", *ms);
  if (mib) budget.mib = parsePositive("--budget-mib", *mib);
  if (error) budget.error = parsePositive("--target-error", *error);
  if (!ms && !mib && !error) throw UsageError(command + ": by what? --budget-ms X, --budget-mib Y or --target-error E");
  return budget;
}

const CostKind& BudgetArguments::kind() const {
  const std::string wanted = cost.value_or("first_picture");
  std::vector<std::string> names;
  for (const CostKind& kind : costKinds())
    if (kind.time) {
      names.emplace_back(kind.name);
      if (wanted == kind.name) return kind;
    }
  throw UsageError(fmt::format("--cost: unknown '{}'{}", wanted, suggestion(wanted, names)));
}

void printChoice(const PointSummary& p, const std::vector<PointSummary>& points, const CostKind& costKind) {
  const CostKind* cost = &costKind;
  const auto half = [](const MeanInterval& m) {
    return std::isfinite(m.half) ? fmt::format(" ± {}", shortNumber(m.half)) : std::string(" (one seed)");
  };
  print("point       {}: {}\n", p.point, p.label);
  print("error       relMSE {}{}, FLIP {}\n", shortNumber(p.relMse.mean), half(p.relMse), shortNumber(p.flip.mean));
  for (const auto& [name, kind] :
       {std::pair("build", "setup"), {"solve", "cold"}, {"relight", "relight"}, {"frame", "camera"}})
    if (const auto spread = p.gpu.find(kind); spread != p.gpu.end())
      print("{:<11} {} ms, {} to {} in 90 % of {} repeats\n", name, milliseconds(spread->second.p50),
            milliseconds(spread->second.p5), milliseconds(spread->second.p95), spread->second.samples);
  print("memory      {:.1f} MiB\n", p.deviceMib);
  const std::optional<size_t> best = pick(points, *cost, {.error = HUGE_VAL}), least = pick(points, *cost, {});
  if (least && *least != p.point) {
    const PointSummary& l = points[*least];
    // With two truths an estimate may be 0 or less: as good as they can tell.
    const std::string loss =
        l.relMse.mean > 0
            ? fmt::format("{} times the error of", shortNumber(p.relMse.mean / l.relMse.mean))
            : fmt::format("relMSE {} against {} of", shortNumber(p.relMse.mean), shortNumber(l.relMse.mean));
    print("loss        {} {} ({}), which takes {} times the {}\n", loss, *least, l.label,
          shortNumber(cost->of(l) / cost->of(p)), cost->unit);
  }
  if (best && *best != p.point)
    print("cheapest    {} ({}): {} times the error for {} of the {}\n", *best, points[*best].label,
          shortNumber(points[*best].relMse.mean / p.relMse.mean), shortNumber(cost->of(points[*best]) / cost->of(p)),
          cost->unit);
}

}  // namespace irad::app
