// `irad plan`: which effects a scene calls for, which not, why, and what that saves.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "app/device_session.h"
#include "app/devices.h"
#include "app/plan_proof.h"
#include "app/table.h"
#include "gi/plan.h"
#include "gi/views/views.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
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

std::string mebibytes(uint64_t bytes) {
  return bytes == 0 ? "-" : fmt::format("{:.2f}", static_cast<double>(bytes) / (1 << 20));
}

/// `costs`: null where they were not measured.
void printTable(const EffectPlan& plan, const std::map<Effect, Times>* costs) {
  std::vector<std::vector<std::string>> rows{{"effect", "state", "difference", "MiB not allocated"}};
  if (costs) rows[0].insert(rows[0].end(), {"rebuild ms", "relight ms", "frame ms"});
  rows[0].push_back("reason");
  for (const EffectRow& row : plan.rows) {
    rows.push_back({row.info().name, row.stateName(),
                    row.threshold ? fmt::format("{:.2g} of {}", row.epsilon, row.of) : row.skipName(),
                    mebibytes(row.bytesNotAllocated)});
    for (size_t i = 0; costs && i < Times{}.size(); ++i)
      rows.back().push_back(costs->contains(row.effect) ? fmt::format("{:.2f}", costs->at(row.effect)[i]) : "-");
    rows.back().push_back(row.reason);
  }
  std::vector<bool> numeric(rows[0].size() - 1, true);
  std::fill_n(numeric.begin(), 3, false);
  print("{}", formatTable(rows, numeric));
  print("{} MiB not allocated in all{}\n", mebibytes(plan.bytesNotAllocated()),
        costs ? "; milliseconds that the effect would take, by the median" : "");
}

void printJson(const EffectPlan& plan, const Scene& scene, const DeviceInfo& device,
               const std::map<Effect, Times>* costs) {
  nlohmann::ordered_json out{{"scene", scene.path.string()}, {"device", device.name}};
  out["effects"] = nlohmann::ordered_json::parse(planJson(plan));
  if (costs)
    for (const auto& [effect, ms] : *costs)
      out["effects"][static_cast<size_t>(effect)]["ms_not_spent"] = {
          {"rebuild", ms[0]}, {"relight", ms[1]}, {"frame", ms[2]}};
  print("{}\n", out.dump(2));
}

void show(DeviceSession& session, const PlanArguments& arguments, const std::string& name, glm::uvec2 size,
          uint32_t frames) {
  Scene scene = session.load(findScene(name, session.config, std::nullopt), arguments.sceneOptions);
  const Camera camera = arguments.picture.resolveCameras(session.config, scene).at(0);
  Pipeline pipeline(*session.context, scene, session.settings);
  session.prepare(pipeline);
  Targets targets(*session.context, size);
  Frame frame = session.context->begin();
  pipeline.render(frame, camera, VIEW_LIT, targets);
  frame.submitAndWait();
  const EffectPlan plan = pipeline.plan();
  std::optional<std::map<Effect, Times>> costs;
  if (arguments.measure) costs = measureCosts(session, scene, plan, size, camera, frames);
  session.progress.finish();
  if (arguments.json)
    printJson(plan, scene, session.device->info, costs ? &*costs : nullptr);
  else
    printTable(plan, costs ? &*costs : nullptr);
  session.checkNumbers(pipeline);
}

void run(const PlanArguments& arguments) {
  if (arguments.device.list) return printDevices(arguments.json);
  arguments.sceneOptions.check();
  arguments.picture.check();
  if (!arguments.prove && arguments.scenes.size() > 1) throw UsageError("plan: one scene at a time, but with --prove");
  const Config early = arguments.settings.readConfig();
  const glm::uvec2 size = arguments.picture.resolveSize(early);
  const uint32_t frames = arguments.picture.resolveFrames({}, 20);
  DeviceSession session(arguments.settings, arguments.device);
  if (!arguments.prove) {
    show(session, arguments, arguments.scenes.empty() ? "box" : arguments.scenes[0], size, frames);
  } else {
    std::vector<std::string> scenes = arguments.scenes.empty() ? builtInScenes() : arguments.scenes;
    Proof proof;
    for (const std::string& name : scenes) {
      Scene scene = session.load(findScene(name, session.config, std::nullopt), arguments.sceneOptions);
      const Camera camera = arguments.picture.resolveCameras(session.config, scene).at(0);
      std::ranges::copy(prove(session, name, scene, camera, size, frames), std::back_inserter(proof));
      session.progress.finish();
    }
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
