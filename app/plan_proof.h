// `irad plan --prove`: a scene with every effect forced on, and with those that it calls for.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/bench.h"
#include "app/session.h"

namespace irad::app {

/// How far a picture is from the one that the plan makes.
struct PictureDifference {
  uint64_t pixels = 0;  ///< that differ in any bit
  float largest = 0;    ///< of any channel, W/(m^2 sr)
  float mean = 0;       ///< between the pictures' means, as a share of the planned one's
  float allowed = 0;    ///< 0: exact
  bool ofMean = false;  ///< `allowed` bounds `mean`, not `largest`: of single pixels noise differs
  bool holds() const { return allowed > 0 ? (ofMean ? mean : largest) <= allowed : pixels == 0; }
};

/// One effect that is not on, done all the same, all others as planned.
struct EffectProof {
  EffectRow row;                                ///< as planned
  std::optional<PictureDifference> difference;  ///< none where it could not be put on
  std::string reason;                           ///< why not
};

/// Work per second of a window at kTickRate ticks per second.
inline constexpr double kTickRate = 60;
struct Energy {
  double gpuMs = 0, dispatches = 0, draws = 0;
};
inline constexpr std::array kMovings{Moving::Nothing, Moving::Camera, Moving::Lights};

/// What one set of effects takes. Times: medians of GPU milliseconds.
struct EffectsCost {
  double rebuildMs = 0, relightMs = 0, frameMs = 0;
  uint64_t bytes = 0;                  ///< of device memory
  uint64_t dispatches = 0, draws = 0;  ///< of a relight and a picture
  uint64_t instructions = 0;           ///< SPIR-V, specialized, of the pipelines of a relight and a picture
  std::array<std::optional<Energy>, kMovings.size()> energy;  ///< measured; none: the scene has no lights to move
};

struct SceneProof {
  std::string scene;
  std::vector<EffectProof> effects;
  PictureDifference all;  ///< everything forced on
  EffectsCost forced, planned;
  /// WorkError naming what does not hold.
  void require() const;
};

/// Interleaves `frames` relights and pictures of both, then runs as many ticks of idle, camera and lights of each.
SceneProof prove(Session& session, const std::string& name, const Scene& scene, const Camera& camera, glm::uvec2 size,
                 uint32_t frames);

/// "same bits"; "1.2e-05 <= 0.0013" of a threshold; "17 pixels, 3e-06".
std::string describe(const PictureDifference& difference);

/// Three tables: cost, energy, and the effects that are not on.
std::string proofTable(const std::vector<SceneProof>& proofs);
std::string proofMarkdown(const std::vector<SceneProof>& proofs);
/// One row per scene and set of effects, "all forced on" and "as planned", and one per effect that is not on.
std::string proofCsv(const std::vector<SceneProof>& proofs);

}  // namespace irad::app
