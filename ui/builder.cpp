#include "ui/builder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "gi/check/check.h"
#include "gi/facets.h"
#include "gi/lighting.h"
#include "gi/plan.h"
#include "gi/shadow_needs.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/image_io.h"
#include "renderer/frame/pipeline_wait.h"
#include "renderer/scene/nodes.h"
#include "renderer/scene/sky_image.h"

namespace irad {
namespace {

constexpr const char* kCancelled = "cancelled";

/// Whether the scene's file is read the same with either.
bool readAlike(const SceneSettings& a, const SceneSettings& b) {
  return a.lambertian == b.lambertian && a.doubleSided == b.doubleSided;
}

}  // namespace

Builder::Builder(Context& context, Session& session, std::function<void()> breathe)
    : context_(context), session_(session), breathe_(std::move(breathe)) {}

void Builder::load(const std::filesystem::path& path) {
  begin("Loading " + path.filename().string());
  try {
    // A scene that is loaded again keeps what the user has made of it.
    const bool again = session_.pipeline && session_.pipeline->scene().path == path,
               unsaved = session_.edits.modified();
    LoadOptions load = session_.load;
    if (again && unsaved) {
      load.lights = session_.edits.lights;
      load.materials = session_.edits.materials;
      load.hidden = session_.edits.hidden;
      load.region = session_.edits.region;
    }
    load.lambertian = session_.edited.scene.lambertian;
    load.doubleSided = session_.edited.scene.doubleSided;
    load.progress = [this](float fraction, const char* step) {
      if (!progress(step, fraction)) throw WorkError(kCancelled);
    };
    Scene scene = openScene(path, load);
    if (again && adopt(scene)) {
      session_.beginEdits(unsaved);
      loaded_ = session_.edited.scene;
      session_.work.reset();
      return session_.note(
          fmt::format("{}: its surfaces are as they were, and so is what was made of them", path.filename().string()));
    }
    if (!again) session_.expose(path);
    ExpectedIrradiance expected = expectedIrradiance(scene);
    auto pipeline = std::make_unique<Pipeline>(context_, std::move(scene), session_.edited, std::move(expected));
    giveReference(*pipeline);
    times_ = {};
    session_.forecast.reset();
    timing_ = true;
    prepare(session_, *pipeline);
    if (session_.comparison) session_.note("The comparison has ended: a scene was loaded.");
    session_.comparison.reset();
    if (unsaved && !again)
      session_.note(fmt::format("{}: lights, materials, objects, bookmarks and region were not saved",
                                session_.pipeline->scene().path.filename().string()));
    session_.inspection.leavePipeline();
    session_.pipeline = std::move(pipeline);
    session_.load.lights.reset();
    session_.load.materials.reset();
    session_.load.hidden.reset();
    session_.beginEdits(again && unsaved);
    loaded_ = session_.pipeline->settings().scene;
    session_.halted = false;
    if (!again) session_.useSceneCamera(0);
  } catch (const Error&) {
    forgetTimes();
    const bool cancelled = session_.work->cancel;
    session_.work.reset();
    if (session_.pipeline && !readAlike(session_.edited.scene, loaded_)) {
      session_.edited.scene.lambertian = loaded_.lambertian;
      session_.edited.scene.doubleSided = loaded_.doubleSided;
      session_.returned = true;
    }
    if (!cancelled) throw;
    session_.note(fmt::format("{}: loading was cancelled", path.filename().string()));
  }
  session_.work.reset();
}

/// The scene that is shown, read again: where its surfaces are the same, voxels and matrix are kept.
bool Builder::adopt(const Scene& scene) {
  for (Side* side : session_.sides()) {
    Scene reading = scene;
    if (!side->pipeline->adopt(reading)) return false;
    side->woke();
  }
  session_.load.lights.reset();
  session_.load.materials.reset();
  session_.load.hidden.reset();
  session_.halted = false;
  session_.viewDirty = true;
  return true;
}

bool Builder::stale() const {
  if (stale_ || !session_.pipeline) return stale_;
  const Scene& scene = session_.pipeline->scene();
  // Materials and hidden objects that wait for the mouse to be let go wait like settings: session_.next says so.
  if (session_.load.sky != scene.sky || session_.reference != given_) return true;
  const bool others = session_.edits.materials != scene.materialEdits || session_.edits.hidden != scene.hidden ||
                      session_.edits.region != scene.region;
  return session_.edits.lights != scene.lights || (others && session_.next == Redo::Nothing);
}

/// Both sides have the same lights. What is wrong with them is reported, and they go back to what they were.
void Builder::applyLights() {
  const std::vector<Light> before = session_.pipeline->scene().lights;
  for (Side* side : session_.sides()) {
    if (session_.edits.lights == side->pipeline->scene().lights) continue;
    try {
      side->pipeline->setLights(session_.edits.lights);
      session_.halted = false;
      side->woke();
    } catch (const Error& error) {
      forgetTimes();
      session_.edits.lights = before;
      session_.returned = true;
      session_.error(error.what());
    }
    session_.viewDirty = true;
  }
}

/// Both sides have the same materials. An edit that redoes no more than the light is taken at once; what moves an alpha
/// mask, or has the first light reach the scene, builds it anew, and is announced and waits as a setting does: its
/// first stage is returned.
Redo Builder::applyMaterials(bool held) {
  const std::vector<MaterialEdit> before = session_.pipeline->scene().materialEdits;
  for (Side* side : session_.sides()) {
    if (session_.edits.materials == side->pipeline->scene().materialEdits) continue;
    try {
      const Redo redo = side->pipeline->due(session_.edits.materials);
      if (redo <= Redo::Matrix && (shownNext_ != redo || held)) return redo;
      session_.materialEdit = MaterialTimes{.from = redo};
      side->pipeline->setMaterials(session_.edits.materials);
      session_.halted = false;
      side->woke();
    } catch (const Error& error) {
      forgetTimes();
      session_.edits.materials = before;
      session_.returned = true;
      session_.error(error.what());
    }
    session_.viewDirty = true;
  }
  return Redo::Nothing;
}

/// Both sides have the same box. One that builds anything anew is announced, and waits, as a setting does.
Redo Builder::applyRegion(bool held) {
  for (Side* side : session_.sides()) {
    const Pipeline& pipeline = *side->pipeline;
    if (session_.edits.region == pipeline.scene().region) continue;
    const bool taken = pipeline.settings().scene.region.mode == RegionMode::automatic;
    if (taken && (shownNext_ != Redo::Voxels || held)) return Redo::Voxels;
    side->pipeline->setRegion(session_.edits.region);
    session_.halted = false;
    side->woke();
    session_.viewDirty = true;
  }
  return Redo::Nothing;
}

/// What is hidden is announced, and waits, as a setting that builds everything anew does: its first stage is returned.
Redo Builder::applyHidden(bool held) {
  if (session_.edits.hidden == session_.pipeline->scene().hidden) return Redo::Nothing;
  if (shownNext_ != Redo::Voxels || held) return Redo::Voxels;
  hide();
  return Redo::Nothing;
}

/// Both sides get pipelines of the scene without what is hidden, once these have something to show. Until then the old
/// picture stays; it does where that fails, or is cancelled, and what was hidden before is hidden again.
void Builder::hide() {
  const Scene& before = session_.pipeline->scene();
  const HiddenNodes wanted = session_.edits.hidden, old = before.hidden;
  begin(wanted.empty() ? "Showing all objects" : "Hiding objects");
  session_.work->ofSettings = true;
  try {
    Scene scene = before;
    hideNodes(scene, wanted);
    if (shownNodes(scene.nodes, wanted) == shownNodes(scene.nodes, old)) {
      adopt(scene);  // names that no node has
    } else {
      std::vector<Side> fresh;
      for (Side* side : session_.sides()) {
        Side& made = fresh.emplace_back();
        made.pipeline = std::make_unique<Pipeline>(context_, scene, side->pipeline->settings());
        giveReference(*made.pipeline);
        prepare(made, *made.pipeline);
      }
      session_.inspection.leavePipeline();
      for (size_t i = 0; i < fresh.size(); ++i) {
        Side& side = *session_.sides()[i];
        side.woke();
        side.pipeline = std::move(fresh[i].pipeline);
        side.built = std::move(fresh[i].built);
        side.solves = std::move(fresh[i].solves);
        side.sweepsSinceWake = fresh[i].sweepsSinceWake;
      }
      session_.halted = false;
      session_.viewDirty = true;
    }
  } catch (const Error& error) {
    forgetTimes();
    if (session_.edits.hidden == wanted) {  // undo may have changed it since
      session_.edits.hidden = old;
      session_.returned = true;
    }
    if (session_.work->cancel)
      session_.note("The rebuild was cancelled; what is hidden is as it was.");
    else
      session_.error(error.what());
  }
  session_.work.reset();
}

/// After a prepare().
void Builder::timeMaterials() {
  if (!session_.materialEdit || session_.materialEdit->settled > 0 || session_.halted) return;
  MaterialTimes& times = *session_.materialEdit;
  const double now = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - times.began).count();
  if (times.shown == 0) times.shown = now;
  if (session_.allAsleep()) times.settled = now;
}

