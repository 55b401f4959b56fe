// What the window knows. Panels read it, and edit settings, view and camera; whatever takes time is a request that the
// loop (ui/window.cpp) serves between frames.
#pragma once

#include <chrono>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gi/pipeline.h"
#include "renderer/frame.h"
#include "ui/bindings.h"
#include "ui/fly_camera.h"
#include "ui/preferences.h"

namespace irad {

struct Message {
  enum class Kind { Note, Error } kind;
  std::string text;
};

/// A rebuild or a load that is running: shown as a bar with its stage, cancelled by a button.
struct Work {
  std::string what;  ///< "Loading box.glb", "Rebuilding"
  std::string stage = {};
  float fraction = 0;
  bool cancel = false;
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
};

/// What the pipeline holds, as of the last completed prepare: panels are drawn in the middle of a rebuild too, when its
/// own products come and go.
struct Built {
  glm::uvec3 dims{0};
  uint32_t facets = 0, solidVoxels = 0, clampedAlbedo = 0;
  double edge = 0;  ///< of a voxel
  SolveReport solve;
  std::vector<Finding> findings;  ///< of the numerical watch, errors first
  float tolerance = 0;            ///< share of the largest H at which it sleeps
  bool faulty() const { return !findings.empty() && findings[0].severity == Finding::Severity::Error; }
};

/// One call of the solver, for the plots.
struct SolveSample {
  uint32_t sweeps;
  float residual, bound;
};

struct Session {
  explicit Session(Context& c) : context(c) {}

  Context& context;
  std::unique_ptr<Pipeline> pipeline;  ///< null: no scene yet
  std::optional<Built> built;          ///< set once the pipeline has something to show

  Settings edited;            ///< as the widgets show them; the loop hands them to the pipeline
  Settings defaults;          ///< of this device class, for the reset buttons
  Redo next = Redo::Nothing;  ///< first stage that a pending edit will redo
  bool halted = false;        ///< a rebuild failed or was cancelled: wait for an edit or for Rebuild

  View view = 0;
  FlyCamera camera;
  int sceneCamera = 0;  ///< index of the scene's camera that `camera` began as
  Targets targets;
  Camera shown;           ///< of the picture in targets
  bool viewDirty = true;  ///< the picture must be rendered again

  bool paused = false, hideUi = false, showHelp = false, showOpen = false;
  Preferences preferences;
  std::optional<Work> work;
  std::vector<Message> messages;

  std::deque<SolveSample> solves;  ///< since the solver last woke
  uint64_t sweepsSinceWake = 0;

  // Requests.
  std::vector<Action> actions;  ///< as if their keys had been pressed
  std::optional<std::filesystem::path> openScene;
  bool reloadShaders = false, capture = false, quit = false, rebuild = false;

  // Shown until dismissed, and printed on standard error.
  void note(std::string text) { say(Message::Kind::Note, std::move(text)); }
  void error(std::string text) { say(Message::Kind::Error, std::move(text)); }
  void useSceneCamera(int index);
  void woke();  ///< the solver begins anew: its plots too
  bool asleep() const { return built && pipeline->asleep(); }

 private:
  void say(Message::Kind kind, std::string text);
};

/// "matrix -> gather -> solve": the stages from `first` on that take time, with the theme's arrow between.
std::string stagesFrom(Redo first, const char* arrow);

}  // namespace irad
