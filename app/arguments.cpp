#include "app/arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "gi/check/check.h"
#include "renderer/base/error.h"
#include "renderer/base/near_match.h"
#include "renderer/scene/camera_json.h"
#include "renderer/scene/light_json.h"
#include "renderer/scene/material_edits.h"
#include "renderer/scene/sky_image.h"

namespace irad::app {
namespace fs = std::filesystem;

void SettingArguments::declare(Options& options) {
  options.values("--set", "NAME=VALUE", set, "Set one setting (repeatable); `irad settings` lists them");
  options.value("--preset", "NAME", preset, "thesis, fast, balanced or reference");
  options.value("--config", "FILE", config, "Settings as JSON, or a manifest.json to replay");
  options.value("--seed", "N", seed, "Seed of the random directions (matrix.seed)");
}

Config SettingArguments::readConfig() const {
  return config ? readConfigFile(*config) : Config{};
}

Settings SettingArguments::resolve(const Config& from, bool cpuDevice) const {
  Settings settings = defaultSettings(cpuDevice);
  if (preset) applyPreset(settings, *preset, cpuDevice);
  if (from.settings) try {
      settingsFromJson(settings, *from.settings);
    } catch (const UsageError& error) {
      throw InputError(fmt::format("{}: {}", from.path.string(), error.what()));
    }
  for (const std::string& assignment : set) applySetting(settings, assignment);
  if (seed) settings.matrix.gpu.seed = static_cast<uint32_t>(parseInteger("--seed", *seed, 0, UINT32_MAX));
  return settings;
}

bool SettingArguments::names(const Config& from, const std::string& setting) const {
  const bool here = std::ranges::any_of(set, [&](const std::string& s) { return s.starts_with(setting + "="); });
  return here || (from.settings && nlohmann::json::parse(*from.settings).contains(setting));
}

bool SettingArguments::sizesAreDefault() const {
  const auto sizes = [](const std::string& s) {
    return s.starts_with("voxel.resolution=") || s.starts_with("matrix.rays=");
  };
  return !preset && !config && std::none_of(set.begin(), set.end(), sizes);
}

void DeviceArguments::declare(Options& options) {
  options.value("--device", "NAME|INDEX", device, "Vulkan device, by index or part of its name");
  options.flag("--validate", validate, "Run under the validation layers; any message is a failure");
  options.flag("--poison", poison, "Debugging aid: fill all fresh device memory with NaN; results must not change");
  options.flag("--list-devices", list, "Print the devices and what each lacks");
  options.value("--memory-budget", "MIB", memoryBudget,
                "Device memory to take at most (default: what the device has to give)");
  options.values("--inject", "oom=N|lost=N", inject,
                 "Debugging: the N-th buffer or image finds no memory; the device is lost at the N-th submission or "
                 "wait");
}

DeviceOptions DeviceArguments::options() const {
  DeviceOptions out;
  out.select = device.value_or("");
  out.validate = validate;
  out.poison = poison;
  if (memoryBudget) out.memoryBudget = parseInteger("--memory-budget", *memoryBudget, 1, uint64_t{1} << 24) << 20;
  for (const std::string& fault : inject) {
    const size_t equals = std::min(fault.find('='), fault.size());
    const std::string kind = fault.substr(0, equals);
    if (equals == fault.size() || (kind != "oom" && kind != "lost"))
      throw UsageError(fmt::format("--inject: '{}' is neither oom=N nor lost=N", fault));
    uint64_t& number = kind == "oom" ? out.failResource : out.loseDevice;
    number = parseInteger("--inject " + kind, fault.substr(equals + 1), 1, UINT64_MAX);
  }
  return out;
}

void PictureArguments::declareView(Options& options) {
  options.value("--size", "WxH", size, "Size of the pictures in pixels (default 640x640)");
  options.values("--camera", "NAME|JSON", cameras,
                 "Camera of the scene, `all`, or JSON (repeatable; default: the first)");
}

void PictureArguments::declare(Options& options) {
  declareView(options);
  options.value("--frames", "N", frames, "Frames to render");
}

glm::uvec2 PictureArguments::resolveSize(const Config& config) const {
  if (size) return parseSize(*size);
  return config.size.value_or(glm::uvec2(640, 640));
}

uint32_t PictureArguments::resolveFrames(const Config& config, uint32_t otherwise) const {
  if (frames) return static_cast<uint32_t>(parseInteger("--frames", *frames, 1, kMaxFrames));
  return config.frames.value_or(otherwise);
}

void PictureArguments::check() const {
  if (size) parseSize(*size);
  resolveFrames({}, 1);
  for (const std::string& camera : cameras)
    if (camera.starts_with("{")) cameraFromJson(camera);
}

std::vector<Camera> PictureArguments::resolveCameras(const Config& config, const Scene& scene) const {
  if (cameras.empty() && !config.cameras.empty()) return config.cameras;
  if (cameras.empty()) return {scene.cameras.at(0)};
  const std::vector<Camera> known = allCameras(scene);
  std::vector<std::string> names;
  for (const Camera& camera : known) names.push_back(camera.name);
  std::vector<Camera> out;
  for (const std::string& wanted : cameras) {
    if (wanted == "all") {
      out.insert(out.end(), known.begin(), known.end());
    } else if (wanted.starts_with("{")) {
      out.push_back(cameraFromJson(wanted));
    } else {
      const auto found = std::find(names.begin(), names.end(), wanted);
      if (found == names.end())
        throw UsageError(fmt::format("unknown camera '{}'{}", wanted, suggestion(wanted, names)));
      out.push_back(known[static_cast<size_t>(found - names.begin())]);
    }
  }
  return out;
}

void SceneArguments::declare(Options& options) {
  options.value("--lights", "JSON", lights, "Lights in place of the scene's, an array as manifests hold it");
  options.value("--materials", "JSON", materials,
                "Edits of the scene's materials in place of the sidecar's, an array as manifests hold it");
  options.values("--hide", "NODE", hidden,
                 "Leave out a node and all under it, by its path (hall/lamp) or its name; in place of what the sidecar "
                 "hides (repeatable)");
  options.value("--isolate", "NODE", isolated, "Show this node and what is under it alone");
  options.value(
      "--sky", "FILE", sky,
      "Picture of the sky, equirectangular (.hdr, .exr, .pfm), or a built-in one (evening); sky.* turn and scale it");
  options.flag("--no-sidecar", noSidecar,
               "Leave lights, materials, hidden nodes, cameras and region of SCENE.irad.json aside");
}

/// A file that is there, or a built-in one by its name: a folder "box" does not hide it.
static std::optional<fs::path> findFile(const std::string& wanted, const std::string& extension) {
  std::error_code ignored;  // a name that is no path at all does not exist either
  const bool folder = fs::is_directory(wanted, ignored);
  if (!folder && fs::exists(wanted, ignored)) return wanted;
  if (fs::path(wanted).filename() == wanted && !fs::path(wanted).has_extension())
    for (const fs::path& built : builtInFolders())
      if (const fs::path path = built / (wanted + extension); fs::exists(path, ignored)) return path;
  return folder ? std::optional<fs::path>(wanted) : std::nullopt;  // whose reader says what it is
}

void SceneArguments::check() const {
  if (lights) lightsFromJson(*lights, "--lights");
  if (materials) materialEditsFromJson(*materials, "--materials");
}

LoadOptions SceneArguments::load(const Config& config, const Settings& settings) const {
  LoadOptions out;
  out.lambertian = settings.scene.lambertian;
  out.doubleSided = settings.scene.doubleSided;
  out.sidecar = !noSidecar && !config.manifest;
  out.lights = config.lights;
  if (lights) out.lights = lightsFromJson(*lights, "--lights");
  if (config.manifest) out.materials = config.materials;
  if (materials) out.materials = materialEditsFromJson(*materials, "--materials");
  if (config.manifest) out.hidden = config.hidden;
  if (!hidden.empty() || isolated) out.hidden = HiddenNodes{hidden, isolated.value_or("")};
  if (sky || config.sky)
    out.sky = std::make_shared<SkyImage>(readSky(sky ? findFile(*sky, ".pfm").value_or(*sky) : *config.sky));
  return out;
}

void useSky(Settings& settings, const LoadOptions& options) {
  if (options.sky && settings.sky.source == SkySource::none) settings.sky.source = SkySource::image;
  if (!options.sky && settings.sky.source == SkySource::image)
    throw UsageError("sky.source=image: no picture of the sky was given (--sky FILE)");
}

double parseNumber(const std::string& option, const std::string& text, double min, double max) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(value >= min && value <= max))
    throw UsageError(fmt::format("{}: '{}' is not allowed; expected a number, {} to {}", option, text, min, max));
  return value;
}

