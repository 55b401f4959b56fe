#include "app/plan_proof.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>

#include "renderer/error.h"

namespace irad::app {
namespace {

constexpr int kRebuilds = 3;

using Pixels = std::vector<glm::vec4>;

PictureDifference compare(const Pixels& a, const Pixels& b, float allowed) {
  IRAD_CHECK_OP(a.size(), ==, b.size());
  PictureDifference out{.allowed = allowed};
  const auto mean = [](const Pixels& pixels) {
    double sum = 0;
    for (const glm::vec4& p : pixels) sum += double{p.x} + p.y + p.z;
    return sum / (3.0 * static_cast<double>(pixels.size()));
  };
  if (mean(a) > 0) out.mean = static_cast<float>(std::abs(mean(b) - mean(a)) / mean(a));
  for (size_t i = 0; i < a.size(); ++i) {
    if (std::memcmp(&a[i], &b[i], sizeof(glm::vec4)) == 0) continue;
    ++out.pixels;
    for (int c = 0; c < 4; ++c) out.largest = std::max(out.largest, std::abs(a[i][c] - b[i][c]));
  }
  return out;
}

/// What a row's skip leaves within, as radiance: a share of the largest H, of which surfaces send on H / pi times a
/// reflectance <= 1.
float allowedRadiance(const Pipeline& pipeline, const EffectRow& row) {
  if (row.skip == Skip::exact) return 0;
  return row.epsilon * pipeline.lighting().report.largestH / std::numbers::pi_v<float>;
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

void takeMedians(Side& side) {
  side.cost.rebuildMs = gpuMedian(*side.bench, WorkKind::Setup);
  side.cost.relightMs = gpuMedian(*side.bench, WorkKind::Relight);
  side.cost.frameMs = gpuMedian(*side.bench, WorkKind::Camera);
}

/// `everything`: nothing sleeps, every tick relights and draws (T 5.7's per-frame set).
void measureEnergy(Side& side, size_t moving, uint32_t ticks, bool everything) {
  Bench& bench = *side.bench;
  if (kMovings[moving] == Moving::Lights && bench.pipeline().scene().lights.empty()) return;
  const Settings settings = bench.pipeline().settings();
  if (everything) {
    Settings restless = settings;
    restless.effects.relight = EffectMode::on;
    bench.pipeline().set(restless);
  }
  const TickWork work = bench.ticks(kMovings[moving], ticks, everything);
  const double perSecond = kTickRate / ticks;
  side.cost.energy[moving] = Energy{.gpuMs = perSecond * work.gpuMs,
                                    .dispatches = perSecond * static_cast<double>(work.dispatches),
                                    .draws = perSecond * static_cast<double>(work.draws)};
  bench.pipeline().set(settings);
  bench.pipeline().prepare();
}

/// Does what the plan has not on, where anything can put it on.
EffectProof proveEffect(const Settings& settings, Bench& bench, const EffectRow& row, const Pixels& planned) {
  EffectProof proof{.row = row, .difference = {}, .reason = {}};
  Pipeline& pipeline = bench.pipeline();
  if (row.effect == Effect::redraw) {
    const Pixels drawn = bench.pictureAsLit();
    proof.difference = compare(drawn, bench.pictureAsLit(), 0);
    return proof;
  }
  if (row.effect == Effect::rebuild) {
    bench.rebuild();
    proof.difference = compare(planned, bench.picture(), 0);
    return proof;
  }
  const std::string setting = effectInfo(row.effect).setting;
  if (settingValue(settings, setting) == "off") {
    proof.reason = fmt::format("{} = off", setting);
    return proof;
  }
  // Relighting anew starts from the light as it is; all else is compared solved from the dark.
  const bool relight = row.effect == Effect::relight;
  const Pixels before = relight ? bench.pictureAsLit() : planned;
  Settings forced = settings;
  applySetting(forced, setting + "=on");
  pipeline.set(forced);
  pipeline.prepare();
  const EffectRow now = pipeline.plan().row(row.effect);
  if (now.state == EffectState::on) {
    const bool ofMean = row.effect == Effect::emitterSampling && row.skip == Skip::threshold;
    proof.difference = compare(before, relight ? bench.pictureAsLit() : bench.picture(),
                               ofMean ? row.epsilon : allowedRadiance(pipeline, row));
    proof.difference->ofMean = ofMean;
  } else {
    proof.reason = now.reason;
  }
  pipeline.set(settings);
  pipeline.prepare();
  return proof;
}

}  // namespace

std::string describe(const PictureDifference& d) {
  if (d.pixels == 0) return "same bits";
  if (d.ofMean) return fmt::format("{:.2g} {} {:.2g} of the mean", d.mean, d.holds() ? "<=" : ">", d.allowed);
  return d.allowed > 0 ? fmt::format("{:.2g} {} {:.2g}", d.largest, d.holds() ? "<=" : ">", d.allowed)
                       : fmt::format("{} pixels, {:.2g}", d.pixels, d.largest);
}

void SceneProof::require() const {
  std::vector<std::string> wrong;
  for (const EffectProof& e : effects)
    if (e.difference && !e.difference->holds())
      wrong.push_back(
          fmt::format("{}: {} forced on: {}", scene, effectInfo(e.row.effect).name, describe(*e.difference)));
  if (!all.holds()) wrong.push_back(fmt::format("{}: everything forced on: {}", scene, describe(all)));
  if (!wrong.empty()) throw WorkError(fmt::format("{}", fmt::join(wrong, "\n")));
}

SceneProof prove(Session& session, const std::string& name, const Scene& scene, const Camera& camera, glm::uvec2 size,
                 uint32_t frames) {
  SceneProof proof{.scene = name, .effects = {}, .all = {}, .forced = {}, .planned = {}};
  Settings all = session.settings;
  forceEffects(all, EffectMode::on);
  all.effects.relight = EffectMode::automatic;  // at rest for the comparison; measureEnergy() has it on
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
  for (Side* side : sides) takeMedians(*side);
  for (size_t moving = 0; moving < kMovings.size(); ++moving)
    for (Side* side : sides) measureEnergy(*side, moving, frames, /*everything=*/side == &forced);
  proof.forced = forced.cost;
  proof.planned = planned.cost;

  // The pictures, each solved from the dark.
  const EffectPlan plan = planned.bench->pipeline().plan(/*redraw=*/false);
  const Pixels picture = planned.bench->picture();
  float allowed = 0;
  for (const EffectRow& row : plan.rows)
    if (row.state == EffectState::off && forcedMode(all, row.effect) == EffectMode::on)
      allowed += allowedRadiance(planned.bench->pipeline(), row);
  proof.all = compare(picture, forced.bench->picture(), allowed);
  forced.bench.reset();
  for (const EffectRow& row : plan.rows)
    if (row.state != EffectState::on)
      proof.effects.push_back(proveEffect(session.settings, *planned.bench, row, picture));
  return proof;
}

}  // namespace irad::app
