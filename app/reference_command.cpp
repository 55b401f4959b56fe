// `irad reference`: pictures that do not share the error that they are held against, with their standard errors.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <signal.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/device_session.h"
#include "app/devices.h"
#include "app/version.h"
#include "gi/check/check.h"
#include "gi/check/exact_solve.h"
#include "gi/check/path_state.h"
#include "gi/facets.h"
#include "gi/host_facets.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/pipeline.h"
#include "gi/sky.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/near_match.h"
#include "renderer/base/output_file.h"
#include "renderer/frame/transfer.h"
#include "renderer/image_io.h"
#include "renderer/scene/camera_json.h"
#include "renderer/scene/light_json.h"
#include "renderer/scene/sky_image.h"
#include "renderer/targets.h"

namespace irad::app {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;
using Seconds = std::chrono::duration<double>;

/// Samples of a pass: what a run may end after. Fixed, so that --noise ends at the same number every time.
constexpr uint32_t kPass = 4;
/// Fewer say too little of their spread.
constexpr uint32_t kFewestSamples = 16;
/// A killed run loses no more than this.
constexpr double kSecondsBetweenStates = 60;
constexpr double kExactTolerance = 1e-12;
constexpr uint64_t kUsualRays = 100'000;
constexpr uint64_t kUsualSamples = 256;
/// Raised when the path tracer gives other samples, so that states from before are not continued.
constexpr int kTracer = 1;

struct ReferenceArguments {
  std::optional<std::string> scene, out, of, spp, seconds, noise;
  std::vector<std::string> layers;
  bool resume = false, centred = false, facets = false;
  SceneArguments sceneOptions;
  SettingArguments settings;
  DeviceArguments device;
  PictureArguments picture;
};

/// What was asked for, checked as far as it can be before anything is loaded.
struct Task {
  std::string of;
  fs::path stem;  ///< of the results: no extension
  std::vector<std::string> layers;
  std::optional<uint64_t> spp;
  std::optional<double> seconds, noise;
  Config config;
  glm::uvec2 size{0};
  fs::path beside(const char* extension) const { return stem.string() + extension; }
};

std::string checked(const char* what, const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw UsageError(
        fmt::format("{}: unknown '{}'{}; there are {}", what, name, suggestion(name, known), fmt::join(known, ", ")));
  return name;
}

Task taskOf(const ReferenceArguments& arguments) {
  Task task;
  if (!arguments.of) throw UsageError("--of: triangles, voxels or matrix is to be given");
  task.of = checked("--of", *arguments.of, {"triangles", "voxels", "matrix"});
  for (const std::string& name :
       arguments.layers.empty() ? std::vector<std::string>{"lit"} : splitList("--layer", arguments.layers)) {
    checked("--layer", name, {"lit", "indirect"});
    if (std::find(task.layers.begin(), task.layers.end(), name) == task.layers.end()) task.layers.push_back(name);
  }
  const fs::path out = arguments.out.value_or(std::string("ref") + linearExtension());
  if (out.extension() != linearExtension() || !out.has_stem())
    throw UsageError(
        fmt::format("--out: '{}' does not end in {}, as this build writes pictures", out.string(), linearExtension()));
  task.stem = out.parent_path() / out.stem();
  if (arguments.spp) task.spp = parseInteger("--spp", *arguments.spp, 2, uint64_t{1} << 31);
  if (arguments.seconds) task.seconds = parseNumber("--seconds", *arguments.seconds, 0, 1e9);
  if (arguments.noise) task.noise = parseNumber("--noise", *arguments.noise, 1e-7, 1);
  const bool triangles = task.of == "triangles", matrix = task.of == "matrix";
  const auto onlyFor = [&](bool given, const char* option, bool fits, const char* whom) {
    if (given && !fits) throw UsageError(fmt::format("{} is for --of {}", option, whom));
  };
  onlyFor(arguments.spp || arguments.seconds || arguments.noise, "--spp, --seconds or --noise", !matrix,
          "triangles and voxels: a matrix is solved to the end");
  onlyFor(arguments.resume, "--resume", triangles, "triangles");
  onlyFor(arguments.centred, "--centred", triangles, "triangles; the others sample pixels as irad render does");
  onlyFor(arguments.facets, "--facets", !triangles, "voxels and matrix");
  arguments.sceneOptions.check();
  arguments.picture.check();
  task.config = arguments.settings.readConfig();
  task.size = arguments.picture.resolveSize(task.config);
  return task;
}

// ---- Ctrl+C: the pass in hand is finished, and what there is written. A second one ends the program at once. ----

volatile sig_atomic_t interruptedBy = 0;

class Interrupts {
 public:
  Interrupts() {
    struct sigaction action {};
    action.sa_handler = [](int signal) { interruptedBy = signal; };
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigemptyset(&action.sa_mask);
    interruptedBy = 0;
    ::sigaction(SIGINT, &action, &interrupt_);
    ::sigaction(SIGTERM, &action, &terminate_);
  }
  ~Interrupts() {
    ::sigaction(SIGINT, &interrupt_, nullptr);
    ::sigaction(SIGTERM, &terminate_, nullptr);
  }
  Interrupts(const Interrupts&) = delete;
  bool came() const { return interruptedBy != 0; }

