#include "app/stage_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "app/interrupts.h"
#include "app/study_ahead.h"
#include "gi/check/exact_solve.h"
#include "gi/facets.h"
#include "gi/final_gather.h"
#include "gi/host_facets.h"
#include "gi/host_trace.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/plan.h"
#include "gi/sky.h"
#include "gi/watch.h"
#include "renderer/base/error.h"
#include "renderer/base/image_io.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/number_text.h"
#include "renderer/base/output_file.h"

namespace irad::app {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kSolved = 1e-12;      ///< of the mean H
constexpr float kConverged = 1e-7f;    ///< the least solver.tolerance
constexpr uint32_t kMostRays = 4096;   ///< of matrix.rays
constexpr uint32_t kFewestRays = 512;  ///< that count as many
constexpr uint32_t kFirstSeen = 0x3F800000u;

LinearPixels asVec4(const std::vector<glm::dvec3>& values) {
  LinearPixels out;
  for (const glm::dvec3& v : values) out.emplace_back(glm::vec3(v), 0.0f);
  return out;
}

/// What PictureTime is made of, by name.
template <class Visit>
void visitTime(PictureTime& time, const Visit& visit) {
  constexpr const char* kParts[] = {"voxels", "field", "matrix", "materials", "gather", "solve", "scatter"};
  static_assert(std::size(kParts) == BuildTimes::kParts);
  for (size_t i = 0; i < time.build.size(); ++i) visit(kParts[i], time.build[i]);
  visit("exact", time.exact);
  visit("draw", time.draw);
  visit("pixel-gather", time.gather);
}
void writeTime(const fs::path& path, PictureTime time) {
  OrderedJson json;
  visitTime(time, [&](const char* name, double& seconds) { json[name] = seconds; });
  writeFile(path, jsonText(json) + "\n");
}
PictureTime readTime(const fs::path& path) {
  PictureTime time;
  std::vector<std::string> names;
  visitTime(time, [&](const char* name, double&) { names.emplace_back(name); });
  const OrderedJson json = readJsonFile(path);
  const JsonObject object(json, path.string(), names);
  visitTime(time, [&](const char* name, double& seconds) { seconds = object.number(name); });
  return time;
}

}  // namespace

StagePictures::StagePictures(DeviceSession& session, StudyRun& run, const AttributionTask& task)
    : session_(session), run_(run), task_(task), folder_(run.task().out / "linear") {
  makeFolder(folder_);
  makeFolder(secondsFolder());
  Pipeline& pipeline = run_.bench().pipeline();
  pipeline.set(asGiven());
  run_.bench().prepare();
  run_.bench().forget();
  facets_ = pipeline.facets().count;
  tinted_ = pipeline.facets().surface.tinted;
  judge();
  Settings many = asGiven();
  many.matrix.gpu.rays = manyRays();
  many.solver.frames = settingsFor({ErrorStage::rays}).solver.frames;
  times_.emplace(asGiven(), many);
  for (const Ideals& ideals : neededPictures(presence_))
    for (const uint32_t seed : seedsOf(ideals))
      if (fs::exists(timeFileOf(ideals, seed))) times_->took(ideals, readTime(timeFileOf(ideals, seed)));
}

uint32_t StagePictures::fewOf(uint32_t seeds) {
  return std::max(static_cast<uint32_t>(ErrorEstimates::kFewestSeeds), seeds / 2);
}

uint32_t StagePictures::finerResolution() const {
  const double n = task_.finer * asGiven().voxel.resolution;
  return static_cast<uint32_t>(std::min(std::round(n), findSetting("voxel.resolution").range.max));
}
/// As many as a row can count.
uint32_t StagePictures::manyRays() const {
  uint32_t most = kMostRays;
  if (asGiven().matrix.format == MatrixFormat::csr) most = std::min(most, mostRaysOfRows(facets_, tinted_));
  return std::max(rays(), std::min(most, std::max(16 * rays(), kFewestRays)));
}
uint32_t StagePictures::largestShadowMap() const {
  return std::max(asGiven().light.shadowResolution, session_.device->isCpu ? 4096u : 8192u);
}
uint32_t StagePictures::manyPoints() const {
  return std::max(asGiven().light.points, session_.device->isCpu ? 256u : 1024u);
}

// ---- Which stages there are ----

