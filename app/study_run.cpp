#include "app/study_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/interrupts.h"
#include "app/reference.h"
#include "app/study_ahead.h"
#include "gi/facets.h"
#include "gi/host_facets.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/watch.h"
#include "renderer/base/error.h"
#include "renderer/base/image_io.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/number_text.h"
#include "renderer/base/output_file.h"
#include "renderer/scene/camera_json.h"
#include "renderer/scene/scene_content.h"
#include "shaders/shared/color_map.h"

namespace irad::app {
namespace {

namespace fs = std::filesystem;

const char* const kPathTracer = "path-tracer";

}  // namespace

void writeAsShown(const fs::path& stem, glm::uvec2 size, const LinearPixels& linear, float exposure) {
  std::vector<glm::u8vec4> bytes;
  for (const glm::vec4& pixel : linear) {
    glm::u8vec4 out(255);
    for (int c = 0; c < 3; ++c) {
      const float x = pixel[c] * exposure;
      out[c] = std::isnan(x) ? 0 : static_cast<uint8_t>(std::lround(255 * encodeSrgb(x)));
    }
    bytes.push_back(out);
  }
  writeDisplay(stem, size, bytes);
}

StudyRun::StudyRun(DeviceSession& session, Scene scene, SettingGrid grid, StudyTask task, const PicturesOfItsOwn& own)
    : session_(session),
      scene_(std::move(scene)),
      sceneContent_(sceneContent(scene_)),
      grid_(std::move(grid)),
      task_(std::move(task)) {
  if (std::min(task_.size.x, task_.size.y) < kBlockSide)
    throw UsageError(fmt::format("--size: {} x {} holds no block of {} x {} pixels", task_.size.x, task_.size.y,
                                 kBlockSide, kBlockSide));
  if (!task_.view.toneMapped()) throw UsageError(fmt::format("--view: {} is no light", task_.view.name));
  if (task_.truth.samples || !task_.peerSamples.empty()) requirePathTracer(task_.view, grid_.base());
  truth_.size = task_.size;
  truth_.what = task_.truth.name();
  for (const std::optional<ReferencePicture>* file : {&task_.truth.file, &task_.truth.secondFile})
    if (*file && (*file)->picture.size != task_.size)
      throw UsageError(fmt::format("{}: {} x {} pixels, --size is {} x {}", (*file)->path.string(),
                                   (*file)->picture.size.x, (*file)->picture.size.y, task_.size.x, task_.size.y));
  for (const std::optional<ReferencePicture>* file : {&task_.truth.file, &task_.truth.secondFile})
    if (*file) requireSubject(**file, task_.camera, task_.view.view);
  folder_.emplace(task_.out, identity());
  const GridTexts grids = gridsOf(folder_->identity());
  for (size_t i = grid_.texts().size(); i < grids.size(); ++i) grid_.add(grids[i]);
  makeFolder(task_.out / "pictures");
  bench_.emplace(*session_.context, scene_, grid_.settings(0), task_.size, task_.view.view, task_.camera);
  bench_->watch([](const char*, float) { return throwIfStopped(), true; });
  if (task_.facetRays) facetTruths_.emplace(session_, *bench_, task_.out / "facets", *task_.facetRays);
  announce(own);
  exposure_ = std::exp2(grid_.base().camera.exposureEv);
  if (!needsTruth()) return;
  makeTruth();
  writeAsShown(task_.out / "pictures" / kReferenceName, task_.size, truth_.mean(), exposure_);
}

void StudyRun::measure() {
  measureErrors(ownPoints(), task_.seeds);
  measureOwnTimes();
  measurePeers();
  folder_->save();
  session_.progress.finish();
  if (!needsTruth()) return;  // a shard beyond the last point: the others have the notes
  const ReportNotes n = notes();
  const nlohmann::ordered_json json{{"facts", n.facts},
                                    {"picture", {n.pictureSize.x, n.pictureSize.y}},
                                    {"crop", {n.cropAt.x, n.cropAt.y}},
                                    {"crop_size", {n.cropSize.x, n.cropSize.y}}};
  writeFile(task_.out / "notes.json", jsonText(json, 2));
}

void StudyRun::measureMore(size_t point, uint32_t seeds, uint32_t repeats) {
  measureErrors({point}, task_.seeds + seeds);
  measureTimes({point}, [&](size_t) { return task_.repeats + repeats; });
  folder_->save();
  session_.progress.finish();
}

void StudyRun::measureTimesOnly() {
  measureOwnTimes();
  folder_->save();
}

void StudyRun::extend(const std::vector<std::string>& sweeps) {
  grid_.add(sweeps);
  folder_->setGrids(grid_.texts());
}

// ---- What is ahead ----

/// Where many studies share truths, those who run them tell of all.
void StudyRun::announce(const PicturesOfItsOwn& own) {
  if (task_.sharedTruths) return;
  const std::vector<size_t> points = ownPoints();
  const SkySettings& sky = grid_.settings(0).sky;
  const std::optional<TruthRecipe> recipe = truthRecipe(session_, task_, scene_, sceneContent_, sky);
  const bool trace = needsTruth() && recipe && task_.truth.samples && !TruthStore(task_.out / "truths").has(*recipe);
  ahead_ = own ? own(*this) : picturesAhead(points);
  double samples = trace ? *task_.truth.samples : 0;
  if (task_.shard.part == 1)
    for (const uint32_t peer : task_.peerSamples) samples += folder_->results.hasPeer(kPathTracer, peer) ? 0 : peer;
  if (ahead_.pictures == 0 && samples == 0) return;
  if (samples > 0) ahead_.tracing = secondsOfTracing(scene_, sky, task_, samples);
  const char* const truth = task_.truth.file ? "the truth is a file"
                            : trace          ? "1 truth is to be traced"
                                             : "the truth is there";
  session_.progress.note(fmt::format("{} points, {} seeds and {} repeats each: {:.0f} pictures to come; {}; about {}",
                                     points.size(), task_.seeds, task_.repeats, ahead_.pictures, truth,
                                     duration(ahead_.all())));
}

double StudyRun::tryRepeat(size_t point) {
  Pipeline& pipeline = bench_->pipeline();
  pipeline.set(grid_.settings(point));
  bench_->prepare();
  const auto began = std::chrono::steady_clock::now();
  bench_->rebuild(), bench_->relight(), bench_->cameraFrame();
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - began;
  pipeline.setLights(pipeline.scene().lights);  // which the relight has nudged
  bench_->forget();
  return spent.count();
}

WorkAhead StudyRun::picturesAhead(const std::vector<size_t>& points) {
  WorkAhead out;
  if (points.empty()) return out;
  const uint32_t firstSeed = grid_.base().matrix.gpu.seed;
  std::vector<PicturesMissing> missing;
  double frames = 0;
  for (const size_t point : points) {
    missing.push_back(picturesMissing(folder_->results, point, grid_.settings(point), firstSeed, task_));
    out.pictures += missing.back().all();
    frames += missing.back().frames;
  }
  if (out.pictures == 0) return out;
  session_.progress("trial", 0);
  const PictureTrial first = tryPicture(session_, scene_, grid_.settings(points.front()), task_),
                     last =
                         points.size() > 1 ? tryPicture(session_, scene_, grid_.settings(points.back()), task_) : first;
  const std::vector<double> factors = pointFactors(grid_, points, first, last);
  const PictureTrial& tried = first.timed > 0 ? first : last;
  out.seconds = frames * std::max(first.frame, last.frame);
  std::vector<Settings> toBeHeld;
  for (size_t i = 0; i < points.size(); ++i) {
    out.seconds += factors[i] * tried.of(missing[i]);
    if (missing[i].errors > 0) toBeHeld.push_back(grid_.settings(points[i]));
  }
  if (facetTruths_) out.seconds += facetTruths_->secondsMissing(toBeHeld);
  return out;
}

LinearPixels StudyRun::picture(const Settings& settings, const std::function<void()>& whileLit) {
  Pipeline& pipeline = bench_->pipeline();
  pipeline.set(settings);
  bench_->prepare();
  bench_->forget();
  const View view = task_.view.view;
  LinearPixels out = bench_->pictures({&view, 1}, whileLit);
  for (const Finding& finding : pipeline.findings())
    if (finding.severity == Finding::Severity::Error) throw DeviceError(finding.text);  // a row that says so
  return out;
}

StudyIdentity StudyRun::identity() const {
  nlohmann::ordered_json json;
  json["study"] = task_.study;
  json["program"] = session_.machine.identity();
  json["device"] = session_.device->info.name;
  json["cpu"] = session_.device->isCpu;
  json["scene"] = scene_.path.filename().string();
  json["scene_sha256"] = scene_.sha256;
  json["scene_as_loaded"] = sceneContent_;  // with edits of lights and materials, which no file has
  if (scene_.sky) json["sky_sha256"] = scene_.sky->sha256;
  json["camera"] = nlohmann::ordered_json::parse(cameraToJson(task_.camera));
  json["size"] = {task_.size.x, task_.size.y};
  json["view"] = task_.view.name;
  json["reference"] = truth_.what;
  if (task_.facetRays) json["facet_rays"] = *task_.facetRays;
  json["sweeps"] = grid_.texts();
  json["settings"] = nlohmann::ordered_json::parse(settingsToJson(grid_.base()));
  return jsonText(json, 2);
}

// ---- Measuring ----

void StudyRun::progress(const char* what, size_t done, size_t all) {
  throwIfStopped();
  if (done == 0) stepBegan_ = std::chrono::steady_clock::now();
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - stepBegan_;
  const double share = static_cast<double>(done) / static_cast<double>(std::max<size_t>(all, 1));
  session_.progress(what, static_cast<float>(share), done > 0 ? timeLeft(spent.count() * (1 - share) / share) : "");
}

std::vector<size_t> StudyRun::ownPoints() const {
  std::vector<size_t> out;
  for (size_t point = 0; point < grid_.size(); ++point)
    if (task_.shard.has(point) && !folder_->results.hasFailed(point)) out.push_back(point);
  return out;
}

void StudyRun::fail(size_t point, const char* message) {
  session_.progress.note(fmt::format("{}: {}", grid_.label(point), message));
  folder_->results.failures.push_back({point, message});
  folder_->save();
}

/// Runs `act`; a point that finds no memory, or whose sizes do not go together, becomes a row that says so.
template <class Act>
bool StudyRun::attempt(size_t point, Act&& act) {
  try {
    act();
    return true;
  } catch (const DeviceError& error) {
    fail(point, error.what());
  } catch (const UsageError& error) {
    fail(point, error.what());
  }
  session_.device->waitIdle();  // all that the attempt held is free from here on
  session_.timings.reset();
  return false;
}

void StudyRun::measureErrors(const std::vector<size_t>& points, uint32_t seeds) {
  const uint32_t firstSeed = grid_.base().matrix.gpu.seed;
  size_t done = 0;
  for (const size_t point : points)
    for (uint32_t i = 0; i < seeds; ++i) {
      progress("errors", done++, points.size() * seeds);
      const uint32_t seed = firstSeed + i;
      if (folder_->results.hasError(point, seed) || folder_->results.hasFailed(point)) continue;
      Settings settings = grid_.settings(point);
      settings.matrix.gpu.seed = seed;
      attempt(point, [&] { measureError(point, settings, i == 0); });
      folder_->save();
    }
}

void StudyRun::measureError(size_t point, const Settings& settings, bool keepPicture) {
  const Pipeline& pipeline = bench_->pipeline();
  std::vector<glm::vec4> h;
  const LinearPixels pixels = picture(settings, [&] {
    if (!facetTruths_) return;
    for (const glm::vec3& v : perFacet(*session_.context, pipeline.facets(), pipeline.lighting().indirect))
      h.emplace_back(v, 0.0f);
  });
  const PictureMetrics m = measurePicture(task_.size, pixels, truth_.first, truth_.second, exposure_);
  const bool matrix = pipeline.obeyed().solver.method == SolverMethod::matrix;
  ErrorRow row{.point = point,
               .seed = settings.matrix.gpu.seed,
               .relMse = m.blockRelMse,
               .rmse = m.pixels.rmse,
               .meanError = m.pixels.meanError,
               .psnr = m.pixels.psnr,
               .flip = m.flip,
               .facets = pipeline.facets().count,
               .entries = matrix ? pipeline.matrix().stats.entries : 0,
               .matrixMib = matrix ? inMebibytes(pipeline.matrix().stats.bytesAllocated) : 0,
               .deviceMib = inMebibytes(session_.device->memory().used())};
  if (facetTruths_) {
    try {
      measureFacets(settings, h, row);
    } catch (const DeviceError& error) {  // the picture and its errors are none the worse for it
      session_.progress.note(fmt::format("{}: no truth of H: {}", grid_.label(point), error.what()));
      session_.device->waitIdle();
      session_.timings.reset();
    }
  }
  folder_->results.errors.push_back(row);
  if (keepPicture) writeAsShown(task_.out / "pictures" / pictureName(point), task_.size, pixels, exposure_);
}

/// The pipeline has other settings afterwards.
void StudyRun::measureFacets(const Settings& settings, const std::vector<glm::vec4>& h, ErrorRow& row) {
  const FacetTruth& truth = facetTruths_->of(settings);
  if (truth.first.empty()) return;  // there is no light to be told apart
  if (truth.first.size() != h.size())
    throw InputError(
        fmt::format("{}: {} facets, the truth of their H has {}", task_.out.string(), h.size(), truth.first.size()));
  const PairedMetrics m = measurePaired(h, truth.first, truth.second);
  row.hRelMse = m.relMse, row.hRmse = m.rmse;
}

/// All points in turn, repeat after repeat, so that other load on the machine falls on all alike; a first round warms
/// caches, clocks and pages and counts for nothing.
void StudyRun::measureTimes(const std::vector<size_t>& asked, const std::function<uint32_t(size_t)>& repeatsOf) {
  struct Timed {
    size_t point;
    uint32_t repeats;
  };
  const auto due = [&](const Timed& timed, uint32_t repeat) {
    return repeat < timed.repeats && !folder_->results.hasFailed(timed.point) &&
           !folder_->results.hasTimes(timed.point, repeat);
  };
  std::vector<Timed> points;
  uint32_t rounds = 0;  // after the one that warms up
  size_t all = 0, done = 0;
  for (const size_t point : asked) {
    const Timed timed{point, repeatsOf(point)};
    size_t lacks = 0;
    for (uint32_t repeat = 0; repeat < timed.repeats; ++repeat) lacks += due(timed, repeat) ? 1 : 0;
    if (lacks == 0) continue;
    points.push_back(timed);
    rounds = std::max(rounds, timed.repeats);
    all += lacks;
  }
  if (points.empty()) return;
  Pipeline& pipeline = bench_->pipeline();
  using Clock = std::chrono::steady_clock;
  Clock::time_point saved = Clock::now();
  for (uint32_t round = 0; round <= rounds; ++round) {
    for (size_t i = 0; i < points.size(); ++i) {
      const size_t point = points[i].point;
      const bool warms = round == 0;
      if (warms ? folder_->results.hasFailed(point) : !due(points[i], round - 1)) continue;
      progress(warms ? "warming up" : "times", warms ? i : done++, warms ? points.size() : all);
      attempt(point, [&] {
        // The light that ends a build is not part of what is compared.
        pipeline.set(withOneFrame(grid_.settings(point)));
        bench_->rebuild();
        if (!warms) pipeline.set(grid_.settings(point));
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
  pipeline.setLights(pipeline.scene().lights);  // relights have nudged them
  bench_->forget();
  folder_->save();
}

void StudyRun::measureOwnTimes() {
  measureTimes(ownPoints(), [&](size_t point) { return timedRepeats(grid_.settings(point), task_.repeats); });
}

void StudyRun::measurePeers() {
  if (task_.shard.part != 1) return;
  for (size_t i = 0; i < task_.peerSamples.size(); ++i) {
    const uint32_t samples = task_.peerSamples[i];
    if (folder_->results.hasPeer(kPathTracer, samples)) continue;
    const TracedPicture picture = trace("path tracer", samples, 1000 + i);  // other samples than the truth's
    const LinearPixels pixels = pixelsOf(lightOf(picture).mean);
    const PictureMetrics m = measurePicture(task_.size, pixels, truth_.first, truth_.second, exposure_);
    folder_->results.peers.push_back({kPathTracer, samples, picture.seconds, m.blockRelMse, m.pixels.rmse,
                                      m.pixels.meanError, m.pixels.psnr, m.flip});
    writeAsShown(task_.out / "pictures" / pictureName(kPathTracer, samples), task_.size, pixels, exposure_);
    folder_->save();
  }
}

}  // namespace irad::app