 private:
  struct sigaction interrupt_ {
  }, terminate_{};
};

/// How much of the work is done by what a run may end at, and how long the rest takes.
class Goal {
 public:
  /// `before`: what earlier runs have done of `most`.
  Goal(const Task& task, uint64_t most, uint64_t before) : task_(task), most_(most), before_(before) {}
  double elapsed() const { return Seconds(std::chrono::steady_clock::now() - start_).count(); }
  /// `noise` falls with the root of what is done; infinite: not known yet.
  float fraction(uint64_t done, double noise) const {
    double share = most_ > 0 ? static_cast<double>(done) / static_cast<double>(most_) : 0;
    if (task_.noise && std::isfinite(noise)) share = std::max(share, *task_.noise * *task_.noise / (noise * noise));
    if (task_.seconds) share = std::max(share, *task_.seconds > 0 ? elapsed() / *task_.seconds : 1);
    return static_cast<float>(std::min(share, 1.0));
  }
  bool reached(uint64_t done, double noise) const {
    return (most_ > 0 && done >= most_) || (task_.noise && noise <= *task_.noise) ||
           (task_.seconds && elapsed() >= *task_.seconds);
  }
  /// Empty: nothing says yet.
  std::string left(uint64_t done, double noise) const {
    double seconds = task_.seconds ? *task_.seconds - elapsed() : std::numeric_limits<double>::infinity();
    const double n = static_cast<double>(done), each = elapsed() / (n - static_cast<double>(before_));
    if (done > before_ && most_ > 0) seconds = std::min(seconds, (static_cast<double>(most_) - n) * each);
    if (done > before_ && task_.noise && std::isfinite(noise))
      seconds = std::min(seconds, (noise * noise / (*task_.noise * *task_.noise) - 1) * n * each);
    return std::isfinite(seconds) ? timeLeft(seconds) : "";
  }

