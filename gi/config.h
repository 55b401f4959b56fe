// What --config takes: a file of settings, or the manifest.json of an export (gi/manifest.h) to replay.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace irad {

constexpr uint32_t kMaxPictureSide = 16384;  ///< pixels
constexpr uint32_t kMaxFrames = 1'000'000;

/// What --config brings: a settings object, or a manifest that also names scene, lights, cameras, size, views, frames.
struct Config {
  std::filesystem::path path;
  std::optional<std::string> settings;       ///< JSON as settingsFromJson takes it
  std::optional<std::string> otherSettings;  ///< likewise: of B, where a comparison was recorded
  std::optional<int64_t> time;               ///< when it was made: seconds since 1970, UTC
  std::string program, device, driver;       ///< that made it, in words; empty: it does not say
  bool manifest = false;                     ///< of a run, which it replays
  std::optional<std::filesystem::path> scene;
  std::optional<std::string> sceneSha256;
  std::optional<std::vector<Light>> lights;
  std::vector<MaterialEdit> materials;
  HiddenNodes hidden;
  std::optional<glm::uvec2> size;
  std::optional<uint32_t> frames;
  std::vector<Camera> cameras;
  std::vector<std::string> views;
  std::optional<std::filesystem::path> reference;  ///< picture to compare with
  std::optional<std::string> referenceSha256;
  std::optional<std::filesystem::path> sky;  ///< picture of it
  std::optional<std::string> skySha256;
  std::vector<std::string> shaders;  ///< that were not the program's own
};
/// InputError when the file cannot be read, is not what it should be, or is of a newer format.
Config readConfigFile(const std::filesystem::path& path);

}  // namespace irad