void Builder::giveReference(Pipeline& pipeline) {
  if (const auto& reference = session_.reference)
    pipeline.setReference(reference->picture.size, reference->picture.pixels, reference->of);
  else
    pipeline.setReference({}, {});
}

/// Every side has the same sky and the same reference.
void Builder::applyPictures() {
  const bool reference = given_ != session_.reference;
  for (Side* side : session_.sides()) {
    if (side->pipeline->scene().sky != session_.load.sky) side->pipeline->setSky(session_.load.sky);
    if (reference) giveReference(*side->pipeline);
  }
  if (reference) session_.viewDirty = true;
  given_ = session_.reference;
}

void Builder::openPicture(const std::filesystem::path& path) {
  try {
    if (const LinearPicture picture = readLinear(path); maySkyBe(picture) || picture.integers) {
      session_.load.sky = std::make_shared<SkyImage>(skyOf(path, picture));
      session_.edited.sky.source = SkySource::image;
      return session_.note(fmt::format("{} is the sky", path.string()));
    }
    session_.reference = std::make_shared<const ReferencePicture>(readReference(path));
    session_.note(fmt::format("{} is what the views reference-picture and error compare with", path.string()));
  } catch (const Error& error) {
    session_.openFailed(error.what());
  }
}

void Builder::apply(bool held) {
  if (!session_.pipeline) return;
  applyPictures();
  applyLights();
  const Redo waits = std::min({applyMaterials(held), applyHidden(held), applyRegion(held)});
  Pipeline& pipeline = *session_.pipeline;
  if (session_.edited != pipeline.settings()) {
    const bool reload = !readAlike(session_.edited.scene, loaded_);
    const Redo redo = reload ? Redo::Voxels : pipeline.due(session_.edited);
    session_.next = redo;
    foresee(redo);
    session_.pending = session_.preferences.applyByHand && redo < Redo::Shade && !session_.applyNow;
    if (session_.pending) return showWhilePending();
    if (redo < Redo::Shade && (shownNext_ != redo || held)) return;
    session_.next = Redo::Nothing;
    session_.applyNow = false;
    if (reload) {
      session_.leave({Leaving::What::OpenScene, pipeline.scene().path});
      return;
    }
    timing_ = redo < Redo::Shade;
    pipeline.set(session_.edited);
    session_.viewDirty = true;
    session_.halted = false;
    if (redo < Redo::Scatter) session_.woke();
    if (redo >= Redo::Shade && !session_.asleep() && session_.paused) return;
  } else {
    session_.next = waits;
    session_.pending = session_.applyNow = false;
    if (!timing_) session_.forecast.reset();
    if (waits != Redo::Nothing) return;
    const bool step = std::exchange(session_.step, false);
    if (session_.paused && session_.built && !stale_ && !step) return;
  }
  stale_ = false;
  if (session_.halted) return;
  if (!session_.asleep()) rebuild(session_, "Rebuilding");
  if (session_.comparison && !session_.halted) follow();
  timeMaterials();
}

