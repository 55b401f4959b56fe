// What the window knows. Panels read it, and edit settings, view and camera; whatever takes time is a request that the
// loop (ui/window.cpp) serves between frames.
#pragma once

#include <algorithm>
#include <chrono>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gi/build_cost.h"
#include "gi/compare.h"
#include "gi/picture.h"
#include "gi/pipeline.h"
#include "gi/region.h"
#include "gi/solve_report.h"
#include "gi/watch.h"
#include "renderer/scene/scene.h"
#include "renderer/targets.h"
#include "shaders/shared/view.h"
#include "ui/accuracy.h"
#include "ui/autosave.h"
#include "ui/bindings.h"
#include "ui/captures.h"
#include "ui/fly_camera.h"
#include "ui/histogram.h"
#include "ui/history.h"
#include "ui/inspection.h"
#include "ui/outline.h"
#include "ui/pointing.h"
#include "ui/preferences.h"
#include "ui/presets.h"
#include "ui/recorder.h"
#include "ui/scene_edits.h"
#include "ui/unsaved.h"

namespace irad {

struct Message {
  enum class Kind { Note, Error } kind;
  std::string text;
  std::filesystem::path folder = {};  ///< that it tells of, absolute: to be copied and opened; empty: none
  std::optional<std::chrono::steady_clock::time_point> shown = {};  ///< since then; work may come before the next frame
  /// Errors stay until they are dismissed. (Of a note that the mouse is on the time begins anew.)
  static constexpr std::chrono::seconds kNoteStays{10};
};

/// A rebuild or a load that is running: shown as a bar with its stage, cancelled by a button.
struct Work {
  std::string what;  ///< "Loading box.glb", "Rebuilding"
  std::string stage = {};
  float fraction = 0;
  bool cancel = false;
  bool ofSettings = false;  ///< a rebuild: what it was begun for may be undone
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
};

/// What the pipeline holds, as of the last completed prepare: panels are drawn in the middle of a rebuild too, when its
/// own products come and go.
struct Built {
  glm::uvec3 dims{0};
  uint32_t facets = 0, solidVoxels = 0, clampedAlbedo = 0;
  double edge = 0;     ///< of a voxel
  SceneRegion region;  ///< that has voxels
  SolveReport solve;
  std::vector<Finding> findings;            ///< of the numerical watch, errors first
  std::vector<std::string> noLight;         ///< EffectPlan::noLight
  std::vector<std::string> nothingDiffuse;  ///< EffectPlan::nothingDiffuse
  std::vector<uint32_t> withoutShadow;      ///< Pipeline::lightsWithoutShadow()
  Settings settings;                        ///< that it was made with
  bool faulty() const { return !findings.empty() && findings[0].severity == Finding::Severity::Error; }
  bool lacksShadow(uint32_t light) const { return std::ranges::binary_search(withoutShadow, light); }
};

/// One call of the solver, for the plots.
struct SolveSample {
  uint32_t sweeps;
  float residual, bound;  ///< bound: by brute force the standard error
};

/// What the last edit of a material took.
struct MaterialTimes {
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
  Redo from = Redo::Materials;  ///< first stage that it redid
  double shown = 0;             ///< until there was a picture's worth of light, ms; 0: not yet
  double settled = 0;           ///< until the light was at rest, ms; 0: not yet
};

/// One set of settings, and what the pipeline made of them.
struct Side {
  std::unique_ptr<Pipeline> pipeline;  ///< null: no scene yet
  std::optional<Built> built;          ///< set once the pipeline has something to show
  Settings edited;                     ///< as the widgets show them; the loop hands them to the pipeline
  Settings saved;                      ///< those that can be had again (docs/conventions.md, "What is unsaved")
  Targets targets;
  std::deque<SolveSample> solves;  ///< since the solver last woke
  uint64_t sweepsSinceWake = 0;

