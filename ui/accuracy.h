// What the window knows of its own error: the picture against the reference, a reference that is made meanwhile, a
// study of what accuracy costs. The panel reads it and writes requests; the loop serves them between frames. Nothing is
// read back, measured, traced or loaded while the panel is not drawn.
#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gi/study/loaded.h"
#include "gi/views/views.h"
#include "renderer/metrics.h"
#include "renderer/targets.h"
#include "ui/background_reference.h"

namespace irad {

class Context;
struct Session;

class Accuracy {
 public:
  Accuracy();
  ~Accuracy();

  bool open = false;  ///< the panel was drawn in the last frame

  // ---- The picture against session.reference ----
  std::optional<PictureMetrics> measured;
  bool fresh = false;       ///< of the picture and the reference as they are; else another is on its way
  std::string unmeasured;   ///< why there are no figures
  bool ofComputed() const;  ///< the reference was made here
  const TracedReference* traced() const { return traced_.get(); }  ///< with its noise; null: none was made here

  // ---- The reference that is made here ----
  uint32_t samples = 256;  ///< per pixel, that are wanted
  bool indirect = true;    ///< of indirect light alone; of all light it takes scene.lambertian
  std::string outdated;    ///< why it is not of what is shown any more; empty: it is
  BackgroundReference::State tracing() const { return tracer_.state(); }
  bool tracingNow() const { return open && tracer_.atWork(); }

  std::string saveAs;  ///< file that a reference made here is saved to
  bool saving() const { return saving_.valid(); }

  // ---- A study ----
  std::string folder = "out/study";
  std::optional<LoadedStudy> study;
  uint64_t studies = 0;  ///< that were read
  std::string studyError;
  bool loading() const { return loading_.valid(); }
  /// What of the study does not hold for what is shown; in order where there is none.
  Misfit studyMisfit(const Session& session) const;

  // ---- Requests ----
  bool wantReference = false, cancelReference = false, wantFlip = false, wantStudy = false, wantSave = false;
  std::optional<View> referenceOf;  ///< what the reference is a picture of

  /// Does what is wanted. True where something that the panel shows has changed.
  bool serve(Session& session);
  /// Something is on its way that the next frames bring.
  bool measuring() const { return open && (awaiting_ || measuring_.valid() || loading_.valid() || saving_.valid()); }

 private:
  /// What the reference that is made here belongs to.
  struct Subject {
    std::filesystem::path scene;
    std::string sha256;
    SceneSettings settings;
    std::vector<Light> lights;
    std::vector<MaterialEdit> materials;
    HiddenNodes hidden;
    Sky sky;
    Camera camera;
    std::string changedIn(const Session& session) const;  ///< in words; empty: nothing
  };
  static Subject subjectOf(const Session& session);
  void startReference(Session& session);
  bool serveReference(Session& session);
  bool serveSave(Session& session);
  bool serveStudy();
  bool serveMeasurement(Session& session);
  std::string whyUnmeasured(const Session& session) const;
  void readPicture(Session& session);

  BackgroundReference tracer_;
  std::optional<Subject> subject_;
  bool indirect_ = true;  ///< of the reference at work
  std::shared_ptr<const TracedReference> traced_;
  Camera tracedFrom_;
  std::future<std::filesystem::path> saving_;

  // A measurement: the picture comes back with a frame, a thread compares it.
  struct Stamp {
    uint64_t picture = 0, reference = 0;
    bool flip = false;
    bool operator==(const Stamp&) const = default;
  };
  uint64_t references_ = 0;  ///< raised with every other one
  bool flip_ = false;        ///< asked for, until the picture is another
  std::optional<Stamp> asked_, done_;
  double askedAt_ = -1;
  bool awaiting_ = false;
  std::shared_ptr<std::vector<glm::vec4>> pixels_;  ///< as they came back
  std::future<PictureMetrics> measuring_;
  Targets targets_;  ///< where the window's own do not fit
  Buffer readback_;
  std::future<LoadedStudy> loading_;
  bool wasOpen_ = false;
};

}  // namespace irad