/// The other side of a comparison has settings of its own; seed and lights belong to both.
void Builder::follow() {
  Side& other = session_.comparison->other;
  if (session_.comparison->sameSeed) other.edited.matrix.gpu.seed = session_.edited.matrix.gpu.seed;
  other.edited.view = session_.edited.view;  // both are shown the same way
  if (other.edited != other.pipeline->settings() && !waitsForApply(other)) {
    other.pipeline->set(other.edited);
    other.woke();
    session_.viewDirty = true;
  }
  if (!other.asleep()) rebuild(other, session_.comparison->editsB ? "Rebuilding A" : "Rebuilding B");
}

/// What is seen at once, as the view, is taken; what rebuilds waits, and the light of what there is goes on.
void Builder::showWhilePending() {
  Pipeline& pipeline = *session_.pipeline;
  Settings now = pipeline.settings();
  for (const Setting& setting : settingTable())
    if (setting.redo >= Redo::Shade) setting.set(now, setting.get(session_.edited));
  if (now != pipeline.settings()) {
    pipeline.set(now);
    session_.viewDirty = true;
  }
  if (session_.halted || session_.paused || session_.asleep()) return;
  rebuild(session_, "Rebuilding");
}

bool Builder::waitsForApply(const Side& side) const {
  return session_.preferences.applyByHand && !session_.applyNow && side.pipeline->due(side.edited) < Redo::Shade;
}

