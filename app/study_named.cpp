#include "app/study_named.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/interrupts.h"
#include "app/named_experiment.h"
#include "app/study_merge.h"
#include "app/version.h"
#include "gi/check/path_tracer.h"
#include "gi/study/named_report.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/image_io.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/number_text.h"
#include "renderer/base/output_file.h"

namespace irad::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const char *const kAll = "thesis", *const kNamedFile = "named.json", *const kTruths = "truths";

/// What a folder holds: named.json.
struct NamedFolder {
  std::string name, scale, device;
  bool cpu = false;
  uint32_t seeds = 0, repeats = 0;

  std::vector<const NamedStudy*> studies() const {
    std::vector<const NamedStudy*> out;
    for (const NamedStudy& study : namedStudies())
      if (name == kAll || name == study.name) out.push_back(&study);
    return out;
  }
  fs::path folderOf(const fs::path& root, const NamedStudy& study) const {
    return name == kAll ? root / study.name : root;
  }
  std::string json() const {
    return jsonText(Json{{"named", name},
                         {"scale", scale},
                         {"device", device},
                         {"cpu", cpu},
                         {"seeds", seeds},
                         {"repeats", repeats}},
                    2);
  }
};

NamedFolder readNamed(const fs::path& folder) {
  const fs::path file = folder / kNamedFile;
  const OrderedJson json = readJsonFile(file);
  try {
    NamedFolder out;
    out.name = json.at("named").get<std::string>(), out.scale = json.at("scale").get<std::string>();
    out.device = json.at("device").get<std::string>(), out.cpu = json.at("cpu").get<bool>();
    out.seeds = json.at("seeds").get<uint32_t>(), out.repeats = json.at("repeats").get<uint32_t>();
    (void)findScale(out.scale);
    if (out.studies().empty()) throw InputError(fmt::format("{}: unknown study '{}'", file.string(), out.name));
    return out;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  } catch (const UsageError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

// ---- From folders to reports ----

ExperimentResult readExperiment(const Experiment& experiment, const fs::path& folder) {
  ExperimentResult out{experiment, readSkipped(folder), {}, readFigures(folder)};
  std::error_code ignored;
  if (out.skipped.empty() && !fs::exists(folder / "study.json", ignored)) out.skipped = "not measured yet";
  if (!out.skipped.empty()) return out;
  const SettingGrid grid = gridOf(readIdentity(folder));
  const std::vector<PointSummary> points = summarize(readResults(folder), grid.labels());
  for (size_t i = 0; i < points.size(); ++i) {
    MeasuredPoint point{{}, points[i]};
    for (size_t s = 0; s < grid.swept().size(); ++s) point.settings[grid.swept()[s]->name] = grid.values(i)[s];
    out.points.push_back(std::move(point));
  }
  return out;
}

std::vector<std::pair<std::string, TextTable>> thesisTables(const fs::path& folder, const NamedResults& results) {
  std::vector<std::pair<std::string, TextTable>> out;
  if (const TextTable memory = readMemoryTable(folder / "sponza"); !memory.empty())
    out.emplace_back("Table 1: memory of Sponza, MiB", memory);
  out.emplace_back("Table 2: extents, grids and voxel edges", extentTable(results));
  out.emplace_back("Table 3: geometry", geometryTable(results));
  for (int table = 6; table <= 10; ++table) {
    std::string experiment = experimentOfTable(table);
    for (const ExperimentResult& e : results.experiments)  // without Sponza: the Box
      if (table == 10 && e.experiment.name == experiment && !e.skipped.empty()) experiment = "writeback-box";
    out.emplace_back(
        fmt::format("Table {}: milliseconds by stage, {}; the thesis's on an AMD Radeon RX 7700 XT at N = 256, so that "
                    "ratios compare machines and sizes as well",
                    table, experiment),
        timeTable(table, readResults(folder / experiment).times));
  }
  return out;
}

void printFindings(const NamedReport& report) {
  print("{}: {}\n", report.study->name, report.study->question);
  for (const ExperimentResult& e : report.results.experiments)
    if (!e.skipped.empty()) print("  {:<12} skipped: {}\n", e.experiment.name, e.skipped);
  for (const Claim& claim : report.study->claims) {
    const Answer answer = answerTo(claim, report.results);
    print("  Section {}: {}\n    here: {}\n    {}\n", claim.section, claim.said, answer.text, toString(answer.verdict));
  }
}

/// All that is made of what lies in the folders; `asked`: the study whose findings are printed, or all of them.
void report(const fs::path& root, const NamedFolder& named, const std::string& asked) {
  const StudyScale& scale = findScale(named.scale);
  std::vector<NamedReport> reports;
  for (const NamedStudy* study : named.studies()) {
    const fs::path folder = named.folderOf(root, *study);
    NamedReport r{study, {}, {}};
    r.results.cpu = named.cpu, r.results.full = std::string_view(scale.name) == "full";
    for (const Experiment& e : study->experiments(scale))
      r.results.experiments.push_back(readExperiment(e, folder / e.name));
    r.facts = {
        fmt::format("Scale {}: {} voxels, {} rays, {} × {} pixels, {} seeds, {} repeats, where an experiment "
                    "does not say otherwise",
                    scale.name, scale.voxels, scale.rays, scale.width, scale.height, named.seeds, named.repeats),
        fmt::format("Device: {}{}", named.device, named.cpu ? "; the thesis's was a GPU (AMD Radeon RX 7700 XT)" : ""),
        "Every sentence and verdict under \"measured here\" is computed from the figures below it"};
    if (std::string_view(study->name) == "tables") r.tables = thesisTables(folder, r.results);
    std::error_code ignored;
    if (fs::exists(folder, ignored)) writeNamedReport(folder, r);  // a thesis may have some of its questions
    if (asked == named.name || asked == study->name) printFindings(r);
    reports.push_back(std::move(r));
  }
  if (named.name == kAll) writeThesisReport(root, reports);
  print("wrote       {}\n", (root / "report.html").string());
}

// ---- Measuring ----

/// The options that fix what an experiment fixes.
void refuseOthers(const std::string& name, const MeasureArguments& m) {
  const std::pair<const char*, bool> fixed[] = {{"--sweep", !m.sweeps.empty()},
                                                {"--reference", m.reference.file.has_value()},
                                                {"--second-reference", m.secondReference.has_value()},
                                                {"--view", m.view.has_value()},
                                                {"--camera", !m.picture.cameras.empty()},
                                                {"--preset", m.settings.preset.has_value()},
                                                {"--config", m.settings.config.has_value()}};
  for (const auto& [option, given] : fixed)
    if (given)
      throw UsageError(fmt::format("irad study {}: {} is the experiments' own; --set changes settings of all of them",
                                   name, option));
}

/// So that a merged study can be gone on with. What a truth is vouched for by comes last.
void mergeTruths(const std::vector<fs::path>& shards, const fs::path& out) {
  for (const fs::path& shard : shards) {
    std::error_code ignored;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(shard / kTruths, ignored)) files.push_back(entry.path());
    if (!files.empty()) makeFolder(out / kTruths);
    std::stable_partition(files.begin(), files.end(), [](const fs::path& file) { return file.extension() != ".json"; });
    for (const fs::path& file : files)
      if (file.extension() == ".json" || file.extension() == linearExtension())
        fs::copy_file(file, out / kTruths / file.filename(), fs::copy_options::skip_existing, ignored);
  }
}

struct Work {
  const NamedStudy* study;
  Experiment experiment;
  fs::path folder;
  double weight;  ///< pictures, about
};

}  // namespace

