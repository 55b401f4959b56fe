// manifest.json: everything that made an export, and how to make it again.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gi/settings.h"
#include "renderer/device.h"
#include "renderer/scene/scene.h"

namespace irad {

struct ReferencePicture;

/// Version of settings files and manifests, their member "format": raised when older programs would misread them. Files
/// without one are older than it.
constexpr uint32_t kConfigFormat = 1;

/// Settings as a file that --config takes.
std::string settingsFile(const Settings& settings);

/// "2026-11-25T23:50:00Z", as manifests say their time, and back; none where it is none.
std::string timeText(int64_t seconds);
std::optional<int64_t> timeFromText(const std::string& text);

/// The build that wrote it.
struct Program {
  std::string version, commit;
};

/// What a run did; writes itself as JSON.
struct Manifest {
  Program program;
  std::string subcommand;
  std::optional<int64_t> time;  ///< seconds since 1970, UTC; none: two runs give the same bytes
  const DeviceInfo* device = nullptr;
  const Scene* scene = nullptr;
  const Settings* settings = nullptr;
  bool cpuDevice = false;
  std::optional<glm::uvec2> size;
  std::optional<uint32_t> frames;
  std::vector<Camera> cameras;
  std::vector<std::string> views;
  std::vector<std::string> viewRanges;          ///< of the pictures that have one: rangeJson (gi/picture.h)
  const ReferencePicture* reference = nullptr;  ///< that views compared with
  std::vector<std::string> arguments;           ///< further options of the reproducing command line
  std::vector<std::pair<std::string, std::string>> details;  ///< further members: name, JSON
  std::vector<std::string> shaders;                          ///< that were not the program's own
  std::vector<std::string> files;                            ///< written beside the manifest

  std::string toJson() const;
  /// The command line: every setting that differs from the device's default is spelled out.
  std::string commandLine() const;
};

}  // namespace irad
