#include "app/named_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <set>

#include "app/blender_pictures.h"
#include "app/interrupts.h"
#include "app/memory_table.h"
#include "app/study_ahead.h"
#include "app/study_merge.h"
#include "gi/check/path_tracer.h"
#include "gi/check/writeback_figures.h"
#include "gi/facets.h"
#include "gi/field.h"
#include "gi/host_matrix.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/memory_report.h"
#include "gi/sky.h"
#include "gi/study/report.h"
#include "gi/thesis/memory.h"
#include "renderer/base/csv.h"
#include "renderer/base/error.h"
#include "renderer/base/image_io.h"
#include "renderer/base/number_text.h"
#include "renderer/base/output_file.h"
#include "renderer/scene/scene_content.h"

namespace irad::app {
namespace {

namespace fs = std::filesystem;

const char *const kFigures = "figures.csv", *const kFigureHead = "name,value", *const kSkipped = "skipped.txt",
                  *const kMemory = "memory.csv";
constexpr const char* kPreset = "preset=";

fs::path cyclesPicture() {
  return sharedFolder() / "scenes/references/sponza_lit_diffuse.exr";
}
fs::path secondCyclesPicture() {
  return sharedFolder() / "scenes/references/sponza_lit_diffuse_seed1.exr";
}

void writeFigures(const fs::path& folder, const std::map<std::string, double>& figures) {
  std::string out = fmt::format("{}\n", kFigureHead);
  for (const auto& [name, value] : figures) out += fmt::format("{},{}\n", csvField(name), value);
  writeFile(folder / kFigures, out);
}

double meanOf(const LinearPixels& pixels) {
  double sum = 0;
  for (const glm::vec4& p : pixels) sum += double{p.x} + p.y + p.z;
  return sum / (3 * static_cast<double>(pixels.size()));
}

/// Every `step`-th row's hits, columns ascending.
std::vector<HostRow> someRows(Context& context, const FormFactors& matrix) {
  constexpr uint32_t kMost = 20'000;
  const auto step = std::max<uint32_t>(1, static_cast<uint32_t>(matrix.rows) / kMost);
  std::vector<HostRow> out;
  forEachRow(context, matrix, [&](uint32_t row, const HostRow& r) {
    if (row % step == 0) out.push_back(merged(r));
  });
  return out;
}

/// The share of rays that must have ended elsewhere for the rows to differ as they do: of a row's rays as many met
/// the same facets as both have hits on them.
double movedShare(const std::vector<HostRow>& a, const std::vector<HostRow>& b, uint32_t rays) {
  IRAD_CHECK_OP(a.size(), ==, b.size());
  double moved = 0;
  for (size_t row = 0; row < a.size(); ++row) {
    uint64_t same = 0, hits[2] = {0, 0};
    for (const uint32_t n : a[row].hits) hits[0] += n;
    for (const uint32_t n : b[row].hits) hits[1] += n;
    for (size_t i = 0, k = 0; i < a[row].columns.size() && k < b[row].columns.size();)
      if (a[row].columns[i] == b[row].columns[k])
        same += std::min(a[row].hits[i++], b[row].hits[k++]);
      else
        a[row].columns[i] < b[row].columns[k] ? ++i : ++k;
    moved += static_cast<double>(std::max(hits[0], hits[1]) - same);
  }
  return a.empty() ? 0 : moved / (static_cast<double>(a.size()) * rays);
}

}  // namespace

fs::path sharedFolder() {
  const char* given = std::getenv("IRAD_SHARED");
  return given ? fs::path(given) : fs::path("../shared");
}

std::optional<fs::path> findSponza(const std::optional<std::string>& given) {
  std::error_code ignored;
  if (given) {
    if (!fs::exists(*given, ignored)) throw InputError(fmt::format("--sponza: {}: no such file", *given));
    return *given;
  }
  const fs::path file = sharedFolder() / "scenes/sponza/sponza_small_lit_m.glb";
  return fs::exists(file, ignored) ? std::optional(file) : std::nullopt;
}

ExperimentRunner::ExperimentRunner(DeviceSession& session, const MeasureArguments& measure, const StudyScale& scale,
                                   std::optional<fs::path> sponza, Shard shard, uint32_t seeds, uint32_t repeats,
                                   fs::path truths)
    : session_(session),
      measure_(measure),
      scale_(scale),
      sponza_(std::move(sponza)),
      shard_(shard),
      seeds_(seeds),
      repeats_(repeats),
      truths_{.folder = std::move(truths), .user = {}, .users = {}} {}

/// Presets, then the scale, then the experiment's own, then --set.
Settings ExperimentRunner::base(const Experiment& e) const {
  Settings out = defaultSettings(session_.device->isCpu);
  for (const std::string& text : e.settings)
    if (text.starts_with(kPreset))
      applyPreset(out, text.substr(std::string_view(kPreset).size()), session_.device->isCpu);
  out.voxel.resolution = scale_.voxels;
  out.matrix.gpu.rays = scale_.rays;
  for (const std::string& text : scale_.settings) applySetting(out, text);
  for (const std::string& text : e.settings)
    if (!text.starts_with(kPreset)) applySetting(out, text);
  for (const std::string& text : measure_.settings.set) applySetting(out, text);
  out.matrix.gpu.seed = session_.settings.matrix.gpu.seed;
  return out;
}

SettingGrid ExperimentRunner::gridOf(const Experiment& e) const {
  const GridTexts one{{}};
  return {e.grids.empty() ? one : e.grids, base(e)};
}

std::string ExperimentRunner::whyNot(const Experiment& e) const {
  std::error_code ignored;
  if (e.truth == TruthKind::Cycles && !fs::exists(cyclesPicture(), ignored))
    return fmt::format("there is no picture by Cycles ({})", cyclesPicture().string());
  if (e.truth == TruthKind::Cycles && linearExtension() != std::string_view(".exr"))
    return "this build reads no EXR files (IRAD_OIIO)";
  if (e.truth == TruthKind::Blender) return whyNoBlender();
  if (e.scene == "sponza" && !sponza_) return "no Sponza (--sponza FILE)";
  if (e.truth == TruthKind::PathTracer && !hasPathTracer()) return "this build has no path tracer (IRAD_EMBREE)";
  return "";
}

double ExperimentRunner::pictures(const Experiment& e) const {
  const auto points = static_cast<double>(gridOf(e).size());
  return whyNot(e).empty() ? points * (seeds_ + repeatsOf(e) + 1.0) : 0;
}

const Scene& ExperimentRunner::sceneOf(const Experiment& e) {
  const Settings& s = session_.settings;
  const std::string wanted = fmt::format("{} {} {}", e.scene, s.scene.lambertian, s.scene.doubleSided);
  if (wanted != loaded_) {
    scene_.reset();
    const fs::path path = e.scene == "sponza" ? *sponza_ : findScene(e.scene, session_.config, std::nullopt);
    SceneArguments options = measure_.sceneOptions;
    options.noSidecar = true;
    const Settings before = session_.settings;
    scene_ = session_.load(path, options);
    session_.settings = before;  // the experiment's, whether or not its scene was there already
    sceneContent_ = sceneContent(*scene_);
    loaded_ = wanted;
  }
  return *scene_;
}

StudyTask ExperimentRunner::taskOf(const Experiment& e, const Scene& scene, const fs::path& folder) {
  StudyTask task;
  task.study = "cost";
  task.out = folder;
  task.view = findViews({e.view}).at(0);
  PictureArguments camera;
  if (!e.camera.empty()) camera.cameras = {e.camera};
  task.camera = camera.resolveCameras({}, scene).at(0);
  task.size = measure_.picture.size ? parseSize(*measure_.picture.size) : glm::uvec2(scale_.width, scale_.height);
  task.seeds = seeds_, task.repeats = repeatsOf(e), task.shard = shard_;
  task.sharedTruths = &truths_;
  switch (e.truth) {
    case TruthKind::PathTracer:
      task.truth.samples =
          measure_.referenceSamples ? evenSamples("--reference-samples", *measure_.referenceSamples) : scale_.samples;
      break;
    case TruthKind::OwnSettings: {
      Settings truth = session_.settings;
      applyPreset(truth, "reference", session_.device->isCpu);
      truth.voxel.resolution = scale_.truthVoxels;
      truth.matrix.gpu.rays = scale_.truthRays;
      for (const std::string& text : scale_.settings) applySetting(truth, text);
      for (const std::string& text : e.truthSettings) applySetting(truth, text);
      task.truth.settings = truth;
      break;
    }
    case TruthKind::Itself:
      task.truth.settings = session_.settings;
      break;
    case TruthKind::Cycles:
      task.truth.file = readReference(cyclesPicture());
      if (fs::exists(secondCyclesPicture())) task.truth.secondFile = readReference(secondCyclesPicture());
      task.size = task.truth.file->picture.size;
      break;
    case TruthKind::Blender: {
      const LinearPicture truth = blenderPart(folder.parent_path() / "blender",
                                              {scene.path, e.camera, e.engine, task.size, scale_.samples}, e.view);
      task.truth.file = readReference(writeLinear(folder / "truth", truth.size, truth.pixels));
      break;
    }
  }
  return task;
}

ExperimentsAhead ExperimentRunner::ahead(std::vector<std::pair<Experiment, fs::path>> experiments) {
  // Scene after scene, so that each is loaded once.
  std::ranges::stable_sort(experiments, {}, [](const auto& e) { return e.first.scene; });
  ExperimentsAhead out;
  std::set<std::string> truths;
  std::map<std::string, PictureTrial> tried;  // by scene
  for (const auto& [e, folder] : experiments) {
    throwIfStopped();
    if (!whyNot(e).empty()) continue;
    const SettingGrid grid = gridOf(e);
    std::vector<size_t> points;
    for (size_t point = 0; point < grid.size(); ++point)
      if (shard_.has(point)) points.push_back(point);
    if (points.empty()) continue;
    ++out.experiments, out.points += points.size();
    session_.settings = grid.base();
    const Scene& scene = sceneOf(e);
    const bool computed = e.truth != TruthKind::Cycles && e.truth != TruthKind::Blender;
    StudyTask task =
        computed ? taskOf(e, scene, folder) : taskOf({.scene = e.scene, .camera = e.camera}, scene, folder);
    task.repeats = repeatsOf(e);
    std::error_code ignored;
    const bool begun = fs::exists(folder / "study.json", ignored);
    const StudyResults there = begun ? readResults(folder) : StudyResults{};
    PicturesMissing pictures;
    for (const size_t point : points) {
      pictures += picturesMissing(there, point, grid.settings(point), grid.base().matrix.gpu.seed, task);
    }
    out.pictures += pictures.all();
    bool trace = false;
    if (computed) {
      ++out.asking;
      const TruthRecipe recipe = *truthRecipe(session_, task, scene, sceneContent_, grid.settings(0).sky);
      if (truths.insert(recipe.name()).second && !TruthStore(truths_.folder).has(recipe)) {
        ++out.missing;
        trace = task.truth.samples.has_value();
        if (!trace) pictures.errors += 2;
      }
    }
    if (trace) out.seconds += secondsOfTracing(scene, grid.settings(0).sky, task, *task.truth.samples);
    if (pictures.all() == 0) continue;
    const bool frames = pictures.frames > 0;
    const auto [one, first] = tried.try_emplace(e.scene + (frames ? " by frames" : ""));
    if (first) {
      session_.progress("trial", 0);
      const auto hasFrames = [&](size_t p) { return grid.settings(p).solver.method == SolverMethod::bruteForce; };
      const size_t point = frames ? *std::ranges::find_if(points, hasFrames) : points.front();
      one->second = tryPicture(session_, scene, grid.settings(point), task);
    }
    out.seconds += one->second.of(pictures) + pictures.frames * one->second.frame;
  }
  out.truths = truths.size();
  return out;
}

void ExperimentRunner::run(const Experiment& e, const fs::path& folder, const std::string& who) {
  truths_.user = who;
  makeFolder(folder);
  if (const std::string why = whyNot(e); !why.empty()) {
    session_.progress.note("  skipped: " + why);
    writeFile(folder / kSkipped, why);
    return;
  }
  removeFile(folder / kSkipped);
  const SettingGrid grid = gridOf(e);
  if (shard_.part > grid.size()) {
    session_.progress.note("  no point of this shard");
    return;
  }
  session_.settings = grid.base();
  try {
    const Scene& scene = sceneOf(e);
    const StudyTask task = taskOf(e, scene, folder);
    StudyRun run(session_, scene, grid, task);
    run.measure();
    writeReport(folder, run.grid(), run.results(), run.notes());
    measureFigures(e, run, task);
  } catch (const NoPicture& error) {
    session_.progress.note(fmt::format("{}: {}", e.name, error.what()));
    writeFile(folder / kSkipped, error.what());
  } catch (const DeviceError& error) {
    session_.progress.note(fmt::format("{}: {}", e.name, error.what()));
    session_.device->waitIdle();
    session_.timings.reset();
    writeFile(folder / kSkipped, error.what());
  }
}

void ExperimentRunner::measureFigures(const Experiment& e, const StudyRun& run, const StudyTask& task) {
  std::map<std::string, double> figures = readFigures(task.out);
  figures["truth_mean"] = meanOf(run.truth().mean());
  const SettingGrid& grid = run.grid();
  const auto has = [&](const std::string& name) { return figures.contains(name); };
  const auto pipelineOf = [&](size_t point) {
    auto pipeline = std::make_unique<Pipeline>(*session_.context, *scene_, grid.settings(point));
    pipeline->prepare([](const char*, float) { return throwIfStopped(), true; });
    return pipeline;
  };
  const auto failed = [&](size_t point) { return run.results().hasFailed(point); };
  if (e.engine == "EEVEE" && e.view == "lit" && !has("cycles_flip")) {
    // How far EEVEE is from Cycles, whatever ours are like.
    const LinearPicture cycles = blenderPart(task.out.parent_path() / "blender",
                                             {scene_->path, e.camera, "CYCLES", task.size, scale_.samples}, e.view);
    figures["cycles_mean"] = meanOf(cycles.pixels);
    figures["cycles_flip"] =
        measurePicture(task.size, run.truth().first, cycles.pixels, {}, std::exp2(session_.settings.camera.exposureEv))
            .flip;
  }
  if (e.flicker)
    for (size_t point = 0; point < grid.size(); ++point) {
      throwIfStopped();
      const std::string name = fmt::format("flicker {}", point);
      if (!shard_.has(point) || failed(point) || has(name)) continue;
      session_.progress("flicker", static_cast<float>(point) / static_cast<float>(grid.size()));
      const auto pipeline = pipelineOf(point);
      figures[name] =
          measureWriteback(*session_.context, *pipeline, task.camera, task.size, scale_.stillFrames).flicker;
    }
  if (e.movedRays && shard_.part == 1 && !has(fmt::format("moved {}", grid.size() - 1)) && !failed(0)) {
    const std::vector<HostRow> first = someRows(*session_.context, pipelineOf(0)->matrix());
    for (size_t point = 1; point < grid.size(); ++point) {
      throwIfStopped();
      session_.progress("moved rays", static_cast<float>(point) / static_cast<float>(grid.size()));
      if (failed(point)) continue;
      const std::vector<HostRow> rows = someRows(*session_.context, pipelineOf(point)->matrix());
      figures[fmt::format("moved {}", point)] = movedShare(first, rows, grid.settings(point).matrix.gpu.rays);
    }
  }
  if (e.tables && shard_.part == 1 && !has("vertices") && !failed(0))
    measureTables(*scene_, grid.settings(0), task.out, figures);
  session_.timings.reset();
  writeFigures(task.out, figures);
}

void ExperimentRunner::measureTables(const Scene& scene, const Settings& settings, const fs::path& folder,
                                     std::map<std::string, double>& figures) {
  Pipeline pipeline(*session_.context, scene, settings);
  pipeline.prepare();
  const glm::vec3 extent = scene.boundsMax - scene.boundsMin;
  for (int axis = 0; axis < 3; ++axis) figures[fmt::format("extent {}", "xyz"[axis])] = extent[axis];
  figures["vertices"] = static_cast<double>(scene.positions.size());
  figures["triangles"] = scene.triangleCount();
  figures["solid voxels"] = pipeline.facets().solidVoxels;
  figures["resolution"] = settings.voxel.resolution;
  const ThesisTable table = thesisTable(memoryReport(session_.device->memory().rows(), pipeline), pipeline.facets(),
                                        pipeline.field(), pipeline.lighting(), settings.matrix.gpu.rays);
  TextTable cells = memoryCells(table, "mib", mebibyteNumber);
  for (size_t row = 0; row < cells.size(); ++row)
    cells[row].insert(cells[row].begin() + 3, row == 0 ? "thesis_table_1_mib" : publishedMebibytes(cells[row][1]));
  writeFile(folder / kMemory, csvOf(cells));
}

// ---- Folders ----

std::string readSkipped(const fs::path& folder) {
  return readFile(folder / kSkipped);
}

std::map<std::string, double> readFigures(const fs::path& folder) {
  std::map<std::string, double> out;
  std::ifstream in(folder / kFigures);
  std::string line;
  for (size_t number = 1; std::getline(in, line); ++number) {
    const std::vector<std::string> fields = csvFields(line);
    double value = 0;
    const bool head = number == 1 && line == kFigureHead;
    if (head) continue;
    if (fields.size() == 2) {
      const auto [end, error] = std::from_chars(fields[1].data(), fields[1].data() + fields[1].size(), value);
      if (error == std::errc{} && end == fields[1].data() + fields[1].size()) {
        out[fields[0]] = value;
        continue;
      }
    }
    throw InputError(
        fmt::format("{}: line {}: '{}' is no name and number", (folder / kFigures).string(), number, line));
  }
  return out;
}

TextTable readMemoryTable(const fs::path& folder) {
  TextTable out;
  std::ifstream in(folder / kMemory);
  for (std::string line; std::getline(in, line);) out.push_back(csvFields(line));
  return out;
}

void mergeExperiment(const std::vector<fs::path>& shards, const fs::path& out) {
  std::vector<fs::path> measured;
  std::error_code ignored;
  for (const fs::path& shard : shards)
    if (readSkipped(shard).empty() && fs::exists(shard / "study.json", ignored)) measured.push_back(shard);
  makeFolder(out);
  if (measured.empty()) {
    const std::string why = readSkipped(shards.front());
    if (!why.empty()) writeFile(out / kSkipped, why);
    return;
  }
  removeFile(out / kSkipped);
  mergeStudies(measured, out);
  std::map<std::string, double> figures = readFigures(out);
  for (const fs::path& shard : measured) {
    for (const auto& [name, value] : readFigures(shard)) figures[name] = value;
    if (const std::string memory = readFile(shard / kMemory); !memory.empty()) writeFile(out / kMemory, memory);
  }
  writeFigures(out, figures);
  writeReport(out, irad::gridOf(readIdentity(out)), readResults(out), readNotes(out));
}

}  // namespace irad::app