/// What the edits will take; found anew when they have changed.
void Builder::foresee(Redo first) {
  if (foreseen_ && *foreseen_ == session_.edited && session_.forecast) return;
  foreseen_ = session_.edited;
  session_.forecast.reset();
  const std::optional<double> ms = first < Redo::Shade ? times_.predict(session_.edited, first) : std::nullopt;
  if (ms && session_.built && session_.pipeline->current())
    session_.forecast =
        BuildCost{*ms, predictedBytes(*session_.pipeline, context_.device.memory().used(), session_.edited, first)};
}

void Builder::compare() {
  if (!session_.built || session_.comparison) return;
  begin("Preparing a second pipeline");
  try {
    Side other;
    other.edited = session_.edited;
    other.saved = session_.saved;
    const Scene& scene = session_.pipeline->scene();
    other.pipeline = std::make_unique<Pipeline>(context_, scene, session_.edited, expectedIrradiance(scene));
    giveReference(*other.pipeline);
    prepare(other, *other.pipeline);
    session_.comparison.emplace().other = std::move(other);
    session_.swapSides();
  } catch (const Error& error) {
    forgetTimes();
    if (!session_.work->cancel) session_.error(fmt::format("No comparison: {}", error.what()));
  }
  session_.work.reset();
}

void Builder::rebuild(Side& side, std::string what) {
  begin(std::move(what));
  session_.work->ofSettings = true;
  try {
    prepare(side, *side.pipeline);
  } catch (const Error& error) {
    session_.halted = true;
    forgetTimes();
    if (!session_.work->cancel)
      session_.error(error.what());
    else if (!session_.quit)
      giveUp(side);
  }
  session_.work.reset();
}

/// Cancelled: the settings are those again that were built last. Of these a rebuild of the voxels may have given up the
/// matrix, which is then made anew. Where it was no setting that called for it, it waits for the next edit, or for
/// Rebuild.
void Builder::giveUp(Side& side) {
  Settings back = side.edited;
  for (const Setting& setting : settingTable())
    if (setting.redo < Redo::Shade) setting.set(back, setting.get(side.built->settings));
  if (back == side.pipeline->settings())
    return session_.note("The rebuild was cancelled; the picture shows the old state.");
  session_.returned |= side.edited != back;
  side.edited = back;
  session_.halted = false;
  session_.note("The rebuild was cancelled; the settings are those of the picture again.");
}

