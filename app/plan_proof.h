// What a scene's effects take and change: two sets of them measured in turn. `irad plan --measure` and --prove, and the
// suites of the plan, which prove their scenes with it.
#pragma once

#include <array>
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

/// Medians of milliseconds: of a rebuild, a relight, a frame.
using Times = std::array<double, 3>;

/// Milliseconds, by the wall's clock, that each effect of `plan` that is off and can be forced on takes beyond those
/// without it.
std::map<Effect, Times> measureCosts(const Subject& subject, const EffectPlan& plan);

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

/// What is measured with a set of effects, in order: heading in tables, column in the CSV, decimals in each. Times are
/// the GPU's; dispatches, draws and (specialized) SPIR-V instructions are those of a relight and a picture. The figures
/// per second are those of a window at 60 ticks per second; none where the scene has no lights to move.
struct Figure {
  const char *heading, *column;
  int decimals, csvDecimals;
};
inline constexpr Figure kFigures[]{{"rebuild ms", "rebuild_ms", 2, 4},
                                   {"relight ms", "relight_ms", 2, 4},
                                   {"frame ms", "frame_ms", 2, 4},
                                   {"MiB", "mib", 1, 3},
                                   {"dispatches", "dispatches", 0, 0},
                                   {"draws", "draws", 0, 0},
                                   {"instructions", "instructions", 0, 0},
                                   {"idle ms/s", "idle_ms_per_s", 2, 3},
                                   {"idle dispatches/s", "idle_dispatches_per_s", 0, 1},
                                   {"idle draws/s", "idle_draws_per_s", 0, 1},
                                   {"camera ms/s", "camera_ms_per_s", 2, 3},
                                   {"camera dispatches/s", "camera_dispatches_per_s", 0, 1},
                                   {"camera draws/s", "camera_draws_per_s", 0, 1},
                                   {"light ms/s", "light_ms_per_s", 2, 3},
                                   {"light dispatches/s", "light_dispatches_per_s", 0, 1},
                                   {"light draws/s", "light_draws_per_s", 0, 1}};
inline constexpr size_t kCostFigures = 7;  ///< the others are energy
using Figures = std::vector<std::optional<double>>;

/// What is proven of a scene: a set of effects, "all forced on" or "as planned", with what it takes; or one effect that
/// is not on, run all the same, with all others as planned.
struct ProofRow {
  std::string scene, name;
  Figures figures{};                              ///< of a set, in `irad plan`
  std::optional<EffectRow> effect{};              ///< as planned
  std::optional<PictureDifference> difference{};  ///< from the picture as planned
  std::string reason{};                           ///< why there is none: the effect cannot be put on
};
using Proof = std::vector<ProofRow>;
/// WorkError naming what does not hold.
void require(const Proof& proof);

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
