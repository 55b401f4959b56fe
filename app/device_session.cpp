#include "app/device_session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/progress.h"
#include "app/version.h"
#include "gi/check/check.h"
#include "gi/sizes.h"
#include "gi/traits.h"
#include "gi/watch.h"
#include "renderer/base/error.h"
#include "renderer/scene/sidecar.h"
#include "renderer/scene/sky_image.h"

namespace irad::app {

DeviceSession::DeviceSession(Machine& machine, const SettingArguments& arguments,
                             const DeviceArguments& deviceArguments, size_t timedFrames)
    : machine(machine),
      config(arguments.readConfig()),
      timings(timedFrames),
      sizesAreDefault_(arguments.sizesAreDefault()) {
  (void)arguments.resolve(config, /*cpuDevice=*/true);
  opened = machine.open(deviceArguments.options());
  device = opened->device.get();
  context = opened->makeContext(timings);
  settings = arguments.resolve(config, device->isCpu);
}

DeviceSession::~DeviceSession() {
  context.reset();
  machine.leave(std::move(opened));
}

Scene DeviceSession::load(const std::filesystem::path& path, const SceneArguments& arguments) {
  return loadForRun(path, arguments, config, settings, progress);
}

Scene loadForRun(const std::filesystem::path& path, const SceneArguments& arguments, const Config& config,
                 Settings& settings, ProgressReport& progress) {
  LoadOptions options = arguments.load(config, settings);
  useSky(settings, options);
  options.progress = [&progress](float fraction, const char* step) { progress(step, fraction); };
  Scene scene = openScene(path, options);
  if (!scene.sidecar.empty()) progress.note(sidecarNote(scene));
  for (const std::string& warning : scene.warnings) progress.note("warning: " + warning);
  warnIfOther(progress, config, path, scene.sha256, config.sceneSha256);
  if (scene.sky && !arguments.sky) warnIfOther(progress, config, scene.sky->path, scene.sky->sha256, config.skySha256);
  if (!config.shaders.empty())
    progress.note(
        fmt::format("warning: {} was made with shaders compiled in the window, which this run does not have: {}",
                    config.path.string(), fmt::join(config.shaders, ", ")));
  return scene;
}

void DeviceSession::tell(const SceneRegion& region) {
  if (!region.line.empty() && region.line != told_) progress.note(region.line);
  told_ = region.line;
}

void DeviceSession::prepare(Pipeline& pipeline) {
  tell(pipeline.traits().region);
  while (true) {
    try {
      pipeline.prepare([this](const char* stage, float fraction) { return progress(stage, fraction); });
      return;
    } catch (const DeviceError& error) {
      Settings lower = settings;
      if (!sizesAreDefault_ || !lowerSizes(lower)) throw;
      progress.note(fmt::format("warning: {}; taking {} voxels and {} rays instead of {} and {}", error.what(),
                                lower.voxel.resolution, lower.matrix.gpu.rays, settings.voxel.resolution,
                                settings.matrix.gpu.rays));
      settings = lower;
    }
    device->waitIdle();  // everything that the attempt held is free from here on
    pipeline.set(settings);
  }
}

Manifest DeviceSession::manifest(std::string subcommand, const Pipeline& pipeline) const {
  return {.program = {versionNumber(), versionCommit()},
          .subcommand = std::move(subcommand),
          .device = &device->info,
          .scene = &pipeline.scene(),
          .settings = &settings,
          .cpuDevice = device->isCpu};
}

void DeviceSession::checkNumbers(const Pipeline& pipeline, std::vector<std::string> errors) {
  for (const Finding& finding : pipeline.findings())
    if (finding.severity == Finding::Severity::Error)
      errors.insert(errors.begin(), finding.text);  // the cause before its pictures
    else
      progress.note("warning: " + finding.text);
  if (!errors.empty()) throw WorkError(fmt::format("{}", fmt::join(errors, "\n")));
}

void DeviceSession::checkValidation() const {
  opened->checkValidation();
}

}  // namespace irad::app
