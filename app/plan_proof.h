// `irad plan --prove`: a scene with every effect forced on, and with those that it calls for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session.h"

namespace irad::app {

/// How far a picture is from the one that the plan makes.
struct PictureDifference {
  uint64_t pixels = 0;  ///< that differ in any bit
  float largest = 0;    ///< of any channel, W/(m^2 sr)
  float allowed = 0;    ///< 0: exact
  bool holds() const { return allowed > 0 ? largest <= allowed : pixels == 0; }
};

/// One effect forced on though the scene does not call for it, all others as planned.
struct EffectProof {
  Effect effect;
  Skip skip;
  PictureDifference difference;
};

/// What one set of effects takes. Times: medians of GPU milliseconds.
struct EffectsCost {
  double rebuildMs = 0, relightMs = 0, frameMs = 0;
  uint64_t bytes = 0;                      ///< of device memory
  uint64_t dispatches = 0, draws = 0;      ///< of a relight and a picture
  uint64_t instructions = 0;               ///< SPIR-V, specialized, of the pipelines of a relight and a picture
  double idle = 0, camera = 0, light = 0;  ///< GPU-busy ms per second at 60 pictures per second
};

struct SceneProof {
  std::string scene;
  std::vector<EffectProof> effects;
  PictureDifference all;  ///< everything forced on
  EffectsCost forced, planned;
  /// WorkError naming what does not hold.
  void require() const;
};

/// Interleaves `frames` relights and pictures of both.
SceneProof prove(Session& session, const std::string& name, const Scene& scene, const Camera& camera, glm::uvec2 size,
                 uint32_t frames);

std::string proofTable(const std::vector<SceneProof>& proofs);
std::string proofCsv(const std::vector<SceneProof>& proofs);
std::string proofMarkdown(const std::vector<SceneProof>& proofs);

}  // namespace irad::app
