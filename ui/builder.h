// Brings scene, pipeline and light to what the session asks for: loads, rebuilds and relights between the window's
// frames. Blocking, but the window keeps answering: every step calls back.
#pragma once

#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <vector>

#include "ui/session.h"

namespace irad {

class Builder {
 public:
  /// `breathe` is called in the middle of work, often: it may handle events and draw a frame of the old state, and sets
  /// session.work->cancel to give up.
  Builder(Context& context, Session& session, std::function<void()> breathe);

  /// Loads and prepares beside the scene that is shown, and replaces it only when both have succeeded; throws what went
  /// wrong. Of the scene that is shown, read again, it takes lights and cameras alone where the surfaces are the same.
  void load(const std::filesystem::path& path);
  /// Reads another sky, of a picture that is twice as wide as high, or reference picture; where the file is wrong that
  /// is reported, and the old one stays.
  void openPicture(const std::filesystem::path& path);
  /// Hands edits to the pipeline, redoes what they call for, and lets the solver go on until it sleeps. What will be
  /// redone is shown for a frame before it starts, and waits as long as the mouse `holds` the widget.
  void apply(bool held);
  /// Begins a comparison: the session's side, with all that it has, becomes A, and a second pipeline of the same scene
  /// and settings B, which is edited from now on. A failure is reported, and there is no comparison.
  void compare();
  /// Compiles what has changed in the folder, and has everything redone that a changed shader had a part in.
  void reloadShaders(const std::filesystem::path& folder);
  /// H = 0: the solver starts from the dark.
  void darken();
  /// The frame just drawn has announced what comes next.
  void announced() { shownNext_ = session_.next; }
  /// Something is to be redone though no setting changed.
  bool stale() const;

 private:
  bool adopt(const Scene& scene);
  void applyPictures();
  void applyLights();
  Redo applyMaterials(bool held);
  Redo applyHidden(bool held);
  Redo applyRegion(bool held);
  void hide();
  void timeMaterials();
  void giveReference(Pipeline& pipeline);
  void rebuild(Side& side, std::string what);
  void giveUp(Side& side);
  void prepare(Side& side, Pipeline& pipeline);
  void follow();
  void begin(std::string what);
  bool progress(const char* stage, float fraction);
  bool waitsForApply(const Side& side) const;
  void showWhilePending();
  void foresee(Redo first);
  void runs(std::optional<BuildTimes::Part> part);
  void forgetTimes();

  Context& context_;
  Session& session_;
  std::function<void()> breathe_;
  SceneSettings loaded_;                           ///< as the scene that is shown was read
  std::shared_ptr<const ReferencePicture> given_;  ///< to every pipeline
  BuildTimes times_;                               ///< of the scene that is shown
  std::optional<Settings> foreseen_;               ///< what session_.forecast is of
  bool timing_ = false;                            ///< the next prepare() is a rebuild's first: its stages are timed
  using Clock = std::chrono::steady_clock;
  std::optional<BuildWatch> watch_;  ///< of the prepare() that is timed
  bool stale_ = false;               ///< shaders that made the pipeline's products have changed
  Redo shownNext_ = Redo::Nothing;   ///< what the last frame announced
};

}  // namespace irad
