#include "app/plan_proof.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>

#include "app/bench.h"
#include "app/table.h"
#include "renderer/csv.h"
#include "renderer/error.h"

namespace irad::app {
namespace {

constexpr int kRebuilds = 3;
constexpr double kRate = 60;  // pictures per second

using Pixels = std::vector<glm::vec4>;

PictureDifference compare(const Pixels& a, const Pixels& b, float allowed) {
  IRAD_CHECK_OP(a.size(), ==, b.size());
  PictureDifference out{.allowed = allowed};
  for (size_t i = 0; i < a.size(); ++i) {
    if (std::memcmp(&a[i], &b[i], sizeof(glm::vec4)) == 0) continue;
    ++out.pixels;
    for (int c = 0; c < 4; ++c) out.largest = std::max(out.largest, std::abs(a[i][c] - b[i][c]));
  }
  return out;
}

/// A share of the largest H, as radiance: surfaces send on H / pi times a reflectance <= 1.
float allowedRadiance(const Pipeline& pipeline, float epsilon) {
  return epsilon * pipeline.lighting().report.largestH / std::numbers::pi_v<float>;
}

double gpuMedian(const Bench& bench, WorkKind kind) {
  std::vector<double> ms;
  for (const FrameSample& call : bench.frames())
    if (call.kind == kind) ms.push_back(call.gpuMs());
  return ms.empty() ? 0 : statistics(ms).p50;
}

/// One of the two sets, with what it was seen to take.
struct Side {
  std::unique_ptr<Bench> bench;
  EffectsCost cost;
};

Side open(Session& session, const Scene& scene, const Settings& settings, glm::uvec2 size, const Camera& camera) {
  Context& context = *session.context;
  context.finish();
  const uint64_t before = session.device->memory().used();
  Side side{std::make_unique<Bench>(context, scene, settings, size, VIEW_LIT, camera), {}};
  side.bench->prepare([&](const char* stage, float fraction) { return session.progress(stage, fraction); });
  side.bench->cameraFrame();
  side.bench->relight();  // pipelines are compiled, pages touched
  context.finish();
  side.cost.bytes = session.device->memory().used() - before;
  (void)context.pipelinesUsed();
  const Counters counters = context.counters();
  side.bench->relight();
  side.bench->cameraFrame();
  const Counters work = context.counters().since(counters);
  side.cost.dispatches = work.dispatches;
  side.cost.draws = work.draws;
  side.cost.instructions = specializedInstructions(context.shaders, context.pipelinesUsed());
  side.bench->forget();
  return side;
}

void finish(Side& side, bool sleeps) {
  EffectsCost& c = side.cost;
  c.rebuildMs = gpuMedian(*side.bench, WorkKind::Setup);
  c.relightMs = gpuMedian(*side.bench, WorkKind::Relight);
  c.frameMs = gpuMedian(*side.bench, WorkKind::Camera);
  // Without sleep a window relights and draws whether or not anything has changed (T 5.7's per-frame set).
  const double everything = kRate * (c.relightMs + c.frameMs);
  c.idle = sleeps ? 0 : everything;
  c.camera = sleeps ? kRate * c.frameMs : everything;
  c.light = everything;
}

/// Each effect that is off, forced on by itself.
std::vector<EffectProof> proveEffects(Session& session, Bench& bench, const Pixels& planned) {
  std::vector<EffectProof> out;
  Pipeline& pipeline = bench.pipeline();
  const EffectPlan plan = pipeline.plan();
  for (const EffectRow& row : plan.rows) {
    const std::string setting = effectInfo(row.effect).setting;
    if (row.state != EffectState::off || !setting.starts_with("effects.")) continue;
    Settings forced = session.settings;
    applySetting(forced, setting + "=on");
    pipeline.set(forced);
    pipeline.prepare();
    if (pipeline.plan().on(row.effect))
      out.push_back({row.effect, row.skip, compare(planned, bench.picture(), allowedRadiance(pipeline, row.epsilon))});
  }
  pipeline.set(session.settings);
  pipeline.prepare();
  for (EffectProof& proof : out)
    if (proof.skip == Skip::exact) proof.difference.allowed = 0;
  return out;
}

std::string describe(const PictureDifference& d) {
  if (d.pixels == 0) return "same bits";
  return d.allowed > 0 ? fmt::format("{:.2g} <= {:.2g}", d.largest, d.allowed)
                       : fmt::format("{} pixels, {:.2g}", d.pixels, d.largest);
}

std::string count(uint64_t value) {
  return std::to_string(value);
}
std::string ms(double value) {
  return fmt::format("{:.2f}", value);
}

const std::vector<std::string> kColumns{"scene",     "effects",     "difference", "rebuild ms", "relight ms",
                                        "frame ms",  "MiB",         "dispatches", "draws",      "instructions",
                                        "idle ms/s", "camera ms/s", "light ms/s"};

std::vector<std::vector<std::string>> rowsOf(const std::vector<SceneProof>& proofs) {
  std::vector<std::vector<std::string>> rows{kColumns};
  for (const SceneProof& p : proofs) {
    const auto add = [&](const char* effects, const std::string& difference, const EffectsCost& c) {
      rows.push_back({p.scene, effects, difference, ms(c.rebuildMs), ms(c.relightMs), ms(c.frameMs),
                      fmt::format("{:.1f}", static_cast<double>(c.bytes) / (1 << 20)), count(c.dispatches),
                      count(c.draws), count(c.instructions), ms(c.idle), ms(c.camera), ms(c.light)});
    };
    add("all forced on", describe(p.all), p.forced);
    add("as planned", "", p.planned);
  }
  return rows;
}

std::vector<std::vector<std::string>> effectRows(const std::vector<SceneProof>& proofs) {
  std::vector<std::vector<std::string>> rows{{"scene", "left out", "skip", "difference when forced on"}};
  for (const SceneProof& p : proofs)
    for (const EffectProof& e : p.effects)
      rows.push_back({p.scene, effectInfo(e.effect).name, EnumNames<Skip>::names.at(static_cast<size_t>(e.skip)),
                      describe(e.difference)});
  return rows;
}

std::string markdown(const std::vector<std::vector<std::string>>& rows) {
  std::string out;
  for (const std::vector<std::string>& row : rows) {
    out += fmt::format("| {} |\n", fmt::join(row, " | "));
    if (&row == &rows.front()) {
      out += '|';
      for (size_t c = 0; c < row.size(); ++c) out += "---|";
      out += '\n';
    }
  }
  return out;
}

}  // namespace

void SceneProof::require() const {
  std::vector<std::string> wrong;
  for (const EffectProof& e : effects)
    if (!e.difference.holds())
      wrong.push_back(fmt::format("{}: {} forced on: {}", scene, effectInfo(e.effect).name, describe(e.difference)));
  if (!all.holds()) wrong.push_back(fmt::format("{}: everything forced on: {}", scene, describe(all)));
  if (!wrong.empty()) throw WorkError(fmt::format("{}", fmt::join(wrong, "\n")));
}

SceneProof prove(Session& session, const std::string& name, const Scene& scene, const Camera& camera, glm::uvec2 size,
                 uint32_t frames) {
  SceneProof proof{.scene = name};
  Settings all = session.settings;
  forceEffects(all, EffectMode::on);
  all.effects.relight = EffectMode::automatic;  // at rest for the comparison; the energy counts it as never asleep
  Side planned = open(session, scene, session.settings, size, camera);
  Side forced = open(session, scene, all, size, camera);
  const std::array sides{&forced, &planned};
  for (int i = 0; i < kRebuilds; ++i)
    for (Side* side : sides) side->bench->rebuild();
  for (uint32_t i = 0; i < frames; ++i)
    for (Side* side : sides) {
      session.progress(name.c_str(), static_cast<float>(i) / static_cast<float>(frames));
      side->bench->relight();
      side->bench->cameraFrame();
    }
  finish(forced, /*sleeps=*/false);
  finish(planned, /*sleeps=*/true);
  proof.forced = forced.cost;
  proof.planned = planned.cost;

  // The pictures, each solved from the dark, of lights that were nudged alike.
  const Pixels picture = planned.bench->picture();
  float epsilon = 0;
  for (const EffectRow& row : planned.bench->pipeline().plan().rows)
    if (row.state == EffectState::off && row.skip == Skip::threshold &&
        std::string(effectInfo(row.effect).setting).starts_with("effects."))
      epsilon = std::max(epsilon, row.epsilon);
  proof.all = compare(picture, forced.bench->picture(), allowedRadiance(forced.bench->pipeline(), epsilon));
  forced.bench.reset();
  proof.effects = proveEffects(session, *planned.bench, picture);
  return proof;
}

std::string proofTable(const std::vector<SceneProof>& proofs) {
  std::vector<bool> numeric(kColumns.size(), true);
  numeric[0] = numeric[1] = numeric[2] = false;
  return formatTable(rowsOf(proofs), numeric) + "\n" + formatTable(effectRows(proofs));
}

std::string proofCsv(const std::vector<SceneProof>& proofs) {
  std::string out;
  for (std::vector<std::string> row : rowsOf(proofs)) {
    for (std::string& cell : row) cell = csvField(cell);
    out += fmt::format("{}\n", fmt::join(row, ","));
  }
  return out;
}

std::string proofMarkdown(const std::vector<SceneProof>& proofs) {
  return markdown(rowsOf(proofs)) + "\n" + markdown(effectRows(proofs));
}

}  // namespace irad::app
