#include "app/plan_proof.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
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

/// By how much a row's skip may change the picture, as radiance: its share of H (`relight`, which the solver's
/// tolerance decides: of the mean; others: of the largest), times at most 1 / pi, since reflectances are <= 1.
float allowedRadiance(const Pipeline& pipeline, const EffectRow& row) {
  const SolveReport& report = pipeline.lighting().report;
  const float share = row.effect == Effect::relight ? report.meanH : report.largestH;
  return row.epsilon * share / std::numbers::pi_v<float>;
}

std::unique_ptr<Bench> open(const Subject& subject, const Settings& settings) {
  Context& context = *subject.session.context;
  auto bench = std::make_unique<Bench>(context, subject.scene, settings, subject.size, VIEW_LIT, subject.camera);
  bench->warmUp(std::ref(subject.session.progress));
  return bench;
}

/// Both work in turn, so that other load on the machine falls on both alike.
void workInTurn(const Subject& subject, Bench& a, Bench& b) {
  const std::array both{&a, &b};
  for (Bench* bench : both) bench->forget();
  measureInTurn(both, /*rebuilds=*/3, subject.frames, std::ref(subject.session.progress));
}

Figures timesOf(const Bench& bench) {
  return {{"rebuild_ms", bench.gpuMs(WorkKind::Setup)},
          {"relight_ms", bench.gpuMs(WorkKind::Relight)},
          {"frame_ms", bench.gpuMs(WorkKind::Camera)}};
}

/// All of a set's, after workInTurn(). `bytes`: of device memory; `everything`: nothing sleeps in a window, every tick
/// relights and draws.
Figures figuresOf(const Subject& subject, Bench& bench, uint64_t bytes, bool everything) {
  Figures out = timesOf(bench);
  out["mib"] = inMebibytes(bytes);
  Context& context = *subject.session.context;
  (void)context.pipelinesUsed();
  const Counters before = context.counters();
  bench.relight();
  bench.cameraFrame();
  const Counters work = context.counters().since(before);
  out["dispatches"] = static_cast<double>(work.dispatches);
  out["draws"] = static_cast<double>(work.draws);
  out["instructions"] = static_cast<double>(specializedInstructions(context.shaders, context.pipelinesUsed()));

  Pipeline& pipeline = bench.pipeline();
  const Settings settings = pipeline.settings();
  Settings restless = settings;
  if (everything) restless.effects.relight = EffectMode::on;
  pipeline.set(restless);
  for (const auto& [moving, name] :
       {std::pair(Moving::Nothing, "idle"), {Moving::Camera, "camera"}, {Moving::Lights, "light"}}) {
    if (moving == Moving::Lights && pipeline.scene().lights.empty()) continue;
    const TickWork ticks = bench.ticks(moving, subject.frames, everything);
    const double perSecond = 60.0 / subject.frames;
    out[fmt::format("{}_ms_per_s", name)] = perSecond * ticks.gpuMs;
    out[fmt::format("{}_dispatches_per_s", name)] = perSecond * static_cast<double>(ticks.dispatches);
    out[fmt::format("{}_draws_per_s", name)] = perSecond * static_cast<double>(ticks.draws);
  }
  pipeline.set(settings);
  pipeline.prepare();
  return out;
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

Proof rowsOf(const Subject& subject, Bench& planned, bool measure) {
  const EffectPlan plan = planned.pipeline().plan();
  if (measure) planned.warmUp(std::ref(subject.session.progress));
  Proof rows;
  for (const EffectRow& row : plan.rows) {
    ProofRow& out = rows.emplace_back(ProofRow{.scene = subject.name, .name = row.info().name, .effect = row});
    if (!measure || row.state != EffectState::off || !row.possible || !row.info().mode) continue;
    Settings forced = subject.session.settings;
    forced.effects.*row.info().mode = EffectMode::on;
    const auto with = open(subject, forced);
    workInTurn(subject, planned, *with);
    out.figures = timesOf(*with);
    for (const auto& [name, ms] : timesOf(planned)) out.figures[name] -= ms;
  }
  return rows;
}

uint64_t heldBytes(Context& context) {
  context.finish();
  uint64_t bytes = 0;
  for (const MemoryRow& row : context.device.memory().rows())
    if (row.subsystem != Subsystem::Staging) bytes += row.bytes;
  return bytes;
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
    const std::string setting = row.info().setting;
    if (!setting.empty() && findSetting(setting).text(settings) == "off")
      proven.reason = setting + " = off";
    else if (!row.possible || row.effect == Effect::bruteForce)  // whose light is another method's
      proven.reason = row.reason;
    if (!proven.reason.empty()) continue;
    // These start from the light as it is; everything else is compared after a solve from the dark.
    bench.settle();
    const bool asLit = row.effect == Effect::redraw || row.effect == Effect::relight;
    const Pixels before = asLit ? bench.picturesAsLit(views) : planned;
    if (!setting.empty()) {
      Settings forced = settings;
      applySetting(forced, setting + "=on");
      pipeline.set(forced);
      pipeline.prepare();
      IRAD_CHECK(pipeline.plan().on(row.effect), "{}", row.info().name);
    }
    if (row.effect == Effect::rebuild) bench.rebuild();
    const bool ofMean = row.effect == Effect::emitterSampling && row.epsilon > 0;
    const auto compared = row.epsilon > 0 ? views.first(1) : views;
    proven.difference = compare(before, asLit ? bench.picturesAsLit(compared) : bench.pictures(compared),
                                ofMean ? row.epsilon : allowedRadiance(pipeline, row));
    proven.difference->ofMean = ofMean;
    pipeline.set(settings);
    pipeline.prepare();
  }
  return proof;
}

Proof prove(const Subject& subject) {
  DeviceSession& session = subject.session;
  const uint64_t nothing = heldBytes(*session.context);
  const auto planned = open(subject, session.settings);
  const uint64_t one = heldBytes(*session.context);
  auto forced = open(subject, allForcedOn(session.settings));
  const uint64_t both = heldBytes(*session.context);
  workInTurn(subject, *planned, *forced);
  const Figures asPlanned = figuresOf(subject, *planned, one - nothing, /*everything=*/false),
                allForced = figuresOf(subject, *forced, both - one, /*everything=*/true);
  constexpr View kPicture[]{VIEW_LIT};
  Proof proof{proveAll(subject.name, *planned, *forced, kPicture), {subject.name, "as planned", asPlanned}};
  proof[0].figures = allForced;
  forced.reset();  // its memory
  std::ranges::copy(proveEach(subject.name, *planned, kPicture), std::back_inserter(proof));
  return proof;
}

}  // namespace irad::app