  bool asleep() const { return built && pipeline->asleep(); }
  void woke();  ///< the solver begins anew, and so do its plots
};

/// A second side of the same scene, drawn from the same camera.
struct Comparison {
  enum class Show { Split, A, B, Difference } show = Show::Split;
  Side other;            ///< the one that is not edited
  bool editsB = false;   ///< the session's own side is B
  bool sameSeed = true;  ///< both take the edited side's
  float split = 0.5f;    ///< share of the viewport's width that is A's
  Targets difference;    ///< B less A, while that is shown
  struct Result {
    PictureMetrics picture;  ///< of B's linear picture against A's; FLIP where it was asked for
    VoxelMetrics voxels;     ///< of B's H against A's
  };
  /// Whether the side that is not edited shows at this share of the viewport's width.
  bool showsOther(float share) const {
    if (show == Show::Difference) return false;
    const bool a = show == Show::A || (show == Show::Split && share < split);
    return a == editsB;
  }
  std::optional<Result> result;  ///< of the pictures as shown, once both sides are asleep
  bool wantFlip = false;         ///< asked for, until the pictures are others
};

/// The picture on the left, the reference on the right.
struct ReferenceSplit {
  float share = 0.5f;  ///< of the viewport's width that is the picture's
  Targets targets;     ///< of the view reference-picture
};

struct Session : Side {
  explicit Session(Context& c) : context(c) {}

  Context& context;
  Settings defaults;                  ///< of this device class, for the reset buttons
  Redo next = Redo::Nothing;          ///< first stage that a pending edit will redo
  bool pending = false;               ///< it waits for Apply (Preferences::applyByHand)
  std::optional<BuildCost> forecast;  ///< of what is due; none: nothing is, or no such stage has been timed yet
  struct LastBuild {
    std::optional<BuildCost> predicted;  ///< before it was begun
    BuildCost took;
    double compileMs = 0;  ///< of it: for shaders that were needed for the first time
  };
  std::optional<LastBuild> lastBuild;
  bool halted = false;  ///< a rebuild failed or was cancelled: wait for an edit or for Rebuild

  SceneEdits edits;                  ///< lights, materials, hidden objects, bookmarks; the loop sees to the former
  History history;                   ///< of the edits of settings, scene, view and camera (ui/edit_state.h)
  bool returned = false;             ///< an edit was taken back by the loop: what it was for was cancelled, or failed
  std::optional<uint32_t> material;  ///< whose fields are shown: an index of the scene's
  std::optional<uint32_t> object;    ///< that is chosen: an index of the scene's nodes
  Outline outline;                   ///< of it
  std::optional<MaterialTimes> materialEdit;  ///< of the last one

  View view = 0;
  std::shared_ptr<const ReferencePicture> reference;  ///< for the views that compare with one; every pipeline gets it
  std::optional<ReferenceSplit> split;                ///< while there is no comparison
  Accuracy accuracy;
  FlyCamera camera;
  int sceneCamera = 0;             ///< index into cameras(): which `camera` began as
  Camera shown;                    ///< of the picture in targets, and of what is drawn over it
  bool viewDirty = true;           ///< the picture must be rendered again
  uint64_t pictures = 0;           ///< that were drawn
  View rangeView = 0;              ///< the view that `range` belongs to
  bool rangeOfDifference = false;  ///< of B less A
  std::optional<ViewRange> range;  ///< that the picture in targets was drawn with; none until it has come back

  bool underRenderDoc = false;  ///< captureFrame can be served
  bool paused = false, hideUi = false, fillWindow = false, showHelp = false, showGlossary = false, showOpen = false;
  std::optional<Leaving> asking;  ///< Save, Discard or Cancel before this
  std::optional<Autosave> found;  ///< an earlier run's, which is offered
  Preferences preferences;
  float scale = 1;  ///< of text and panels, times the monitor's own: the user's, else the command line's
  Filling filling() const { return hideUi ? Filling::PictureAlone : fillWindow ? Filling::Picture : Filling::Panels; }
  void showPanel(const char* title, const char* column);  ///< unfolded, whatever hid it
  Presets presets;
  std::optional<Work> work;
  std::vector<Message> messages;
  std::optional<std::chrono::steady_clock::time_point> nextMessageEnds() const;  ///< of the notes; none: there is none
  std::vector<Rect> legends;  ///< over the picture, of this frame: messages keep off them

  std::optional<Comparison> comparison;
  Side& sideA() { return comparison && comparison->editsB ? comparison->other : *this; }
  Side& sideB() { return comparison && comparison->editsB ? static_cast<Side&>(*this) : comparison->other; }
  void swapSides();  ///< the other one is edited
  /// Both sides of what there is, the edited one first.
  std::vector<Side*> sides();
  bool showsDifference() const { return comparison && comparison->show == Comparison::Show::Difference; }
  bool allAsleep() const { return asleep() && (!comparison || comparison->other.asleep()); }
  Recorder recorder;
  Captures captures;

