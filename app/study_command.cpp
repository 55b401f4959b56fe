// `irad study`: what accuracy costs. `cost` measures error, time and memory over a grid of settings; `merge` puts the
// shards of a study together.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/bench.h"
#include "app/device_session.h"
#include "app/devices.h"
#include "app/reference.h"
#include "app/table.h"
#include "app/version.h"
#include "gi/check/path_tracer.h"
#include "gi/facets.h"
#include "gi/manifest.h"
#include "gi/matrix.h"
#include "gi/sky.h"
#include "gi/study/pick.h"
#include "gi/study/report.h"
#include "gi/study/results.h"
#include "gi/study/sweep.h"
#include "gi/watch.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/near_match.h"
#include "renderer/base/number_text.h"
#include "renderer/base/output_file.h"
#include "renderer/image_io.h"
#include "renderer/scene/camera_json.h"

namespace irad::app {
namespace {

namespace fs = std::filesystem;
using LinearPixels = std::vector<glm::vec4>;

struct StudyArguments {
  std::vector<std::string> names;  ///< the study, then the scene, or folders
  std::vector<std::string> sweeps, peers;
  std::optional<std::string> out, seeds, repeats, shard, view, referenceSamples, secondReference, peerSamples;
  std::optional<std::string> budgetMs, budgetMib, targetError, cost;  ///< of pick
  ReferenceArgument reference;
  SceneArguments sceneOptions;
  SettingArguments settings;
  DeviceArguments device;
  PictureArguments picture;
};

const char* const kPathTracer = "path-tracer";

/// As a screen shows it without a tone curve, which is what FLIP compares.
void writePng(const fs::path& stem, glm::uvec2 size, const LinearPixels& linear, float exposure) {
  std::vector<glm::u8vec4> bytes;
  for (const glm::vec4& pixel : linear) {
    glm::u8vec4 out(255);
    for (int c = 0; c < 3; ++c) {
      const float x = std::clamp(pixel[c] * exposure, 0.0f, 1.0f);  // NaN: 0
      const float encoded = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
      out[c] = static_cast<uint8_t>(std::lround(255 * (x == x ? encoded : 0)));
    }
    bytes.push_back(out);
  }
  writeDisplay(stem, size, bytes);
}

/// What pictures are held against: one picture, or two with independent noise.
struct Truth {
  glm::uvec2 size{0};
  LinearPixels first, second;  ///< second: empty where there is one
  std::string what;            ///< for the identity and the report
  LinearPixels mean() const {
    LinearPixels out = first;
    for (size_t i = 0; i < second.size(); ++i) out[i] = 0.5f * (first[i] + second[i]);
    return out;
  }
};

LinearPixels toPixels(const std::vector<glm::dvec3>& light) {
  LinearPixels out;
  for (const glm::dvec3& pixel : light) out.emplace_back(glm::vec3(pixel), 1);
  return out;
}

/// A third of the picture's width and height, 16 to 128 pixels, where the truth has most contrast.
void chooseCrop(const Truth& truth, ReportNotes& notes) {
  notes.pictureSize = truth.size;
  notes.cropSize = glm::min(glm::max(truth.size / 3u, glm::uvec2(16)), glm::uvec2(128));
  notes.cropSize = glm::min(notes.cropSize, truth.size);
  const LinearPixels mean = truth.mean();
  double most = -1;
  const glm::uvec2 step = glm::max(notes.cropSize / 4u, glm::uvec2(1));
  for (uint32_t y0 = 0; y0 + notes.cropSize.y <= truth.size.y; y0 += step.y)
    for (uint32_t x0 = 0; x0 + notes.cropSize.x <= truth.size.x; x0 += step.x) {
      double sum = 0, squares = 0, n = 0;
      for (uint32_t y = y0; y < y0 + notes.cropSize.y; ++y)
        for (uint32_t x = x0; x < x0 + notes.cropSize.x; ++x) {
          const glm::vec4& p = mean[size_t{y} * truth.size.x + x];
          const double value = std::log(1e-4 + std::max(0.0, double{p.x} + p.y + p.z));
          sum += value, squares += value * value, ++n;
        }
      const double variance = squares / n - (sum / n) * (sum / n);
      if (variance > most) most = variance, notes.cropAt = {x0, y0};
    }
}

/// All that `irad study cost` goes by.
class CostStudy {
 public:
  explicit CostStudy(const StudyArguments& arguments)
      : arguments_(arguments),
        session_(arguments.settings, arguments.device),
        grid_(arguments.sweeps, session_.settings) {}

