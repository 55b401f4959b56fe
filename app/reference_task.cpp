#include "app/reference_task.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "app/device_session.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/near_match.h"
#include "renderer/frame/transfer.h"
#include "renderer/scene/camera_json.h"
#include "renderer/targets.h"

namespace irad::app::reference {
namespace fs = std::filesystem;
namespace {

/// Layers of 72 bytes a pixel.
constexpr uint64_t kMostBounces = 31;

std::string checked(const char* what, const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw UsageError(
        fmt::format("{}: unknown '{}'{}; there are {}", what, name, suggestion(name, known), fmt::join(known, ", ")));
  return name;
}

}  // namespace

Task taskOf(const Arguments& arguments) {
  Task task;
  if (!arguments.of) throw UsageError("--of: triangles, voxels or matrix is to be given");
  task.of = checked("--of", *arguments.of, {"triangles", "voxels", "matrix"});
  for (const std::string& name :
       arguments.layers.empty() ? std::vector<std::string>{"lit"} : splitList("--layer", arguments.layers)) {
    checked("--layer", name, {"lit", "indirect", "specular"});
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
  onlyFor(arguments.resume, "--resume", !matrix, "triangles and voxels: a matrix is solved to the end");
  onlyFor(arguments.glossy, "--glossy", triangles, "triangles; the others have the materials that pictures have");
  onlyFor(arguments.glossySeen, "--glossy-seen", triangles,
          "triangles; the others have the materials that pictures have");
  if (arguments.glossy && arguments.glossySeen) throw UsageError("--glossy or --glossy-seen, not both");
  onlyFor(arguments.bounces.has_value(), "--bounces", triangles || matrix,
          "triangles and matrix: frames of rays do not tell them apart");
  if (arguments.bounces)
    task.bounces = 1 + static_cast<uint32_t>(parseInteger("--bounces", *arguments.bounces, 0, kMostBounces));
  if (std::ranges::count(task.layers, "specular") > 0 && !arguments.glossy && !arguments.glossySeen)
    throw UsageError("--layer specular is for --of triangles with --glossy or --glossy-seen");
  onlyFor(arguments.centred, "--centred", triangles, "triangles; the others sample pixels as irad render does");
  onlyFor(arguments.facets, "--facets", !triangles, "voxels and matrix");
  arguments.sceneOptions.check();
  arguments.picture.check();
  task.config = arguments.settings.readConfig();
  task.size = arguments.picture.resolveSize(task.config);
  return task;
}

double Goal::elapsed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

float Goal::fraction(uint64_t done, double noise) const {
  double share = most_ > 0 ? static_cast<double>(done) / static_cast<double>(most_) : 0;
  if (task_.noise && std::isfinite(noise)) share = std::max(share, *task_.noise * *task_.noise / (noise * noise));
  if (task_.seconds) share = std::max(share, *task_.seconds > 0 ? elapsed() / *task_.seconds : 1);
  return static_cast<float>(std::min(share, 1.0));
}

bool Goal::reached(uint64_t done, double noise) const {
  return (most_ > 0 && done >= most_) || (task_.noise && noise <= *task_.noise) ||
         (task_.seconds && elapsed() >= *task_.seconds);
}

std::string Goal::left(uint64_t done, double noise) const {
  double seconds = task_.seconds ? *task_.seconds - elapsed() : std::numeric_limits<double>::infinity();
  const double n = static_cast<double>(done), each = elapsed() / (n - static_cast<double>(before_));
  if (done > before_ && most_ > 0) seconds = std::min(seconds, (static_cast<double>(most_) - n) * each);
  if (done > before_ && task_.noise && std::isfinite(noise))
    seconds = std::min(seconds, (noise * noise / (*task_.noise * *task_.noise) - 1) * n * each);
  return std::isfinite(seconds) ? timeLeft(seconds) : "";
}

void addLayer(std::vector<PictureLayer>& layers, const std::string& name, std::vector<glm::vec4> value,
              std::optional<std::vector<glm::vec4>> error) {
  const bool first = layers.empty();
  layers.push_back({first ? "" : name, std::move(value)});
  if (error) layers.push_back({first ? "error" : name + ".error", std::move(*error)});
}

std::unique_ptr<MadeFolder> beginFiles(const Task& task) {
  auto folder = std::make_unique<MadeFolder>(task.stem.has_parent_path() ? task.stem.parent_path() : fs::path("."));
  removeFile(task.beside(".json"));
  return folder;
}

void finishFiles(const Task& task, const Arguments& arguments, Manifest manifest, const Camera& camera,
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
  repeat("--bounces", arguments.bounces);
  if (arguments.glossy) manifest.arguments.emplace_back("--glossy");
  if (arguments.glossySeen) manifest.arguments.emplace_back("--glossy-seen");
  if (arguments.centred) manifest.arguments.emplace_back("--centred");
  if (arguments.facets) manifest.arguments.emplace_back("--facets");
  manifest.details.emplace_back("truth", jsonText(truth));
  for (const fs::path& path : written) manifest.files.push_back(path.filename().string());
  writeFile(task.beside(".json"), manifest.toJson());
  written.push_back(task.beside(".json"));
  for (const fs::path& path : written) print("wrote       {}\n", path.string());
}

Camera cameraOf(const Arguments& arguments, const Task& task, const Scene& scene) {
  const std::vector<Camera> cameras = arguments.picture.resolveCameras(task.config, scene);
  if (cameras.size() != 1) throw UsageError(fmt::format("--camera: one, not {}", cameras.size()));
  return cameras[0];
}

PictureSubject subjectOf(const Task& task, const Camera& camera) {
  return {cameraToJson(camera), task.layers.front()};
}

std::string bounceName(size_t reflections) {
  return fmt::format("bounce.{}", reflections);
}

Json tellBounces(const glm::dvec3& lit, const std::vector<glm::dvec3>& bounces, const std::vector<glm::dvec3>& errors) {
  const auto mean = [](const glm::dvec3& v) { return (v.x + v.y + v.z) / 3; };
  Json json = Json::array();
  glm::dvec3 rest = lit;
  const auto line = [&](const std::string& name, const glm::dvec3& v, const std::string& error) {
    print("{:<11} {:.6g} {:.6g} {:.6g} W/(m^2 sr){}: {:.2f} % of lit\n", name, v.x, v.y, v.z, error,
          mean(lit) > 0 ? 100 * mean(v) / mean(lit) : 0);
  };
  for (size_t k = 0; k < bounces.size(); ++k) {
    const glm::dvec3& b = bounces[k];
    rest -= b;
    Json one{{"reflections", k}, {"mean", {b.x, b.y, b.z}}};
    if (!errors.empty()) one["mean_error"] = {errors[k].x, errors[k].y, errors[k].z};
    json.push_back(std::move(one));
    line(bounceName(k), b,
         errors.empty() ? ""
                        : fmt::format(", standard error {:.2g} {:.2g} {:.2g}", errors[k].x, errors[k].y, errors[k].z));
  }
  line("the rest", rest, "");
  return json;
}

void checkMade(const fs::path& state, const Json& before, const Json& made) {
  for (const Json* both : {&made, &before})
    for (const auto& [name, value] : both->items()) {
      const Json there = before.value(name, Json()), here = made.value(name, Json());
      if (there != here)
        throw UsageError(fmt::format("--resume: {} is of another picture: {} {}, not {}", state.string(), name,
                                     jsonText(there), jsonText(here)));
    }
}

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

}  // namespace irad::app::reference