uint64_t parseInteger(const std::string& option, const std::string& text, uint64_t min, uint64_t max) {
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < min || value > max)
    throw UsageError(fmt::format("{}: '{}' is not allowed; expected an integer, {} to {}", option, text, min, max));
  return value;
}

glm::uvec3 parseVoxel(const std::string& option, const std::string& text) {
  const std::vector<std::string> axes = splitList(option, {text});
  if (axes.size() != 3) throw UsageError(fmt::format("{}: '{}' is not X,Y,Z", option, text));
  glm::uvec3 voxel;
  for (int a = 0; a < 3; ++a) voxel[a] = static_cast<uint32_t>(parseInteger(option, axes[a], 0, 1023));
  return voxel;
}

glm::uvec2 parseSize(const std::string& text) {
  const size_t x = text.find('x');
  if (x == std::string::npos) throw UsageError(fmt::format("--size: '{}' is not WIDTHxHEIGHT", text));
  return {parseInteger("--size", text.substr(0, x), 1, kMaxPictureSide),
          parseInteger("--size", text.substr(x + 1), 1, kMaxPictureSide)};
}

std::vector<std::string> splitList(const std::string& option, const std::vector<std::string>& values) {
  std::vector<std::string> out;
  for (const std::string& value : values) {
    size_t start = 0;
    while (true) {
      const size_t comma = value.find(',', start);
      out.push_back(value.substr(start, comma - start));
      if (out.back().empty()) throw UsageError(fmt::format("{}: an empty name in '{}'", option, value));
      if (comma == std::string::npos) break;
      start = comma + 1;
    }
  }
  return out;
}

