// `irad writeback`: what writing reflections back does to scenes: time, writers, flicker, gain in light.
#include <fmt/format.h>

#include <memory>

#include "app/device_session.h"
#include "app/devices.h"
#include "app/table.h"
#include "gi/check/check.h"
#include "gi/check/writeback_figures.h"
#include "renderer/base/console.h"
#include "renderer/base/output_file.h"

namespace irad::app {
namespace {

struct WritebackArguments {
  std::vector<std::string> scenes;
  SceneArguments sceneOptions;
  SettingArguments settings;
  DeviceArguments device;
  PictureArguments picture;
  std::optional<std::string> csv, markdown;
};

using Cells = std::vector<std::string>;
const Cells kHeading{"scene",  "mode",    "ms",           "visible", "written_percent", "several_percent",
                     "stores", "flicker", "gain_percent", "rounds",  "settled"};

Cells cellsOf(const std::string& scene, WritebackMode mode, const WritebackFigures& f, double withoutB) {
  const bool on = mode != WritebackMode::off;
  const auto ifOn = [&](std::string text) { return on ? std::move(text) : std::string(); };
  const auto percent = [&](uint32_t facets) { return ifOn(fmt::format("{:.2f}", 100 * f.share(facets))); };
  return {scene,
          nameOf(mode),
          fmt::format("{:.3f}", f.ms),
          ifOn(std::to_string(f.report.visible())),
          percent(f.report.written()),
          percent(mode == WritebackMode::mask ? f.several() : 0),
          ifOn(std::to_string(f.report.stores)),
          fmt::format("{:.2g}", f.flicker),
          ifOn(withoutB > 0 ? fmt::format("{:+.2f}", 100 * (f.meanB / withoutB - 1)) : ""),
          ifOn(std::to_string(f.rounds.rounds)),
          ifOn(f.rounds.settled ? "yes" : "no")};
}

void run(const WritebackArguments& arguments, Machine& machine) {
  if (arguments.device.list) return printDevices(/*json=*/false);
  arguments.sceneOptions.check();
  arguments.picture.check();
  std::vector<std::string> scenes = arguments.scenes;
  if (scenes.empty()) scenes = {"box", "check:floor-flat", "check:floor-45", "check:floor-tilted"};
  const glm::uvec2 size = arguments.picture.resolveSize(arguments.settings.readConfig());
  const uint32_t frames = arguments.picture.resolveFrames({}, 60);
  DeviceSession session(machine, arguments.settings, arguments.device);
  std::vector<Cells> rows{kHeading};
  for (const std::string& name : scenes) {
    const Scene scene = session.load(findScene(name, session.config, std::nullopt), arguments.sceneOptions);
    const Camera camera = arguments.picture.resolveCameras(session.config, scene).at(0);
    double withoutB = 0;
    for (const WritebackMode mode : {WritebackMode::off, WritebackMode::mask, WritebackMode::compute}) {
      Settings settings = session.settings;
      settings.writeback.mode = mode;
      Pipeline pipeline(*session.context, scene, settings);
      session.prepare(pipeline);
      const WritebackFigures f =
          measureWriteback(*session.context, pipeline, camera, size, frames,
                           [&](const char* stage, float done) { return session.progress(stage, done); });
      if (mode == WritebackMode::off) withoutB = f.meanB;
      rows.push_back(cellsOf(name, mode, f, withoutB));
      session.checkNumbers(pipeline);
    }
    session.progress.finish();
  }
  print("{}", formatTable(rows, {false, false, true, true, true, true, true, true, true, true, false}));
  if (arguments.csv) writeFile(*arguments.csv, csvTable(rows));
  if (arguments.markdown) writeFile(*arguments.markdown, markdownTable(rows));
  session.checkValidation();
}

}  // namespace

Command writebackCommand() {
  const auto arguments = std::make_shared<WritebackArguments>();
  return {"writeback", "Measure what writing reflections back does: time, writers, flicker, gain in light",
          [arguments](Options& options) {
            options.arguments("SCENE", arguments->scenes,
                              sceneHelp() + ", or check:NAME, any number; default: box and the glossy floors");
            options.value("--csv", "FILE", arguments->csv, "Write the table as CSV");
            options.value("--markdown", "FILE", arguments->markdown, "Write the table as Markdown");
            arguments->picture.declare(options);
            arguments->sceneOptions.declare(options);
            arguments->settings.declare(options);
            arguments->device.declare(options);
          },
          [arguments](Machine& machine) { run(*arguments, machine); }};
}

}  // namespace irad::app