  LoadOptions load;                            ///< of scenes; `lights` are the first one's, `sky` is what is shown
  std::vector<std::filesystem::path> builtIn;  ///< folders whose scenes have no sidecar
  bool exposes = false;                        ///< WindowOptions::exposes
  Inspection inspection;
  Pointing pointing;
  ShownHistogram histogram;

  // Requests; those that may lose work come from leave().
  std::optional<std::filesystem::path> openScene, openPicture;
  std::optional<std::filesystem::path> openFolder;  ///< in the desktop's file manager
  bool reloadShaders = false, capture = false, captureAll = false, captureFrame = false, quit = false, rebuild = false;
  std::optional<bool> compare;  ///< begin or end a comparison
  enum class Offer { Take, Discard, Later };
  std::optional<Offer> answer;        ///< to what was found
  bool applyNow = false;              ///< what is pending
  bool findSetting = false;           ///< the panel Settings takes the keys to its search
  bool step = false, darken = false;  ///< of the paused solver: a sweep; of any: from H = 0 again

  // Notes are shown for a while, errors until dismissed; both are printed on standard error.
  void note(std::string text, std::filesystem::path folder = {}) {
    say(Message::Kind::Note, std::move(text), std::move(folder));
  }
  void error(std::string text) { say(Message::Kind::Error, std::move(text)); }
  void act(Action action);  ///< what its key does
  /// After a frame: what has changed in it becomes a step of the history, unless the edit is `held` (History::see).
  void seeEdits(bool held);
  /// Undo and redo: the state of a step of the history. A rebuild that this makes pointless is given up.
  void goToStep(size_t step);
  /// Linear factor that the light shown is displayed with, camera.auto_exposure's included once its picture is there.
  double exposure() const;
  bool isOurs(const std::filesystem::path& scene) const;  ///< built in, or a check's
  /// Before another scene is shown: camera.auto_exposure as suits it, where the user has not chosen.
  void expose(const std::filesystem::path& scene);
  /// After a scene was loaded: edits begin with what it came with, or are `kept`.
  void beginEdits(bool kept);
  std::vector<Camera> cameras() const;  ///< the scene's, then the bookmarks
  void startAt(const Camera& from);     ///< the window's camera
  void useSceneCamera(int index);       ///< of cameras()
  /// Around what is chosen: the object, unless it is all there is, or a light was chosen after it; else the inspected
  /// facet, the light, the surfaces of the material; none where none is.
  struct Sphere {
    glm::dvec3 centre{0};  ///< world
    double radius = 1;     ///< > 0
  };
  std::optional<Sphere> chosenSphere() const;
  Sphere sceneSphere() const;
  /// A scene, a sidecar, or a picture (a sky or a reference), by its extension. It may be asked first. Errors are said
  /// by openFailed(): in the dialog, where it is what opens the file.
  void open(const std::filesystem::path& path, bool fromDialog = false);
  void openFailed(const std::string& text);
  std::string openError;                   ///< for the dialog
  void saveEdits();                        ///< reports what became of it
  void settingsSaved(const Settings& as);  ///< the sides that have these

  void leave(Leaving what);            ///< at once, or after it was asked what becomes of what is unsaved
  void leaveNow(const Leaving& what);  ///< whatever is unsaved
  void stay();                         ///< the answer was Cancel
  bool dialogOpen() const { return showOpen || asking || found || captures.shown; }  ///< one that takes mouse and keys

 private:
  bool openedInDialog_ = false;         ///< what was opened last
  std::optional<uint32_t> objectSeen_;  ///< by the last seeEdits()
  int lightSeen_ = -1;                  ///< likewise
  bool lightLast_ = false;              ///< of light and object the light was chosen last
  void say(Message::Kind kind, std::string text, std::filesystem::path folder = {});
  void closeTopmost();
  void openSidecar(const std::filesystem::path& path);
};

/// A scene's path as it can be opened from any folder.
std::filesystem::path lastingPath(const std::filesystem::path& scene);

/// Its name, or its number where it has none.
std::string cameraName(const Camera& camera, int index);

/// "matrix -> gather -> solve": the stages from `first` on that take time, with the theme's arrow between.
std::string stagesFrom(Redo first, const char* arrow);

}  // namespace irad