void NamedArguments::declare(Options& options) {
  options.value("--scale", "NAME", scale,
                "Named studies: full (the thesis's sizes; default on GPUs) or small (minutes on two cores; default on "
                "CPU devices)");
  options.value(
      "--sponza", "FILE", sponza,
      "Named studies: Sponza as glTF, with a sun (default: sponza_small_lit_m.glb of $IRAD_SHARED or ../shared, "
      "where it is there)");
}

std::vector<std::string> namedStudyNames() {
  std::vector<std::string> out;
  for (const NamedStudy& study : namedStudies()) out.emplace_back(study.name);
  out.emplace_back(kAll);
  return out;
}

std::string namedStudyHelp() {
  std::string out = "The thesis's experiments, each with what the thesis found beside what is measured: ";
  for (const NamedStudy& study : namedStudies()) out += fmt::format("{}: {}; ", study.name, study.question);
  return out + fmt::format("{}: all of them", kAll);
}

void runNamedStudy(Machine& machine, const std::string& name, const MeasureArguments& measure, const Shard& shard,
                   const NamedArguments& arguments) {
  refuseOthers(name, measure);
  measure.sceneOptions.check();
  measure.picture.check();
  if (arguments.scale) (void)findScale(*arguments.scale);
  const std::optional<fs::path> sponza = findSponza(arguments.sponza);
  DeviceSession session(machine, measure.settings, measure.device);
  const StudyScale& scale = findScale(arguments.scale.value_or(session.device->isCpu ? "small" : "full"));
  const auto count = [](const char* option, const std::optional<std::string>& text, uint32_t otherwise, uint32_t most) {
    return text ? static_cast<uint32_t>(parseInteger(option, *text, 1, most)) : otherwise;
  };
  NamedFolder named{.name = name,
                    .scale = scale.name,
                    .device = session.device->info.name,
                    .cpu = session.device->isCpu,
                    .seeds = count("--seeds", measure.seeds, scale.seeds, 10'000),
                    .repeats = count("--repeats", measure.repeats, scale.repeats, 100'000)};
  const fs::path root = measure.out.value_or(fmt::format("out/{}", name));
  std::error_code ignored;
  if (fs::exists(root / kNamedFile, ignored)) {
    const NamedFolder there = readNamed(root);
    if (there.name == kAll) named.name = kAll;  // one of its questions
    if (there.name != named.name || there.scale != named.scale || there.device != named.device)
      throw UsageError(
          fmt::format("{} holds another study: {} ({}, {}) instead of {} ({}, {}); name another folder with "
                      "--out, or remove it",
                      root.string(), there.name, there.scale, there.device, named.name, named.scale, named.device));
  }
  const MadeFolder folder(root, kStudyLabels);
  writeFile(root / kNamedFile, named.json());
  session.progress.note(fmt::format("scale {}: {}", scale.name,
                                    arguments.scale ? "as asked for"
                                    : named.cpu     ? "the default of CPU devices (--scale full: the thesis's sizes)"
                                                    : "the default of GPUs (--scale small: minutes)"));

  const StopOnSignal stop;
  ExperimentRunner runner(session, measure, scale, sponza, shard, named.seeds, named.repeats, root / kTruths);
  std::vector<Work> work;
  double all = 0, done = 0;
  for (const NamedStudy* study : named.studies()) {
    if (name != named.name && name != study->name) continue;
    for (const Experiment& e : study->experiments(scale)) {
      work.push_back({study, e, named.folderOf(root, *study) / e.name, runner.pictures(e)});
      all += work.back().weight;
    }
  }
  std::vector<std::pair<Experiment, fs::path>> experiments;
  for (const Work& w : work) experiments.emplace_back(w.experiment, w.folder);
  const ExperimentsAhead ahead = runner.ahead(std::move(experiments));
  session.progress.note(fmt::format(
      "{} experiments, {} points: {:.0f} pictures to come; {} of them compute a truth, of which {} are different "
      "and {} are to be made{}",
      ahead.experiments, ahead.points, ahead.pictures, ahead.asking, ahead.truths, ahead.missing,
      ahead.seconds > 0 ? "; about " + duration(ahead.seconds) : ""));
  using Clock = std::chrono::steady_clock;
  const Clock::time_point began = Clock::now();
  for (size_t i = 0; i < work.size(); ++i) {
    throwIfStopped();
    const double seconds = std::chrono::duration<double>(Clock::now() - began).count();
    session.progress.note(fmt::format("{} of {}: {} {}{}", i + 1, work.size(), work[i].study->name,
                                      work[i].experiment.name,
                                      done > 0 ? ", " + timeLeft(seconds * (all - done) / done) : ""));
    runner.run(work[i].experiment, work[i].folder, fmt::format("{} {}", work[i].study->name, work[i].experiment.name));
    done += work[i].weight;
  }
  session.progress.finish();
  report(root, named, name);
  session.checkValidation();
}

bool isNamedStudy(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / kNamedFile, ignored);
}

void mergeNamedStudies(const std::vector<fs::path>& shards, const fs::path& out) {
  const NamedFolder named = readNamed(shards.front());
  for (const fs::path& shard : shards)
    if (const NamedFolder other = readNamed(shard);
        other.name != named.name || other.scale != named.scale || other.device != named.device)
      throw InputError(fmt::format("{}: not the study of {}: {} ({}, {}) instead of {} ({}, {})", shard.string(),
                                   shards.front().string(), other.name, other.scale, other.device, named.name,
                                   named.scale, named.device));
  makeFolder(out);
  writeFile(out / kNamedFile, named.json());
  for (const NamedStudy* study : named.studies())
    for (const Experiment& e : study->experiments(findScale(named.scale))) {
      std::vector<fs::path> folders;
      for (const fs::path& shard : shards) folders.push_back(named.folderOf(shard, *study) / e.name);
      mergeExperiment(folders, named.folderOf(out, *study) / e.name);
    }
  mergeTruths(shards, out);
  report(out, named, named.name);
}

}  // namespace irad::app
