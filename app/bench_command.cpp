// `irad bench`: a table of times per stage, rates beside the machine's own copy bandwidth, and ratios of two settings
// sets measured in turn.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <ctime>
#include <nlohmann/json.hpp>

#include "app/bench.h"
#include "app/bench_ui.h"
#include "app/device_session.h"
#include "app/devices.h"
#include "app/table.h"
#include "gi/facets.h"
#include "gi/manifest.h"
#include "gi/matrix.h"
#include "gi/traits.h"
#include "renderer/base/compare_timings.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/near_match.h"
#include "renderer/base/number_text.h"
#include "renderer/base/output_file.h"
#include "renderer/base/recording.h"

namespace irad::app {
namespace {

namespace fs = std::filesystem;

struct BenchArguments {
  std::optional<std::string> scene, csv, record, warmup, rebuilds, view;
  std::optional<std::pair<std::string, std::string>> compare;
  std::vector<std::string> versus;
  SceneArguments sceneOptions;
  SettingArguments settings;
  DeviceArguments device;
  PictureArguments picture;
  bool json = false, ui = false;
};

const std::vector<std::string> columns{"subsystem", "kind",   "mean_ms", "min_ms", "max_ms",
                                       "std_ms",    "p50_ms", "p95_ms",  "p99_ms", "samples"};

/// The rows of one settings set: stage, kind, then the statistics.
std::vector<std::vector<std::string>> statisticRows(const Bench& bench) {
  std::vector<std::vector<std::string>> rows;
  const std::vector<StageSamples> samples = bench.samples();
  for (const WorkKind kind : {WorkKind::Setup, WorkKind::Cold, WorkKind::Relight, WorkKind::Camera})
    for (const StageSamples& s : samples) {
      if (s.kind != kind) continue;
      const TimingStats t = statistics(s.ms);
      std::vector<std::string> row{s.stage, toString(kind)};
      for (const double value : {t.mean, t.min, t.max, t.std, t.p50, t.p95, t.p99})
        row.push_back(fmt::format("{:.4f}", value));
      row.push_back(std::to_string(t.samples));
      rows.push_back(row);
    }
  return rows;
}

/// Stage by stage, the second set's time over the first's, sample by sample: both were measured in turn.
std::vector<std::vector<std::string>> ratioRows(const Bench& a, const Bench& b) {
  std::vector<std::vector<std::string>> rows{
      {"subsystem", "kind", "p50_ms", "versus_p50_ms", "ratio_p50", "ratio_min", "ratio_max", "samples"}};
  const std::vector<StageSamples> before = a.samples(), after = b.samples();
  for (const StageSamples& first : before)
    for (const StageSamples& second : after) {
      if (first.kind != second.kind || first.stage != second.stage) continue;
      std::vector<double> ratios;
      for (size_t i = 0; i < std::min(first.ms.size(), second.ms.size()); ++i)
        if (first.ms[i] > 0) ratios.push_back(second.ms[i] / first.ms[i]);
      const TimingStats r = statistics(ratios);
      rows.push_back({first.stage, toString(first.kind), fmt::format("{:.4f}", statistics(first.ms).p50),
                      fmt::format("{:.4f}", statistics(second.ms).p50), fmt::format("{:.3f}", r.p50),
                      fmt::format("{:.3f}", r.min), fmt::format("{:.3f}", r.max), std::to_string(r.samples)});
    }
  return rows;
}

/// --versus name=value ..., and preset=NAME.
Settings versusSettings(const std::vector<std::string>& assignments, Settings settings, bool cpuDevice) {
  for (const std::string& assignment : assignments) {
    if (assignment.starts_with("preset="))
      applyPreset(settings, assignment.substr(7), cpuDevice);
    else
      applySetting(settings, assignment);
  }
  return settings;
}

std::string rates(const Bench& bench, double copy) {
  const MatrixStats& matrix = bench.pipeline().matrix().stats;
  std::string out;
  if (bench.megaRaysPerSecond() > 0)
    out += fmt::format("build       {:.2f} Mrays/s ({} rays)\n", bench.megaRaysPerSecond(), matrix.rays);
  if (bench.sweepMilliseconds() > 0)
    out +=
        fmt::format("sweep       {:.4f} ms, {:.1f} M entries/s, {:.1f} MB: {:.2f} GB/s; copy bandwidth {:.2f} GB/s\n",
                    bench.sweepMilliseconds(), static_cast<double>(matrix.entries) * 1e-3 / bench.sweepMilliseconds(),
                    static_cast<double>(bench.sweepBytes()) * 1e-6, bench.sweepGigabytesPerSecond(), copy);
  out += fmt::format("matrix      {} facets, {} entries, {:.1f} MiB used, {:.1f} MiB allocated\n",
                     bench.pipeline().facets().count, matrix.entries, inMebibytes(matrix.bytesUsed),
                     inMebibytes(matrix.bytesAllocated));
  return out;
}

nlohmann::ordered_json toJson(const Bench& bench, double copy) {
  nlohmann::ordered_json json;
  json["stages"] = nlohmann::ordered_json::array();
  for (const StageSamples& s : bench.samples())
    json["stages"].push_back({{"stage", s.stage}, {"kind", toString(s.kind)}, {"ms", s.ms}});
  json["mrays_per_s"] = bench.megaRaysPerSecond();
  json["sweep_ms"] = bench.sweepMilliseconds();
  json["sweep_gb_per_s"] = bench.sweepGigabytesPerSecond();
  json["sweep_bytes"] = bench.sweepBytes();
  json["copy_gb_per_s"] = copy;
  json["facets"] = bench.pipeline().facets().count;
  json["matrix_entries"] = bench.pipeline().matrix().stats.entries;
  json["matrix_bytes_used"] = bench.pipeline().matrix().stats.bytesUsed;
  json["matrix_bytes_allocated"] = bench.pipeline().matrix().stats.bytesAllocated;
  json["settings"] = nlohmann::ordered_json::parse(settingsToJson(bench.pipeline().settings()));
  return json;
}

/// --compare: recordings that were made before, of any scene and device.
void printComparison(const fs::path& before, const fs::path& after) {
  std::vector<std::vector<std::string>> rows{{"subsystem", "kind", "first_p50_ms", "second_p50_ms", "ratio", "low",
                                              "high", "first_samples", "second_samples", "verdict"}};
  const std::vector<StageChange> changes = compareTimings(readRecording(before), readRecording(after));
  if (changes.empty())
    throw WorkError(fmt::format("{} and {} have no stage in common", before.string(), after.string()));
  for (const StageChange& c : changes) {
    const auto ratio = [&](double value) {
      return c.verdict == Verdict::TooFew ? std::string("-") : fmt::format("{:.4f}", value);
    };
    rows.push_back({c.stage, toString(c.kind), fmt::format("{:.4f}", c.before), fmt::format("{:.4f}", c.after),
                    ratio(c.ratio), ratio(c.low), ratio(c.high), std::to_string(c.samples[0]),
                    std::to_string(c.samples[1]), toString(c.verdict)});
  }
  print("{}", formatTable(rows, {false, false, true, true, true, true, true, true, true, false}));
}

/// --record: the set's calls as a recording (renderer/recording.h).
void record(const fs::path& folder, const DeviceSession& session, const Bench& bench, Manifest manifest) {
  manifest.settings = &bench.pipeline().settings();
  manifest.time = std::time(nullptr);
  manifest.arguments.insert(manifest.arguments.end(), {"--record", folder.string()});
  manifest.files = {"frames.csv", "summary.csv", "trace.json"};
  writeRecording(folder, {.device = session.device->info.name,
                          .scene = bench.pipeline().scene().path.filename().string(),
                          .frames = bench.frames(),
                          .manifest = manifest.toJson()});
}

void run(const BenchArguments& arguments, Machine& machine) {
  if (arguments.device.list) return printDevices(arguments.json);
  if (arguments.compare) return printComparison(arguments.compare->first, arguments.compare->second);
  arguments.picture.check();
  arguments.sceneOptions.check();
  if (arguments.ui)
    return measureUi(machine, arguments.scene, arguments.view, arguments.picture, arguments.settings,
                     arguments.sceneOptions, arguments.device);
  const Config early = arguments.settings.readConfig();
  const uint32_t frames = arguments.picture.resolveFrames({}, 20);
  const auto count = [](const char* option, const std::optional<std::string>& text, uint64_t otherwise) {
    return text ? parseInteger(option, *text, 0, 100'000) : otherwise;
  };
  const uint64_t warmup = count("--warmup", arguments.warmup, 3), rebuilds = count("--rebuilds", arguments.rebuilds, 3);
  const ViewInfo view = findViews({arguments.view.value_or("lit")}).at(0);
  if (view.isFrom(FROM_PICTURE | FROM_ORACLE))
    throw UsageError(fmt::format("--view {}: has nothing to be drawn from here", view.name));
  (void)versusSettings(arguments.versus, defaultSettings(true), /*cpuDevice=*/true);
  const glm::uvec2 size = arguments.picture.resolveSize(early);
  const auto scenePath = findScene(arguments.scene, early, "box");

  DeviceSession session(machine, arguments.settings, arguments.device);
  Scene scene = session.load(scenePath, arguments.sceneOptions);
  const Camera camera = arguments.picture.resolveCameras(session.config, scene).at(0);
  std::vector<std::unique_ptr<Bench>> sets;
  if (!arguments.versus.empty()) {
    const Settings other = versusSettings(arguments.versus, session.settings, session.device->isCpu);
    sets.push_back(std::make_unique<Bench>(*session.context, scene, session.settings, size, view.view, camera));
    sets.push_back(std::make_unique<Bench>(*session.context, std::move(scene), other, size, view.view, camera));
  } else {
    sets.push_back(
        std::make_unique<Bench>(*session.context, std::move(scene), session.settings, size, view.view, camera));
  }

  session.tell(sets.front()->pipeline().traits().region);

  // Every kind of work, the settings sets in turn.
  const Progress progress = [&](const char* stage, float fraction) { return session.progress(stage, fraction); };
  std::vector<Bench*> turns;
  for (const auto& bench : sets) {
    bench->warmUp(progress, warmup);
    session.checkNumbers(bench->pipeline());
    turns.push_back(bench.get());
  }
  measureInTurn(turns, rebuilds, frames, progress);
  for (const auto& bench : sets) session.checkNumbers(bench->pipeline());  // else the times mean nothing
  const double copy = copyBandwidth(*session.context);
  session.progress.finish();

  if (arguments.json) {
    nlohmann::ordered_json out = toJson(*sets[0], copy);
    out["device"] = session.device->info.name;
    if (sets.size() > 1) out["versus"] = toJson(*sets[1], copy);
    print("{}\n", jsonText(out, 2));
  } else {
    print("{}, {} x {}, view {}\n", session.device->info.name, size.x, size.y, view.name);
    for (size_t i = 0; i < sets.size(); ++i) {
      if (sets.size() > 1) print("\n{}:\n", i == 0 ? "settings" : "versus");
      std::vector<std::vector<std::string>> rows = statisticRows(*sets[i]);
      rows.insert(rows.begin(), columns);
      print("{}{}", formatTable(rows, {false, false, true, true, true, true, true, true, true, true}),
            rates(*sets[i], copy));
    }
    if (sets.size() > 1)
      print("\nversus / settings:\n{}",
            formatTable(ratioRows(*sets[0], *sets[1]), {false, false, true, true, true, true, true, true}));
  }
  if (arguments.csv) {
    std::vector<std::vector<std::string>> rows{columns};
    rows[0].insert(rows[0].begin(), "set");
    for (size_t i = 0; i < sets.size(); ++i)
      for (std::vector<std::string> row : statisticRows(*sets[i])) {
        row.insert(row.begin(), i == 0 ? "settings" : "versus");
        rows.push_back(row);
      }
    writeFile(*arguments.csv, csvTable(rows));
  }
  if (arguments.record) {
    const fs::path folder = *arguments.record;
    Manifest manifest = session.manifest("bench", sets[0]->pipeline());
    manifest.size = size;
    manifest.frames = frames;
    manifest.cameras = {camera};
    manifest.views = {view.name};
    manifest.arguments = {"--warmup", std::to_string(warmup), "--rebuilds", std::to_string(rebuilds)};
    for (size_t i = 0; i < sets.size(); ++i)
      record(sets.size() == 1 ? folder : folder / (i == 0 ? "settings" : "versus"), session, *sets[i], manifest);
  }
  session.checkValidation();
}

}  // namespace

Command benchCommand() {
  const auto arguments = std::make_shared<BenchArguments>();
  return {
      "bench", "Time every stage: set-up, relight, camera frames",
      [arguments](Options& options) {
        options.argument("SCENE", arguments->scene, sceneHelp() + "; default: box");
        options.value("--csv", "FILE", arguments->csv, "Write the table as CSV too");
        options.value(
            "--record", "DIR", arguments->record,
            "Write a recording: frames.csv, summary.csv, manifest.json and trace.json, which Perfetto opens (with "
            "--versus into DIR/settings and DIR/versus)");
        options.pair("--compare", "DIR DIR", arguments->compare,
                     "Measure nothing: compare two recordings stage by stage, the second's times over the first's");
        options.flag("--ui", arguments->ui,
                     "Measure the window instead: CPU time of all panels per frame (needs a display)");
        options.flag("--json", arguments->json, "Print all samples as JSON instead of the table");
        options.value("--warmup", "N", arguments->warmup, "Frames before the measurement (default 3)");
        options.value("--rebuilds", "N", arguments->rebuilds, "Times that voxels to matrix are rebuilt (default 3)");
        options.values("--versus", "NAME=VALUE", arguments->versus,
                       "A second settings set, the first with these changes (repeatable; preset=NAME too): measured "
                       "in turn with the first, with the ratio per stage");
        options.value("--view", "NAME", arguments->view, "View of the camera frames (default: lit)");
        arguments->picture.declare(options);
        arguments->sceneOptions.declare(options);
        arguments->settings.declare(options);
        arguments->device.declare(options);
      },
      [arguments](Machine& machine) { run(*arguments, machine); }};
}

}  // namespace irad::app
