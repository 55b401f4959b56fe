// The same answer over time, under toggled settings, in poisoned memory, in another process.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <numeric>

#include "gi/check/cases.h"
#include "gi/check/process.h"
#include "gi/check/scenes.h"
#include "gi/lighting.h"
#include "renderer/base/error.h"
#include "renderer/base/output_file.h"
#include "renderer/base/temporary_folder.h"
#include "renderer/frame/frame.h"
#include "renderer/targets.h"

namespace irad {
namespace {

namespace fs = std::filesystem;

constexpr glm::uvec2 kStabilityPicture(64, 64);

/// Memory that is the process's own, without mapped files, MiB: a driver's devices are among these (one maps 4 MiB
/// more, once, after some thousands of submissions).
double resident() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word && word != "RssAnon:") {
  }
  uint64_t kib = 0;
  status >> kib;
  IRAD_CHECK(status.good(), "/proc/self/status ends at \"{}\"", word);
  return static_cast<double>(kib) / 1024;
}

/// Device memory taken since `before`, bytes.
double grown(const CheckRun& run, uint64_t before) {
  return static_cast<double>(run.context.device.memory().used()) - static_cast<double>(before);
}

/// How many steps between neighbouring floats lie between two numbers.
uint64_t ulps(float a, float b) {
  const auto ordered = [](float x) {
    const auto bits = std::bit_cast<int32_t>(x);
    return int64_t{bits < 0 ? std::numeric_limits<int32_t>::min() - bits : bits};
  };
  return static_cast<uint64_t>(std::abs(ordered(a) - ordered(b)));
}

void soakCase(CheckRun& run) {
  const uint32_t frames = run.options.quick ? 200 : 10000, settled = frames / 5;
  const auto pipeline = run.prepare(mixedRoom(), run.small());
  Targets targets(run.context, kStabilityPicture);
  std::vector<glm::vec3> before;
  uint64_t deviceBefore = 0;
  double memory[3] = {};  // of the process: when it has settled, half-way from there, at the end
  for (uint32_t i = 0; i < frames; ++i) {
    if (i == settled) {
      before = run.read(*pipeline, pipeline->lighting().indirect);
      deviceBefore = run.context.device.memory().used();
      memory[0] = resident();
    }
    if (i == settled + (frames - settled) / 2) memory[1] = resident();
    pipeline->lightsChanged();  // the same light again: gather, warm start, scatter
    pipeline->prepare();
    Frame frame = run.context.begin(i);
    pipeline->render(frame, pipeline->scene().cameras.at(0), VIEW_LIT, targets);
    frame.submitAndWait();
  }
  const std::vector<glm::vec3> after = run.read(*pipeline, pipeline->lighting().indirect);
  uint64_t drift = 0;
  for (size_t i = 0; i < after.size(); ++i)
    for (int c = 0; c < 3; ++c) drift = std::max(drift, ulps(before[i][c], after[i][c]));
  run.info("frames", frames);
  run.atMost("drift of H, ulp", static_cast<double>(drift), 2);
  run.near("growth of device memory, B", grown(run, deviceBefore), 0, 0);
  memory[2] = resident();
  // What leaks with every frame grows in both halves; a heap or a driver's compiler that takes pages once, in one.
  const double leak = std::min(memory[1] - memory[0], memory[2] - memory[1]);
  run.atMost("growth of the process in the steadier half, MiB", std::max(leak, 0.0), .5);
  run.none("H not finite", countNonFinite(after));
}

/// Another value for a setting: the next of its choices, or a cheap one well inside its range.
void toggle(const Setting& setting, Settings& settings) {
  const double value = setting.get(settings);
  const SettingRange& range = setting.range;
  switch (setting.kind) {
    case SettingKind::integer: {
      const double half = std::floor(value / 2);
      return setting.set(settings, half >= range.min ? half : value + std::max(range.step, 1.0));
    }
    case SettingKind::number: {
      const bool halves = value > 0 && value * 0.5 >= static_cast<float>(range.min);
      return setting.set(settings, halves ? value * 0.5 : 0.5 * (range.min + range.max));
    }
    case SettingKind::toggle:
      return setting.set(settings, 1 - value);
    case SettingKind::choice:
      return setting.set(settings, std::fmod(value + 1, static_cast<double>(setting.choices.size())));
  }
}

