// `irad plan`: which effects a scene calls for, which not, why, and what that saves.
#include <fmt/format.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/bench.h"
#include "app/devices.h"
#include "app/plan_proof.h"
#include "app/session.h"
#include "app/table.h"
#include "gi/views.h"
#include "renderer/error.h"
#include "renderer/output_file.h"

namespace irad::app {
namespace {

struct Arguments {
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

/// "exact", "0.002 of the largest H".
std::string skipText(const EffectRow& row) {
  return row.skip == Skip::exact ? "exact" : fmt::format("{:.2g} of {}", row.epsilon, row.of);
}

/// Milliseconds that an effect takes when it is forced on, beyond those without it.
struct Cost {
  double rebuild = 0, relight = 0, frame = 0;
};

double wallMedian(const Bench& bench, WorkKind kind) {
  for (const StageSamples& s : bench.samples())
    if (s.kind == kind && s.stage == "wall") return statistics(s.ms).p50;
  return 0;
}

/// Both sets in turn, so that what the machine does besides falls on both.
Cost measureCost(Bench& without, Bench& with, uint32_t frames) {
  constexpr int kRebuilds = 3;
  for (Bench* bench : {&without, &with}) {
    bench->relight();
    bench->cameraFrame();
    bench->forget();
  }
  for (int i = 0; i < kRebuilds; ++i)
    for (Bench* bench : {&without, &with}) bench->rebuild();
  for (uint32_t i = 0; i < frames; ++i)
    for (Bench* bench : {&without, &with}) {
      bench->relight();
      bench->cameraFrame();
    }
  const auto difference = [&](WorkKind kind) { return wallMedian(with, kind) - wallMedian(without, kind); };
  return {difference(WorkKind::Setup), difference(WorkKind::Relight), difference(WorkKind::Camera)};
}

/// Of every effect that the scene does not call for and that can be forced.
std::map<Effect, Cost> measureCosts(Session& session, const Scene& scene, const EffectPlan& plan, glm::uvec2 size,
                                    const Camera& camera, uint32_t frames) {
  std::map<Effect, Cost> costs;
  const auto bench = [&](const Settings& settings) {
    auto made = std::make_unique<Bench>(*session.context, scene, settings, size, VIEW_LIT, camera);
    made->prepare([&](const char* stage, float fraction) { return session.progress(stage, fraction); });
    return made;
  };
  for (const EffectRow& row : plan.rows) {
    const std::string setting = effectInfo(row.effect).setting;
    if (row.state != EffectState::off || !setting.starts_with("effects.")) continue;
    Settings forced = session.settings;
    applySetting(forced, setting + "=on");
    const auto without = bench(session.settings), with = bench(forced);
    if (!with->pipeline().plan().on(row.effect)) continue;  // another setting has it off
    costs[row.effect] = measureCost(*without, *with, frames);
  }
  return costs;
}

void printTable(const EffectPlan& plan, const std::map<Effect, Cost>* costs) {
  std::vector<std::vector<std::string>> rows{{"effect", "state", "difference", "MiB not allocated"}};
  if (costs) rows[0].insert(rows[0].end(), {"rebuild ms", "relight ms", "frame ms"});
  rows[0].push_back("reason");
  for (const EffectRow& row : plan.rows) {
    rows.push_back({effectInfo(row.effect).name, EnumNames<EffectState>::names.at(static_cast<size_t>(row.state)),
                    skipText(row), mebibytes(row.bytesNotAllocated)});
    if (costs) {
      const auto cost = costs->find(row.effect);
      for (const double Cost::*ms : {&Cost::rebuild, &Cost::relight, &Cost::frame})
        rows.back().push_back(cost == costs->end() ? "-" : fmt::format("{:.2f}", cost->second.*ms));
    }
    rows.back().push_back(row.reason);
  }
  std::vector<bool> numeric(rows[0].size(), false);
  for (size_t i = 3; i + 1 < numeric.size(); ++i) numeric[i] = true;
  fmt::print("{}", formatTable(rows, numeric));
  fmt::print("{} MiB not allocated in all{}\n", mebibytes(plan.bytesNotAllocated()),
             costs ? "; milliseconds that the effect would take, by the median" : "");
}

void printJson(const EffectPlan& plan, const Scene& scene, const DeviceInfo& device,
               const std::map<Effect, Cost>* costs) {
  nlohmann::ordered_json out{{"scene", scene.path.string()}, {"device", device.name}};
  out["effects"] = nlohmann::ordered_json::parse(planJson(plan));
  if (costs)
    for (auto& row : out["effects"])
      for (const auto& [effect, cost] : *costs)
        if (row["effect"].get<std::string>() == effectInfo(effect).name)
          row["ms_not_spent"] = {{"rebuild", cost.rebuild}, {"relight", cost.relight}, {"frame", cost.frame}};
  fmt::print("{}\n", out.dump(2));
}

void show(Session& session, const Arguments& arguments, const std::string& name, glm::uvec2 size, uint32_t frames) {
  Scene scene = session.load(findScene(name, session.config, std::nullopt), arguments.sceneOptions);
  const Camera camera = arguments.picture.resolveCameras(session.config, scene).at(0);
  Pipeline pipeline(*session.context, scene, session.settings);
  session.prepare(pipeline);
  Targets targets(*session.context, size);
  Frame frame = session.context->begin();
  pipeline.render(frame, camera, VIEW_LIT, targets);
  frame.submitAndWait();
  const EffectPlan plan = pipeline.plan();
  std::optional<std::map<Effect, Cost>> costs;
  if (arguments.measure) costs = measureCosts(session, scene, plan, size, camera, frames);
  session.progress.finish();
  if (arguments.json)
    printJson(plan, scene, session.device->info, costs ? &*costs : nullptr);
  else
    printTable(plan, costs ? &*costs : nullptr);
  session.checkNumbers(pipeline);
}

void run(const Arguments& arguments) {
  if (arguments.device.list) return printDevices(arguments.json);
  arguments.sceneOptions.check();
  arguments.picture.check();
  if (!arguments.prove && arguments.scenes.size() > 1) throw UsageError("plan: one scene at a time, but with --prove");
  const Config early = arguments.settings.readConfig();
  const glm::uvec2 size = arguments.picture.resolveSize(early);
  const uint32_t frames = arguments.picture.resolveFrames({}, 20);
  Session session(arguments.settings, arguments.device);
  if (!arguments.prove) {
    show(session, arguments, arguments.scenes.empty() ? "box" : arguments.scenes[0], size, frames);
  } else {
    std::vector<std::string> scenes = arguments.scenes.empty() ? builtInScenes() : arguments.scenes;
    std::vector<SceneProof> proofs;
    for (const std::string& name : scenes) {
      Scene scene = session.load(findScene(name, session.config, std::nullopt), arguments.sceneOptions);
      const Camera camera = arguments.picture.resolveCameras(session.config, scene).at(0);
      proofs.push_back(prove(session, name, scene, camera, size, frames));
      session.progress.finish();
    }
    fmt::print("{}", proofTable(proofs));
    if (arguments.csv) writeFile(*arguments.csv, proofCsv(proofs));
    if (arguments.markdown) writeFile(*arguments.markdown, proofMarkdown(proofs));
    for (const SceneProof& proof : proofs) proof.require();
  }
  session.checkValidation();
}

}  // namespace

Command planCommand() {
  const auto arguments = std::make_shared<Arguments>();
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
