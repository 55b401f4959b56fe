#include "app/study_attribution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/devices.h"
#include "app/interrupts.h"
#include "app/stage_pictures.h"
#include "app/table.h"
#include "gi/memory_report.h"
#include "gi/study/attribution.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/image_io.h"
#include "renderer/base/number_text.h"
#include "renderer/base/output_file.h"
#include "shaders/shared/color_map.h"

namespace irad::app {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kUsualSeeds = 8;
constexpr float kHeatEnd = 0.5f;  ///< of differences' colours: this share of the truth's mean

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

/// Measures what the folder lacks, and writes all that a study of one point leaves there. Seeds and folder are those of
/// `study`, settings those given.
Attribution splitPoint(DeviceSession& session, Scene scene, const Settings& settings, StudyTask study,
                       const AttributionTask& task) {
  study.study = fmt::format("attribution: {} times as fine, {} rays per pixel", task.finer, task.gatherRays);
  const fs::path out = study.out;
  const glm::uvec2 size = study.size;
  const uint32_t seeds = study.seeds;
  const float exposure = std::exp2(settings.camera.exposureEv);
  std::optional<StagePictures> pictures;
  StudyRun run(session, std::move(scene), SettingGrid(std::vector<std::string>{}, settings), std::move(study),
               [&](StudyRun& opened) { return pictures.emplace(session, opened, task).tryFew(); });
  if (!pictures) {  // where others tell of truths, nobody was asked what is ahead
    const WorkAhead ahead = pictures.emplace(session, run, task).tryFew();
    session.progress.note(fmt::format("  {:.0f} pictures to come, about {}", ahead.pictures, duration(ahead.all())));
  }
  pictures->measure();
  run.measureTimesOnly();
  session.progress.finish();

  const TruthBlocks truth(size, run.truth().first, run.truth().second);
  AttributionInput input{.presence = pictures->presence(), .pictures = {}, .cost = {}, .other = {}};
  std::map<std::string, LinearPixels> means;
  for (const Ideals& ideals : neededPictures(input.presence)) {
    const std::map<uint32_t, LinearPixels> bySeed = pictures->read(ideals);
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
      const std::map<uint32_t, LinearPixels> bySeed = pictures->read(chain[i].second);
      heat("difference-rays", means.at(chain[i].second.name()), bySeed.begin()->second,
           "What rays add: the first seed's picture less the mean");
    }
  std::vector<std::string> facts = run.notes().facts;
  facts.push_back(fmt::format("Differences: mean pictures along the chain, blue to red is ∓{} % of the truth's mean",
                              100 * kHeatEnd));
  facts.push_back(fmt::format("Ideal voxels and many rays: the first {} seeds", StagePictures::fewOf(seeds)));
  writeFile(out / "attribution.csv", attributionCsv(result));
  writeFile(out / "attribution-errors.svg", errorBars(result));
  writeFile(out / "attribution-times.svg", timeBars(result));
  writeFile(out / "report.html", attributionReport(result, facts, out, size, shown));
  return result;
}

}  // namespace

void AttributionArguments::declare(Options& options) {
  options.value(
      "--finer", "FACTOR", finer,
      "attribution, --split: ideal voxels are so many times as fine, 1.25 to 8 (default 2; the grid's limit at most)");
  options.value("--gather-rays", "N", gatherRays,
                "attribution, --split: rays from each pixel in the place of its lookup, 16 to 65536 (default 256)");
}

AttributionTask AttributionArguments::task() const {
  AttributionTask task;
  if (finer) task.finer = parseNumber("--finer", *finer, 1.25, 8);
  if (gatherRays) task.gatherRays = static_cast<uint32_t>(parseInteger("--gather-rays", *gatherRays, 16, 65536));
  return task;
}

void requireSplittable(const std::string& command, const Settings& settings, const ViewInfo& view) {
  if (settings.writeback.mode != WritebackMode::off)
    throw UsageError(fmt::format("{}: writeback.mode is to be off: what it adds is no stage's error", command));
  if (std::string_view(view.name) != "lit" && std::string_view(view.name) != "indirect")
    throw UsageError(fmt::format("{}: --view is lit or indirect, not {}", command, view.name));
}

std::vector<SplitPoint> splitFront(DeviceSession& session, const Scene& scene, const SettingGrid& grid,
                                   const StudyResults& results, const StudyTask& study, const AttributionTask& task,
                                   size_t most) {
  const std::vector<size_t> all = frontOfFirstPictures(summarize(results, grid.labels()));
  std::vector<size_t> chosen;
  const size_t count = std::min(most, all.size());
  for (size_t i = 0; i < count; ++i)
    chosen.push_back(all[count > 1 ? i * (all.size() - 1) / (count - 1) : all.size() / 2]);
  SharedTruths truths{.folder = study.out / "truths", .user = "cost", .users = {}};
  std::vector<SplitPoint> out;
  for (const size_t point : chosen) {
    session.progress.note(fmt::format("errors of point {} ({}) by stage", point, grid.label(point)));
    StudyTask own = study;
    own.out = study.out / "split" / pictureName(point);
    own.seeds = std::max(study.seeds, static_cast<uint32_t>(ErrorEstimates::kFewestSeeds));
    own.shard = {}, own.peerSamples.clear(), own.facetRays.reset();
    own.sharedTruths = &truths;
    makeFolder(own.out);
    try {
      out.push_back({point, splitPoint(session, scene, grid.settings(point), std::move(own), task)});
    } catch (const DeviceError& error) {
      session.progress.note(fmt::format("errors of point {}: {}", point, error.what()));
      session.device->waitIdle();
      session.timings.reset();
    }
  }
  return out;
}

void attributionStudy(Machine& machine, const MeasureArguments& measure, const AttributionArguments& arguments,
                      const std::optional<std::string>& scene) {
  const char* const command = "irad study attribution";
  measure.check();
  if (!measure.sweeps.empty()) throw UsageError(fmt::format("{}: one point has no --sweep", command));
  const AttributionTask task = arguments.task();
  if (measure.seeds) parseInteger("--seeds", *measure.seeds, ErrorEstimates::kFewestSeeds, 10'000);

  DeviceSession session(machine, measure.settings, measure.device);
  auto [loaded, study] = measure.open(session, command, scene);
  requireSplittable(command, session.settings, study.view);
  if (!measure.seeds) study.seeds = kUsualSeeds;
  study.out = measure.out.value_or("out/attribution");
  const fs::path out = study.out;
  const uint32_t seeds = study.seeds;
  const MadeFolder folder(out, kStudyLabels);
  const StopOnSignal stop;
  const Attribution result = splitPoint(session, std::move(loaded), session.settings, std::move(study), task);

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
