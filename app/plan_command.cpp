// `irad plan`: which effects a scene calls for, which not, why, and what that saves; its tables, JSON and CSV.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "app/device_session.h"
#include "app/devices.h"
#include "app/plan_proof.h"
#include "app/table.h"
#include "gi/plan.h"
#include "gi/views/views.h"
#include "renderer/base/console.h"
#include "renderer/base/csv.h"
#include "renderer/base/error.h"
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

using Costs = std::optional<std::map<Effect, Times>>;  ///< where they were measured
using Cells = std::vector<std::string>;

std::string mebibyteCell(uint64_t bytes) {
  return bytes == 0 ? "-" : fmt::format("{:.2f}", inMebibytes(bytes));
}

void printTable(const EffectPlan& plan, const Costs& costs) {
  std::vector<Cells> rows{{"effect", "state", "difference", "MiB not allocated"}};
  if (costs) rows[0].insert(rows[0].end(), {"rebuild ms", "relight ms", "frame ms"});
  rows[0].push_back("reason");
  for (const EffectRow& row : plan.rows) {
    rows.push_back({row.info().name, row.stateName(),
                    row.threshold ? fmt::format("{:.2g} of {}", row.epsilon, row.of) : row.skipName(),
                    mebibyteCell(row.bytesNotAllocated)});
    for (size_t i = 0; costs && i < Times{}.size(); ++i)
      rows.back().push_back(costs->contains(row.effect) ? fmt::format("{:.2f}", costs->at(row.effect)[i]) : "-");
    rows.back().push_back(row.reason);
  }
  std::vector<bool> numeric(rows[0].size() - 1, true);
  std::fill_n(numeric.begin(), 3, false);
  print("{}", formatTable(rows, numeric));
  print("{} MiB not allocated in all{}\n", mebibyteCell(plan.bytesNotAllocated()),
        costs ? "; milliseconds that the effect would take, by the median" : "");
}

void printJson(const EffectPlan& plan, const Scene& scene, const DeviceInfo& device, const Costs& costs) {
  nlohmann::ordered_json out{{"scene", scene.path.string()}, {"device", device.name}};
  out["effects"] = nlohmann::ordered_json::parse(planJson(plan));
  if (costs)
    for (const auto& [effect, ms] : *costs)
      out["effects"][static_cast<size_t>(effect)]["ms_not_spent"] = {
          {"rebuild", ms[0]}, {"relight", ms[1]}, {"frame", ms[2]}};
  print("{}\n", out.dump(2));
}

/// The first `words` columns to the left, the others, numbers, to the right.
std::string table(const std::vector<Cells>& rows, size_t words, bool markdown) {
  std::vector<bool> numeric(words, false);
  numeric.resize(rows[0].size(), true);
  if (!markdown) return formatTable(rows, numeric);
  std::string out;
  for (const Cells& row : rows) {
    out += fmt::format("| {} |\n", fmt::join(row, " | "));
    if (&row == &rows.front()) out += fmt::format("|{}\n", fmt::join(Cells(row.size(), "---|"), ""));
  }
  return out;
}

std::string proofTables(const Proof& proof, bool markdown) {
  std::vector<Cells> cost{{"scene", "effects", "difference"}}, energy{{"scene", "effects"}},
      effects{{"scene", "not on", "state", "skip", "difference when done", "MiB not allocated"}};
  const auto tableOf = [&](size_t figure) -> auto& {
    return figure < kCostFigures ? cost : energy;
  };
  for (size_t i = 0; i < std::size(kFigures); ++i) tableOf(i)[0].push_back(kFigures[i].heading);
  for (const ProofRow& row : proof) {
    std::string difference = row.difference ? row.difference->text() : "";
    if (const auto& effect = row.effect) {
      if (!row.difference) difference = "not done: " + row.reason;
      effects.push_back({row.scene, row.name, effect->stateName(), effect->skipName(), difference,
                         mebibyteCell(effect->bytesNotAllocated)});
      continue;
    }
    cost.push_back({row.scene, row.name, difference});
    energy.push_back({row.scene, row.name});
    for (size_t i = 0; i < row.figures.size(); ++i)
      tableOf(i).back().push_back(row.figures[i] ? fmt::format("{:.{}f}", *row.figures[i], kFigures[i].decimals) : "-");
  }
  return table(cost, 3, markdown) + "\n" + table(energy, 2, markdown) + "\n" + table(effects, 5, markdown);
}

