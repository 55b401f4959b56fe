// What a study's pictures are held against: read from a file, found where other studies left it, or made and kept.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "app/interrupts.h"
#include "app/study_run.h"
#include "gi/check/path_state.h"
#include "gi/sky.h"
#include "renderer/base/error.h"
#include "renderer/base/output_file.h"
#include "renderer/scene/camera_json.h"

namespace irad::app {
namespace {

namespace fs = std::filesystem;

/// A truth that is killed while it is traced loses no more than this.
constexpr std::chrono::seconds kBetweenStates(60);

/// Of the path tracer for a truth, whatever the seeds of points are.
TraceOptions truthOptions(uint32_t samples) {
  return {.samples = samples, .seed = 1, .centred = true};
}

}  // namespace

LinearPixels Truth::mean() const {
  LinearPixels out = first;
  for (size_t i = 0; i < second.size(); ++i) out[i] = 0.5f * (first[i] + second[i]);
  return out;
}

void requirePathTracer(const ViewInfo& view, const Settings& settings) {
  if (!hasPathTracer()) throw UsageError("--peer, --reference-samples: this build has no path tracer (IRAD_EMBREE)");
  const std::string_view name = view.name;
  if (name != "indirect" && !(name == "lit" && settings.scene.lambertian))
    throw UsageError(
        fmt::format("--view {}: the path tracer is diffuse: compare --view indirect, or --view lit with "
                    "--set scene.lambertian=true",
                    view.name));
}

std::string TruthSource::name() const {
  if (samples) return fmt::format("path tracer, {} samples per pixel", *samples);
  if (settings) return fmt::format("own pictures of two seeds by {}", settingsToJson(*settings));
  return secondFile ? fmt::format("{} and {}", file->sha256, secondFile->sha256) : file->sha256;
}

std::optional<TruthRecipe> truthRecipe(const DeviceSession& session, const StudyTask& task, const Scene& scene,
                                       const std::string& sceneContent, const SkySettings& sky) {
  if (task.truth.file) return std::nullopt;
  const TruthSubject subject{.program = session.machine.identity(),
                             .scene = sceneContent,
                             .sceneName = scene.path.stem().string(),
                             .camera = task.camera,
                             .size = task.size,
                             .view = task.view.name};
  if (task.truth.samples)
    return tracedTruth(subject, makeSky(sky, skyInputs(scene, scene.lights)), truthOptions(*task.truth.samples));
  return drawnTruth(subject, *task.truth.settings, session.device->info.name);
}

bool StudyRun::needsTruth() const {
  for (size_t point = 0; point < grid_.size(); ++point)
    if (task_.shard.has(point)) return true;
  return task_.shard.part == 1 && !task_.peerSamples.empty();
}

/// What is computed is two pictures of independent noise, kept in a folder.
void StudyRun::makeTruth() {
  if (task_.truth.file) {
    truth_.first = task_.truth.file->picture.pixels;
    if (task_.truth.secondFile) truth_.second = task_.truth.secondFile->picture.pixels;
    return;
  }
  const TruthRecipe recipe = *truthRecipe(session_, task_, scene_, sceneContent_, grid_.settings(0).sky);
  const TruthStore store(task_.sharedTruths ? task_.sharedTruths->folder : task_.out / "truths");
  std::string spoilt;
  std::optional<LinearPicture> halves[] = {store.find(recipe, 0, &spoilt), store.find(recipe, 1, &spoilt)};
  if (!spoilt.empty()) session_.progress.note(fmt::format("warning: {}; it is made anew", spoilt));
  const bool there = halves[0] && halves[1];
  std::string from = there ? "there already" : "is made";
  if (SharedTruths* shared = task_.sharedTruths) {
    const std::string& first = shared->users.try_emplace(recipe.name(), shared->user).first->second;
    if (there && first != shared->user) from = "shared with " + first;
  }
  session_.progress.note(fmt::format("  truth {}: {}", recipe.name(), from));
  if (!there) {
    makeHalves(store, recipe);
    for (int half : {0, 1}) halves[half] = store.find(recipe, half);
  }
  for (const std::optional<LinearPicture>& half : halves)
    IRAD_CHECK(half && half->size == task_.size, "the truth {} is gone from its folder", recipe.name());
  truth_.first = std::move(halves[0]->pixels), truth_.second = std::move(halves[1]->pixels);
}

/// Those that the store lacks.
void StudyRun::makeHalves(const TruthStore& store, const TruthRecipe& recipe) {
  const PictureSubject subject{cameraToJson(task_.camera), task_.view.name};
  if (!task_.truth.samples) {
    for (int half : {0, 1}) {
      if (store.find(recipe, half)) continue;
      progress("reference", 0, 1);
      Settings settings = *task_.truth.settings;
      settings.matrix.gpu.seed += kHalfSeeds[half];
      store.keep(recipe, half, task_.size, picture(settings), subject);
    }
    return;
  }
  const fs::path state = store.stateFile(recipe);
  std::error_code ignored;
  TracedSums sums;
  if (fs::exists(state, ignored))
    if (SavedSums saved = readSums(state); saved.made == recipe.made) sums = std::move(saved.sums);
  const auto save = [&](const TracedSums& so) {
    makeFolder(state.parent_path());
    writeSums(state, {recipe.made, so});
  };
  auto saved = std::chrono::steady_clock::now();
  const TracedPicture picture =
      trace("reference", *task_.truth.samples, truthOptions(0).seed, std::move(sums), [&](const TracedSums& so) {
        const auto now = std::chrono::steady_clock::now();
        if (now - saved < kBetweenStates && !isStopped()) return;
        save(so);
        saved = now;
      });
  for (int half : {0, 1}) store.keep(recipe, half, task_.size, pixelsOf(lightOf(picture).half[half]), subject);
  removeFile(state);
}

/// In passes of about a second, between which a signal ends it; the bits are those of one go.
TracedPicture StudyRun::trace(const char* what, uint32_t samples, uint64_t seed, TracedSums sums,
                              const std::function<void(const TracedSums&)>& afterPass) {
  constexpr double kPass = 1;  // s
  if (!tracer_) tracer_ = makePathTracer(scene_, makeSky(grid_.settings(0).sky, skyInputs(scene_, scene_.lights)));
  const uint32_t before = sums.samples;
  TraceOptions options = truthOptions(0);
  options.seed = seed;
  uint32_t next = 1;
  while (sums.samples < samples) {
    progress(what, sums.samples - before, samples - before);
    options.samples = std::min(next, samples - sums.samples);
    const auto began = std::chrono::steady_clock::now();
    tracer_->add(task_.camera, task_.size, options, sums);
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - began;
    const double fitting = options.samples * kPass / std::max(spent.count(), 1e-6);
    next = static_cast<uint32_t>(std::clamp(fitting, 1.0, 2.0 * options.samples));
    if (afterPass) afterPass(sums);
  }
  return pictureOf(sums);
}

const TracedLight& StudyRun::lightOf(const TracedPicture& picture) const {
  return std::string_view(task_.view.name) == "indirect" ? picture.indirect : picture.lit;
}

}  // namespace irad::app
