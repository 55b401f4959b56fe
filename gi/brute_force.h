// Indirect light without a matrix (docs/method.md 9, T 5.13): in every frame each facet traces the rays of a matrix row
// anew, and H is the mean of what the frames' rays bring.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "shaders/shared/gi_params.h"

namespace irad {

class Buffer;
class Context;
struct FacetList;
struct Field;
struct FrameMean;
struct Lighting;
struct Settings;
struct SkyOnDevice;
struct SolveReport;

/// The ray set of frame `frame`. Frame 0 has the matrix's; the others have sets of the same kind that depend on each
/// other in nothing, and are shifted by voxel whatever matrix.jitter says.
MatrixParams raysOfFrame(const MatrixParams& params, uint32_t frame);

/// The weight of a frame in the mean, and what follows from the weights of all so far.
class FrameWeights {
 public:
  /// Takes in frame number frames(), with the weight (frames() + 1)^2, so that the first frames, in which light has not
  /// yet come around, are forgotten: their part falls as frames^-3.
  void add();
  uint32_t frames() const { return frames_; }
  float share() const { return static_cast<float>(last_ / sum_); }  ///< of the mean, that the last frame has
  /// The squared standard error of the mean over the frames' variance about it: q / (1 - q), q = sum w^2 / (sum w)^2. 0
  /// for less than two frames, which have none.
  float errorOfVariance() const;

 private:
  uint32_t frames_ = 0;
  double last_ = 0, sum_ = 0, squares_ = 0;
};

/// All that the next frame depends on, and what pictures show, to go on with in another run.
struct SavedFrames {
  uint32_t frames = 0;
  double meanH = 0;
  float standardError = 0, largestH = 0;                             ///< SolveReport's
  std::vector<glm::vec4> next, radiosity, indirect, error, emitted;  ///< per facet; `emitted` may be empty
};
SavedFrames saveFrames(Context& context, const Lighting& light);
/// Into the light of the same settings and facets, which has a frame or more; lambda is 1 at most, so that the guard
/// knows nothing that is not here. To the bit what it was.
void restoreFrames(Context& context, Lighting& light, const SavedFrames& saved);

/// Traces `frames` more frames, until the mean standard error of H is below solver.tolerance of the mean H, or there
/// are solver.frames. `restarts`: the sources have changed; then, and where lambda or omega has, the mean begins anew,
/// from the dark, so that the light depends on nothing but settings, scene and the number of frames. `progress` (0..1
/// of solver.frames) may be empty; where it returns false it ends after a frame in a WorkError. Blocking.
SolveReport bruteForce(Context& context, const FacetList& facets, const Field& field, const SkyOnDevice& sky,
                       Lighting& light, const Settings& settings, uint32_t frames, bool restarts,
                       const std::function<bool(float)>& progress = {});

}  // namespace irad
