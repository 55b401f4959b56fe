// Measuring: one pipeline's stages, several times over, and the machine's copy bandwidth beside it.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "gi/pipeline.h"
#include "renderer/base/timings.h"
#include "renderer/scene/scene.h"
#include "renderer/targets.h"

namespace irad::app {

/// What changes from one tick of a window to the next: the camera's place, or the lights' places and directions.
enum class Moving { Nothing, Camera, Lights };

/// What some ticks made the device do.
struct TickWork {
  double gpuMs = 0;  ///< that the timers saw
  uint64_t dispatches = 0, draws = 0;
};

/// One settings set under measurement. Each call runs its work once and keeps the samples.
class Bench {
 public:
  Bench(Context& context, Scene scene, const Settings& settings, glm::uvec2 size, View view, const Camera& camera);
  /// Called between steps of whatever is called from now on, prepare() with a progress of its own apart. It may throw.
  void watch(Progress watch) { watch_ = std::move(watch); }
  void prepare(const Progress& progress = {});
  void rebuild();      ///< voxels to matrix anew (Setup), and the relight that follows (Cold)
  void relight();      ///< lights nudged by 2 %: shadows, gather, solve, scatter
  void cameraFrame();  ///< one picture, nothing else dirty
  void settle();       ///< light and pictures agree on what is written back; without a sample
  void forget();       ///< drops the samples so far
  /// Prepares, compiles pipelines and touches pages, all of it without a sample.
  void warmUp(const Progress& progress, uint64_t pictures = 1);
  /// Runs `count` ticks as a window does that begins at rest: moves, prepares what is not asleep, and draws where
  /// anything has changed (`redraws`: in any case). Leaves camera and lights as they were.
  TickWork ticks(Moving moving, uint32_t count, bool redraws);
  /// Pixels of these views, one view after the other, bottom rows last, of the light that a solve from the dark gives.
  /// `whileLit` looks at that light; afterwards it is as it was before.
  std::vector<glm::vec4> pictures(std::span<const View> views, const std::function<void()>& whileLit = {});
  /// The same of the light as it is.
  std::vector<glm::vec4> picturesAsLit(std::span<const View> views);

  /// Per kind and stage; the stage "wall" is all of a call, on the CPU's clock.
  std::vector<StageSamples> samples() const;
  /// A group per call and kind of work.
  const std::deque<FrameSample>& frames() const { return frames_; }
  /// The GPU's milliseconds of a call of this kind, by the median; 0 when not measured.
  double gpuMs(WorkKind kind) const;
  const Pipeline& pipeline() const { return pipeline_; }
  Pipeline& pipeline() { return pipeline_; }
  const Targets& targets() const { return targets_; }  ///< of the last picture
  /// Rays of the build over the median build time; 0 when not measured.
  double megaRaysPerSecond() const;
  /// Bytes that one Jacobi sweep has to move: every matrix entry (csr 4 B, padded 8 B) and the fp32 vec4 of B that it
  /// gathers (16 B); per row its start (csr 4 B), info (8 B), albedo (8 B), D (16 B), M (12 B, where anything emits),
  /// the old B (16 B), H and B written (32 B).
  uint64_t sweepBytes() const;
  /// Time of "GI Solve" over its sweeps, summed over all relights; 0 when not measured. (F M is "GI Solve Emitters".)
  double sweepMilliseconds() const { return sweeps_ > 0 ? solveMs_ / static_cast<double>(sweeps_) : 0; }
  double sweepGigabytesPerSecond() const;

 private:
  void collect(WorkKind kind);
  void draw();
  Context& context_;
  Progress watch_;
  Pipeline pipeline_;
  Targets targets_;
  View view_;
  Camera camera_;
  uint64_t frame_ = 0, relights_ = 0, sweeps_ = 0;
  double solveMs_ = 0;
  std::deque<FrameSample> frames_;
};

/// Rebuilds, relights and pictures, as many of the latter as of relights, of all benches in turn: other load on the
/// machine falls on all alike.
void measureInTurn(std::span<Bench* const> benches, uint64_t rebuilds, uint64_t frames, const Progress& progress);

/// Median GB/s of a device buffer copy, bytes read plus bytes written, by the driver's transfer or by a kernel,
/// whichever is faster: 256 MiB on a CPU device, 2 GiB on a GPU, less where memory is short.
double copyBandwidth(Context& context);

}  // namespace irad::app
