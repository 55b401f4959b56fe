#include "app/study_attribution.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "app/devices.h"
#include "app/interrupts.h"
#include "app/table.h"
#include "gi/check/exact_solve.h"
#include "gi/facets.h"
#include "gi/final_gather.h"
#include "gi/host_facets.h"
#include "gi/host_trace.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/memory_report.h"
#include "gi/plan.h"
#include "gi/sky.h"
#include "gi/study/attribution.h"
#include "gi/watch.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/number_text.h"
#include "renderer/base/output_file.h"
#include "renderer/image_io.h"
#include "shaders/shared/color_map.h"

namespace irad::app {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kUsualSeeds = 8;
constexpr double kSolved = 1e-12;      ///< of the mean H
constexpr float kConverged = 1e-7f;    ///< the least solver.tolerance
constexpr uint32_t kMostRays = 4096;   ///< of matrix.rays
constexpr uint32_t kFewestRays = 512;  ///< that count as many
constexpr float kHeatEnd = 0.5f;       ///< of differences' colours: this share of the truth's mean

/// Of so many seeds those that pictures have whose builds take many times as long.
uint32_t fewOf(uint32_t seeds) {
  return std::max(static_cast<uint32_t>(ErrorEstimates::kFewestSeeds), seeds / 2);
}

/// How far a study goes.
struct AttributionTask {
  double finer = 2;
  uint32_t gatherRays = 256;
};

/// The pictures by which an error is split.
class StagePictures {
 public:
  StagePictures(DeviceSession& session, StudyRun& run, const AttributionTask& task)
      : session_(session), run_(run), task_(task), folder_(run.task().out / "linear") {
    makeFolder(folder_);
    Pipeline& pipeline = run_.bench().pipeline();
    pipeline.set(asGiven());
    run_.bench().prepare({});
    run_.bench().forget();
    judge();
  }

  const std::map<ErrorStage, StagePresence>& presence() const { return presence_; }

  /// Makes those that the folder does not have yet.
  void measure() {
    started_ = Clock::now();
    while (!measureAll())
      ;  // a stage fell out
    session_.progress.finish();
  }

  /// Those of a set of ideal stages, by seed.
  std::map<uint32_t, LinearPixels> read(const Ideals& ideals) const {
    std::map<uint32_t, LinearPixels> out;
    for (const uint32_t seed : seedsOf(ideals)) out[seed] = readLinear(fileOf(ideals, seed)).pixels;
    return out;
  }

 private:
  using Clock = std::chrono::steady_clock;

  const Settings& asGiven() const { return run_.grid().base(); }
  bool is(const char* view) const { return std::string_view(run_.task().view.name) == view; }
  uint32_t finerResolution() const {
    const double n = task_.finer * asGiven().voxel.resolution;
    return static_cast<uint32_t>(std::min(std::round(n), findSetting("voxel.resolution").range.max));
  }
  uint32_t manyRays() const {
    const uint32_t rays = asGiven().matrix.gpu.rays;
    return std::max(rays, std::min(kMostRays, std::max(16 * rays, kFewestRays)));
  }
  uint32_t largestShadowMap() const {
    return std::max(asGiven().light.shadowResolution, session_.device->isCpu ? 4096u : 8192u);
  }
  uint32_t manyPoints() const { return std::max(asGiven().light.points, session_.device->isCpu ? 256u : 1024u); }

  // ---- Which stages there are ----

  void have(ErrorStage stage, std::string words) { presence_[stage] = {true, std::move(words)}; }
  void lack(ErrorStage stage, std::string words) { presence_[stage] = {false, std::move(words)}; }

