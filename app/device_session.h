// What every subcommand that computes needs: device, shaders, timings, context, settings, in this order.
#pragma once

#include <memory>
#include <string>

#include "app/arguments.h"
#include "app/machine.h"
#include "app/progress.h"
#include "gi/manifest.h"
#include "gi/pipeline.h"
#include "gi/region.h"
#include "renderer/frame/context.h"
#include "renderer/scene/scene.h"

namespace irad::app {

/// Loads a scene, with its sidecar, and says what is odd about it, on standard error. Where a sky is given `settings`
/// show it.
Scene loadForRun(const std::filesystem::path& path, const SceneArguments& arguments, const Config& config,
                 Settings& settings, ProgressReport& progress);

struct DeviceSession {
  /// Checks the settings first (so that mistakes are reported before a device is opened), then opens the device. Times
  /// are kept of the last `timedFrames` frames.
  DeviceSession(Machine& machine, const SettingArguments& settings, const DeviceArguments& device,
                size_t timedFrames = SIZE_MAX);
  ~DeviceSession();  ///< leaves the device to the machine
  DeviceSession(const DeviceSession&) = delete;

  Machine& machine;
  Config config;
  Timings timings;
  std::unique_ptr<OpenDevice> opened;
  const Device* device = nullptr;  ///< that which was opened
  std::unique_ptr<Context> context;
  Settings settings;
  ProgressReport progress;

  /// loadForRun
  Scene load(const std::filesystem::path& path, const SceneArguments& arguments);
  /// Says what of the scene has no voxels, or why none is left out; the same line once.
  void tell(const SceneRegion& region);
  /// Runs the pipeline up to the picture, and tells its region. Where memory does not suffice for the default sizes:
  /// says so, and takes the next smaller ones, in `settings` too.
  void prepare(Pipeline& pipeline);
  /// A manifest of this program, device, scene and settings; the subcommand adds what it made.
  Manifest manifest(std::string subcommand, const Pipeline& pipeline) const;
  /// Prints the numerical watch's warnings; WorkError with what it found wrong, and with `errors`.
  void checkNumbers(const Pipeline& pipeline, std::vector<std::string> errors = {});
  /// After --validate: WorkError with the messages, if there were any.
  void checkValidation() const;

 private:
  bool sizesAreDefault_;
  std::string told_;  ///< of the region
};

}  // namespace irad::app
