// What the truths of `irad reference` have in common: what was asked for, when a run ends, what it writes.
#pragma once

#include <chrono>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/arguments.h"
#include "gi/manifest.h"
#include "gi/views/views.h"
#include "renderer/base/image_io.h"
#include "renderer/base/output_file.h"

namespace irad {
struct Targets;
class Pipeline;
}  // namespace irad

namespace irad::app {
struct DeviceSession;
}

namespace irad::app::reference {

using Json = nlohmann::ordered_json;

/// A killed run loses no more than this.
constexpr double kSecondsBetweenStates = 60;

struct Arguments {
  std::optional<std::string> scene, out, of, spp, seconds, noise, bounces;
  std::vector<std::string> layers;
  bool resume = false, centred = false, facets = false, glossy = false, glossySeen = false;
  SceneArguments sceneOptions;
  SettingArguments settings;
  DeviceArguments device;
  PictureArguments picture;
};

/// What was asked for, checked as far as it can be before anything is loaded.
struct Task {
  std::string of;
  std::filesystem::path stem;  ///< of the results: no extension
  std::vector<std::string> layers;
  std::optional<uint64_t> spp;
  std::optional<double> seconds, noise;
  uint32_t bounces = 0;  ///< layers bounce.0 to bounce.(this - 1)
  Config config;
  glm::uvec2 size{0};
  std::filesystem::path beside(const char* extension) const { return stem.string() + extension; }
};
Task taskOf(const Arguments& arguments);

/// How much of the work is done by what a run may end at, and how long the rest takes.
class Goal {
 public:
  /// `before`: what earlier runs have done of `most`.
  Goal(const Task& task, uint64_t most, uint64_t before) : task_(task), most_(most), before_(before) {}
  double elapsed() const;
  /// `noise` falls with the root of what is done; infinite: not known yet.
  float fraction(uint64_t done, double noise) const;
  bool reached(uint64_t done, double noise) const;
  /// Empty: nothing says yet.
  std::string left(uint64_t done, double noise) const;

 private:
  const Task& task_;
  uint64_t most_, before_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The first layer has no name; `error`, its standard error, NAME.error.
void addLayer(std::vector<PictureLayer>& layers, const std::string& name, std::vector<glm::vec4> value,
              std::optional<std::vector<glm::vec4>> error);
std::string bounceName(size_t reflections);  ///< of the layer

/// The lines of output that say what share of the mean `lit` each bounce has, and the same for the manifest. `errors`:
/// standard errors, or empty.
Json tellBounces(const glm::dvec3& lit, const std::vector<glm::dvec3>& bounces, const std::vector<glm::dvec3>& errors);

/// Checks that the results can be written, and takes the last run's manifest away, which vouches for its files.
/// The folder goes with what is returned, where nothing was written into it.
std::unique_ptr<MadeFolder> beginFiles(const Task& task);
void finishFiles(const Task& task, const Arguments& arguments, Manifest manifest, const Camera& camera,
                 const Json& truth, std::vector<std::filesystem::path> written);

Camera cameraOf(const Arguments& arguments, const Task& task, const Scene& scene);

/// What the picture's header says.
PictureSubject subjectOf(const Task& task, const Camera& camera);

/// Compares what a state was made of with what is asked for; UsageError names the member that differs.
void checkMade(const std::filesystem::path& state, const Json& before, const Json& made);

// Of those that draw with the pipeline:
std::vector<glm::vec4> drawn(DeviceSession& session, Pipeline& pipeline, const Camera& camera, View view,
                             Targets& targets);
View viewOf(const std::string& layer);
template <class T>
std::filesystem::path writePerFacet(const std::filesystem::path& path, const std::vector<glm::vec<3, T>>& values) {
  std::vector<T> flat;
  for (const auto& v : values) flat.insert(flat.end(), {v.x, v.y, v.z});
  writeNpy<T>(path, {values.size(), 3}, flat);
  return path;
}

// One for each --of, in the file of its name.
void traceTriangles(const Arguments& arguments, const Task& task);
void traceVoxels(const Arguments& arguments, const Task& task, DeviceSession& session, Scene scene,
                 const Camera& camera);
void solveMatrix(const Arguments& arguments, const Task& task, DeviceSession& session, Scene scene,
                 const Camera& camera);

}  // namespace irad::app::reference
