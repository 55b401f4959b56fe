// `irad study`: what accuracy costs. `cost` measures error, time and memory over a grid of settings; `merge` puts the
// shards of a study together; `pick` chooses settings by a budget, among points that were measured.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/devices.h"
#include "app/study.h"
#include "app/study_run.h"
#include "gi/manifest.h"
#include "gi/study/pick.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/near_match.h"
#include "renderer/base/number_text.h"
#include "renderer/base/output_file.h"

namespace irad::app {
namespace {

namespace fs = std::filesystem;

uint32_t evenSamples(const std::string& option, const std::string& text) {
  const auto samples = static_cast<uint32_t>(parseInteger(option, text, 2, 10'000'000));
  if (samples % 2 != 0) throw UsageError(fmt::format("{}: '{}' is not even", option, text));
  return samples;
}

TruthSource truthOf(const StudyArguments& a, DeviceSession& session) {
  if (a.reference.file && a.referenceSamples)
    throw UsageError("--reference and --reference-samples: a study has one truth");
  if (!a.reference.file && !a.referenceSamples)
    throw UsageError("irad study cost: no truth: --reference FILE, or --reference-samples N of the path tracer");
  if (a.secondReference && !a.reference.file) throw UsageError("--second-reference needs --reference");
  TruthSource out;
  if (a.referenceSamples) {
    out.samples = evenSamples("--reference-samples", *a.referenceSamples);
    return out;
  }
  out.file = *a.reference.read(session.config, session.progress);
  if (a.secondReference) out.secondFile = readReference(*a.secondReference);
  return out;
}

/// `irad study cost SCENE`.
void costStudy(const StudyArguments& a) {
  if (a.names.size() > 2) throw UsageError(fmt::format("irad study cost: unexpected argument '{}'", a.names[2]));
  a.sceneOptions.check();
  a.picture.check();
  if (a.shard) parseShard(*a.shard);
  const Config early = a.settings.readConfig();
  SettingGrid(a.sweeps, a.settings.resolve(early, /*cpuDevice=*/true));  // before a device is opened

  DeviceSession session(a.settings, a.device);
  StudyTask task;
  task.out = a.out.value_or("out/study");
  task.seeds = static_cast<uint32_t>(parseInteger("--seeds", a.seeds.value_or("4"), 1, 10'000));
  const char* const repeats = session.device->isCpu ? "5" : "30";
  task.repeats = static_cast<uint32_t>(parseInteger("--repeats", a.repeats.value_or(repeats), 1, 100'000));
  if (a.shard) task.shard = parseShard(*a.shard);
  task.view = findViews({a.view.value_or("lit")}).at(0);
  for (const std::string& peer : a.peers)
    if (peer != "path-tracer")
      throw UsageError(fmt::format("--peer: unknown '{}'{}", peer, suggestion(peer, {"path-tracer"})));
  for (const std::string& samples : splitList("--peer-samples", {a.peerSamples.value_or("2,8,32,128")}))
    if (const uint32_t n = evenSamples("--peer-samples", samples); !a.peers.empty()) task.peerSamples.push_back(n);
  if (a.referenceSamples || !a.peers.empty()) requirePathTracer(task.view, session.settings);
  task.truth = truthOf(a, session);
  const std::optional<std::string> name = a.names.size() > 1 ? std::optional(a.names[1]) : std::nullopt;
  Scene scene = session.load(findScene(name, session.config, std::nullopt), a.sceneOptions);
  task.camera = a.picture.resolveCameras(session.config, scene).at(0);
  task.size = a.picture.resolveSize(session.config);
  if (task.truth.file && !a.picture.size && !session.config.size) task.size = task.truth.file->picture.size;
  StudyRun run(session, std::move(scene), SettingGrid(a.sweeps, session.settings), std::move(task));
  run.measure();
  finishStudy(a.out.value_or("out/study"), run.grid(), run.results(), run.notes());
  session.checkValidation();
}

SettingGrid gridOf(const StudyIdentity& identity) {
  try {
    const auto json = nlohmann::ordered_json::parse(identity);
    Settings settings;
    settingsFromJson(settings, json.at("settings").dump());
    return {gridsOf(identity), settings};
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("study.json: {}", error.what()));
  }
}

/// `irad study merge DIR... --out DIR`.
void mergeShards(const StudyArguments& arguments) {
  const std::vector<fs::path> shards(arguments.names.begin() + 1, arguments.names.end());
  if (shards.empty()) throw UsageError("irad study merge: no folders given");
  if (!arguments.out) throw UsageError("irad study merge: no --out DIR");
  const fs::path out = *arguments.out;
  const StudyIdentity identity = readIdentity(shards.front());
  StudyResults results;
  for (const fs::path& shard : shards) {
    if (const std::string other = differences(readIdentity(shard), identity); !other.empty())
      throw InputError(fmt::format("{}: not the study of {}: {}", shard.string(), shards.front().string(), other));
    merge(results, readResults(shard), shard.string());
  }
  StudyFolder folder(out, identity);
  merge(results, folder.results, out.string());
  folder.results = std::move(results);
  folder.save();
  makeFolder(out / "pictures");
  for (const fs::path& shard : shards) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(shard / "pictures", ignored))
      fs::copy_file(entry.path(), out / "pictures" / entry.path().filename(), fs::copy_options::overwrite_existing,
                    ignored);
    fs::copy_file(shard / "notes.json", out / "notes.json", fs::copy_options::skip_existing, ignored);
  }
  const SettingGrid grid = gridOf(identity);
  ReportNotes notes;
  if (fs::exists(out / "notes.json")) {
    std::ifstream in(out / "notes.json");
    const auto saved = nlohmann::ordered_json::parse(in, nullptr, /*allow_exceptions=*/false);
    try {
      notes.facts = saved.at("facts").get<std::vector<std::string>>();
      const auto pair = [&](const char* name) {
        return glm::uvec2(saved.at(name).at(0).get<uint32_t>(), saved.at(name).at(1).get<uint32_t>());
      };
      notes.pictureSize = pair("picture"), notes.cropAt = pair("crop"), notes.cropSize = pair("crop_size");
    } catch (const nlohmann::json::exception& error) {
      throw InputError(fmt::format("{}: {}", (out / "notes.json").string(), error.what()));
    }
  }
  finishStudy(out, grid, folder.results, notes);
}

double parsePositive(const std::string& option, const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value) || value <= 0)
    throw UsageError(fmt::format("{}: '{}' is not allowed; expected a number above 0", option, text));
  return value;
}

/// `irad study pick DIR --budget-ms X`.
void pickPoint(const StudyArguments& arguments) {
  if (arguments.names.size() != 2) throw UsageError("irad study pick: expected one folder of a study");
  Budget budget;
  if (arguments.budgetMs) budget.ms = parsePositive("--budget-ms", *arguments.budgetMs);
  if (arguments.budgetMib) budget.mib = parsePositive("--budget-mib", *arguments.budgetMib);
  if (arguments.targetError) budget.error = parsePositive("--target-error", *arguments.targetError);
  if (!budget.ms && !budget.mib && !budget.error)
    throw UsageError("irad study pick: by what? --budget-ms X, --budget-mib Y or --target-error E");
  const std::string wanted = arguments.cost.value_or("first_picture");
  const CostKind* cost = nullptr;
  std::vector<std::string> names;
  for (const CostKind& kind : costKinds())
    if (kind.time) {
      names.emplace_back(kind.name);
      if (wanted == kind.name) cost = &kind;
    }
  if (!cost) throw UsageError(fmt::format("--cost: unknown '{}'{}", wanted, suggestion(wanted, names)));

  const fs::path folder = arguments.names[1];
  const SettingGrid grid = gridOf(readIdentity(folder));
  const std::vector<PointSummary> points = summarize(readResults(folder), grid.labels());
  const std::optional<size_t> chosen = pick(points, *cost, budget);
  if (!chosen)
    throw WorkError(fmt::format("{}: none of its {} points is within that: see {}", folder.string(), points.size(),
                                (folder / "points.csv").string()));
  const PointSummary& p = points[*chosen];
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
  if (least && *least != *chosen)
    print("loss        {} times the error of {} ({}), which takes {} times the {}\n",
          shortNumber(p.relMse.mean / points[*least].relMse.mean), *least, points[*least].label,
          shortNumber(cost->of(points[*least]) / cost->of(p)), cost->unit);
  if (best && *best != *chosen)
    print("cheapest    {} ({}): {} times the error for {} of the {}\n", *best, points[*best].label,
          shortNumber(points[*best].relMse.mean / p.relMse.mean), shortNumber(cost->of(points[*best]) / cost->of(p)),
          cost->unit);
  const fs::path file = folder / "picked.json";
  writeFile(file, settingsFile(grid.settings(*chosen)));
  print("wrote       {} (for --config)\n", file.string());
}

void run(const StudyArguments& arguments) {
  if (arguments.device.list) return printDevices(/*json=*/false);
  struct Study {
    const char* name;
    void (*run)(const StudyArguments&);
  };
  const Study studies[] = {{"cost", costStudy}, {"merge", mergeShards}, {"pick", pickPoint}};
  std::vector<std::string> names;
  for (const Study& study : studies) names.emplace_back(study.name);
  if (arguments.names.empty()) throw UsageError(fmt::format("irad study: which? {}", fmt::join(names, " | ")));
  for (const Study& study : studies)
    if (arguments.names[0] == study.name) return study.run(arguments);
  throw UsageError(fmt::format("unknown study '{}'{}; there are: {}", arguments.names[0],
                               suggestion(arguments.names[0], names), fmt::join(names, ", ")));
}

}  // namespace

