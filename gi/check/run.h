// What a hard case works with: scenes taken through the pipeline, the light on their facets, and figures with marks.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "gi/host_facets.h"
#include "gi/host_matrix.h"
#include "gi/pipeline.h"
#include "renderer/frame/context.h"
#include "renderer/scene/scene.h"

namespace irad {

struct CheckFigure {
  std::string name;
  double value = 0;
  std::string mark;   ///< "1 +- 0.001", ">= 0.99"; empty: printed, not judged
  double strain = 0;  ///< 0: as expected, 1: at the mark, above or NaN: failed
  bool passed() const { return mark.empty() || strain <= 1; }
};

struct CheckOptions {
  bool quick = false;  ///< soak cases take a fraction of their frames, truths of their samples
  /// The program, for cases that need another process; empty: they say that they could not.
  std::string program;
  std::vector<std::filesystem::path> scenes;  ///< those shipped with the program
  uint32_t seeds = 0;                         ///< members of a family, seeds 1 to this; 0: 3, with `quick` 1
};

/// One RGBA fp32 picture (Targets::linear), top row first.
struct CheckPicture {
  glm::uvec2 size{0};
  std::vector<glm::vec4> pixels;
};

class CheckRun {
 public:
  CheckRun(Context& context, const Settings& settings, const CheckOptions& options)
      : context(context), settings(settings), options(options) {}

  Context& context;
  const Settings settings;
  const CheckOptions options;
  std::vector<CheckFigure> figures;

  /// Sizes at which thousands of frames or dozens of rebuilds take seconds on a CPU device.
  Settings small() const;
  /// Samples of a pixel of a truth: an eighth with `quick`, when marks are still nine times the noise of a mean.
  uint32_t samples(uint32_t whole) const { return options.quick ? whole / 8 : whole; }
  /// To open this run's device once more.
  DeviceOptions sameDevice() const;

  // ---- Figures ----
  /// |value - expected| <= tolerance.
  void near(std::string name, double value, double expected, double tolerance);
  void atMost(std::string name, double value, double limit);
  /// `ideal`: the value, above the limit, at which the strain is 0.
  void atLeast(std::string name, double value, double limit, double ideal = 1);
  /// Expects `differing` to be 0.
  void none(std::string name, uint64_t differing);
  void require(std::string name, bool holds) { near(std::move(name), holds ? 1 : 0, 1, 0); }
  /// Printed with the others, not judged.
  void info(std::string name, double value);

  // ---- The pipeline ----
  /// A scene with its matrix and its light at rest.
  std::unique_ptr<Pipeline> prepare(Scene scene, const Settings& settings) const;
  std::unique_ptr<Pipeline> prepare(Scene scene) const { return prepare(std::move(scene), settings); }
  HostFacets facets(const Pipeline& pipeline) const { return hostFacets(context, pipeline.facets()); }
  std::vector<glm::vec3> read(const Pipeline& pipeline, const Buffer& perFacet) const;
  // Replace what the facets hold; the next prepare() solves again, from the last light.
  void setAlbedo(Pipeline& pipeline, const std::vector<glm::vec3>& albedo) const;
  void setDirect(Pipeline& pipeline, const std::vector<glm::vec3>& direct) const;
  CheckPicture picture(Pipeline& pipeline, const Camera& camera, View view, glm::uvec2 size) const;
};

/// A device of its own beside the run's.
struct Apart {
  explicit Apart(const DeviceOptions& options) : device(Device::create(options)), context(*device, shaders, timings) {}
  std::unique_ptr<Device> device;
  ShaderLibrary shaders;
  Timings timings;
  Context context;
};

/// Counts components that are NaN or infinite.
uint64_t countNonFinite(const std::vector<glm::vec3>& values);
uint64_t countNonFinite(const CheckPicture& picture);
/// Pixels whose bits differ.
uint64_t countDiffering(const CheckPicture& a, const CheckPicture& b);

struct Spread {
  double mean = 0, least = 0, most = 0, deviation = 0, percentile1 = 0;
};
/// Of the red channel; nothing where there are no values.
Spread spread(const std::vector<glm::vec3>& values);

}  // namespace irad