void StagePictures::judge() {
  const Pipeline& pipeline = run_.bench().pipeline();
  const Settings& s = pipeline.obeyed();
  const EffectPlan plan = pipeline.plan();
  const bool triangles = s.matrix.gpu.hitRule == HitRule::triangles, light = plan.indirectLight(),
             matrix = s.solver.method == SolverMethod::matrix;
  const char* const dark = "there is no indirect light";
  const uint32_t n = asGiven().voxel.resolution, finer = finerResolution();
  for (size_t i = 0; i < kErrorStages; ++i) lack(static_cast<ErrorStage>(i), dark);
  if (light) {
    if (finer > n)
      have(ErrorStage::voxels,
           fmt::format("voxel.resolution={} instead of {}{}: if errors go with a voxel's edge, {} of this gain more "
                       "is left in the model",
                       finer, n, s.voxel.method == VoxelMethod::raster ? ", conservative instead of raster" : "",
                       shortNumber(1 / (double{1} * finer / n - 1))));
    else
      lack(ErrorStage::voxels, fmt::format("{} voxels are the most", n));
    if (triangles)
      lack(ErrorStage::facets, "facets are the sides of the true surface already (matrix.hit_rule=triangles)");
    else
      have(ErrorStage::facets,
           "matrix.hit_rule=triangles: a facet for each side of the true surface, and its own "
           "rays, lookup and shadows");
    if (triangles)
      lack(ErrorStage::normals, "rays, light and lookups go by the triangles: no picture reads stored normals");
    else if (s.voxel.normals == NormalEncoding::oct16)
      lack(ErrorStage::normals, "oct16 already: within 0.95 degrees");
    else
      have(ErrorStage::normals, fmt::format("oct16 instead of {}", nameOf(s.voxel.normals)));
    const bool host = triangles && session_.device->isCpu && canTraceOnHost();
    if (host)
      lack(ErrorStage::traversal, "the host traces these rays past the triangles: nothing is stepped over");
    else if (s.matrix.gpu.traversal == Traversal::dda)
      lack(ErrorStage::traversal, "dda already: cell by cell");
    else
      have(ErrorStage::traversal, fmt::format("dda instead of sdf on field {}", nameOf(s.field.method)));
    have(ErrorStage::rays,
         matrix ? fmt::format("the mean of {} seeds, of {} rays instead of {}", fewSeeds(), manyRays(), rays())
                : fmt::format("the mean of {} seeds, of 16 times as many frames", fewSeeds()));
    if (matrix) {
      have(ErrorStage::storage,
           fmt::format("double precision instead of fp32 and solver.flush={}, both solved to the end{}",
                       findSetting("solver.flush").text(s),
                       triangles ? "" : "; the volume stays RGBA16F, and its roundings in the model"));
      have(ErrorStage::sweeps,
           fmt::format("solver.tolerance={} instead of {}", kConverged, findSetting("solver.tolerance").text(s)));
    } else {
      for (const ErrorStage stage : {ErrorStage::storage, ErrorStage::sweeps})
        lack(stage, "brute force solves no matrix: see rays");
    }
    if (!triangles)
      lack(ErrorStage::lookup,
           "pixels read the thesis's volume, which has no surface to gather at: its error is in facets");
    else if (!canTraceOnHost())
      lack(ErrorStage::lookup, "this build has no Embree to gather with");
    else
      have(ErrorStage::lookup, fmt::format("{} rays from each pixel's own point instead of sample.filter={}",
                                           task_.gatherRays, nameOf(s.sample.gpu.filter_)));
  }
  bool size = false;
  for (const LightTraits& lamp : pipeline.traits().lights) size = size || (lamp.shines && lamp.size);
  if (!plan.on(Effect::sun) && !plan.on(Effect::point) && !plan.on(Effect::spot))
    lack(ErrorStage::shadows, "there are no suns, points or spots");
  else if (!is("lit") && triangles && !size)
    lack(ErrorStage::shadows, "facets see lights past the triangles; shadow maps are no part of this view");
  else
    have(ErrorStage::shadows,
         fmt::format("light.shadow_resolution={} instead of {}{}", largestShadowMap(), s.light.shadowResolution,
                     size ? fmt::format(", light.points={} instead of {}", manyPoints(), s.light.points) : ""));
  if (!is("lit"))
    lack(ErrorStage::reflections, "reflections are no part of this view");
  else if (!plan.on(Effect::specular))
    lack(ErrorStage::reflections, plan.row(Effect::specular).reason);
  else
    have(ErrorStage::reflections,
         fmt::format("64 rays instead of {}, of every roughness, unfiltered", s.specular.gpu.rays));
}