void toggleCase(CheckRun& run) {
  Settings settings = run.small();
  if (run.options.quick) settings.voxel.resolution = 16, settings.matrix.gpu.rays = 32;
  const auto pipeline = run.prepare(mixedRoom(), settings);
  const auto shot = [&] {
    return run.picture(*pipeline, pipeline->scene().cameras.at(0), VIEW_LIT, kStabilityPicture);
  };
  const CheckPicture untoggled = shot();
  uint64_t count = 0, bad = 0;
  const auto round = [&] {
    for (const Setting& setting : settingTable()) {
      Settings changed = settings;
      toggle(setting, changed);
      // What is the thesis's alone comes with its hit rule.
      if (changed.voxel.method == VoxelMethod::raster || changed.matrix.format == MatrixFormat::padded ||
          changed.thesis.literal)
        changed.matrix.gpu.hitRule = HitRule::thesis;
      pipeline->set(changed);
      pipeline->prepare();
      bad += countNonFinite(shot());
      ++count;
    }
    pipeline->set(settings);
    pipeline->prepare();
  };
  round();
  // A fresh start, so that both solvers begin from the same light.
  const CheckPicture warm = shot();
  const uint64_t used = run.context.device.memory().used();
  round();
  const CheckPicture end = shot();
  double worst = 0, largest = 0;
  for (size_t i = 0; i < end.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      worst = std::max(worst, std::abs(double{end.pixels[i][c]} - untoggled.pixels[i][c]));
      largest = std::max(largest, double{untoggled.pixels[i][c]});
    }
  run.info("settings toggled", static_cast<double>(count));
  run.none("pixels not finite while toggling", bad);
  run.atMost("largest difference to the untoggled picture / its largest value", worst / largest, 1e-5);
  run.none("pixels that a second round changes", countDiffering(warm, end));
  run.near("growth of device memory, B", grown(run, used), 0, 0);
}

void poisonCase(CheckRun& run) {
  std::vector<CheckPicture> pictures[2];
  std::vector<glm::vec3> light[2];
  for (const bool poison : {false, true}) {
    DeviceOptions options = run.sameDevice();
    options.poison = poison;
    Apart apart(options);
    CheckRun there(apart.context, run.settings, run.options);
    const auto pipeline = there.prepare(mixedRoom(), run.small());
    light[poison] = there.read(*pipeline, pipeline->lighting().indirect);
    for (const ViewInfo& view : views())
      pictures[poison].push_back(
          there.picture(*pipeline, pipeline->scene().cameras.at(0), view.view, kStabilityPicture));
  }
  uint64_t pixels = 0, facets = 0;
  for (size_t v = 0; v < pictures[0].size(); ++v) pixels += countDiffering(pictures[0][v], pictures[1][v]);
  for (size_t i = 0; i < light[0].size(); ++i) facets += light[0][i] != light[1][i];
  run.none("pixels that poison changes, all views", pixels);
  run.none("facets whose H poison changes", facets);
}

/// A table's text without its times: everything but numbers with a fraction.
std::string withoutTimes(const std::string& csv) {
  std::string out;
  for (size_t i = 0; i < csv.size(); ++i) {
    size_t end = i;
    while (end < csv.size() && (std::isdigit(static_cast<unsigned char>(csv[end])) || csv[end] == '.')) ++end;
    if (csv.substr(i, end - i).find('.') == std::string::npos) out += csv.substr(i, std::max<size_t>(end - i, 1));
    i = std::max(end, i + 1) - 1;
  }
  return out;
}

void repeatCase(CheckRun& run) {
  if (run.options.program.empty()) throw WorkError("needs the program to run it twice");
  const TemporaryFolder folder;
  for (const char* name : {"a", "b"}) {
    const auto call = [&](std::vector<std::string> arguments) {
      arguments.insert(arguments.end(), {"--out", (folder.path / name).string(), "--device",
                                         std::to_string(run.context.device.info.index), "--set", "voxel.resolution=32",
                                         "--set", "matrix.rays=128"});
      if (const int status = Process(run.options.program, arguments).wait(); status != 0)
        throw WorkError(fmt::format("irad {} {} ended with status {}", arguments[0], arguments[1], status));
    };
    call({"render", "check:repeat", "--view", "lit,irradiance,specular", "--size", "96x96"});
    call({"export", "check:repeat", "--matrix", "--facets", "--volume", "radiosity"});
  }
  uint64_t files = 0, differing = 0;
  for (const auto& entry : fs::directory_iterator(folder.path / "a")) {
    const fs::path name = entry.path().filename();
    if (name == "manifest.json") continue;  // names its folder
    const bool times = name == "timings.csv";
    const std::string a = readFile(entry.path()), b = readFile(folder.path / "b" / name);
    differing += times ? withoutTimes(a) != withoutTimes(b) : a != b;
    ++files;
  }
  run.info("files of two processes compared", static_cast<double>(files));
  run.none("files that differ", differing);
  run.atLeast("files compared", static_cast<double>(files), 15, /*ideal=*/18);
}

}  // namespace

std::vector<CheckCase> stabilityCases() {
  std::vector<CheckCase> cases{
      {"soak", "10,000 frames, warm start, relit in each", "fixed point, memory flat", "<= 2 ulp", soakCase, mixedRoom},
      {"toggle", "every setting toggled in a frame of its own, twice", "the untoggled picture", "1e-5, no growth",
       toggleCase, mixedRoom},
      {"poison", "all fresh memory filled with NaN", "the same pictures", "bits equal", poisonCase, mixedRoom},
      {"repeat", "two processes", "the same files, but for times", "exact", repeatCase, mixedRoom},
  };
  cases[0].soak = cases[1].soak = true;
  return cases;
}

}  // namespace irad
