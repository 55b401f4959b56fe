// `irad reference --of voxels`: brute force, frame after frame.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/device_session.h"
#include "app/interrupts.h"
#include "app/reference_task.h"
#include "gi/check/frames_state.h"
#include "gi/facets.h"
#include "gi/host_facets.h"
#include "gi/lighting.h"
#include "gi/pipeline.h"
#include "gi/traits.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/output_file.h"
#include "renderer/scene/light_json.h"
#include "renderer/scene/sky_image.h"
#include "renderer/targets.h"

namespace irad::app::reference {
namespace fs = std::filesystem;
namespace {

constexpr uint64_t kUsualRays = 100'000;
/// Raised when brute force gives other frames, so that states from before are not continued.
constexpr int kFrames = 1;

/// All that the light depends on: camera and size are no part of it.
Json framesMadeOf(const Scene& scene, const Settings& settings, const DeviceInfo& device) {
  Json made;
  made["brute_force"] = kFrames;
  made["scene"] = scene.sha256.empty() ? scene.path.string() : scene.sha256;
  made["lights"] = Json::parse(lightsToJson(scene.lights));
  if (scene.sky) made["sky"] = scene.sky->sha256;
  made["device"] = device.name + ", " + device.driver;
  for (const Setting& setting : settingTable()) {
    const std::string_view name = setting.name;
    const bool ends = name == "solver.frames" || name == "solver.tolerance";
    if (setting.redo <= Redo::Solve && !ends) made[setting.name] = setting.text(settings);
  }
  return made;
}

/// Frames to go on with, or none.
std::optional<FramesState> resumedFrames(const Task& task, bool resume, const Json& made) {
  const fs::path path = task.beside(".state");
  std::error_code ignored;
  if (!resume || !fs::exists(path, ignored)) return std::nullopt;
  FramesState state = readFrames(path);
  const Json before = Json::parse(state.made);
  if (!before.is_object()) throw InputError(fmt::format("{}: made: unexpected value {}", path.string(), state.made));
  checkMade(path, before, made);
  return state;
}

}  // namespace

void traceVoxels(const Arguments& arguments, const Task& task, DeviceSession& session, Scene scene,
                 const Camera& camera) {
  const Settings asked = session.settings;
  Settings& settings = session.settings;
  const uint64_t most = task.spp || task.seconds || task.noise ? task.spp.value_or(0) : kUsualRays;
  // The mean over n frames has the variance of 5/9 n (docs/method.md 9).
  const uint64_t rays = settings.matrix.gpu.rays,
                 frames = most > 0 ? std::max<uint64_t>((most * 9 + 5 * rays - 1) / (5 * rays), 16) : 100'000;
  if (frames > 100'000)
    throw UsageError(fmt::format(
        "--spp: {} takes {} frames of {} rays, and there are 100000 at most; raise matrix.rays", most, frames, rays));
  settings.solver.method = SolverMethod::bruteForce;
  settings.solver.frames = static_cast<uint32_t>(frames);
  settings.solver.tolerance = static_cast<float>(task.noise.value_or(1e-7));
  if (arguments.resume && settings.solver.gpu.lambda > 1)
    throw UsageError("--resume: solver.lambda is above 1: what keeps growing light in check is in no state");
  const Json made = framesMadeOf(scene, settings, session.device->info);
  const std::optional<FramesState> state = resumedFrames(task, arguments.resume, made);
  const uint32_t before = state ? state->frames.frames : 0;
  const double secondsBefore = state ? state->seconds : 0;
  settings.solver.frames = std::max(settings.solver.frames, before);
  const auto folder = beginFiles(task);  // goes again where the work fails

  Pipeline pipeline(*session.context, std::move(scene), settings);
  session.tell(pipeline.traits().region);
  const StopOnSignal interrupts;
  const Goal goal(task, frames, before);
  double saved = 0;
  const auto save = [&] {
    const Lighting& light = pipeline.lighting();
    if (!light || light.report.frames == 0 || light.report.nonFinite > 0 || light.report.diverging) return;
    writeFrames(task.beside(".state"),
                {jsonText(made), secondsBefore + goal.elapsed(), saveFrames(*session.context, light)});
    saved = goal.elapsed();
  };
  const auto noise = [&](const SolveReport& r) {
    return r.frames >= 16 && r.meanH > 0 ? double{r.standardError} / r.meanH : std::numeric_limits<double>::infinity();
  };
  pipeline.prepare([&](const char* stage, float fraction) { return session.progress(stage, fraction); }, 1);
  if (state) {
    const size_t there = state->frames.indirect.size();
    if (there != pipeline.facets().count)
      throw UsageError(fmt::format("--resume: {} is of another picture: {} facets, not {}",
                                   task.beside(".state").string(), there, pipeline.facets().count));
    pipeline.goOn(state->frames);
  }
  // One frame alone has no standard error.
  while (!pipeline.asleep() && (!interrupts.came() || pipeline.lighting().report.frames < 2)) {
    const SolveReport& r = pipeline.lighting().report;
    if (r.frames >= 2 && task.seconds && goal.elapsed() >= *task.seconds) break;
    session.progress("frames of rays", goal.fraction(r.frames, noise(r)), goal.left(r.frames, noise(r)));
    pipeline.prepare({}, 1);
    if (goal.elapsed() - saved > kSecondsBetweenStates) save();
  }
  save();
  const SolveReport report = pipeline.lighting().report;
  const bool whole = !interrupts.came() || pipeline.asleep();

  Targets targets(*session.context, task.size);
  std::vector<PictureLayer> layers;
  std::vector<std::vector<glm::vec4>> values;
  for (const std::string& name : task.layers) values.push_back(drawn(session, pipeline, camera, viewOf(name), targets));
  const FacetList& list = pipeline.facets();
  const std::vector<glm::vec3> h = perFacet(*session.context, list, pipeline.lighting().indirect),
                               e = perFacet(*session.context, list, pipeline.lighting().frameMean.standardError);
  // The errors as the pictures look H up: errors of neighbours added as if they were one, which they are not.
  std::vector<glm::vec4> error(values[0].size(), glm::vec4(0, 0, 0, 1));
  if (pipeline.lighting()) {
    std::vector<glm::vec4> shown;
    for (const glm::vec3& v : e) shown.emplace_back(v, 0.0f);
    Settings lookedUp = settings;
    lookedUp.sample.emitters = EmitterLookup::facets;
    pipeline.set(lookedUp);
    pipeline.showLight(shown, {});
    error = drawn(session, pipeline, camera, VIEW_INDIRECT, targets);
  }
  for (size_t l = 0; l < values.size(); ++l) addLayer(layers, task.layers[l], std::move(values[l]), error);

  std::vector<fs::path> written = writeLayers(task.stem, task.size, layers, subjectOf(task, camera));
  std::error_code ignored;
  if (fs::exists(task.beside(".state"), ignored)) written.push_back(task.beside(".state"));
  if (arguments.facets) {
    written.push_back(writePerFacet<float>(task.beside(".irradiance.npy"), h));
    written.push_back(writePerFacet<float>(task.beside(".standard_error.npy"), e));
  }
  const double counted = static_cast<double>(rays) * report.frames * 5 / 9, relative = noise(report);
  const uint64_t all = rays * report.frames * list.count;
  const double seconds = secondsBefore + goal.elapsed();
  const Json truth{{"of", task.of},
                   {"layers", task.layers},
                   {"complete", whole},
                   {"frames", report.frames},
                   {"rays_per_facet", counted},
                   {"rays", all},
                   {"seconds", seconds},
                   {"mrays_per_second", static_cast<double>(all) * 1e-6 / seconds},
                   {"mean_irradiance", report.meanH},
                   {"relative_standard_error", std::isfinite(relative) ? relative : 0}};
  session.progress.finish();
  print("facets      {}\n", list.count);
  print("rays        {:.6g} per facet that count, of {} frames of {}{}; {:.2f} Mrays/s\n", counted, report.frames, rays,
        before > 0 ? fmt::format(", {} by earlier runs", before) : "", static_cast<double>(all) * 1e-6 / seconds);
  print("noise       standard error {:.3g} W/m^2 of mean H {:.6g}\n", report.standardError, report.meanH);
  settings = asked;  // which is what the manifest tells `irad render`
  finishFiles(task, arguments, session.manifest("reference", pipeline), camera, truth, std::move(written));
  session.checkNumbers(pipeline);
  session.checkValidation();
  if (!whole)
    throw WorkError(fmt::format("interrupted: {} is the mean of {} frames; --resume goes on with them",
                                task.beside(linearExtension()).string(), report.frames));
}

}  // namespace irad::app::reference