std::vector<fs::path> builtInFolders() {
  std::vector<fs::path> folders;
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  if (!error) folders.push_back(executable.parent_path() / "assets");
  folders.emplace_back(IRAD_ASSETS);
  return folders;
}

static std::vector<std::string> listScenes() {
  std::vector<std::string> names;
  for (const fs::path& folder : builtInFolders()) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (const fs::path extension = entry.path().extension(); extension == ".glb" || extension == ".irscene")
        names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

const std::vector<std::string>& builtInScenes() {
  static const std::vector<std::string> names = listScenes();  // the help of each command asks
  return names;
}

std::string sceneHelp() {
  return fmt::format("A .gltf or .glb file, or a built-in scene ({})", fmt::join(builtInScenes(), ", "));
}

fs::path findScene(const std::optional<std::string>& argument, const Config& config,
                   const std::optional<std::string>& otherwise) {
  std::optional<std::string> wanted = argument;
  if (!wanted && config.scene) wanted = config.scene->string();
  if (!wanted) wanted = otherwise;
  if (!wanted)
    throw UsageError(
        fmt::format("no scene given: a .gltf or .glb file, or one of: {}", fmt::join(builtInScenes(), ", ")));
  if (isCheckScene(*wanted)) {
    (void)caseOf(*wanted);
    return *wanted;
  }
  for (const char* extension : {".glb", ".irscene"})  // a build without image decoders comes with the latter
    if (const std::optional<fs::path> path = findFile(*wanted, extension)) return *path;
  throw InputError(fmt::format("{}: no such file; built-in scenes{}", *wanted,
                               builtInScenes().empty() ? ": none found" : suggestion(*wanted, builtInScenes())));
}

}  // namespace irad::app
