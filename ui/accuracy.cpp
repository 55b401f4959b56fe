#include "ui/accuracy.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <utility>

#include "gi/check/check.h"
#include "gi/pipeline.h"
#include "renderer/base/error.h"
#include "renderer/frame/frame.h"
#include "renderer/scene/camera_json.h"
#include "ui/imgui_layer.h"
#include "ui/session.h"

namespace irad {
namespace {

constexpr double kSecondsBetween = 1;  ///< measurements while the light still converges

double nowSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class T>
bool ready(const std::future<T>& future) {
  return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

Accuracy::Accuracy() : saveAs(std::string("out/reference") + linearExtension()) {}
Accuracy::~Accuracy() = default;

bool Accuracy::ofComputed() const {
  return traced_ != nullptr;
}

// ---- The reference that is made here ----

Accuracy::Subject Accuracy::subjectOf(const Session& session) {
  const Pipeline& pipeline = *session.pipeline;
  const Scene& scene = pipeline.scene();
  return {scene.path,   scene.sha256,   pipeline.settings().scene, scene.lights, scene.materialEdits,
          scene.hidden, pipeline.sky(), session.camera.camera()};
}

std::string Accuracy::Subject::changedIn(const Session& session) const {
  const Subject now = subjectOf(session);
  if (now.scene != scene || now.sha256 != sha256 || now.settings != settings) return "the scene is another";
  if (now.lights != lights) return "the lights have changed";
  if (now.materials != materials) return "a material has changed";
  if (now.hidden != hidden) return "other objects are hidden";
  if (now.sky != sky) return "the sky has changed";
  if (now.camera != camera) return "the camera has moved";
  return "";
}

void Accuracy::startReference(Session& session) {
  if (!hasPathTracer() || !session.built || session.targets.size.x == 0) return;
  indirect_ = indirect || !session.pipeline->settings().scene.lambertian;
  subject_ = subjectOf(session);
  outdated.clear();
  // Read again rather than copied, which would hold up the window where there are many textures.
  LoadOptions load = session.load;
  load.lambertian = subject_->settings.lambertian;
  load.doubleSided = subject_->settings.doubleSided;
  load.lights.reset();
  load.materials = subject_->materials;
  load.hidden = subject_->hidden;
  load.progress = {};
  tracer_.start({.scene =
                     [load, subject = *subject_] {
                       Scene scene = openScene(subject.scene, load);
                       if (scene.sha256 != subject.sha256)
                         throw InputError(fmt::format("{}: the file has changed since it was opened: load it again",
                                                      subject.scene.string()));
                       scene.lights = subject.lights;
                       return scene;
                     },
                 .sky = subject_->sky,
                 .camera = subject_->camera,
                 .size = session.targets.size,
                 .indirect = indirect_,
                 .samples = samples});
}

bool Accuracy::serveReference(Session& session) {
  bool changed = false;
  if (std::exchange(cancelReference, false)) {
    tracer_.cancel();
    changed = true;
  }
  if (std::exchange(wantReference, false)) {
    startReference(session);
    changed = true;
  }
  if (const std::optional<View> of = std::exchange(referenceOf, std::nullopt); of && session.reference) {
    auto other = std::make_shared<ReferencePicture>(*session.reference);
    other->of = *of;
    session.reference = std::move(other);
    ++references_;
    session.viewDirty = changed = true;
  }
  // Another picture was given in its place: what is still at work would replace that.
  if (traced_ && (!session.reference || !session.reference->path.empty())) {
    tracer_.cancel();
    subject_.reset();
    outdated.clear();
    traced_.reset();
    ++references_;
    changed = true;
  }
  if (subject_ && session.built) {
    std::string why = subject_->changedIn(session);
    changed = changed || why != outdated;
    outdated = std::move(why);
    if (!outdated.empty()) tracer_.cancel();
  }
  if (std::shared_ptr<const TracedReference> better = tracer_.take()) {
    traced_ = std::move(better);
    tracedFrom_ = subject_->camera;
    session.reference = std::make_shared<const ReferencePicture>(
        ReferencePicture{.path = {},
                         .sha256 = {},
                         .picture = {.size = traced_->size, .pixels = traced_->mean},
                         .of = indirect_ ? View{VIEW_INDIRECT} : View{VIEW_LIT}});
    ++references_;
    const ViewInfo* info = viewInfo(session.view);
    if (session.split || (info != nullptr && info->isFrom(FROM_PICTURE))) session.viewDirty = true;
    changed = true;
  }
  return changed;
}

/// On a thread of its own: compressing a large picture would hold the window up.
bool Accuracy::serveSave(Session& session) {
  if (std::exchange(wantSave, false) && traced_ && !saving_.valid()) {
    const PictureSubject subject{cameraToJson(tracedFrom_), viewInfo(session.reference->of)->name};
    saving_ = std::async(std::launch::async, [to = std::filesystem::path(saveAs), traced = traced_, subject] {
      return saveReference(to, *traced, subject);
    });
    return true;
  }
  if (!ready(saving_)) return false;
  try {
    session.note(fmt::format("wrote {}: --reference takes it", saving_.get().string()));
  } catch (const std::exception& error) {
    session.error(error.what());
  }
  return true;
}

// ---- The study ----

Misfit Accuracy::studyMisfit(const Session& session) const {
  if (!study || !session.pipeline) return {};
  return misfit(*study, session.pipeline->scene().sha256, session.camera.camera(), session.targets.size);
}

bool Accuracy::serveStudy() {
  std::error_code ignored;
  if (!wasOpen_ && !study && studyError.empty() && std::filesystem::exists(folder + "/study.json", ignored))
    wantStudy = true;
  if (std::exchange(wantStudy, false) && !loading_.valid()) {
    loading_ = std::async(std::launch::async, [from = folder] { return loadStudy(from); });
    return true;
  }
  if (!ready(loading_)) return false;
  try {
    studyError.clear();
    LoadedStudy loaded = loading_.get();
    // Front and attribution are studies of their own: one of each can be there.
    if (study && study->sceneSha256 == loaded.sceneSha256) {
      if (loaded.points.empty())
        loaded.points = std::move(study->points), loaded.settings = std::move(study->settings);
      else if (loaded.stages.empty())
        loaded.stages = std::move(study->stages);
    }
    study = std::move(loaded);
    ++studies;
  } catch (const std::exception& error) {
    study.reset();
    studyError = error.what();
  }
  return true;
}

// ---- The measurement ----

std::string Accuracy::whyUnmeasured(const Session& session) const {
  if (!session.reference) return "No reference";
  if (!session.built || session.halted) return "Nothing is built";
  if (traced_ && !outdated.empty()) return "The reference is outdated: " + outdated;
  if (const std::string other = otherCamera(session.reference->camera, session.camera.camera()); !other.empty())
    return "The reference is from another camera: " + other;
  if (session.edited.writeback.mode != WritebackMode::off && session.view != session.reference->of)
    return "With writeback.mode another picture would change the light: show the reference's view";
  const glm::uvec2 size = session.reference->picture.size;
  if (std::min(size.x, size.y) < kBlockSide) return "The reference holds no block of 8 \u00D7 8 pixels";
  return "";
}

/// The view that the reference is of, from the camera as it is, at the reference's size: the window's own picture where
/// that is it, or one beside it.
void Accuracy::readPicture(Session& session) {
  const ReferencePicture& reference = *session.reference;
  const glm::uvec2 size = reference.picture.size;
  const bool own = session.view == reference.of && session.targets.size == size;
  if (own || targets_.size != size) targets_ = own ? Targets() : Targets(session.context, size);
  const uint64_t bytes = uint64_t{size.x} * size.y * sizeof(glm::vec4);
  if (readback_.bytes != bytes) readback_ = Buffer(session.context.device, "accuracy", Subsystem::Ui, bytes);
  Frame frame = session.context.beginUntimed();
  if (!own) session.pipeline->render(frame, session.shown, reference.of, targets_);
  frame.pass("Readback").copy(own ? session.targets.linear : targets_.linear, readback_);
  pixels_ = std::make_shared<std::vector<glm::vec4>>();
  frame.readback(readback_, 0, bytes, [to = pixels_](std::span<const uint8_t> from) {
    to->resize(from.size() / sizeof(glm::vec4));
    std::memcpy(to->data(), from.data(), from.size());
  });
  frame.submit();
  awaiting_ = true;
}

bool Accuracy::serveMeasurement(Session& session) {
  std::string why = whyUnmeasured(session);
  bool changed = why != unmeasured;
  unmeasured = std::move(why);
  if (!unmeasured.empty()) measured.reset();
  if (std::exchange(wantFlip, false)) flip_ = true;

  if (awaiting_ && !pixels_->empty()) {
    awaiting_ = false;
    if (session.reference && pixels_->size() == session.reference->picture.pixels.size()) {
      const ReferencePicture& reference = *session.reference;
      const std::optional<double> exposure = asked_->flip ? std::optional(session.exposure()) : std::nullopt;
      measuring_ = std::async(
          std::launch::async, [pixels = pixels_, size = reference.picture.size, traced = traced_,
                               given = traced_ ? std::vector<glm::vec4>() : reference.picture.pixels, exposure] {
            if (traced)
              return measurePicture(size, *pixels, traced->halves[0], traced->halves[1], exposure, traced->error);
            return measurePicture(size, *pixels, given, {}, exposure);
          });
    }
  }
  if (ready(measuring_)) {
    PictureMetrics result = measuring_.get();
    if (unmeasured.empty()) measured = result;
    done_ = asked_;
    changed = true;
  }
  if (done_ && done_->picture != session.pictures) flip_ = false;
  const Stamp stamp{session.pictures, references_, flip_};
  const bool isFresh = measured && done_ == stamp;
  changed = changed || isFresh != fresh;
  fresh = isFresh;
  const bool due = unmeasured.empty() && !session.viewDirty && !session.work && session.targets.linear &&
                   done_ != stamp && !awaiting_ && !measuring_.valid() &&
                   (session.allAsleep() || session.paused || nowSeconds() - askedAt_ > kSecondsBetween);
  if (!due) return changed;
  asked_ = stamp;
  askedAt_ = nowSeconds();
  readPicture(session);
  return true;
}

bool Accuracy::serve(Session& session) {
  tracer_.hold(!open);
  if (!open) {
    wasOpen_ = false;
    if (targets_.size != glm::uvec2(0)) targets_ = {};
    if (readback_.bytes > 0) readback_ = {};
    return false;
  }
  if (!session.pipeline) return false;
  bool changed = serveReference(session);
  changed |= serveSave(session);
  changed |= serveStudy();
  changed |= serveMeasurement(session);
  wasOpen_ = true;
  return changed;
}

}  // namespace irad