  void run() {
    const StudyArguments& a = arguments_;
    seeds_ = static_cast<uint32_t>(parseInteger("--seeds", a.seeds.value_or("4"), 1, 10'000));
    const bool cpu = session_.device->isCpu;
    repeats_ = static_cast<uint32_t>(parseInteger("--repeats", a.repeats.value_or(cpu ? "5" : "30"), 1, 100'000));
    if (a.shard) shard_ = parseShard(*a.shard);
    view_ = findViews({a.view.value_or("lit")}).at(0);
    if (!view_.toneMapped()) throw UsageError(fmt::format("--view: {} is no light", view_.name));
    const fs::path out = a.out.value_or("out/study");
    const std::optional<std::string> name = a.names.size() > 1 ? std::optional(a.names[1]) : std::nullopt;
    scene_ = session_.load(findScene(name, session_.config, std::nullopt), a.sceneOptions);
    camera_ = a.picture.resolveCameras(session_.config, *scene_).at(0);
    readTruth();
    if (std::min(size_.x, size_.y) < kBlockSide)
      throw UsageError(
          fmt::format("--size: {} x {} holds no block of {} x {} pixels", size_.x, size_.y, kBlockSide, kBlockSide));
    folder_.emplace(out, identity());
    makeFolder(out / "pictures");
    bench_.emplace(*session_.context, *scene_, grid_.settings(0), size_, view_.view, camera_);
    if (a.referenceSamples) traceTruth(out);
    exposure_ = std::exp2(session_.settings.camera.exposureEv);
    writePng(out / "pictures" / kReferenceName, size_, truth_.mean(), exposure_);
    measureErrors();
    measureTimes();
    measurePeers();
    folder_->save();
    session_.progress.finish();
    ReportNotes notes = notesOf();
    chooseCrop(truth_, notes);
    writeFile(out / "notes.json", nlohmann::ordered_json{{"facts", notes.facts},
                                                         {"picture", {notes.pictureSize.x, notes.pictureSize.y}},
                                                         {"crop", {notes.cropAt.x, notes.cropAt.y}},
                                                         {"crop_size", {notes.cropSize.x, notes.cropSize.y}}}
                                      .dump(2));
    finish(out, grid_, folder_->results, notes);
    session_.checkValidation();
  }

  /// Writes the report, prints the table and the findings.
  static void finish(const fs::path& out, const SettingGrid& grid, const StudyResults& results,
                     const ReportNotes& notes);

 private:
  void readTruth() {
    const StudyArguments& a = arguments_;
    if (a.reference.file && a.referenceSamples)
      throw UsageError("--reference and --reference-samples: a study has one truth");
    if (!a.reference.file && !a.referenceSamples)
      throw UsageError("irad study cost: no truth: --reference FILE, or --reference-samples N of the path tracer");
    if (a.secondReference && !a.reference.file) throw UsageError("--second-reference needs --reference");
    for (const std::string& peer : a.peers)
      if (peer != kPathTracer)
        throw UsageError(fmt::format("--peer: unknown '{}'{}", peer, suggestion(peer, {kPathTracer})));
    for (const std::string& samples : splitList("--peer-samples", {a.peerSamples.value_or("2,8,32,128")})) {
      peerSamples_.push_back(static_cast<uint32_t>(parseInteger("--peer-samples", samples, 2, 1'000'000)));
      if (peerSamples_.back() % 2 != 0) throw UsageError(fmt::format("--peer-samples: '{}' is not even", samples));
    }
    const bool traces = !a.peers.empty() || a.referenceSamples;
    if (traces && !hasPathTracer())
      throw UsageError("--peer, --reference-samples: this build has no path tracer (IRAD_EMBREE)");
    const bool indirect = std::string_view(view_.name) == "indirect";
    if (traces && !indirect && !(std::string_view(view_.name) == "lit" && session_.settings.scene.lambertian))
      throw UsageError(
          fmt::format("--view {}: the path tracer is diffuse: compare --view indirect, or --view lit with "
                      "--set scene.lambertian=true",
                      view_.name));
    size_ = a.picture.resolveSize(session_.config);
    if (a.referenceSamples) {
      samples_ = static_cast<uint32_t>(parseInteger("--reference-samples", *a.referenceSamples, 2, 10'000'000));
      if (samples_ % 2 != 0) throw UsageError(fmt::format("--reference-samples: '{}' is not even", samples_));
      truth_.what = fmt::format("path tracer, {} samples per pixel", samples_);
      return;
    }
    const ReferencePicture reference = *a.reference.read(session_.config, session_.progress);
    truth_ = {reference.picture.size, reference.picture.pixels, {}, reference.sha256};
    if (!a.picture.size && !session_.config.size) size_ = truth_.size;
    if (truth_.size != size_)
      throw UsageError(fmt::format("{}: {} x {} pixels, --size is {} x {}", reference.path.string(), truth_.size.x,
                                   truth_.size.y, size_.x, size_.y));
    if (a.secondReference) {
      const ReferencePicture second = readReference(*a.secondReference);
      if (second.picture.size != size_)
        throw UsageError(fmt::format("{}: {} x {} pixels, {} has {} x {}", second.path.string(), second.picture.size.x,
                                     second.picture.size.y, reference.path.string(), size_.x, size_.y));
      truth_.second = second.picture.pixels;
      truth_.what += " and " + second.sha256;
    }
  }

  TracedPicture trace(uint32_t samples, uint64_t seed) {
    if (!tracer_) tracer_ = makePathTracer(*scene_, bench_->pipeline().sky());
    return tracer_->render(camera_, size_, {.samples = samples, .seed = seed, .centred = true});
  }
  const TracedLight& lightOf(const TracedPicture& picture) const {
    return std::string_view(view_.name) == "indirect" ? picture.indirect : picture.lit;
  }

  /// Two halves of the samples, kept in the folder.
  void traceTruth(const fs::path& out) {
    truth_.size = size_;
    const auto fileOf = [&](const char* half) {
      for (const char* extension : {".exr", ".pfm"})
        if (const fs::path file = out / (half + std::string(extension)); fs::exists(file)) return file;
      return fs::path();
    };
    if (fileOf("reference.a").empty() || fileOf("reference.b").empty()) {
      session_.progress("reference by the path tracer", 0);
      const TracedPicture picture = trace(samples_, 1);
      writeLinear(out / "reference.a", size_, toPixels(lightOf(picture).half[0]));
      writeLinear(out / "reference.b", size_, toPixels(lightOf(picture).half[1]));
    }
    truth_.first = readLinear(fileOf("reference.a")).pixels;
    truth_.second = readLinear(fileOf("reference.b")).pixels;
    IRAD_CHECK_OP(truth_.first.size(), ==, size_t{size_.x} * size_.y);
    IRAD_CHECK_OP(truth_.second.size(), ==, truth_.first.size());
  }

  StudyIdentity identity() const {
    nlohmann::ordered_json json;
    json["study"] = "cost";
    json["program"] = fmt::format("{} ({})", versionNumber(), versionCommit());
    json["device"] = session_.device->info.name;
    json["cpu"] = session_.device->isCpu;
    json["scene"] = scene_->path.filename().string();
    json["scene_sha256"] = scene_->sha256;
    if (scene_->sky) json["sky_sha256"] = scene_->sky->sha256;
    json["camera"] = nlohmann::ordered_json::parse(cameraToJson(camera_));
    json["size"] = {size_.x, size_.y};
    json["view"] = view_.name;
    json["reference"] = truth_.what;
    json["sweeps"] = nlohmann::ordered_json::array();
    for (const Sweep& sweep : grid_.sweeps()) json["sweeps"].push_back(sweep.text());
    json["settings"] = nlohmann::ordered_json::parse(settingsToJson(session_.settings));
    return json.dump(2);
  }

  bool progress(const char* what, size_t done, size_t all) {
    return session_.progress(what, static_cast<float>(done) / static_cast<float>(std::max<size_t>(all, 1)));
  }
  std::vector<size_t> ownPoints() const {
    std::vector<size_t> out;
    for (size_t point = 0; point < grid_.size(); ++point)
      if (shard_.has(point) && !folder_->results.hasFailed(point)) out.push_back(point);
    return out;
  }
  /// Runs `act`; a point that finds no memory becomes a row that says so.
  template <class Act>
  bool attempt(size_t point, Act&& act) {
    try {
      act();
      return true;
    } catch (const DeviceError& error) {
      session_.progress.note(fmt::format("{}: {}", grid_.label(point), error.what()));
      folder_->results.failures.push_back({point, error.what()});
      folder_->save();
    }
    session_.device->waitIdle();  // all that the attempt held is free from here on
    session_.timings.reset();
    return false;
  }

  /// Before any time is taken: relights that are measured nudge the lights.
  void measureErrors() {
    const std::vector<size_t> points = ownPoints();
    const uint32_t firstSeed = session_.settings.matrix.gpu.seed;
    size_t done = 0;
    for (const size_t point : points)
      for (uint32_t i = 0; i < seeds_; ++i) {
        progress("errors", done++, points.size() * seeds_);
        const uint32_t seed = firstSeed + i;
        if (folder_->results.hasError(point, seed) || folder_->results.hasFailed(point)) continue;
        Settings settings = grid_.settings(point);
        settings.matrix.gpu.seed = seed;
        attempt(point, [&] { measureError(point, seed, settings, i == 0); });
        folder_->save();
      }
  }

  void measureError(size_t point, uint32_t seed, const Settings& settings, bool keepPicture) {
    Pipeline& pipeline = bench_->pipeline();
    pipeline.set(settings);
    bench_->prepare({});
    bench_->forget();
    const View view = view_.view;
    const LinearPixels pixels = bench_->pictures({&view, 1});
    for (const Finding& finding : pipeline.findings())
      if (finding.severity == Finding::Severity::Error) throw DeviceError(finding.text);  // a row that says so
    const PictureMetrics m = measurePicture(size_, pixels, truth_.first, truth_.second, exposure_);
    const bool matrix = pipeline.obeyed().solver.method == SolverMethod::matrix;
    folder_->results.errors.push_back({.point = point,
                                       .seed = seed,
                                       .relMse = m.blockRelMse,
                                       .rmse = m.pixels.rmse,
                                       .meanError = m.pixels.meanError,
                                       .psnr = m.pixels.psnr,
                                       .flip = m.flip,
                                       .facets = pipeline.facets().count,
                                       .entries = matrix ? pipeline.matrix().stats.entries : 0,
                                       .matrixMib = matrix ? inMebibytes(pipeline.matrix().stats.bytesAllocated) : 0,
                                       .deviceMib = inMebibytes(session_.device->memory().used())});
    if (keepPicture) writePng(folder_->path() / "pictures" / pictureName(point), size_, pixels, exposure_);
  }

  /// All points in turn, repeat after repeat, so that other load on the machine falls on all alike; a first round warms
  /// caches, clocks and pages and counts for nothing.
  void measureTimes() {
    const std::vector<size_t> points = ownPoints();
    const auto due = [&](size_t point, uint32_t repeat) {
      return !folder_->results.hasFailed(point) && !folder_->results.hasTimes(point, repeat);
    };
    bool any = false;
    for (const size_t point : points)
      for (uint32_t repeat = 0; repeat < repeats_; ++repeat) any = any || due(point, repeat);
    if (!any) return;
    using Clock = std::chrono::steady_clock;
    Clock::time_point saved = Clock::now(), began = saved;
    for (uint32_t round = 0; round <= repeats_; ++round) {
      if (round == 1) {
        const std::chrono::duration<double> once = Clock::now() - began;
        session_.progress.note(
            fmt::format("{} repeats of {} points: about {:.0f} s", repeats_, points.size(), once.count() * repeats_));
      }
      for (size_t i = 0; i < points.size(); ++i) {
        progress(round == 0 ? "warming up" : "times", round == 0 ? i : (round - 1) * points.size() + i,
                 round == 0 ? points.size() : repeats_ * points.size());
        const size_t point = points[i];
        const bool warms = round == 0;
        if (warms ? folder_->results.hasFailed(point) : !due(point, round - 1)) continue;
        attempt(point, [&] {
          bench_->pipeline().set(grid_.settings(point));
          bench_->rebuild();
          bench_->relight();
          bench_->cameraFrame();
          if (warms) return;
          for (const StageSamples& stage : bench_->samples())
            for (const double ms : stage.ms)
              folder_->results.times.push_back({point, round - 1, toString(stage.kind), stage.stage, ms});
        });
        bench_->forget();
        if (Clock::now() - saved > std::chrono::seconds(2)) {
          folder_->save();
          saved = Clock::now();
        }
      }
    }
    folder_->save();
  }

  void measurePeers() {
    if (arguments_.peers.empty() || shard_.part != 1) return;
    for (size_t i = 0; i < peerSamples_.size(); ++i) {
      progress("path tracer", i, peerSamples_.size());
      const uint32_t samples = peerSamples_[i];
      if (folder_->results.hasPeer(kPathTracer, samples)) continue;
      const TracedPicture picture = trace(samples, 1000 + i);  // other samples than the truth's
      const LinearPixels pixels = toPixels(lightOf(picture).mean);
      const PictureMetrics m = measurePicture(size_, pixels, truth_.first, truth_.second, exposure_);
      folder_->results.peers.push_back({kPathTracer, samples, picture.seconds, m.blockRelMse, m.pixels.rmse,
                                        m.pixels.meanError, m.pixels.psnr, m.flip});
      writePng(folder_->path() / "pictures" / pictureName(kPathTracer, samples), size_, pixels, exposure_);
      folder_->save();
    }
  }

  ReportNotes notesOf() const {
    ReportNotes notes;
    notes.facts = {
        fmt::format("Scene {}, camera {}, view {}, {} × {} pixels", scene_->path.filename().string(),
                    camera_.name.empty() ? "of its own" : camera_.name, view_.name, size_.x, size_.y),
        fmt::format("Reference: {}",
                    arguments_.reference.file ? fs::path(*arguments_.reference.file).filename().string() : truth_.what),
        fmt::format(
            "Device: {}; times are GPU time stamps, medians of {} repeats with all points in turn, after a round "
            "that warms up{}",
            session_.device->info.name, repeats_,
            repeats_ < 30 ? fmt::format("; {} repeats are few: 30 and more are meant", repeats_) : ""),
        fmt::format("Errors: {} seeds from {} on; relMSE of means over {} × {} pixels, ε = (0.1 × mean)²; ± is half of "
                    "a 95 % interval over seeds (Student's t)",
                    seeds_, session_.settings.matrix.gpu.seed, kBlockSide, kBlockSide)};
    if (!arguments_.peers.empty())
      notes.facts.push_back(
          "Path tracer: Embree on this machine's CPU, diffuse, one sample through each pixel's middle; "
          "every picture takes all of its time");
    return notes;
  }

  const StudyArguments& arguments_;
  DeviceSession session_;
  SettingGrid grid_;
  Shard shard_;
  uint32_t seeds_ = 0, repeats_ = 0, samples_ = 0;
  std::vector<uint32_t> peerSamples_;
  ViewInfo view_{};
  std::optional<Scene> scene_;
  Camera camera_;
  glm::uvec2 size_{0};
  float exposure_ = 1;
  Truth truth_;
  std::optional<StudyFolder> folder_;
  std::optional<Bench> bench_;
  std::unique_ptr<PathTracer> tracer_;
};

/// The point whose settings are those given.
std::optional<size_t> givenPoint(const SettingGrid& grid, const Settings& given) {
  for (size_t point = 0; point < grid.size(); ++point)
    if (grid.settings(point) == given) return point;
  return std::nullopt;
}

std::vector<std::string> labelsOf(const SettingGrid& grid) {
  std::vector<std::string> out;
  for (size_t point = 0; point < grid.size(); ++point) out.push_back(grid.label(point));
  return out;
}

void CostStudy::finish(const fs::path& out, const SettingGrid& grid, const StudyResults& results,
                       const ReportNotes& notes) {
  writeReport(out, grid, results, notes);
  const std::vector<PointSummary> points = summarize(results, labelsOf(grid));
  std::vector<std::vector<std::string>> rows{
      {"point", "settings", "relMSE", "±", "FLIP", "build ms", "relight ms", "frame ms", "MiB", ""}};
  for (const PointSummary& p : points) {
    const auto ms = [&](const char* kind) {
      return std::isfinite(p.gpuMs(kind)) ? milliseconds(p.gpuMs(kind)) : std::string("-");
    };
    const bool done = p.seeds > 0;
    rows.push_back({std::to_string(p.point), p.label, done ? shortNumber(p.relMse.mean) : "-",
                    done && std::isfinite(p.relMse.half) ? shortNumber(p.relMse.half) : "-",
                    done ? shortNumber(p.flip.mean) : "-", ms("setup"), ms("relight"), ms("camera"),
                    done ? fmt::format("{:.1f}", p.deviceMib) : "-", p.failure});
  }
  print("{}", formatTable(rows, {true, false, true, true, true, true, true, true, true, false}));
  for (const std::string& finding : findings(points, results.peers, givenPoint(grid, grid.base())))
    print("{}\n", finding);
  print("wrote       {}\n", (out / "report.html").string());
}

SettingGrid gridOf(const StudyIdentity& identity) {
  try {
    const auto json = nlohmann::ordered_json::parse(identity);
    Settings settings;
    settingsFromJson(settings, json.at("settings").dump());
    return {json.at("sweeps").get<std::vector<std::string>>(), settings};
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
  CostStudy::finish(out, grid, folder.results, notes);
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
  const std::vector<PointSummary> points = summarize(readResults(folder), labelsOf(grid));
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
  const std::vector<std::string> studies{"cost", "merge", "pick"};
  if (arguments.names.empty()) throw UsageError(fmt::format("irad study: which? {}", fmt::join(studies, " | ")));
  if (arguments.names[0] == "merge") return mergeShards(arguments);
  if (arguments.names[0] == "pick") return pickPoint(arguments);
  if (arguments.names[0] != "cost")
    throw UsageError(fmt::format("unknown study '{}'{}; there are: {}", arguments.names[0],
                                 suggestion(arguments.names[0], studies), fmt::join(studies, ", ")));
  if (arguments.names.size() > 2)
    throw UsageError(fmt::format("irad study cost: unexpected argument '{}'", arguments.names[2]));
  arguments.sceneOptions.check();
  arguments.picture.check();
  if (arguments.shard) parseShard(*arguments.shard);
  const Config early = arguments.settings.readConfig();
  SettingGrid(arguments.sweeps, arguments.settings.resolve(early, /*cpuDevice=*/true));  // before a device is opened
  CostStudy(arguments).run();
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
