#include "app/plan_proof.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <numbers>

#include "gi/lighting.h"
#include "gi/plan.h"
#include "renderer/base/error.h"

namespace irad::app {
namespace {

using Pixels = std::vector<glm::vec4>;

PictureDifference compare(const Pixels& a, const Pixels& b, float allowed) {
  IRAD_CHECK_OP(a.size(), ==, b.size());
  PictureDifference out{.allowed = allowed};
  const auto sum = [](const Pixels& pixels) {
    double all = 0;
    for (const glm::vec4& p : pixels) all += double{p.x} + p.y + p.z;
    return all;
  };
  if (sum(a) > 0) out.mean = static_cast<float>(std::abs(sum(b) - sum(a)) / sum(a));
  for (size_t i = 0; i < a.size(); ++i) {
    if (std::memcmp(&a[i], &b[i], sizeof(glm::vec4)) == 0) continue;
    ++out.pixels;
    for (int c = 0; c < 4; ++c) out.largest = std::max(out.largest, std::abs(a[i][c] - b[i][c]));
  }
  return out;
}

/// By how much a row's skip may change the picture, as radiance: its share of the largest H, times at most 1 / pi,
/// since reflectances are <= 1.
float allowedRadiance(const Pipeline& pipeline, const EffectRow& row) {
  return row.threshold ? row.epsilon * pipeline.lighting().report.largestH / std::numbers::pi_v<float> : 0;
}

/// Prepares, compiles pipelines and touches pages.
std::unique_ptr<Bench> open(DeviceSession& session, const Scene& scene, const Settings& settings, glm::uvec2 size,
                            const Camera& camera) {
  auto bench = std::make_unique<Bench>(*session.context, scene, settings, size, VIEW_LIT, camera);
  bench->prepare([&](const char* stage, float fraction) { return session.progress(stage, fraction); });
  bench->cameraFrame();
  bench->relight();
  bench->forget();
  return bench;
}

/// Each one's medians of `ms` of a call. Both work in turn, so that other load on the machine falls on both alike.
template <class Ms>
std::array<Times, 2> timesInTurn(std::array<Bench*, 2> benches, uint32_t frames, Ms ms,
                                 const std::function<void(float)>& progress) {
  constexpr int kRebuilds = 3;
  for (int i = 0; i < kRebuilds; ++i)
    for (Bench* bench : benches) bench->rebuild();
  for (uint32_t i = 0; i < frames; ++i)
    for (Bench* bench : benches) {
      progress(static_cast<float>(i) / static_cast<float>(frames));
      bench->relight();
      bench->cameraFrame();
    }
  std::array<Times, 2> out;
  constexpr std::array kKinds{WorkKind::Setup, WorkKind::Relight, WorkKind::Camera};
  for (size_t i = 0; i < benches.size(); ++i)
    for (size_t k = 0; k < kKinds.size(); ++k) {
      std::vector<double> samples;
      for (const FrameSample& call : benches[i]->frames())
        if (call.kind == kKinds[k]) samples.push_back(std::invoke(ms, call));
      out[i][k] = samples.empty() ? 0 : statistics(samples).p50;
    }
  return out;
}

/// Bytes of device memory, without the staging that the context keeps for every frame, whichever set it draws.
uint64_t heldBytes(const DeviceSession& session) {
  session.context->finish();
  uint64_t bytes = 0;
  for (const MemoryRow& row : session.device->memory().rows())
    if (row.subsystem != Subsystem::Staging) bytes += row.bytes;
  return bytes;
}

/// MiB of device memory (beside `before` bytes that were in use), dispatches, draws and instructions of a
/// relight and a picture.
Figures workOf(DeviceSession& session, Bench& bench, uint64_t before) {
  Context& context = *session.context;
  const double mebibytes = static_cast<double>(heldBytes(session) - before) / (1 << 20);
  (void)context.pipelinesUsed();
  const Counters counters = context.counters();
  bench.relight();
  bench.cameraFrame();
  const Counters work = context.counters().since(counters);
  bench.forget();
  return {mebibytes, static_cast<double>(work.dispatches), static_cast<double>(work.draws),
          static_cast<double>(specializedInstructions(context.shaders, context.pipelinesUsed()))};
}

/// Milliseconds of the GPU, dispatches and draws per second. `everything`: nothing sleeps, every tick relights and
/// draws.
Figures energyOf(Bench& bench, Moving moving, uint32_t ticks, bool everything) {
  Pipeline& pipeline = bench.pipeline();
  if (moving == Moving::Lights && pipeline.scene().lights.empty()) return Figures(3);
  const Settings settings = pipeline.settings();
  Settings restless = settings;
  if (everything) restless.effects.relight = EffectMode::on;
  pipeline.set(restless);
  const TickWork work = bench.ticks(moving, ticks, everything);
  pipeline.set(settings);
  pipeline.prepare();
  const double perSecond = 60.0 / ticks;
  return {perSecond * work.gpuMs, perSecond * static_cast<double>(work.dispatches),
          perSecond * static_cast<double>(work.draws)};
}

/// Runs an effect that the plan does not have on, where anything can put it on.
ProofRow proveEffect(const std::string& scene, const Settings& settings, Bench& bench, const EffectRow& row,
                     const Pixels& planned) {
  ProofRow proof{.scene = scene, .name = row.info().name, .effect = row};
  Pipeline& pipeline = bench.pipeline();
  const std::string setting = row.info().setting;
  // These start from the light as it is; everything else is compared after a solve from the dark.
  const bool asLit = row.effect == Effect::redraw || row.effect == Effect::relight;
  const Pixels before = asLit ? bench.pictureAsLit() : planned;
  if (!setting.empty()) {
    if (findSetting(setting).text(settings) == "off") {
      proof.reason = setting + " = off";
      return proof;
    }
    Settings forced = settings;
    applySetting(forced, setting + "=on");
    pipeline.set(forced);
    pipeline.prepare();
    if (const EffectRow now = pipeline.plan().row(row.effect); now.state != EffectState::on) proof.reason = now.reason;
  }
  if (row.effect == Effect::rebuild) bench.rebuild();
  if (proof.reason.empty()) {
    const bool ofMean = row.effect == Effect::emitterSampling && row.threshold;
    proof.difference = compare(before, asLit ? bench.pictureAsLit() : bench.picture(),
                               ofMean ? row.epsilon : allowedRadiance(pipeline, row));
    proof.difference->ofMean = ofMean;
  }
  pipeline.set(settings);
  pipeline.prepare();
  return proof;
}

}  // namespace

std::string PictureDifference::text() const {
  if (pixels == 0) return "same bits";
  if (allowed == 0) return fmt::format("{} pixels, {:.2g}", pixels, largest);
  return fmt::format("{:.2g} {} {:.2g}{}", judged(), holds() ? "<=" : ">", allowed, ofMean ? " of the mean" : "");
}

void require(const Proof& proof) {
  std::vector<std::string> wrong;
  for (const ProofRow& row : proof)
    if (row.difference && !row.difference->holds())
      wrong.push_back(
          fmt::format("{}: {}{}: {}", row.scene, row.name, row.effect ? " forced on" : "", row.difference->text()));
  if (!wrong.empty()) throw WorkError(fmt::format("{}", fmt::join(wrong, "\n")));
}

std::map<Effect, Times> measureCosts(DeviceSession& session, const Scene& scene, const EffectPlan& plan,
                                     glm::uvec2 size, const Camera& camera, uint32_t frames) {
  std::map<Effect, Times> costs;
  for (const EffectRow& row : plan.rows) {
    if (row.state != EffectState::off || !row.info().mode) continue;
    Settings forced = session.settings;
    forced.effects.*row.info().mode = EffectMode::on;
    const auto without = open(session, scene, session.settings, size, camera),
               with = open(session, scene, forced, size, camera);
    if (!with->pipeline().plan().on(row.effect)) continue;  // another setting has it off
    const auto [off, on] = timesInTurn({without.get(), with.get()}, frames, &FrameSample::cpuMs, [](float) {});
    for (size_t i = 0; i < on.size(); ++i) costs[row.effect][i] = on[i] - off[i];
  }
  return costs;
}

Proof prove(DeviceSession& session, const std::string& name, const Scene& scene, const Camera& camera, glm::uvec2 size,
            uint32_t frames) {
  Settings all = session.settings;
  forceEffects(all, EffectMode::on);
  all.effects.relight = EffectMode::automatic;  // asleep for the comparison; energyOf() puts it on
  Proof proof{{name, "all forced on"}, {name, "as planned"}};
  std::array<std::unique_ptr<Bench>, 2> benches;
  for (const size_t i : {1, 0}) {
    const uint64_t before = heldBytes(session);
    benches[i] = open(session, scene, i == 0 ? all : session.settings, size, camera);
    proof[i].figures = workOf(session, *benches[i], before);
  }
  Bench &forced = *benches[0], &planned = *benches[1];
  const auto times = timesInTurn({&forced, &planned}, frames, &FrameSample::gpuMs,
                                 [&](float share) { session.progress(name.c_str(), share); });
  for (const size_t i : {1, 0}) {
    Figures& figures = proof[i].figures;
    figures.insert(figures.begin(), times[i].begin(), times[i].end());
    for (const Moving moving : {Moving::Nothing, Moving::Camera, Moving::Lights})
      std::ranges::copy(energyOf(*benches[i], moving, frames, /*everything=*/i == 0), std::back_inserter(figures));
  }

  // The pictures, each solved from the dark.
  const EffectPlan plan = planned.pipeline().plan(/*redraw=*/false);
  const Pixels picture = planned.picture();
  float allowed = 0;
  for (const EffectRow& row : plan.rows)
    if (row.state == EffectState::off && forcedMode(all, row.effect) == EffectMode::on)
      allowed += allowedRadiance(planned.pipeline(), row);
  proof[0].difference = compare(picture, forced.picture(), allowed);
  benches[0].reset();
  for (const EffectRow& row : plan.rows)
    if (row.state != EffectState::on) proof.push_back(proveEffect(name, session.settings, planned, row, picture));
  return proof;
}

}  // namespace irad::app
