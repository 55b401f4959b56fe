// `irad view`: the interactive window.
#if IRAD_UI
#include <fmt/format.h>

#include <array>
#include <memory>

#include "app/arguments.h"
#include "app/command.h"
#include "app/devices.h"
#include "app/machine.h"
#include "app/reference.h"
#include "app/version.h"
#include "app/view_command.h"
#include "gi/config.h"
#include "renderer/base/error.h"
#include "renderer/base/timings.h"
#include "renderer/frame/context.h"
#include "renderer/shaders.h"
#include "ui/preferences.h"

namespace irad::app {
namespace fs = std::filesystem;
namespace {

struct ViewArguments {
  SceneArguments sceneOptions;
  SettingArguments settings;
  DeviceArguments device;
  ReferenceArgument reference;
  std::optional<std::string> scene, size, view, camera, inspect, scale, captures, shaders, exitAfter, screenshot,
      controls;

  void declare(Options& options) {
    options.argument("SCENE", scene, sceneHelp() + "; default: box");
    options.value("--view", "NAME", view,
                  "View to begin with (default: the manifest's first, or lit; 'irad views' lists them)");
    options.value("--camera", "NAME", camera,
                  "Camera of the scene to begin with (default: the manifest's first, or the scene's)");
    options.value("--inspect", "X,Y,Z", inspect, "Voxel to begin with in the inspector");
    options.value("--size", "WxH", size, "Size of the window (default: 1280x720)");
    options.value("--scale", "FACTOR", scale, "Size of text and panels, times the monitor's own (default: 1)");
    options.value("--out", "DIR", captures, "Where F12 saves (default: out/captures)");
    options.value("--shaders", "DIR", shaders, "Sources that F5 compiles (default: those the program was built from)");
    options.value("--exit-after", "FRAMES", exitAfter,
                  "End after so many frames in which nothing was left to do (for tests)");
    options.value(
        "--screenshot", "FILE", screenshot,
        "Write the whole window as PNG once nothing is left to do, and end (with --exit-after: when that ends it)");
    options.value("--controls", "FILE", controls,
                  "Written with every frame: names and places of all controls (for tests)");
    reference.declare(options);
    sceneOptions.declare(options);
    settings.declare(options);
    device.declare(options);
  }
};

constexpr size_t kTimedFrames = 3000;       ///< that the timing table remembers
constexpr uint32_t kScreenshotFrames = 10;  ///< in which the panels take their sizes, once nothing is left to do

float parseScale(const std::string& text) {
  char* end = nullptr;
  const float value = std::strtof(text.c_str(), &end);
  if (end == text.c_str() || *end || !(value >= 0.5f && value <= 4.0f))
    throw UsageError(fmt::format("--scale: '{}' is not a number from 0.5 to 4", text));
  return value;
}

/// The shader sources beside the program's build folder or in the current one, for F5; empty where there are none.
std::filesystem::path findShaders(const Machine& machine) {
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::canonical(machine.program, ignored);
  const std::array candidates{program.parent_path().parent_path() / "shaders", std::filesystem::path("shaders")};
  for (const std::filesystem::path& folder : candidates)
    if (std::filesystem::exists(folder / "shared" / "types.h", ignored)) return folder;
  return {};
}

void run(const ViewArguments& arguments, Machine& machine) {
  if (arguments.device.list) return printDevices(/*json=*/false);
  const Config config = arguments.settings.readConfig();
  arguments.sceneOptions.check();
  WindowOptions options;
  options.program = {versionNumber(), versionCommit()};
  options.scene = findScene(arguments.scene, config, "box");
  options.builtIn = builtInFolders();
  options.exposes =
      !arguments.settings.names(config, "camera.exposure") && !arguments.settings.names(config, "camera.auto_exposure");
  if (arguments.view)
    options.view = findViews({*arguments.view}).front().view;
  else if (!config.views.empty())
    options.view = findViews(config.views).front().view;
  if (!config.cameras.empty()) options.start = config.cameras.front();
  if (arguments.inspect) options.inspect = parseVoxel("--inspect", *arguments.inspect);
  if (arguments.size) options.size = parseSize(*arguments.size);
  if (arguments.scale) options.scale = parseScale(*arguments.scale);
  if (arguments.camera) options.camera = *arguments.camera;
  if (arguments.captures) options.captures = *arguments.captures;
  if (arguments.exitAfter)
    options.exitAfter = static_cast<uint32_t>(parseInteger("--exit-after", *arguments.exitAfter, 1, 1'000'000));
  if (arguments.screenshot) {
    options.screenshot = *arguments.screenshot;
    if (!arguments.exitAfter) options.exitAfter = kScreenshotFrames;
  }
  if (arguments.controls) options.controls = fs::absolute(*arguments.controls);
  if (options.exitAfter == 0) options.preferences = preferencesFile();
  ProgressReport notes;
  if (auto reference = arguments.reference.read(config, notes)) options.reference = std::move(reference);
  options.presets = Presets(
      options.preferences.empty() ? fs::path() : options.preferences.parent_path() / "presets",
      [](Settings& settings, const fs::path& file) { settingsFromJson(settings, *readConfigFile(file).settings); });
  options.shaders = arguments.shaders ? std::filesystem::path(*arguments.shaders) : findShaders(machine);

  openWindow(machine, std::move(options), config, arguments.settings, arguments.sceneOptions, arguments.device);
}

}  // namespace

void openWindow(Machine& machine, WindowOptions options, const Config& config, const SettingArguments& settings,
                const SceneArguments& scene, const DeviceArguments& device) {
  (void)settings.resolve(config, /*cpuDevice=*/true);  // mistakes are reported before a device is opened
  DeviceOptions deviceOptions = device.options();
  deviceOptions.presentable = true;
  std::unique_ptr<OpenDevice> opened = machine.open(deviceOptions);
  Timings timings(kTimedFrames);
  options.settings = settings.resolve(config, opened->device->isCpu);
  options.defaults = defaultSettings(opened->device->isCpu);
  options.load = scene.load(config, options.settings);
  useSky(options.settings, options.load);
  runWindow(*opened->makeContext(timings), options);
  opened->checkValidation();
  machine.leave(std::move(opened));
}

Command viewCommand() {
  const auto arguments = std::make_shared<ViewArguments>();
  return {"view", "Open a scene in the interactive window",
          [arguments](Options& options) { arguments->declare(options); },
          [arguments](Machine& machine) { run(*arguments, machine); }};
}

}  // namespace irad::app
#endif