std::string proofCsv(const Proof& proof) {
  std::string header, lines;
  for (const ProofRow& row : proof) {
    Cells columns, cells;  // those that do not apply to a row are empty
    const auto cell = [&](const char* column, bool applies, const auto& value) {
      columns.push_back(column);
      cells.push_back(applies ? csvField(fmt::format("{}", value)) : "");
    };
    const bool isEffect = row.effect.has_value(), compared = row.difference.has_value();
    const EffectRow effect = row.effect.value_or(EffectRow{});
    const PictureDifference difference = row.difference.value_or(PictureDifference{});
    cell("scene", true, row.scene);
    cell("effect", true, row.name);
    cell("state", isEffect, effect.stateName());
    cell("reason", isEffect, effect.reason);
    cell("skip", isEffect, effect.skipName());
    cell("epsilon", effect.threshold, effect.epsilon);
    cell("pixels_different", compared, difference.pixels);
    cell("largest_difference", compared, difference.largest);
    cell("mean_difference", compared, difference.mean);
    cell("allowed_difference", compared, difference.allowed);
    cell("not_proven", true, row.reason);
    cell("mib_not_allocated", isEffect, fmt::format("{:.3f}", inMebibytes(effect.bytesNotAllocated)));
    for (size_t i = 0; i < std::size(kFigures); ++i) {
      const auto figure = i < row.figures.size() ? row.figures[i] : std::nullopt;
      cell(kFigures[i].column, figure.has_value(), fmt::format("{:.{}f}", figure.value_or(0), kFigures[i].csvDecimals));
    }
    header = fmt::format("{}\n", fmt::join(columns, ","));
    lines += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return header + lines;
}

void show(const Subject& subject, const PlanArguments& arguments) {
  DeviceSession& session = subject.session;
  Pipeline pipeline(*session.context, subject.scene, session.settings);
  session.prepare(pipeline);
  Targets targets(*session.context, subject.size);
  Frame frame = session.context->begin();
  pipeline.render(frame, subject.camera, VIEW_LIT, targets);
  frame.submitAndWait();
  const EffectPlan plan = pipeline.plan();
  Costs costs;
  if (arguments.measure) costs = measureCosts(subject, plan);
  session.progress.finish();
  if (arguments.json)
    printJson(plan, subject.scene, session.device->info, costs);
  else
    printTable(plan, costs);
  session.checkNumbers(pipeline);
}

void run(const PlanArguments& arguments) {
  if (arguments.device.list) return printDevices(arguments.json);
  arguments.sceneOptions.check();
  arguments.picture.check();
  std::vector<std::string> scenes = arguments.scenes;
  if (!arguments.prove && scenes.size() > 1) throw UsageError("plan: one scene at a time, but with --prove");
  if (scenes.empty()) scenes = arguments.prove ? builtInScenes() : std::vector<std::string>{"box"};
  const glm::uvec2 size = arguments.picture.resolveSize(arguments.settings.readConfig());
  const uint32_t frames = arguments.picture.resolveFrames({}, 20);
  DeviceSession session(arguments.settings, arguments.device);
  Proof proof;
  for (const std::string& name : scenes) {
    Scene scene = session.load(findScene(name, session.config, std::nullopt), arguments.sceneOptions);
    const Camera camera = arguments.picture.resolveCameras(session.config, scene).at(0);
    const Subject subject{session, name, std::move(scene), camera, size, frames};
    if (!arguments.prove) {
      show(subject, arguments);
      continue;
    }
    std::ranges::copy(prove(subject), std::back_inserter(proof));
    session.progress.finish();
  }
  if (arguments.prove) {
    print("{}", proofTables(proof, /*markdown=*/false));
    if (arguments.csv) writeFile(*arguments.csv, proofCsv(proof));
    if (arguments.markdown) writeFile(*arguments.markdown, proofTables(proof, /*markdown=*/true));
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
                              "A .gltf or .glb file, a built-in scene or check:NAME (default: box; with --prove any "
                              "number, default: every built-in one)");
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
          [arguments] { run(*arguments); }};
}

}  // namespace irad::app
