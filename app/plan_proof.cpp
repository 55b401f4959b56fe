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
#include "renderer/base/number_text.h"

namespace irad::app {
namespace {

using Pixels = std::vector<glm::vec4>;

/// Of `b` and as many pixels of `a`.
PictureDifference compare(std::span<const glm::vec4> a, std::span<const glm::vec4> b, float allowed) {
  IRAD_CHECK_OP(a.size(), >=, b.size());
  PictureDifference out{.allowed = allowed};
  double sum = 0, change = 0;
  for (size_t i = 0; i < b.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      sum += a[i][c];
      change += double{b[i][c]} - a[i][c];
    }
    if (std::memcmp(&a[i], &b[i], sizeof(glm::vec4)) == 0) continue;
    ++out.pixels;
    for (int c = 0; c < 4; ++c) out.largest = std::max(out.largest, std::abs(a[i][c] - b[i][c]));
  }
  if (sum > 0) out.mean = static_cast<float>(std::abs(change) / sum);
  return out;
}

/// By how much a row's skip may change the picture, as radiance: its share of the largest H, times at most 1 / pi,
/// since reflectances are <= 1.
float allowedRadiance(const Pipeline& pipeline, const EffectRow& row) {
  return row.threshold ? row.epsilon * pipeline.lighting().report.largestH / std::numbers::pi_v<float> : 0;
}

/// Prepares, compiles pipelines and touches pages.
std::unique_ptr<Bench> open(const Subject& subject, const Settings& settings) {
  DeviceSession& session = subject.session;
  auto bench =
      std::make_unique<Bench>(*session.context, subject.scene, settings, subject.size, VIEW_LIT, subject.camera);
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
  const double mebibytes = inMebibytes(heldBytes(session) - before);
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

std::map<Effect, Times> measureCosts(const Subject& subject, const EffectPlan& plan) {
  std::map<Effect, Times> costs;
  for (const EffectRow& row : plan.rows) {
    if (row.state != EffectState::off || !row.info().mode) continue;
    Settings forced = subject.session.settings;
    forced.effects.*row.info().mode = EffectMode::on;
    const auto without = open(subject, subject.session.settings), with = open(subject, forced);
    if (!with->pipeline().plan().on(row.effect)) continue;  // another setting has it off
    const auto [off, on] = timesInTurn({without.get(), with.get()}, subject.frames, &FrameSample::cpuMs, [](float) {});
    for (size_t i = 0; i < on.size(); ++i) costs[row.effect][i] = on[i] - off[i];
  }
  return costs;
}

Settings allForcedOn(const Settings& settings) {
  Settings all = settings;
  forceEffects(all, EffectMode::on);
  all.effects.relight = EffectMode::automatic;
  return all;
}

ProofRow proveAll(const std::string& scene, Bench& planned, Bench& forced, std::span<const View> views) {
  float allowed = 0;
  for (const EffectRow& row : planned.pipeline().plan().rows)
    if (row.state == EffectState::off && forcedMode(forced.pipeline().settings(), row.effect) == EffectMode::on)
      allowed += allowedRadiance(planned.pipeline(), row);
  const auto compared = allowed > 0 ? views.first(1) : views;
  return {.scene = scene,
          .name = "all forced on",
          .difference = compare(planned.pictures(compared), forced.pictures(compared), allowed)};
}

Proof proveEach(const std::string& scene, Bench& bench, std::span<const View> views) {
  Pipeline& pipeline = bench.pipeline();
  const Settings settings = pipeline.settings();
  const EffectPlan plan = pipeline.plan(/*redraw=*/false);
  const Pixels planned = bench.pictures(views);
  Proof proof;
  for (const EffectRow& row : plan.rows) {
    if (row.state == EffectState::on) continue;
    ProofRow& proven = proof.emplace_back(ProofRow{.scene = scene, .name = row.info().name, .effect = row});
    // These start from the light as it is; everything else is compared after a solve from the dark.
    const bool asLit = row.effect == Effect::redraw || row.effect == Effect::relight;
    const Pixels before = asLit ? bench.picturesAsLit(views) : planned;
    if (const std::string setting = row.info().setting; !setting.empty()) {
      if (findSetting(setting).text(settings) == "off") {
        proven.reason = setting + " = off";
        continue;
      }
      Settings forced = settings;
      applySetting(forced, setting + "=on");
      pipeline.set(forced);
      pipeline.prepare();
      const EffectRow now = pipeline.plan().row(row.effect);
      if (now.state != EffectState::on) proven.reason = now.reason;
    }
    if (row.effect == Effect::rebuild) bench.rebuild();
    if (proven.reason.empty()) {
      const bool ofMean = row.effect == Effect::emitterSampling && row.threshold;
      const auto compared = row.threshold ? views.first(1) : views;
      proven.difference = compare(before, asLit ? bench.picturesAsLit(compared) : bench.pictures(compared),
                                  ofMean ? row.epsilon : allowedRadiance(pipeline, row));
      proven.difference->ofMean = ofMean;
    }
    pipeline.set(settings);
    pipeline.prepare();
  }
  return proof;
}

Proof prove(const Subject& subject) {
  DeviceSession& session = subject.session;
  const std::array sets{allForcedOn(session.settings), session.settings};
  std::array<std::unique_ptr<Bench>, 2> benches;
  std::array<Figures, 2> figures;
  for (const size_t i : {1, 0}) {
    const uint64_t before = heldBytes(session);
    benches[i] = open(subject, sets[i]);
    figures[i] = workOf(session, *benches[i], before);
  }
  Bench &forced = *benches[0], &planned = *benches[1];
  const auto times = timesInTurn({&forced, &planned}, subject.frames, &FrameSample::gpuMs,
                                 [&](float share) { session.progress(subject.name.c_str(), share); });
  for (const size_t i : {1, 0}) {
    figures[i].insert(figures[i].begin(), times[i].begin(), times[i].end());
    for (const Moving moving : {Moving::Nothing, Moving::Camera, Moving::Lights})
      std::ranges::copy(energyOf(*benches[i], moving, subject.frames, /*everything=*/i == 0),
                        std::back_inserter(figures[i]));
  }
  constexpr View kPicture[]{VIEW_LIT};
  Proof proof{proveAll(subject.name, planned, forced, kPicture), {subject.name, "as planned", figures[1]}};
  proof[0].figures = figures[0];
  benches[0].reset();  // its memory
  std::ranges::copy(proveEach(subject.name, planned, kPicture), std::back_inserter(proof));
  return proof;
}

}  // namespace irad::app
