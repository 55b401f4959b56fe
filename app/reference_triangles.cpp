// `irad reference --of triangles`: the path tracer, pass after pass.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/device_session.h"
#include "app/interrupts.h"
#include "app/reference_task.h"
#include "app/version.h"
#include "gi/check/path_state.h"
#include "gi/sky.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/scene/camera_json.h"
#include "renderer/scene/light_json.h"
#include "renderer/scene/sky_image.h"

namespace irad::app::reference {
namespace fs = std::filesystem;
namespace {

/// Samples of a pass: what a run may end after. Fixed, so that --noise ends at the same number every time.
constexpr uint32_t kPass = 4;
/// Fewer say too little of their spread.
constexpr uint32_t kFewestSamples = 16;
constexpr uint64_t kUsualSamples = 256;
/// Raised when the path tracer gives other samples, so that states from before are not continued.
constexpr int kTracer = 1;

/// All that the samples depend on.
Json madeOf(const Scene& scene, const Settings& settings, const Camera& camera, const TraceOptions& options) {
  Json made;
  made["tracer"] = kTracer;
  made["scene"] = scene.sha256.empty() ? scene.path.string() : scene.sha256;
  made["camera"] = Json::parse(cameraToJson(camera));
  made["lights"] = Json::parse(lightsToJson(scene.lights));
  if (scene.sky) made["sky"] = scene.sky->sha256;
  made["seed"] = settings.matrix.gpu.seed;
  made["centred"] = options.centred;
  made["materials"] = options.glossySeen ? "glossy-seen" : options.glossy ? "glossy" : "diffuse";
  made["bounces"] = options.bounces > 0 ? Json(options.bounces - 1) : Json("none");
  for (const Setting& setting : settingTable())
    if (setting.group() == "scene" || setting.group() == "sky") made[setting.name] = setting.text(settings);
  return made;
}

const TracedLight& layerOf(const TracedPicture& picture, const std::string& name) {
  return name == "lit" ? picture.lit : name == "indirect" ? picture.indirect : picture.specular;
}

/// Sums to go on with: those of the state, which must be of this picture, or none.
TracedSums resumed(const Task& task, bool resume, const Json& made) {
  const fs::path path = task.beside(".state");
  std::error_code ignored;
  if (!resume || !fs::exists(path, ignored)) return {};
  SavedSums saved = readSums(path);
  const auto refuse = [&](const std::string& what, const std::string& there, const std::string& here) {
    throw UsageError(
        fmt::format("--resume: {} is of another picture: {} {}, not {}", path.string(), what, there, here));
  };
  if (saved.sums.size != task.size)
    refuse("size", fmt::format("{}x{}", saved.sums.size.x, saved.sums.size.y),
           fmt::format("{}x{}", task.size.x, task.size.y));
  Json before = Json::parse(saved.made);
  if (!before.is_object()) throw InputError(fmt::format("{}: made: unexpected value {}", path.string(), saved.made));
  if (!before.contains("materials")) before["materials"] = "diffuse";  // from before there were others
  if (!before.contains("bounces")) before["bounces"] = "none";
  checkMade(path, before, made);
  return std::move(saved.sums);
}

}  // namespace

void traceTriangles(const Arguments& arguments, const Task& task) {
  if (!hasPathTracer()) throw UsageError("--of triangles: this build has no path tracer (IRAD_EMBREE)");
  Settings settings = arguments.settings.resolve(task.config, /*cpuDevice=*/true);
  ProgressReport progress;
  const fs::path scenePath = findScene(arguments.scene, task.config, std::nullopt);
  Scene scene = loadForRun(scenePath, arguments.sceneOptions, task.config, settings, progress);
  const Camera camera = cameraOf(arguments, task, scene);
  TraceOptions options{.seed = settings.matrix.gpu.seed,
                       .centred = arguments.centred,
                       .glossy = arguments.glossy || arguments.glossySeen,
                       .glossySeen = arguments.glossySeen,
                       .bounces = task.bounces};
  const Json made = madeOf(scene, settings, camera, options);
  TracedSums sums = resumed(task, arguments.resume, made);
  const uint32_t before = sums.samples;
  const auto folder = beginFiles(task);  // goes again where the work fails

  const auto tracer = makePathTracer(scene, makeSky(settings.sky, skyInputs(scene, scene.lights)));
  const uint64_t most = task.spp || task.seconds || task.noise ? task.spp.value_or(0) : kUsualSamples;
  const auto save = [&] { writeSums(task.beside(".state"), {jsonText(made), sums}); };
  const StopOnSignal interrupts;
  const Goal goal(task, most, before);
  double noise = std::numeric_limits<double>::infinity(), saved = 0;
  const auto measure = [&] {
    if (!task.noise || sums.samples < kFewestSamples) return;
    const TracedPicture p = pictureOf(sums);
    noise = relativeNoise(layerOf(p, task.layers[0]));
  };
  measure();
  while (sums.samples < 2 || !goal.reached(sums.samples, noise)) {
    progress("path tracing", goal.fraction(sums.samples, noise), goal.left(sums.samples, noise));
    const uint64_t left = most > sums.samples ? most - sums.samples : kPass;
    options.samples = std::max(static_cast<uint32_t>(std::min<uint64_t>(kPass, left)), sums.samples == 0 ? 2u : 1u);
    tracer->add(camera, task.size, options, sums);
    measure();
    if (interrupts.came()) break;
    if (goal.elapsed() - saved > kSecondsBetweenStates) {
      save();
      saved = goal.elapsed();
    }
  }
  const TracedPicture picture = pictureOf(sums);
  std::vector<PictureLayer> layers;
  for (const std::string& name : task.layers) {
    const TracedLight& light = layerOf(picture, name);
    addLayer(layers, name, pixelsOf(light.mean), pixelsOf(light.error));
  }
  std::vector<glm::dvec3> bounces, bounceErrors;
  for (const TracedLight& light : picture.bounces) {
    addLayer(layers, bounceName(bounces.size()), pixelsOf(light.mean), pixelsOf(light.error));
    bounces.push_back(light.pictureMean);
    bounceErrors.push_back(light.pictureError);
  }
  const TracedLight& first = layerOf(picture, task.layers[0]);
  const double relative = relativeNoise(first), rate = static_cast<double>(sums.rays) * 1e-6 / sums.seconds;
  const bool whole = !interrupts.came() || goal.reached(sums.samples, noise);

  save();
  std::vector<fs::path> written = writeLayers(task.stem, task.size, layers, subjectOf(task, camera));
  written.push_back(task.beside(".state"));
  Manifest manifest{.program = {versionNumber(), versionCommit()},
                    .subcommand = "reference",
                    .scene = &scene,
                    .settings = &settings,
                    .cpuDevice = true};
  const glm::dvec3 &mean = first.pictureMean, &error = first.pictureError;
  Json truth{{"of", task.of},
             {"materials", made.at("materials")},
             {"layers", task.layers},
             {"complete", whole},
             {"samples_per_pixel", sums.samples},
             {"rays", sums.rays},
             {"seconds", sums.seconds},
             {"mrays_per_second", rate},
             {"mean", {mean.x, mean.y, mean.z}},
             {"mean_error", {error.x, error.y, error.z}},
             {"relative_standard_error", relative}};
  progress.finish();
  print("samples     {} per pixel{}\n", sums.samples,
        before > 0 ? fmt::format(", {} of them by earlier runs", before) : "");
  print("rays        {:.2f} M in {:.1f} s: {:.2f} Mrays/s\n", static_cast<double>(sums.rays) * 1e-6, sums.seconds,
        rate);
  print("mean        {:.6g} {:.6g} {:.6g} W/(m^2 sr), standard error {:.2g} {:.2g} {:.2g}\n", mean.x, mean.y, mean.z,
        error.x, error.y, error.z);
  print("noise       {:.3g}: relative standard error of pixels\n", relative);
  if (task.bounces > 0) truth["bounces"] = tellBounces(picture.lit.pictureMean, bounces, bounceErrors);
  finishFiles(task, arguments, std::move(manifest), camera, truth, std::move(written));
  if (!whole)
    throw WorkError(fmt::format("interrupted: {} holds {} samples per pixel; --resume goes on with them",
                                task.beside(linearExtension()).string(), sums.samples));
}

}  // namespace irad::app::reference