 private:
  const Task& task_;
  uint64_t most_, before_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// ---- What all of them write ----

std::vector<glm::vec4> pixelsOf(const std::vector<glm::dvec3>& values) {
  std::vector<glm::vec4> out;
  out.reserve(values.size());
  for (const glm::dvec3& v : values) out.emplace_back(glm::vec3(v), 1.0f);
  return out;
}

void addLayer(std::vector<PictureLayer>& layers, const std::string& name, std::vector<glm::vec4> value,
              std::optional<std::vector<glm::vec4>> error) {
  const bool first = layers.empty();
  layers.push_back({first ? "" : name, std::move(value)});
  if (error) layers.push_back({first ? "error" : name + ".error", std::move(*error)});
}

/// Checks that the results can be written, and takes the last run's manifest away, which vouches for its files.
void beginFiles(const Task& task) {
  makeFolder(task.stem.has_parent_path() ? task.stem.parent_path() : fs::path("."));
  removeFile(task.beside(".json"));
}

void finishFiles(const Task& task, const ReferenceArguments& arguments, Manifest manifest, const Camera& camera,
                 const Json& truth, std::vector<fs::path> written) {
  manifest.size = task.size;
  manifest.cameras = {camera};
  manifest.arguments.insert(manifest.arguments.end(), {"--of", task.of});
  for (const std::string& layer : task.layers) manifest.arguments.insert(manifest.arguments.end(), {"--layer", layer});
  const auto repeat = [&](const char* option, const std::optional<std::string>& value) {
    if (value) manifest.arguments.insert(manifest.arguments.end(), {option, *value});
  };
  repeat("--spp", arguments.spp);
  repeat("--seconds", arguments.seconds);
  repeat("--noise", arguments.noise);
  if (arguments.centred) manifest.arguments.emplace_back("--centred");
  if (arguments.facets) manifest.arguments.emplace_back("--facets");
  manifest.details.emplace_back("truth", truth.dump());
  for (const fs::path& path : written) manifest.files.push_back(path.filename().string());
  writeFile(task.beside(".json"), manifest.toJson());
  written.push_back(task.beside(".json"));
  for (const fs::path& path : written) print("wrote       {}\n", path.string());
}

Camera cameraOf(const ReferenceArguments& arguments, const Task& task, const Scene& scene) {
  const std::vector<Camera> cameras = arguments.picture.resolveCameras(task.config, scene);
  if (cameras.size() != 1) throw UsageError(fmt::format("--camera: one, not {}", cameras.size()));
  return cameras[0];
}

// ---- Triangles ----

/// The root of the mean over pixels and channels of (standard error)^2 / (value^2 + (mean / 10)^2).
double relativeError(const TracedLight& light) {
  const glm::dvec3& m = light.pictureMean;
  const double mean = (m.x + m.y + m.z) / 3, eps = 0.01 * mean * mean;
  if (!(mean > 0)) return 0;
  double sum = 0;
  for (size_t i = 0; i < light.mean.size(); ++i) {
    const glm::dvec3 e2 = light.error[i] * light.error[i], v2 = light.mean[i] * light.mean[i];
    for (int c = 0; c < 3; ++c) sum += e2[c] / (v2[c] + eps);
  }
  return std::sqrt(sum / 3 / static_cast<double>(light.mean.size()));
}

/// All that the samples depend on.
Json madeOf(const Scene& scene, const Settings& settings, const Camera& camera, bool centred) {
  Json made;
  made["tracer"] = kTracer;
  made["scene"] = scene.sha256.empty() ? scene.path.string() : scene.sha256;
  made["camera"] = Json::parse(cameraToJson(camera));
  made["lights"] = Json::parse(lightsToJson(scene.lights));
  if (scene.sky) made["sky"] = scene.sky->sha256;
  made["seed"] = settings.matrix.gpu.seed;
  made["centred"] = centred;
  for (const Setting& setting : settingTable())
    if (setting.group() == "scene" || setting.group() == "sky") made[setting.name] = setting.text(settings);
  return made;
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
  const Json before = Json::parse(saved.made);
  if (!before.is_object()) throw InputError(fmt::format("{}: made: unexpected value {}", path.string(), saved.made));
  for (const Json* both : {&made, &before})
    for (const auto& [name, value] : both->items()) {
      const Json there = before.value(name, Json()), here = made.value(name, Json());
      if (there != here) refuse(name, there.dump(), here.dump());
    }
  return std::move(saved.sums);
}

void traceTriangles(const ReferenceArguments& arguments, const Task& task) {
  if (!hasPathTracer()) throw UsageError("--of triangles: this build has no path tracer (IRAD_EMBREE)");
  Settings settings = arguments.settings.resolve(task.config, /*cpuDevice=*/true);
  ProgressReport progress;
  const fs::path scenePath = findScene(arguments.scene, task.config, std::nullopt);
  Scene scene = loadForRun(scenePath, arguments.sceneOptions, task.config, settings, progress);
  const Camera camera = cameraOf(arguments, task, scene);
  const Json made = madeOf(scene, settings, camera, arguments.centred);
  TracedSums sums = resumed(task, arguments.resume, made);
  const uint32_t before = sums.samples;
  beginFiles(task);

  const auto tracer = makePathTracer(scene, makeSky(settings.sky, skyInputs(scene, scene.lights)));
  TraceOptions options{.seed = settings.matrix.gpu.seed, .centred = arguments.centred};
  const uint64_t most = task.spp || task.seconds || task.noise ? task.spp.value_or(0) : kUsualSamples;
  const auto save = [&] { writeSums(task.beside(".state"), {made.dump(), sums}); };
  const Interrupts interrupts;
  const Goal goal(task, most, before);
  double noise = std::numeric_limits<double>::infinity(), saved = 0;
  const auto measure = [&] {
    if (!task.noise || sums.samples < kFewestSamples) return;
    const TracedPicture p = pictureOf(sums);
    noise = relativeError(task.layers[0] == "lit" ? p.lit : p.indirect);
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
    const TracedLight& light = name == "lit" ? picture.lit : picture.indirect;
    addLayer(layers, name, pixelsOf(light.mean), pixelsOf(light.error));
  }
  const TracedLight& first = task.layers[0] == "lit" ? picture.lit : picture.indirect;
  const double relative = relativeError(first), rate = static_cast<double>(sums.rays) * 1e-6 / sums.seconds;
  const bool whole = !interrupts.came() || goal.reached(sums.samples, noise);

  save();
  std::vector<fs::path> written = writeLayers(task.stem, task.size, layers);
  written.push_back(task.beside(".state"));
  Manifest manifest{.program = {versionNumber(), versionCommit()},
                    .subcommand = "reference",
                    .scene = &scene,
                    .settings = &settings,
                    .cpuDevice = true};
  const glm::dvec3 &mean = first.pictureMean, &error = first.pictureError;
  const Json truth{{"of", task.of},
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
  finishFiles(task, arguments, std::move(manifest), camera, truth, std::move(written));
  if (!whole)
    throw WorkError(fmt::format("interrupted: {} holds {} samples per pixel; --resume goes on with them",
                                task.beside(linearExtension()).string(), sums.samples));
}

// ---- Voxels and matrix: the pipeline's own light, solved to the end ----

std::vector<glm::vec4> drawn(DeviceSession& session, Pipeline& pipeline, const Camera& camera, View view,
                             Targets& targets) {
  Frame frame = session.context->begin();
  pipeline.render(frame, camera, view, targets);
  frame.submitAndWait();
  const std::vector<std::byte> bytes = download(*session.context, targets.linear);
  std::vector<glm::vec4> pixels(bytes.size() / sizeof(glm::vec4));
  std::memcpy(pixels.data(), bytes.data(), bytes.size());
  return pixels;
}

View viewOf(const std::string& layer) {
  return layer == "lit" ? VIEW_LIT : VIEW_INDIRECT;
}

template <class T>
fs::path writePerFacet(const fs::path& path, const std::vector<glm::vec<3, T>>& values) {
  std::vector<T> flat;
  for (const auto& v : values) flat.insert(flat.end(), {v.x, v.y, v.z});
  writeNpy<T>(path, {values.size(), 3}, flat);
  return path;
}

/// Indirect light without a matrix, frame after frame.
void traceVoxels(const ReferenceArguments& arguments, const Task& task, DeviceSession& session, Scene scene,
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
  Pipeline pipeline(*session.context, std::move(scene), settings);
  const Interrupts interrupts;
  const Goal goal(task, frames, 0);
  const auto noise = [&](const SolveReport& r) {
    return r.frames >= 16 && r.meanH > 0 ? double{r.standardError} / r.meanH : std::numeric_limits<double>::infinity();
  };
  pipeline.prepare([&](const char* stage, float fraction) { return session.progress(stage, fraction); }, 1);
  // One frame alone has no standard error.
  while (!pipeline.asleep() && (!interrupts.came() || pipeline.lighting().report.frames < 2)) {
    const SolveReport& r = pipeline.lighting().report;
    if (r.frames >= 2 && task.seconds && goal.elapsed() >= *task.seconds) break;
    session.progress("frames of rays", goal.fraction(r.frames, noise(r)), goal.left(r.frames, noise(r)));
    pipeline.prepare({}, 1);
  }
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

  std::vector<fs::path> written = writeLayers(task.stem, task.size, layers);
  if (arguments.facets) {
    written.push_back(writePerFacet<float>(task.beside(".irradiance.npy"), h));
    written.push_back(writePerFacet<float>(task.beside(".standard_error.npy"), e));
  }
  const double counted = static_cast<double>(rays) * report.frames * 5 / 9, relative = noise(report);
  const uint64_t all = rays * report.frames * list.count;
  const Json truth{{"of", task.of},
                   {"layers", task.layers},
                   {"complete", whole},
                   {"frames", report.frames},
                   {"rays_per_facet", counted},
                   {"rays", all},
                   {"seconds", goal.elapsed()},
                   {"mrays_per_second", static_cast<double>(all) * 1e-6 / goal.elapsed()},
                   {"mean_irradiance", report.meanH},
                   {"relative_standard_error", std::isfinite(relative) ? relative : 0}};
  session.progress.finish();
  print("facets      {}\n", list.count);
  print("rays        {:.6g} per facet that count, of {} frames of {}; {:.2f} Mrays/s\n", counted, report.frames, rays,
        static_cast<double>(all) * 1e-6 / goal.elapsed());
  print("noise       standard error {:.3g} W/m^2 of mean H {:.6g}\n", report.standardError, report.meanH);
  settings = asked;  // which is what the manifest tells `irad render`
  finishFiles(task, arguments, session.manifest("reference", pipeline), camera, truth, std::move(written));
  session.checkNumbers(pipeline);
  session.checkValidation();
  if (!whole)
    throw WorkError(fmt::format("interrupted: {} is the mean of {} frames", task.beside(linearExtension()).string(),
                                report.frames));
}

void solveMatrix(const ReferenceArguments& arguments, const Task& task, DeviceSession& session, Scene scene,
                 const Camera& camera) {
  if (session.settings.solver.method != SolverMethod::matrix)
    throw UsageError("--of matrix: solver.method = brute_force has no matrix");
  if (session.settings.effects.matrix == EffectMode::automatic) session.settings.effects.matrix = EffectMode::on;
  const auto start = std::chrono::steady_clock::now();
  const Interrupts interrupts;
  Pipeline pipeline(*session.context, std::move(scene), session.settings);
  session.prepare(pipeline);
  if (!pipeline.matrix() || !pipeline.lighting())
    throw UsageError("--of matrix: there is no matrix, or no light that it could carry");
  const SolveReport solved = pipeline.lighting().report;
  const ExactLight exact = solveExactly(*session.context, pipeline, kExactTolerance, [&](float done) {
    return session.progress("solving in double precision", done) && !interrupts.came();
  });
  const std::vector<glm::vec3> h = perFacet(*session.context, pipeline.facets(), pipeline.lighting().indirect);
  double largest = 0;
  for (size_t i = 0; i < h.size(); ++i)
    for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(double{h[i][c]} - exact.indirect[i][c]));
  std::vector<glm::vec4> indirect, radiosity;
  for (size_t i = 0; i < h.size(); ++i) {
    indirect.emplace_back(glm::vec3(exact.indirect[i]), 0.0f);
    radiosity.emplace_back(glm::vec3(exact.radiosity[i]), 0.0f);
  }
  pipeline.showLight(indirect, radiosity);
  Targets targets(*session.context, task.size);
  std::vector<PictureLayer> layers;
  for (const std::string& name : task.layers)
    addLayer(layers, name, drawn(session, pipeline, camera, viewOf(name), targets), std::nullopt);
  std::vector<fs::path> written = writeLayers(task.stem, task.size, layers);
  if (arguments.facets) written.push_back(writePerFacet<double>(task.beside(".irradiance.npy"), exact.indirect));
  const double seconds = Seconds(std::chrono::steady_clock::now() - start).count();
  const Json truth{{"of", task.of},        {"layers", task.layers},
                   {"complete", true},     {"sweeps", exact.sweeps},
                   {"seconds", seconds},   {"mean_irradiance", exact.meanH},
                   {"bound", exact.bound}, {"largest_error_of_the_solver", largest}};
  session.progress.finish();
  print("facets      {}\n", h.size());
  print("solve       {} sweeps in double precision, error at most {:.3g} W/m^2 of mean H {:.6g}\n", exact.sweeps,
        exact.bound, exact.meanH);
  print("solver      was off by {:.3g} W/m^2 at most, its bound {:.3g}\n", largest, solved.bound);
  finishFiles(task, arguments, session.manifest("reference", pipeline), camera, truth, std::move(written));
  session.checkNumbers(pipeline);
  session.checkValidation();
}

void run(const ReferenceArguments& arguments) {
  if (arguments.device.list) return printDevices(/*json=*/false);
  const Task task = taskOf(arguments);
  if (task.of == "triangles") return traceTriangles(arguments, task);
  const fs::path scenePath = findScene(arguments.scene, task.config, std::nullopt);
  DeviceSession session(arguments.settings, arguments.device);
  Scene scene = session.load(scenePath, arguments.sceneOptions);
  const Camera camera = cameraOf(arguments, task, scene);
  if (session.settings.writeback.mode != WritebackMode::off)
    throw UsageError(
        fmt::format("--of {}: writeback.mode is to be off: reflections are no part of this truth", task.of));
  beginFiles(task);
  (task.of == "voxels" ? traceVoxels : solveMatrix)(arguments, task, session, std::move(scene), camera);
}

}  // namespace

Command referenceCommand() {
  const auto arguments = std::make_shared<ReferenceArguments>();
  return {"reference", "A picture to hold others against, with its standard error: of triangles, voxels or the matrix",
          [arguments](Options& options) {
            options.argument("SCENE", arguments->scene, sceneHelp());
            options.value("--out", "FILE", arguments->out,
                          fmt::format("The picture (default ref{0}); beside it NAME.json, the manifest. Channels R G B "
                                      "hold the first --layer, error.* its standard error per pixel (a build without "
                                      "OpenImageIO: NAME.error.pfm)",
                                      linearExtension()));
            options.value("--of", "WHAT", arguments->of,
                          "triangles: path traced, diffuse (metals are black: see scene.lambertian), in double "
                          "precision; of the settings scene.*, sky.* and matrix.seed apply. voxels: the model with "
                          "very many rays per facet, without a matrix. "
                          "matrix: the matrix solved in double precision to 1e-12 of the mean H");
            options.values("--layer", "NAME[,NAME...]", arguments->layers,
                           "lit (default) or indirect, as the views of these names; the second one has channels "
                           "NAME.R, NAME.error.R, ...");
            options.value("--spp", "N", arguments->spp,
                          "End with N samples per pixel (triangles; default 256), or N rays per facet that count "
                          "(voxels; default 100000)");
            options.value("--seconds", "S", arguments->seconds,
                          "End after the pass during which S seconds have passed");
            options.value("--noise", "E", arguments->noise,
                          "End when the relative standard error is E at most. triangles: the root of the mean over "
                          "pixels and channels of error^2 / (value^2 + (a tenth of the picture's mean)^2), from 16 "
                          "samples on. voxels: the mean standard error of H over the mean H, from 16 frames on");
            options.flag("--resume", arguments->resume,
                         "triangles: go on from NAME.state (144 bytes per pixel), which every run leaves beside the "
                         "picture, to the bits of one run; from the start where there is none. Refused where scene, "
                         "camera, size or settings differ. Without it every run starts anew");
            options.flag("--centred", arguments->centred,
                         "triangles: rays through the middle of pixels, as irad render samples, not all over them");
            options.flag("--facets", arguments->facets,
                         "voxels, matrix: also NAME.irradiance.npy, H per facet in matrix order (and "
                         "NAME.standard_error.npy)");
            arguments->picture.declareView(options);
            arguments->sceneOptions.declare(options);
            arguments->settings.declare(options);
            arguments->device.declare(options);
          },
          [arguments] { run(*arguments); }};
}

}  // namespace irad::app