Command studyCommand() {
  const auto arguments = std::make_shared<StudyArguments>();
  return {"study", "What accuracy costs: error against time and memory over a grid of settings",
          [arguments](Options& options) {
            options.arguments(
                "STUDY", arguments->names,
                "cost SCENE: measure a grid; merge DIR...: put the shards of one study together; pick DIR: settings by "
                "a budget, from its measured points. Of a picture v "
                "against a reference r, over all colour channels: relMSE = mean (v - r)^2 / (r^2 + e) of means "
                "over 8 x 8 pixels, e = (0.1 mean r)^2; RMSE = sqrt mean (v - r)^2; mean error = mean (v - r); "
                "PSNR = 20 log10(largest r / RMSE) dB; FLIP = mean LDR-FLIP (Andersson et al. 2020) of both "
                "times 2^camera.exposure_ev within [0, 1]; +-: half a 95 % interval over seeds by Student's t");
            options.values(
                "--sweep", "NAME=VALUES", arguments->sweeps,
                "Setting to go through: a,b,c or FIRST..LAST*FACTOR or FIRST..LAST+STEP; several make a grid");
            options.value("--out", "DIR", arguments->out,
                          "Folder of the study (default: out/study); one that holds a part of it is gone on with");
            options.value("--seeds", "N", arguments->seeds, "Seeds per point, from --seed on (default 4)");
            options.value("--repeats", "N", arguments->repeats,
                          "Times that each point is timed (default 30, on CPU devices 5)");
            options.value("--shard", "PART/OF", arguments->shard, "Only every OF-th point, from the PART-th on");
            options.value(
                "--view", "NAME", arguments->view,
                "View that is compared (default: lit; with the path tracer indirect, or lit and scene.lambertian)");
            arguments->reference.declare(options);
            options.value("--second-reference", "FILE", arguments->secondReference,
                          "A second reference with independent noise: that of both then cancels in relMSE");
            options.value("--reference-samples", "N", arguments->referenceSamples,
                          "The path tracer's picture with N samples per pixel as the reference, its noise cancelled by "
                          "halves");
            options.values("--peer", "NAME", arguments->peers, "Measure another renderer too: path-tracer");
            options.value("--peer-samples", "N[,N...]", arguments->peerSamples,
                          "Its samples per pixel, even (default 2,8,32,128)");
            options.value("--budget-ms", "X", arguments->budgetMs, "pick: milliseconds to spend at most, of --cost");
            options.value("--budget-mib", "Y", arguments->budgetMib, "pick: device memory to take at most");
            options.value("--target-error", "E", arguments->targetError, "pick: the cheapest with no more relMSE");
            options.value("--cost", "NAME", arguments->cost, "pick: first_picture (default), build, relight or frame");
            arguments->picture.declare(options);
            arguments->sceneOptions.declare(options);
            arguments->settings.declare(options);
            arguments->device.declare(options);
          },
          [arguments] { run(*arguments); }};
}

}  // namespace irad::app
