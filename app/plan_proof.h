// What a scene's effects take and change: two sets of them measured in turn. `irad plan --measure` and --prove, and the
// suites of the plan, which prove their scenes with it.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/bench.h"
#include "app/device_session.h"
#include "gi/plan.h"

namespace irad::app {

/// What is measured.
struct Subject {
  DeviceSession& session;
  std::string name;
  Scene scene;
  Camera camera;
  glm::uvec2 size;
  uint32_t frames;  ///< relights, pictures and ticks of each set
};

/// How far a picture is from the one that the plan makes.
struct PictureDifference {
  uint64_t pixels = 0;  ///< that differ in any bit
  float largest = 0;    ///< of any channel, W/(m^2 sr)
  float mean = 0;       ///< between the pictures' means, as a share of the planned one's
  float allowed = 0;    ///< 0: exact
  bool ofMean = false;  ///< `allowed` bounds `mean`, not `largest`: single pixels differ by noise
  float judged() const { return ofMean ? mean : largest; }
  bool holds() const { return allowed > 0 ? judged() <= allowed : pixels == 0; }
  /// "same bits"; "1.2e-05 <= 0.0013" of a threshold; "17 pixels, 3e-06".
  std::string text() const;
};

/// What is measured, by the names of columns: "rebuild_ms", "relight_ms" and "frame_ms", medians of the GPU's; "mib";
/// "dispatches", "draws" and "instructions" (specialized SPIR-V) of a relight and a picture; and of a window at 60
/// ticks per second "idle_ms_per_s", "idle_dispatches_per_s", "idle_draws_per_s", and likewise with a "camera" and with
/// a "light" that moves, where there are lights.
using Figures = std::map<std::string, double>;

/// A set of effects, "all forced on" or "as planned", with what it takes; or one effect: what it takes while it is off,
/// or the proof that it may be: it runs all the same, with all others as planned.
struct ProofRow {
  std::string scene, name;
  Figures figures{};                              ///< of a set: all; of an effect: times that it would take
  std::optional<EffectRow> effect{};              ///< as planned
  std::optional<PictureDifference> difference{};  ///< from the picture as planned
  std::string reason{};                           ///< why there is none: the effect cannot be put on
};
using Proof = std::vector<ProofRow>;
/// WorkError naming what does not hold.
void require(const Proof& proof);

/// A row for each effect of the plan of `planned`. `measure`: with the milliseconds that each one which is off and can
/// be forced on takes beyond those without it.
Proof rowsOf(const Subject& subject, Bench& planned, bool measure);

/// Bytes of device memory, without the staging that the context keeps for every frame, whatever it draws.
uint64_t heldBytes(Context& context);

/// With every effect on; but the light sleeps where it is at rest.
Settings allForcedOn(const Settings& settings);
/// Both show all `views` alike, each solved from the dark: `forced` has the settings allForcedOn(). What a threshold
/// allows is allowed to the first view, which is radiance, and thresholds are judged by that one alone.
ProofRow proveAll(const std::string& scene, Bench& planned, Bench& forced, std::span<const View> views);
/// A row for each effect that is not on.
Proof proveEach(const std::string& scene, Bench& planned, std::span<const View> views);

/// Both of the picture, after the figures: relights and pictures of both sets in turn, then ticks of idle, camera and
/// lights of each.
Proof prove(const Subject& subject);

}  // namespace irad::app
