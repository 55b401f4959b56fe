#include "ui/builder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "gi/check/check.h"
#include "gi/facets.h"
#include "gi/lighting.h"
#include "gi/plan.h"
#include "renderer/base/error.h"
#include "renderer/image_io.h"
#include "renderer/scene/sky_image.h"

namespace irad {
namespace {

constexpr const char* kCancelled = "cancelled";

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
    if (again && unsaved) load.lights = session_.edits.lights;
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
    prepare(session_, *pipeline);
    if (session_.comparison) session_.note("The comparison has ended: a scene was loaded.");
    session_.comparison.reset();
    if (unsaved && !again)
      session_.note(
          fmt::format("{}: lights and bookmarks were not saved", session_.pipeline->scene().path.filename().string()));
    session_.pipeline = std::move(pipeline);
    session_.load.lights.reset();
    session_.beginEdits(again && unsaved);
    loaded_ = session_.pipeline->settings().scene;
    session_.halted = false;
    if (!again) session_.useSceneCamera(0);
  } catch (const Error&) {
    forgetTimes();
    const bool cancelled = session_.work->cancel;
    session_.work.reset();
    if (session_.pipeline) session_.edited.scene = loaded_;
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
  session_.halted = false;
  session_.viewDirty = true;
  return true;
}

bool Builder::stale() const {
  return stale_ || (session_.pipeline && session_.edits.lights != session_.pipeline->scene().lights);
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
      session_.error(error.what());
    }
    session_.viewDirty = true;
  }
}

void Builder::giveReference(Pipeline& pipeline) {
  if (const auto& reference = session_.reference)
    pipeline.setReference(reference->picture.size, reference->picture.pixels, reference->of);
}

void Builder::openPicture(const std::filesystem::path& path) {
  try {
    if (const LinearPicture picture = readLinear(path); maySkyBe(picture) || picture.integers) {
      session_.load.sky = std::make_shared<SkyImage>(skyOf(path, picture));
      session_.edited.sky.source = SkySource::image;
      for (Side* side : session_.sides())
        if (side->pipeline) side->pipeline->setSky(session_.load.sky);
      return session_.note(fmt::format("{} is the sky", path.string()));
    }
    session_.reference = readReference(path);
    for (Side* side : session_.sides())
      if (side->pipeline) giveReference(*side->pipeline);
    session_.viewDirty = true;
    session_.note(fmt::format("{} is what the views reference-picture and error compare with", path.string()));
  } catch (const Error& error) {
    session_.error(error.what());
  }
}

void Builder::apply(bool held) {
  if (!session_.pipeline) return;
  applyLights();
  Pipeline& pipeline = *session_.pipeline;
  if (session_.edited != pipeline.settings()) {
    const bool reload = session_.edited.scene != loaded_;
    const Redo redo = reload ? Redo::Voxels : pipeline.due(session_.edited);
    session_.next = redo;
    if (redo < Redo::Shade && (shownNext_ != redo || held)) return;
    session_.next = Redo::Nothing;
    if (reload) {
      session_.leave({Leaving::What::OpenScene, pipeline.scene().path});
      return;
    }
    pipeline.set(session_.edited);
    session_.viewDirty = true;
    session_.halted = false;
    if (redo < Redo::Scatter) session_.woke();
    if (redo >= Redo::Shade && !session_.asleep() && session_.paused) return;
  } else {
    session_.next = Redo::Nothing;
    const bool step = std::exchange(session_.step, false);
    if (session_.paused && session_.built && !stale_ && !step) return;
  }
  stale_ = false;
  if (session_.halted) return;
  if (!session_.asleep()) rebuild(session_, "Rebuilding");
  if (session_.comparison && !session_.halted) follow();
}

/// The other side of a comparison has settings of its own; seed and lights belong to both.
void Builder::follow() {
  Side& other = session_.comparison->other;
  if (session_.comparison->sameSeed) other.edited.matrix.gpu.seed = session_.edited.matrix.gpu.seed;
  other.edited.view = session_.edited.view;  // both are shown the same way
  if (other.edited != other.pipeline->settings()) {
    other.pipeline->set(other.edited);
    other.woke();
    session_.viewDirty = true;
  }
  if (!other.asleep()) rebuild(other, session_.comparison->editsB ? "Rebuilding A" : "Rebuilding B");
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
  try {
    prepare(side, *side.pipeline);
  } catch (const Error& error) {
    session_.halted = true;
    forgetTimes();
    if (!session_.work->cancel)
      session_.error(error.what());
    else if (!session_.quit)
      session_.note("The rebuild was cancelled; the picture shows the old state.");
  }
  session_.work.reset();
}

/// `pipeline` may be a new one that is not the side's yet.
void Builder::prepare(Side& side, Pipeline& pipeline) {
  pipeline.prepare([this](const char* stage, float fraction) { return progress(stage, fraction); },
                   session_.paused ? 1 : pipeline.settings().solver.sweepsPerFrame);
  if (&pipeline != side.pipeline.get()) side.woke();
  const FacetList& facets = pipeline.facets();
  const SolveReport& report = pipeline.lighting().report;
  side.built = Built{.dims = facets.grid.dims,
                     .facets = facets.count,
                     .solidVoxels = facets.solidVoxels,
                     .clampedAlbedo = facets.clampedAlbedo,
                     .edge = facets.grid.edge,
                     .solve = report,
                     .findings = pipeline.findings(),
                     .noLight = pipeline.plan().noLight,
                     .nothingDiffuse = pipeline.plan().nothingDiffuse};
  const float error = report.frames > 0 ? report.standardError : report.bound;
  side.solves.push_back({report.sweeps, report.residual, error});
  if (side.solves.size() > 400) side.solves.pop_front();
  side.sweepsSinceWake += report.sweeps;
  session_.viewDirty = true;
}

void Builder::begin(std::string what) {
  session_.work = Work{.what = std::move(what)};
}

/// False: cancelled.
bool Builder::progress(const char* stage, float fraction) {
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
