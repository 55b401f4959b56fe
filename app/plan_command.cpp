// `irad plan`: which effects a scene calls for, which not, why, and what that saves; its tables, JSON and CSV.
#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/device_session.h"
#include "app/devices.h"
#include "app/plan_proof.h"
#include "app/table.h"
#include "gi/plan.h"
#include "gi/views/views.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/number_text.h"
#include "renderer/base/output_file.h"

namespace irad::app {
namespace {

struct PlanArguments {
  std::vector<std::string> scenes;
  SceneArguments sceneOptions;
  SettingArguments settings;
  DeviceArguments device;
  PictureArguments picture;
  std::optional<std::string> csv, markdown;
  bool json = false, measure = false, prove = false;
};

using Cells = std::vector<std::string>;
constexpr const char *kTimes = "rebuild_ms relight_ms frame_ms", *kWork = "mib dispatches draws instructions",
                     *kEnergy =
                         "idle_ms_per_s idle_dispatches_per_s idle_draws_per_s "
                         "camera_ms_per_s camera_dispatches_per_s camera_draws_per_s "
                         "light_ms_per_s light_dispatches_per_s light_draws_per_s",
                     *kProven =
                         "scene effect state reason skip epsilon pixels_different largest_difference "
                         "mean_difference allowed_difference not_proven mib_not_allocated";

/// A whole number, or three decimals.
std::string numberText(double value) {
  return fmt::format("{:.{}f}", value, value == std::round(value) ? 0 : 3);
}

/// What applies to the row, by the names of columns.
std::map<std::string, std::string> cellsOf(const ProofRow& row) {
  std::map<std::string, std::string> cells{{"scene", row.scene}, {"effect", row.name}, {"not_proven", row.reason}};
  for (const auto& [name, value] : row.figures) cells[name] = numberText(value);
  if (const auto& effect = row.effect) {
    cells["state"] = effect->stateName();
    cells["reason"] = effect->reason;
    cells["skip"] = effect->skipName();
    if (effect->epsilon > 0)
      cells.insert({{"epsilon", fmt::format("{}", effect->epsilon)}, {"epsilon_of", effect->of}});
    cells["mib_not_allocated"] = numberText(inMebibytes(effect->bytesNotAllocated));
  }
  if (const auto& difference = row.difference) {
    cells["difference"] = difference->text();
    cells["pixels_different"] = fmt::format("{}", difference->pixels);
    cells["largest_difference"] = fmt::format("{}", difference->largest);
    cells["mean_difference"] = fmt::format("{}", difference->mean);
    cells["allowed_difference"] = fmt::format("{}", difference->allowed);
  }
  return cells;
}

/// Rows of cells, the first the names of columns. `effects`: of effects, or of sets; none: all.
std::vector<Cells> table(const Proof& proof, const std::string& names, std::optional<bool> effects = {}) {
  std::istringstream in(names);
  const Cells columns{std::istream_iterator<std::string>(in), {}};
  std::vector<Cells> rows{columns};
  for (const ProofRow& row : proof) {
    if (effects.value_or(row.effect.has_value()) != row.effect.has_value()) continue;
    auto cells = cellsOf(row);
    Cells& line = rows.emplace_back();
    for (const std::string& column : columns) line.push_back(cells[column]);
  }
  return rows;
}

/// Numbers to the right.
std::string aligned(const std::vector<Cells>& rows) {
  std::vector<bool> numeric;
  for (const std::string& cell : rows.back())
    numeric.push_back(cell.find_first_not_of("0123456789.-") == std::string::npos);
  return formatTable(rows, numeric);
}

template <class Format>
std::string proofTables(const Proof& proof, Format format) {
  return fmt::format("{}\n{}\n{}",
                     format(table(proof, fmt::format("scene effect difference {} {}", kTimes, kWork), false)),
                     format(table(proof, fmt::format("scene effect {}", kEnergy), false)),
                     format(table(proof, "scene effect state skip difference not_proven mib_not_allocated", true)));
}

void printJson(const Proof& rows, const EffectPlan& plan, const Scene& scene, const DeviceInfo& device) {
  nlohmann::ordered_json out{{"scene", scene.path.string()}, {"device", device.name}};
  out["effects"] = nlohmann::ordered_json::parse(planJson(plan));
  if (!plan.nothingDiffuse.empty()) out["nothing_diffuse"] = plan.nothingDiffuse;
  for (size_t i = 0; i < rows.size(); ++i)
    for (const auto& [name, ms] : rows[i].figures)
      out["effects"][i]["ms_not_spent"][name.substr(0, name.find('_'))] = ms;
  print("{}\n", jsonText(out, 2));
}

void show(const Subject& subject, const PlanArguments& arguments) {
  DeviceSession& session = subject.session;
  Bench bench(*session.context, subject.scene, session.settings, subject.size, VIEW_LIT, subject.camera);
  session.prepare(bench.pipeline());
  bench.cameraFrame();
  const EffectPlan plan = bench.pipeline().plan();
  const Proof rows = rowsOf(subject, bench, arguments.measure);
  session.progress.finish();
  if (arguments.json) {
    printJson(rows, plan, subject.scene, session.device->info);
  } else {
    constexpr const char* kColumns = "effect state skip epsilon epsilon_of mib_not_allocated {} reason";
    print("{}", aligned(table(rows, fmt::format(kColumns, arguments.measure ? kTimes : ""))));
    for (const std::string& line : plan.nothingDiffuse) print("{}\n", line);
    print("{} MiB not allocated in all{}\n", numberText(inMebibytes(plan.bytesNotAllocated())),
          arguments.measure ? "; milliseconds that the effect would take, by the median" : "");
  }
  session.checkNumbers(bench.pipeline());
}

void run(const PlanArguments& arguments, Machine& machine) {
  if (arguments.device.list) return printDevices(arguments.json);
  arguments.sceneOptions.check();
  arguments.picture.check();
  std::vector<std::string> scenes = arguments.scenes;
  if (!arguments.prove && scenes.size() > 1) throw UsageError("plan: one scene at a time, but with --prove");
  if (scenes.empty()) scenes = arguments.prove ? builtInScenes() : std::vector<std::string>{"box"};
  const glm::uvec2 size = arguments.picture.resolveSize(arguments.settings.readConfig());
  const uint32_t frames = arguments.picture.resolveFrames({}, 20);
  DeviceSession session(machine, arguments.settings, arguments.device);
  Proof proof;
  for (const std::string& name : scenes) {
    Scene scene = session.load(findScene(name, session.config, std::nullopt), arguments.sceneOptions);
    const Camera camera = arguments.picture.resolveCameras(session.config, scene).at(0);
    const Subject subject{session, name, std::move(scene), camera, size, frames};
    if (!arguments.prove) {
      show(subject, arguments);
      continue;
    }
    session.tell(regionOrWhole(subject.scene, session.settings));
    std::ranges::copy(prove(subject), std::back_inserter(proof));
    session.progress.finish();
  }
  if (arguments.prove) {
    print("{}", proofTables(proof, aligned));
    const std::string all = fmt::format("{} {} {} {}", kProven, kTimes, kWork, kEnergy);
    if (arguments.csv) writeFile(*arguments.csv, csvTable(table(proof, all)));
    if (arguments.markdown) writeFile(*arguments.markdown, proofTables(proof, markdownTable));
    require(proof);
  }
  session.checkValidation();
}

}  // namespace

Command planCommand() {
  const auto arguments = std::make_shared<PlanArguments>();
  return {"plan", "Show which effects a scene calls for, why, and what leaving the others out saves",
          [arguments](Options& options) {
            options.arguments("SCENE", arguments->scenes,
                              sceneHelp() +
                                  ", or check:NAME; default: box; with --prove any number, default: every "
                                  "built-in one");
            options.flag("--json", arguments->json, "The table as JSON");
            options.flag("--measure", arguments->measure,
                         "Measure what each effect that is off would take: forced on and off in turn");
            options.flag("--prove", arguments->prove,
                         "Render with everything forced on and with what is called for alone: differences of the "
                         "pictures, time, memory, work");
            options.value("--csv", "FILE", arguments->csv, "With --prove: write the figures as CSV");
            options.value("--markdown", "FILE", arguments->markdown, "With --prove: write the figures as a table");
            arguments->picture.declare(options);
            arguments->sceneOptions.declare(options);
            arguments->settings.declare(options);
            arguments->device.declare(options);
          },
          [arguments](Machine& machine) { run(*arguments, machine); }};
}

}  // namespace irad::app