/// `pipeline` may be a new one that is not the side's yet.
void Builder::prepare(Side& side, Pipeline& pipeline) {
  const auto began = Clock::now();
  const double waited = pipelineWaitMs(context_);
  watch_.reset();
  if (std::exchange(timing_, false)) watch_.emplace();
  pipeline.prepare([this](const char* stage, float fraction) { return progress(stage, fraction); },
                   session_.paused ? 1 : pipeline.settings().solver.sweepsPerFrame);
  if (watch_) {
    runs({});
    watch_->tell(times_, pipeline.settings());
    watch_.reset();
    session_.lastBuild =
        Session::LastBuild{.predicted = std::exchange(session_.forecast, std::nullopt),
                           .took = {std::chrono::duration<double, std::milli>(Clock::now() - began).count(),
                                    context_.device.memory().used()},
                           .compileMs = pipelineWaitMs(context_) - waited};
    if (const auto& [predicted, took, compileMs] = *session_.lastBuild; predicted)
      tell("irad: predicted {}; took {}, {} of it for compiling shaders\n", costText(*predicted), costText(took),
           durationText(compileMs));
  }
  if (&pipeline != side.pipeline.get()) side.woke();
  const FacetList& facets = pipeline.facets();
  const SolveReport& report = pipeline.lighting().report;
  if (!(side.built && side.built->region == facets.region))
    if (!facets.region.line.empty()) session_.note(facets.region.line);
  std::vector<uint32_t> withoutShadow = pipeline.lightsWithoutShadow();
  if (!withoutShadow.empty() && !(side.built && side.built->withoutShadow == withoutShadow))
    session_.note(describeWithoutShadow(pipeline.scene().lights, withoutShadow));
  side.built = Built{.dims = facets.grid.dims,
                     .facets = facets.count,
                     .solidVoxels = facets.solidVoxels,
                     .clampedAlbedo = facets.clampedAlbedo,
                     .edge = facets.grid.edge,
                     .region = facets.region,
                     .solve = report,
                     .findings = pipeline.findings(),
                     .noLight = pipeline.plan().noLight,
                     .nothingDiffuse = pipeline.plan().nothingDiffuse,
                     .withoutShadow = std::move(withoutShadow),
                     .settings = pipeline.settings()};
  const float error = report.frames > 0 ? report.standardError : report.bound;
  side.solves.push_back({report.sweeps, report.residual, error});
  if (side.solves.size() > 400) side.solves.pop_front();
  side.sweepsSinceWake += report.sweeps;
  session_.viewDirty = true;
}

void Builder::begin(std::string what) {
  session_.work = Work{.what = std::move(what)};
}

void Builder::runs(std::optional<BuildTimes::Part> part) {
  const std::chrono::duration<double, std::milli> now = Clock::now().time_since_epoch();
  watch_->runs(part, now.count(), pipelineWaitMs(context_));
}

/// False: cancelled.
bool Builder::progress(const char* stage, float fraction) {
  if (watch_) runs(BuildTimes::partOf(stage));
  session_.work->stage = stage;
  session_.work->fraction = std::clamp(fraction, 0.0f, 1.0f);
  breathe_();
  return !session_.work->cancel;
}

/// The times of work that was given up belong to no frame.
void Builder::forgetTimes() {
  context_.finish();
  context_.timings.forget();
}

void Builder::darken() {
  if (!session_.built) return;
  session_.pipeline->darken();
  session_.built->solve = {};
  session_.woke();
  session_.halted = false;
  session_.viewDirty = true;
}

void Builder::reloadShaders(const std::filesystem::path& folder) {
  if (folder.empty()) return session_.error("F5: the folder shaders/ was not found; the built-in shaders stay");
  const ShaderReload reload = context_.shaders.reload(folder);
  if (!reload.errors.empty()) return session_.error("The old shaders stay in use.\n" + reload.errors);
  if (reload.changed.empty()) return session_.note("F5: no shader has changed");
  const auto changedIn = [&](std::string_view part) {
    return std::any_of(reload.changed.begin(), reload.changed.end(),
                       [&](const std::string& name) { return name.starts_with(part); });
  };
  const bool build = changedIn("gi/"), shadows = changedIn("forward/");  // shadow maps are drawn by depth.vert
  if (session_.pipeline && (build || shadows)) {
    for (Side* side : session_.sides()) {
      if (build) side->pipeline->invalidate(Redo::Voxels);
      if (shadows) side->pipeline->lightsChanged();
      side->woke();
    }
    stale_ = true;
    session_.halted = false;
  }
  session_.viewDirty = true;
  session_.note(fmt::format("Compiled again: {}", fmt::join(reload.changed, ", ")));
}

}  // namespace irad
