#include "ui/builder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "gi/check/check.h"
#include "renderer/error.h"

namespace irad {
namespace {

constexpr const char* kCancelled = "cancelled";

/// Every setting as a number, to see whether anything was edited.
std::vector<double> values(Settings settings) {
  std::vector<double> out;
  visit(settings, [&](auto&& member, const Meta&) {
    if constexpr (requires { member.value; })
      out.push_back(member.value);
    else
      out.push_back(static_cast<double>(member));
  });
  return out;
}

}  // namespace

Builder::Builder(Context& context, Session& session, std::function<void()> breathe)
    : context_(context), session_(session), breathe_(std::move(breathe)) {}

void Builder::load(const std::filesystem::path& path) {
  begin("Loading " + path.filename().string());
  try {
    LoadOptions load;
    load.lambertian = session_.edited.lambertian;
    load.progress = [this](float fraction, const char* step) {
      if (!progress(step, fraction)) throw WorkError(kCancelled);
    };
    Scene scene = openScene(path, load);
    auto pipeline = std::make_unique<Pipeline>(context_, std::move(scene), session_.edited);
    prepare(*pipeline);
    const bool sameScene = session_.pipeline && session_.pipeline->scene().path == pipeline->scene().path;
    session_.pipeline = std::move(pipeline);
    applied_ = values(session_.pipeline->settings());
    loadedLambertian_ = session_.pipeline->settings().lambertian;
    session_.halted = false;
    if (!sameScene) session_.useSceneCamera(0);
  } catch (const Error&) {
    forgetTimes();
    const bool cancelled = session_.work->cancel;
    session_.work.reset();
    if (session_.pipeline) session_.edited.lambertian = loadedLambertian_;
    if (!cancelled) throw;
    session_.note(fmt::format("{}: loading was cancelled", path.filename().string()));
  }
  session_.work.reset();
}

void Builder::apply(bool held) {
  if (!session_.pipeline) return;
  Pipeline& pipeline = *session_.pipeline;
  if (values(session_.edited) != applied_) {
    const bool reload = session_.edited.lambertian != loadedLambertian_;
    const Redo redo = reload ? Redo::Voxels : difference(pipeline.settings(), session_.edited);
    session_.next = redo;
    if (redo < Redo::Shade && (shownNext_ != redo || held)) return;
    session_.next = Redo::Nothing;
    if (reload) {
      session_.openScene = pipeline.scene().path;
      return;
    }
    pipeline.set(session_.edited);
    applied_ = values(session_.edited);
    session_.viewDirty = true;
    session_.halted = false;
    if (redo < Redo::Scatter) session_.woke();
    if (redo >= Redo::Shade && !session_.asleep() && session_.paused) return;
  } else {
    session_.next = Redo::Nothing;
    if (session_.paused && session_.built && !stale_) return;
  }
  stale_ = false;
  if (!session_.halted && !(session_.built && pipeline.asleep())) rebuild();
}

void Builder::rebuild() {
  begin("Rebuilding");
  try {
    prepare(*session_.pipeline);
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

void Builder::prepare(Pipeline& pipeline) {
  pipeline.prepare([this](const char* stage, float fraction) { return progress(stage, fraction); },
                   session_.paused ? 1 : pipeline.settings().solver.sweepsPerFrame);
  if (&pipeline != session_.pipeline.get()) session_.woke();
  const FacetList& facets = pipeline.facets();
  const SolveReport& report = pipeline.lighting().report;
  session_.built = Built{.dims = facets.grid.dims,
                         .facets = facets.count,
                         .solidVoxels = facets.solidVoxels,
                         .clampedAlbedo = facets.clampedAlbedo,
                         .edge = facets.grid.edge,
                         .solve = report,
                         .findings = pipeline.findings(),
                         .tolerance = pipeline.settings().solver.tolerance};
  session_.solves.push_back({report.sweeps, report.residual, report.bound});
  if (session_.solves.size() > 400) session_.solves.pop_front();
  session_.sweepsSinceWake += report.sweeps;
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

/// What given-up work has measured is no frame's time.
void Builder::forgetTimes() {
  context_.finish();
  context_.timings.forget();
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
  if (session_.pipeline && build) session_.pipeline->invalidate(Redo::Voxels);
  if (session_.pipeline && shadows) session_.pipeline->lightsChanged();
  if (build || shadows) {
    stale_ = session_.pipeline != nullptr;
    session_.halted = false;
    session_.woke();
  }
  session_.viewDirty = true;
  session_.note(fmt::format("Compiled again: {}", fmt::join(reload.changed, ", ")));
}

}  // namespace irad
