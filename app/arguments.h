// The options that subcommands share, and what they mean.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/command.h"
#include "gi/config.h"
#include "gi/settings.h"
#include "renderer/device.h"
#include "renderer/scene/scene.h"

namespace irad::app {

/// --set, --preset, --config, --seed. Later beats earlier: defaults of the device class, preset, config, set, seed.
struct SettingArguments {
  std::vector<std::string> set;
  std::optional<std::string> preset, config, seed;
  void declare(Options& options);
  Config readConfig() const;
  Settings resolve(const Config& config, bool cpuDevice) const;
  /// Whether --set or --config gives a setting.
  bool names(const Config& config, const std::string& setting) const;
  /// Voxels and rays are the defaults' choice alone, so they may be lowered where memory does not suffice.
  bool sizesAreDefault() const;
};

/// --device, --validate, --poison, --list-devices, --memory-budget, --inject.
struct DeviceArguments {
  std::optional<std::string> device, memoryBudget;
  std::vector<std::string> inject;
  bool validate = false, poison = false, list = false;
  void declare(Options& options);
  DeviceOptions options() const;
};

/// --size, --camera, --frames.
struct PictureArguments {
  std::optional<std::string> size, frames;
  std::vector<std::string> cameras;
  void declare(Options& options);
  void declareView(Options& options);                  ///< --size and --camera alone
  glm::uvec2 resolveSize(const Config& config) const;  ///< default 640 x 640
  uint32_t resolveFrames(const Config& config, uint32_t otherwise) const;
  /// Named cameras of the scene and its sidecar, "all", or JSON; default: those of the config, else the scene's first.
  std::vector<Camera> resolveCameras(const Config& config, const Scene& scene) const;
  /// Checks what can be checked before a scene is loaded.
  void check() const;
};

/// A number of an option; UsageError names the option and the range.
double parseNumber(const std::string& option, const std::string& text, double min, double max);
/// A whole number of an option; UsageError names the option and the range.
uint64_t parseInteger(const std::string& option, const std::string& text, uint64_t min, uint64_t max);
/// "12,3,40": a voxel's place in the grid, which is not known yet.
glm::uvec3 parseVoxel(const std::string& option, const std::string& text);
/// "640x480".
glm::uvec2 parseSize(const std::string& text);
/// Elements of "a,b,c", empty ones refused.
std::vector<std::string> splitList(const std::string& option, const std::vector<std::string>& values);

/// --lights, --materials, --hide, --isolate, --no-sidecar, --sky.
struct SceneArguments {
  std::optional<std::string> lights, materials, isolated, sky;
  std::vector<std::string> hidden;
  bool noSidecar = false;
  void declare(Options& options);
  void check() const;  ///< checks what it can before a scene is loaded
  /// How to load the scene. A replayed manifest brings its run's lights, materials and hidden nodes; the sidecar, which
  /// may have changed since, does not count.
  LoadOptions load(const Config& config, const Settings& settings) const;
};
/// A sky that was given is shown: sky.source becomes `image` where it is `none`. UsageError where it is `image`, and
/// none was given.
void useSky(Settings& settings, const LoadOptions& options);

/// The path of a scene argument: a file, or the name of a built-in scene ("box"); absent: the config's, else
/// `otherwise`, else a usage error.
std::filesystem::path findScene(const std::optional<std::string>& argument, const Config& config,
                                const std::optional<std::string>& otherwise);
const std::vector<std::string>& builtInScenes();  ///< every .glb of builtInFolders(), by its stem
/// What to say of a scene argument: "A .gltf or .glb file, or a built-in scene (box, …)".
std::string sceneHelp();
/// Where they may lie: beside the executable (an unpacked binary), then in the source tree.
std::vector<std::filesystem::path> builtInFolders();

}  // namespace irad::app