Settings StagePictures::settingsFor(const Ideals& ideals) const {
  Settings s = asGiven();
  const auto ideal = [&](ErrorStage stage) { return ideals.has(stage); };
  if (ideal(ErrorStage::voxels)) s.voxel.resolution = finerResolution(), s.voxel.method = VoxelMethod::conservative;
  if (ideal(ErrorStage::facets)) {
    s.matrix.gpu.hitRule = HitRule::triangles;
    s.voxel.method = VoxelMethod::conservative;
    s.matrix.format = MatrixFormat::csr;
    s.thesis.literal = false;
  }
  if (ideal(ErrorStage::normals)) s.voxel.normals = NormalEncoding::oct16;
  if (ideal(ErrorStage::traversal)) s.matrix.gpu.traversal = Traversal::dda;
  if (ideal(ErrorStage::rays)) {
    s.matrix.gpu.rays = manyRays();
    if (s.solver.method == SolverMethod::bruteForce) {
      s.matrix.gpu.rays = asGiven().matrix.gpu.rays;
      s.solver.frames = std::min(16 * s.solver.frames, 100'000u);
      s.solver.tolerance = std::max(s.solver.tolerance / 4, kConverged);
    }
  }
  if (ideal(ErrorStage::sweeps)) s.solver.tolerance = kConverged, s.solver.maxSweeps = 100'000;
  if (ideal(ErrorStage::shadows)) s.light.shadowResolution = largestShadowMap(), s.light.points = manyPoints();
  if (ideal(ErrorStage::reflections)) {
    s.specular.mode = SpecularMode::compute;
    s.specular.gpu.rays = 64;
    s.specular.gpu.traversal = Traversal::dda;
    s.specular.gpu.maxRoughness = 1;
    s.specular.gpu.fade = 0;
    s.specular.gpu.threshold = 0;
    s.specular.gpu.filter_ = 0;
  }
  return s;
}

// ---- Seeds and files ----

/// Fewer where a build takes many times as long.
std::vector<uint32_t> StagePictures::seedsOf(const Ideals& ideals) const {
  const bool heavy = ideals.has(ErrorStage::voxels) || ideals.has(ErrorStage::rays);
  std::vector<uint32_t> out;
  for (uint32_t i = 0; i < (heavy ? fewSeeds() : run_.task().seeds); ++i) out.push_back(asGiven().matrix.gpu.seed + i);
  return out;
}
fs::path StagePictures::stemOf(const Ideals& ideals, uint32_t seed) const {
  return folder_ / fmt::format("{}.{}", ideals.name(), seed);
}
fs::path StagePictures::fileOf(const Ideals& ideals, uint32_t seed) const {
  return stemOf(ideals, seed).string() + linearExtension();
}

fs::path StagePictures::timeFileOf(const Ideals& ideals, uint32_t seed) const {
  return secondsFolder() / fmt::format("{}.{}.json", ideals.name(), seed);
}

std::map<uint32_t, LinearPixels> StagePictures::read(const Ideals& ideals) const {
  std::map<uint32_t, LinearPixels> out;
  for (const uint32_t seed : seedsOf(ideals)) out[seed] = readLinear(fileOf(ideals, seed)).pixels;
  return out;
}

/// By builds, so that pictures that differ in the light alone share one, and then by light; seed after seed.
std::vector<StagePictures::Due> StagePictures::due() const {
  std::vector<Ideals> needed = neededPictures(presence_);
  std::ranges::stable_sort(needed, {}, [&](const Ideals& ideals) {
    std::string out;
    for (const ErrorStage stage : {ErrorStage::voxels, ErrorStage::facets, ErrorStage::normals, ErrorStage::traversal,
                                   ErrorStage::rays, ErrorStage::shadows, ErrorStage::storage, ErrorStage::sweeps})
      out += ideals.has(stage) ? '1' : '0';
    return out;
  });
  std::vector<Due> out;
  for (uint32_t i = 0; i < run_.task().seeds; ++i)
    for (const Ideals& ideals : needed) {
      const uint32_t seed = asGiven().matrix.gpu.seed + i;
      if (std::ranges::count(seedsOf(ideals), seed) > 0 && !fs::exists(fileOf(ideals, seed)))
        out.push_back({seed, ideals});
    }
  return out;
}

// ---- Making them ----

WorkAhead StagePictures::tryFew() {
  bool all = false;
  while (!all) {
    all = true;
    const std::vector<Due> before = due();
    for (const Ideals& ideals : AttributionTimes::toBeTried(neededPictures(presence_))) {
      const auto next = std::ranges::find(before, ideals, &Due::ideals);
      if (next == before.end() || times_->knows(ideals)) continue;
      session_.progress("trial", 0);
      all = all && make(*next, /*fromVoxelsOn=*/true);
      if (!all) break;  // a stage fell out
    }
  }
  WorkAhead out;
  const std::vector<Due> left = due();
  for (const double seconds : secondsOf(left)) out.seconds += seconds;
  out.pictures = static_cast<double>(left.size());
  double repeats = 0;
  for (uint32_t i = 0; i < run_.task().repeats; ++i) repeats += run_.results().hasTimes(0, i) ? 0 : 1;
  if (repeats > 0) {
    out.pictures += repeats + 1;
    out.seconds += (repeats + 1) * run_.tryRepeat(0);
  }
  return out;
}

std::vector<double> StagePictures::secondsOf(const std::vector<Due>& due) const {
  std::vector<double> out;
  std::optional<Due> before;
  for (const Due& d : due) {
    out.push_back(
        times_
            ->predict(d.ideals, before && before->seed == d.seed, before ? std::optional(before->ideals) : std::nullopt)
            .value_or(0));
    before = d;
  }
  return out;
}

void StagePictures::measure() {
  while (!measureAll())
    ;  // a stage fell out
  session_.progress.finish();
}

/// False where a stage could not be made ideal: it is none from then on.
bool StagePictures::measureAll() {
  const std::vector<Due> all = due();
  const Clock::time_point began = Clock::now();
  double done = 0;  // as foreseen
  for (size_t i = 0; i < all.size(); ++i) {
    throwIfStopped();
    // What is left by what has been seen by now, in proportion to how it has come out so far.
    const std::vector<double> seconds = secondsOf({all.begin() + static_cast<std::ptrdiff_t>(i), all.end()});
    double left = 0;
    for (const double s : seconds) left += s;
    const double pace = done > 0 ? std::clamp(secondsSince(began) / done, 0.25, 4.0) : 1;
    session_.progress("pictures", static_cast<float>(done + left > 0 ? done / (done + left) : 0),
                      left > 0 ? timeLeft(pace * left) : "");
    if (!make(all[i], /*fromVoxelsOn=*/false)) return false;
    done += seconds.front();
  }
  return true;
}

/// False where a stage could not be made ideal.
bool StagePictures::make(const Due& due, bool fromVoxelsOn) {
  const auto& [seed, ideals] = due;
  try {
    if (fromVoxelsOn) run_.bench().pipeline().invalidate(Redo::Voxels);
    PictureTime time;
    const LinearPixels pixels = picture(ideals, seed, time);
    writeLinear(stemOf(ideals, seed), run_.task().size, pixels);
    writeTime(timeFileOf(ideals, seed), time);
    times_->took(ideals, time);
    return true;
  } catch (const DeviceError& error) {
    if (!dismiss(ideals, error.what())) throw;
  } catch (const UsageError& error) {  // sizes that do not go together
    if (!dismiss(ideals, error.what())) throw;
  } catch (const WorkError& error) {
    throwIfStopped();
    if (!ideals.has(ErrorStage::storage) || !dismiss({ErrorStage::storage}, error.what())) throw;
  }
  return false;
}

/// The stage that a picture found no memory for, or no solution: false where that is none.
bool StagePictures::dismiss(const Ideals& ideals, const std::string& why) {
  session_.device->waitIdle();
  session_.timings.reset();
  for (const ErrorStage stage : {ErrorStage::voxels, ErrorStage::rays, ErrorStage::storage, ErrorStage::facets,
                                 ErrorStage::shadows, ErrorStage::reflections, ErrorStage::lookup})
    if (ideals.has(stage) && presence_[stage].present) {
      lack(stage, fmt::format("could not be made ideal: {}", why));
      session_.progress.note(fmt::format("{}: {}", nameOf(stage), why));
      return true;
    }
  return false;
}

/// Of light that is solved from the dark.
LinearPixels StagePictures::picture(const Ideals& ideals, uint32_t seed, PictureTime& time) {
  Bench& bench = run_.bench();
  Pipeline& pipeline = bench.pipeline();
  Settings settings = settingsFor(ideals);
  settings.matrix.gpu.seed = seed;
  pipeline.set(settings);
  pipeline.darken();
  StageClock clock([](const char*, float) { return throwIfStopped(), true; });
  bench.prepare(clock.progress());
  time.build = clock.finish();
  bench.forget();
  for (const Finding& finding : pipeline.findings())
    if (finding.severity == Finding::Severity::Error) throw DeviceError(finding.text);
  std::vector<glm::dvec3> h, b;
  Clock::time_point began = Clock::now();
  if (ideals.has(ErrorStage::storage)) {
    const bool solved = exact_ && AttributionTimes::sameLight(ideals, exact_->of.ideals) && exact_->of.seed == seed;
    if (!solved) {
      exact_.reset();
      exact_ = Exact{{seed, ideals},
                     solveExactly(*session_.context, pipeline, kSolved, [](float) { return throwIfStopped(), true; })};
    }
    h = exact_->light.indirect, b = exact_->light.radiosity;
    pipeline.showLight(asVec4(h), asVec4(b));
    if (!solved) time.exact = secondsSince(began);
  }
  began = Clock::now();
  LinearPixels pixels = drawn(run_.task().view.view);
  time.draw = secondsSince(began);
  if (ideals.has(ErrorStage::lookup)) {
    began = Clock::now();
    if (h.empty()) {
      const auto perFacetOf = [&](const Buffer& values) {
        const std::vector<glm::vec3> v = perFacet(*session_.context, pipeline.facets(), values);
        return std::vector<glm::dvec3>(v.begin(), v.end());
      };
      h = perFacetOf(pipeline.lighting().indirect), b = perFacetOf(pipeline.lighting().radiosity);
    }
    replaceLookup(settings, h, b, seed, pixels);
    time.gather = secondsSince(began);
  }
  return pixels;
}

/// Takes the indirect light that was looked up out of a picture and puts in what is gathered at each pixel.
void StagePictures::replaceLookup(const Settings& settings, const std::vector<glm::dvec3>& h,
                                  const std::vector<glm::dvec3>& b, uint32_t seed, LinearPixels& pixels) {
  Pipeline& pipeline = run_.bench().pipeline();
  const LinearPixels lookedUp = is("indirect") ? pixels : drawn(VIEW_INDIRECT);
  Settings other = settings;
  // What a pixel makes of an irradiance of 1.
  other.sample.emitters = EmitterLookup::facets;
  pipeline.set(other);
  pipeline.showLight(LinearPixels(h.size(), glm::vec4(1, 1, 1, 0)), {});
  const LinearPixels factor = drawn(VIEW_INDIRECT);
  const std::vector<std::optional<SeenPoint>> seen = seenPoints();
  pipeline.showLight(asVec4(h), {});
  pipeline.set(settings);

  const Scene& scene = pipeline.scene();
  const auto gathered = gatherAtPixels(*session_.context, pipeline.facets(), run_.task().camera, scene.origin,
                                       {.size = run_.task().size,
                                        .seen = seen,
                                        .byFace = pipeline.plan().on(Effect::normalMap),
                                        .radiosity = b,
                                        .sky = pipeline.plan().on(Effect::sky) ? &pipeline.sky() : nullptr,
                                        .rays = task_.gatherRays,
                                        .seed = seed,
                                        .watch = throwIfStopped});
  for (size_t i = 0; i < pixels.size(); ++i) {
    if (!gathered[i]) continue;
    const glm::dvec3 ideal = glm::dvec3(factor[i]) * *gathered[i];
    pixels[i] += glm::vec4(glm::vec3(ideal) - glm::vec3(lookedUp[i]), 0);
  }
}

/// Of the picture just drawn.
std::vector<std::optional<SeenPoint>> StagePictures::seenPoints() {
  const Targets& targets = run_.bench().targets();
  const std::vector<std::byte> indirect = download(*session_.context, targets.indirect),
                               normals = download(*session_.context, targets.normal);
  const size_t count = size_t{targets.size.x} * targets.size.y;
  IRAD_CHECK_OP(indirect.size(), ==, count * sizeof(glm::vec4));
  IRAD_CHECK_OP(normals.size(), ==, count * sizeof(uint64_t));
  std::vector<std::optional<SeenPoint>> out(count);
  for (size_t i = 0; i < count; ++i) {
    uint32_t seenAs = 0;  // shaders/shared/passes.h
    std::memcpy(&seenAs, &indirect[i * sizeof(glm::vec4) + 3 * sizeof(float)], sizeof seenAs);
    if (seenAs < kFirstSeen) continue;
    uint64_t packed = 0;
    std::memcpy(&packed, &normals[i * sizeof packed], sizeof packed);
    out[i] = SeenPoint{seenAs - kFirstSeen, glm::vec3(glm::unpackHalf4x16(packed))};
  }
  return out;
}

}  // namespace irad::app