  void judge() {
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

  Settings settingsFor(const Ideals& ideals) const {
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

  uint32_t rays() const { return asGiven().matrix.gpu.rays; }
  uint32_t fewSeeds() const { return fewOf(run_.task().seeds); }
  /// Fewer where a build takes many times as long.
  std::vector<uint32_t> seedsOf(const Ideals& ideals) const {
    const bool heavy = ideals.has(ErrorStage::voxels) || ideals.has(ErrorStage::rays);
    std::vector<uint32_t> out;
    for (uint32_t i = 0; i < (heavy ? fewSeeds() : run_.task().seeds); ++i)
      out.push_back(asGiven().matrix.gpu.seed + i);
    return out;
  }
  fs::path stemOf(const Ideals& ideals, uint32_t seed) const {
    return folder_ / fmt::format("{}.{}", ideals.name(), seed);
  }
  fs::path fileOf(const Ideals& ideals, uint32_t seed) const {
    return stemOf(ideals, seed).string() + linearExtension();
  }

  /// How many times the work of a picture as it is.
  double weightOf(const Ideals& ideals) const {
    double out = 1;
    if (ideals.has(ErrorStage::voxels)) out *= std::pow(double{1} * finerResolution() / asGiven().voxel.resolution, 2);
    if (ideals.has(ErrorStage::rays)) out *= double{1} * manyRays() / rays();
    return out;
  }

  /// False where a stage could not be made ideal: it is none from then on.
  bool measureAll() {
    // By builds, so that pictures that differ in the light alone share one; seed after seed.
    std::vector<Ideals> needed = neededPictures(presence_);
    std::ranges::stable_sort(needed, {}, [&](const Ideals& ideals) {
      return fmt::format("{:d}{:d}{:d}{:d}{:d}", ideals.has(ErrorStage::rays), ideals.has(ErrorStage::voxels),
                         ideals.has(ErrorStage::facets), ideals.has(ErrorStage::normals),
                         ideals.has(ErrorStage::traversal));
    });
    std::vector<std::pair<uint32_t, Ideals>> due;
    double all = 0, left = 0;
    for (uint32_t i = 0; i < run_.task().seeds; ++i)
      for (const Ideals& ideals : needed) {
        const uint32_t seed = asGiven().matrix.gpu.seed + i;
        if (std::ranges::count(seedsOf(ideals), seed) == 0) continue;
        all += weightOf(ideals);
        if (fs::exists(fileOf(ideals, seed))) continue;
        due.emplace_back(seed, ideals);
        left += weightOf(ideals);
      }
    double done = 0;
    for (const auto& [seed, ideals] : due) {
      throwIfStopped();
      const std::chrono::duration<double> elapsed = Clock::now() - started_;
      session_.progress("pictures", static_cast<float>((all - left) / all),
                        done > 0 ? timeLeft(elapsed.count() / done * left) : "");
      try {
        const LinearPixels pixels = picture(ideals, seed);
        writeLinear(stemOf(ideals, seed), run_.task().size, pixels);
      } catch (const DeviceError& error) {
        if (!dismiss(ideals, error.what())) throw;
        return false;
      } catch (const WorkError& error) {
        if (!ideals.has(ErrorStage::storage) || !dismiss({ErrorStage::storage}, error.what())) throw;
        return false;
      }
      done += weightOf(ideals);
      left -= weightOf(ideals);
    }
    return true;
  }

  /// The stage that a picture found no memory for, or no solution: false where that is none.
  bool dismiss(const Ideals& ideals, const std::string& why) {
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

  // ---- Pictures ----

  LinearPixels drawn(View view) { return run_.bench().picturesAsLit({&view, 1}); }

  /// Of light that is solved from the dark.
  LinearPixels picture(const Ideals& ideals, uint32_t seed) {
    Bench& bench = run_.bench();
    Pipeline& pipeline = bench.pipeline();
    Settings settings = settingsFor(ideals);
    settings.matrix.gpu.seed = seed;
    pipeline.set(settings);
    pipeline.darken();
    bench.prepare({});
    bench.forget();
    for (const Finding& finding : pipeline.findings())
      if (finding.severity == Finding::Severity::Error) throw DeviceError(finding.text);
    std::vector<glm::dvec3> h, b;
    if (ideals.has(ErrorStage::storage)) {
      ExactLight exact = solveExactly(*session_.context, pipeline, kSolved);
      h = std::move(exact.indirect), b = std::move(exact.radiosity);
      pipeline.showLight(asVec4(h), asVec4(b));
    }
    LinearPixels pixels = drawn(run_.task().view.view);
    if (ideals.has(ErrorStage::lookup)) {
      if (h.empty()) {
        const auto perFacetOf = [&](const Buffer& values) {
          const std::vector<glm::vec3> v = perFacet(*session_.context, pipeline.facets(), values);
          return std::vector<glm::dvec3>(v.begin(), v.end());
        };
        h = perFacetOf(pipeline.lighting().indirect), b = perFacetOf(pipeline.lighting().radiosity);
      }
      replaceLookup(settings, h, b, seed, pixels);
    }
    return pixels;
  }

  static LinearPixels asVec4(const std::vector<glm::dvec3>& values) {
    LinearPixels out;
    for (const glm::dvec3& v : values) out.emplace_back(glm::vec3(v), 0.0f);
    return out;
  }

  /// Takes the indirect light that was looked up out of a picture and puts in what is gathered at each pixel.
  void replaceLookup(const Settings& settings, const std::vector<glm::dvec3>& h, const std::vector<glm::dvec3>& b,
                     uint32_t seed, LinearPixels& pixels) {
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
                                          .seed = seed});
    for (size_t i = 0; i < pixels.size(); ++i) {
      if (!gathered[i]) continue;
      const glm::dvec3 ideal = glm::dvec3(factor[i]) * *gathered[i];
      pixels[i] += glm::vec4(glm::vec3(ideal) - glm::vec3(lookedUp[i]), 0);
    }
  }

  /// Of the picture just drawn.
  std::vector<std::optional<SeenPoint>> seenPoints() {
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
  static constexpr uint32_t kFirstSeen = 0x3F800000u;

  DeviceSession& session_;
  StudyRun& run_;
  AttributionTask task_;
  fs::path folder_;
  std::map<ErrorStage, StagePresence> presence_;
  Clock::time_point started_;
};

/// Times by the study's rows, memory as it is now.
void addCosts(const Context& context, StudyRun& run, AttributionInput& input) {
  const PointSummary point = run.points().at(0);
  const std::pair<const char*, double StageCost::*> kinds[] = {
      {"setup", &StageCost::buildMs}, {"relight", &StageCost::relightMs}, {"camera", &StageCost::frameMs}};
  const auto costOf = [&](std::optional<ErrorStage> stage) -> StageCost& {
    return stage ? input.cost[*stage] : input.other;
  };
  for (const auto& [kind, member] : kinds)
    if (const auto stages = point.stages.find(kind); stages != point.stages.end())
      for (const auto& [pass, spread] : stages->second) costOf(stageOfPass(pass)).*member += spread.p50;
  for (const MemoryReportRow& row : memoryReport(context.device.memory().rows(), run.bench().pipeline()))
    if (row.kind == MemoryReportRow::Kind::Resource && row.measured)
      costOf(stageOfMemory(row.subsystem, row.name)).mib += inMebibytes(*row.measured);
}

LinearPixels meanOf(const std::map<uint32_t, LinearPixels>& pictures) {
  LinearPixels out;
  for (const auto& [seed, pixels] : pictures) {
    if (out.empty()) out.assign(pixels.size(), glm::vec4(0));
    for (size_t i = 0; i < pixels.size(); ++i) out[i] += pixels[i] / static_cast<float>(pictures.size());
  }
  return out;
}

/// to - from, luminance, as a share of `mean`: blue is darker, red brighter.
void writeDifference(const fs::path& stem, glm::uvec2 size, const LinearPixels& from, const LinearPixels& to,
                     double mean) {
  std::vector<glm::u8vec4> bytes;
  for (size_t i = 0; i < from.size(); ++i) {
    const glm::vec3 d = glm::vec3(to[i]) - glm::vec3(from[i]);
    const float value = mean > 0 ? glm::dot(d, glm::vec3(0.2126f, 0.7152f, 0.0722f)) / static_cast<float>(mean) : 0;
    const glm::vec3 color = encodeSrgb(colorMap(COLOR_MAP_BLUE_RED, colorMapPosition(value, -kHeatEnd, kHeatEnd)));
    bytes.emplace_back(glm::u8vec3(glm::round(255.0f * color)), 255);
  }
  writeDisplay(stem, size, bytes);
}

}  // namespace

void AttributionArguments::declare(Options& options) {
  options.value("--finer", "FACTOR", finer,
                "attribution: ideal voxels are so many times as fine, 1.25 to 8 (default 2; the grid's limit at most)");
  options.value("--gather-rays", "N", gatherRays,
                "attribution: rays from each pixel in the place of its lookup, 16 to 65536 (default 256)");
}

void attributionStudy(const MeasureArguments& measure, const AttributionArguments& arguments,
                      const std::optional<std::string>& scene) {
  const char* const command = "irad study attribution";
  measure.check();
  if (!measure.sweeps.empty()) throw UsageError(fmt::format("{}: one point has no --sweep", command));
  AttributionTask task;
  if (arguments.finer) task.finer = parseNumber("--finer", *arguments.finer, 1.25, 8);
  if (arguments.gatherRays)
    task.gatherRays = static_cast<uint32_t>(parseInteger("--gather-rays", *arguments.gatherRays, 16, 65536));
  if (measure.seeds) parseInteger("--seeds", *measure.seeds, ErrorEstimates::kFewestSeeds, 10'000);

  DeviceSession session(measure.settings, measure.device);
  auto [loaded, study] = measure.open(session, command, scene);
  if (session.settings.writeback.mode != WritebackMode::off)
    throw UsageError(fmt::format("{}: writeback.mode is to be off: what it adds is no stage's error", command));
  if (std::string_view(study.view.name) != "lit" && std::string_view(study.view.name) != "indirect")
    throw UsageError(fmt::format("{}: --view is lit or indirect, not {}", command, study.view.name));
  const uint32_t seeds = measure.seeds ? study.seeds : kUsualSeeds;
  study.study = fmt::format("attribution: {} times as fine, {} rays per pixel", task.finer, task.gatherRays);
  study.out = measure.out.value_or("out/attribution");
  study.seeds = seeds;
  const fs::path out = study.out;
  const MadeFolder folder(out);
  const glm::uvec2 size = study.size;
  const float exposure = std::exp2(session.settings.camera.exposureEv);
  const StopOnSignal stop;
  StudyRun run(session, std::move(loaded), SettingGrid(std::vector<std::string>{}, session.settings), std::move(study));
  StagePictures pictures(session, run, task);
  pictures.measure();
  run.measureTimesOnly();
  session.progress.finish();

  const TruthBlocks truth(size, run.truth().first, run.truth().second);
  AttributionInput input{.presence = pictures.presence(), .pictures = {}, .cost = {}, .other = {}};
  std::map<std::string, LinearPixels> means;
  for (const Ideals& ideals : neededPictures(input.presence)) {
    const std::map<uint32_t, LinearPixels> bySeed = pictures.read(ideals);
    for (const auto& [seed, pixels] : bySeed) input.pictures[ideals.name()][seed] = truth.of(pixels);
    means[ideals.name()] = meanOf(bySeed);
  }
  addCosts(*session.context, run, input);
  const Attribution result = attribute(truth, input);

  std::vector<std::pair<std::string, std::string>> shown{{kReferenceName, "The truth"}};
  const auto heat = [&](const std::string& name, const LinearPixels& from, const LinearPixels& to,
                        const std::string& caption) {
    writeDifference(out / "pictures" / name, size, from, to, truth.mean());
    shown.emplace_back(name, caption);
  };
  writeAsShown(out / "pictures" / "as-is", size, means.at("as-is"), exposure);
  shown.emplace_back("as-is", "The picture as it is, mean over the seeds");
  const std::vector<std::pair<std::optional<ErrorStage>, Ideals>> chain = chainOf(input.presence);
  heat("difference-all", run.truth().mean(), means.at("as-is"), "All of its error; red: too bright, by half the mean");
  heat("difference-model", run.truth().mean(), means.at(chain.front().second.name()), "model: every stage ideal");
  for (size_t i = 1; i < chain.size(); ++i)
    if (*chain[i].first != ErrorStage::rays) {
      const char* name = nameOf(*chain[i].first);
      heat(fmt::format("difference-{}", name), means.at(chain[i - 1].second.name()), means.at(chain[i].second.name()),
           fmt::format("What the error of {} adds", name));
    } else {
      const std::map<uint32_t, LinearPixels> bySeed = pictures.read(chain[i].second);
      heat("difference-rays", means.at(chain[i].second.name()), bySeed.begin()->second,
           "What rays add: the first seed's picture less the mean");
    }
  std::vector<std::string> facts = run.notes().facts;
  facts.push_back(fmt::format("Differences: mean pictures along the chain, blue to red is ∓{} % of the truth's mean",
                              100 * kHeatEnd));
  facts.push_back(fmt::format("Ideal voxels and many rays: the first {} seeds", fewOf(seeds)));
  writeFile(out / "attribution.csv", attributionCsv(result));
  writeFile(out / "attribution-errors.svg", errorBars(result));
  writeFile(out / "attribution-times.svg", timeBars(result));
  writeFile(out / "report.html", attributionReport(result, facts, out, size, shown));

  std::vector<bool> right(13, true);
  right.front() = right.back() = false;
  print("relMSE      {} ± {} of 8 x 8 means, {} seeds\n", shortNumber(result.asIs.mean), shortNumber(result.asIs.half),
        seeds);
  print("{}", formatTable(attributionTable(result), right));
  for (const std::string& finding : result.findings) print("{}\n", finding);
  print("wrote       {}\n", (out / "report.html").string());
  session.checkValidation();
}

}  // namespace irad::app
