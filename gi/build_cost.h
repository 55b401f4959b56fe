// What a rebuild will take before it is begun: from what each stage took the last time, the memory that is in use, and
// the growth by voxel.resolution (N) and matrix.rays (R) that docs/performance.md measures. What other settings do to
// the time of a stage is not known: it is taken for what it was.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "gi/settings.h"

namespace irad {

class Pipeline;

/// What a rebuild takes, or took: until its light is first shown, and the device memory that is in use then.
struct BuildCost {
  double ms = 0;
  uint64_t bytes = 0;
};
/// "1.9 s, 480 MiB"
std::string costText(const BuildCost& cost);
/// "1.9 s", "420 ms"
std::string durationText(double ms);

/// Times of the stages of one scene's last builds, as they were waited for: work on the processor included.
class BuildTimes {
 public:
  /// Stages whose times are told apart. Materials: what these give the facets of voxels that stay. Gather: D, and F M.
  /// Solve: the first sweeps.
  enum class Part { Voxels, Field, Matrix, Materials, Gather, Solve, Scatter };
  static constexpr size_t kParts = 7;
  /// The part that a stage's name in Progress belongs to: Solve where it is no other's.
  static Part partOf(const char* stage);

  /// By how much its time grows from one settings' voxels and rays to other ones'.
  static double growth(Part part, const Settings& from, const Settings& to);

  void took(Part part, double ms, const Settings& settings);
  /// Of all that is redone from `first` on; none where one of these stages has not been seen yet, or nothing is redone.
  std::optional<double> predict(const Settings& wanted, Redo first) const;

 private:
  struct Seen {
    double ms;
    double resolution, rays;
  };
  std::array<std::optional<Seen>, kParts> seen_;
};

/// What the parts of a build take, as it goes on. Its user reads two clocks: one that always runs, and one of the time
/// in which passes waited for pipelines to be compiled (renderer/frame/pipeline_wait.h), which is left out: another
/// build finds them.
class BuildWatch {
 public:
  /// From now on this part, and no longer the one before; none: it has ended.
  void runs(std::optional<BuildTimes::Part> part, double ms, double pipelineWaitMs);
  /// To `times`, of every part that has run.
  void tell(BuildTimes& times, const Settings& settings) const;

 private:
  double since_ = 0;                      ///< by the first clock less the second
  std::optional<BuildTimes::Part> part_;  ///< that runs since then
  std::array<std::optional<double>, BuildTimes::kParts> ms_{};
};

/// Bytes in use once `wanted` has been built from `first` on, of which `used` are in use now that the pipeline holds
/// what it was built with: with the formulas of `irad memory` for facets by N^2, voxels by N^3 and entries by N^2 and
/// R^0.93. Scratch memory of the build itself, which is freed again, is not in it.
uint64_t predictedBytes(const Pipeline& pipeline, uint64_t used, const Settings& wanted, Redo first);

}  // namespace irad
