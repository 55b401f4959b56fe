// manifest.json: everything that made an export, and how to make it again.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gi/settings.h"
#include "renderer/device.h"
#include "renderer/scene/scene.h"

namespace irad::app {

constexpr uint32_t kMaxPictureSide = 16384;  ///< pixels
constexpr uint32_t kMaxFrames = 1'000'000;

/// Version of settings files and manifests, their member "format": raised when older programs would misread them. Files
/// without one are older than it.
constexpr uint32_t kConfigFormat = 1;

/// What --config brings: a settings object, or a manifest that also names scene, cameras, size, views, frames.
struct Config {
  std::filesystem::path path;
  std::optional<std::string> settings;  ///< JSON as settingsFromJson takes it
  std::optional<std::filesystem::path> scene;
  std::optional<std::string> sceneSha256;
  std::optional<glm::uvec2> size;
  std::optional<uint32_t> frames;
  std::vector<Camera> cameras;
  std::vector<std::string> views;
};
/// InputError when the file cannot be read, is not what it should be, or is of a newer format.
Config readConfigFile(const std::filesystem::path& path);

/// Settings as a file that --config takes.
std::string settingsFile(const Settings& settings);

/// What a run did; writes itself as JSON.
struct Manifest {
  std::string subcommand;
  const DeviceInfo* device = nullptr;
  const Scene* scene = nullptr;
  const Settings* settings = nullptr;
  bool cpuDevice = false;
  std::optional<glm::uvec2> size;
  std::optional<uint32_t> frames;
  std::vector<Camera> cameras;
  std::vector<std::string> views;
  std::vector<std::string> arguments;                        ///< further options of the reproducing command line
  std::vector<std::pair<std::string, std::string>> details;  ///< further members: name, JSON
  std::vector<std::string> files;                            ///< written beside the manifest

  std::string toJson() const;
  /// The command line: every setting that differs from the device's default is spelled out.
  std::string commandLine() const;
};

/// Quoted for a POSIX shell where needed.
std::string shellQuote(const std::string& word);

}  // namespace irad::app
