// Jacobi (docs/method.md 1 and 6, T 5.8): H <- F B, then B <- lambda (M + rho (D + H)).
#include "gi/solve.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "gi/acceleration.h"
#include "gi/facets.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/subsystems.h"
#include "gi/sweep.h"
#include "gi/watch.h"
#include "renderer/base/error.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/solve.h"

namespace irad {
namespace {

constexpr const char* kSolveStage = "GI Solve";
constexpr float kDark = 1e-6f;            ///< share of the last lit H below which an unlit scene is put out
constexpr float kTameLambda = 1 / 0.98f;  ///< albedos are <= .98 and row sums of F <= 1: no divergence up to here
constexpr float kRounding = 4e-6f;        ///< of a row's sum in fp32
constexpr float kTight = 1.25f;           ///< kappa is known well enough when it is known to this factor
constexpr float kUnknown = std::numeric_limits<float>::infinity();

/// kappa, from a sweep of the gains' answer w = 1 + v. A w = w' - 1 for the matrix A of the gains; where w - A w >= s >
/// 0 in every row, (I - A)^-1 1 exists and is at most w / s, since A has no negative entry.
void judgeGains(SolveReport& report, const SolveResidual& r) {
  const float reach = 1 + std::bit_cast<float>(r.maxReach);
  const float least = 1 - std::bit_cast<float>(r.maxRise) - kRounding * reach;
  report.kappa = least > 0 ? reach / least : kUnknown;
  report.kappaSlack = least > 0 ? (1 + std::bit_cast<float>(r.maxFall)) / least : kUnknown;
}

/// What the error of H is to be below: the tolerance; but no less than what a sweep cannot tell from rounding, a unit
/// in the last place of the largest H, between two of which it may go to and fro.
float target(const SolveReport& report, float omega, float tolerance) {
  return std::max(tolerance * report.meanH, report.kappa / omega * report.largestH * 0x1p-23f);
}

/// How far B may still be from its fixed point, and H from F times it, after watchSolve(). |dB|: the last change.
void judge(SolveReport& report, const SolveResidual& r, double meanH, float omega, float tolerance) {
  report.meanH = static_cast<float>(meanH);
  report.dark = r.maxSource == 0;
  report.omega = omega;
  // The error of B before the sweep is at most kappa |dB| / omega, and so is that of H, row sums being <= 1.
  const float reach = report.kappa / omega * report.residual;
  report.bound = report.residual == 0 ? 0 : reach - report.residual;
  const float wanted = target(report, omega, tolerance);
  report.allowed = (1 - omega / report.kappa) * wanted;
  report.converged = report.nonFinite == 0 && (report.residual == 0 || (report.kappa < kUnknown && reach <= wanted));
}

/// Sweeps until the tolerance holds, if the residual goes on as it was last seen to.
uint32_t sweepsToGo(const SolveReport& report, float omega, float tolerance) {
  const double wanted = double{target(report, omega, tolerance)} * omega / report.kappa;
  if (!(report.contraction > 0 && report.contraction < 1 && wanted > 0 && report.residual > 0))
    return std::numeric_limits<uint32_t>::max();
  const double sweeps = std::ceil(std::log(wanted / report.residual) / std::log(report.contraction));
  return static_cast<uint32_t>(std::clamp(sweeps, 1.0, 1e6));
}

/// The light from before the solve, where it was kept.
void restoreLight(Context& context, const FacetList& facets, Lighting& light) {
  if (!light.guard.radiosity) return;
  const uint64_t bytes = 16ull * facets.count;
  Frame frame = context.begin();
  frame.pass(kSolveStage).copy(light.guard.radiosity, light.radiosity, bytes);
  frame.pass(kSolveStage).copy(light.guard.indirect, light.indirect, bytes);
  frame.submit();
  light.gain = light.guard.gain;
}

}  // namespace

void beginSolve(Context& context, const FacetList& facets, Lighting& light, const SolverParams& params) {
  DivergenceGuard& guard = light.guard;
  if (!light.report.settled() && guard.lambda == params.lambda && guard.asked == params.omega) return;
  const bool goesOn = !light.report.settled() && guard.radiosity;
  DivergenceGuard fresh;
  fresh.lambda = params.lambda;
  fresh.asked = fresh.omega = params.omega;
  if (light.report.nonFinite > 0) {
    Frame frame = context.begin();
    frame.pass(kSolveStage).fill(light.radiosity, 0);
    frame.submit();
    light.gain.radiosity = params.lambda;
  }
  if (goesOn) {
    fresh.radiosity = std::move(guard.radiosity);
    fresh.indirect = std::move(guard.indirect);
    fresh.gain = guard.gain;
  } else if (params.lambda > kTameLambda) {
    const uint64_t bytes = 16ull * facets.count;
    fresh.radiosity = Buffer(context.device, "radiosity B (before)", Subsystem::Solver, bytes);
    fresh.indirect = Buffer(context.device, "indirect irradiance H (before)", Subsystem::Solver, bytes);
    Frame frame = context.begin();
    frame.pass(kSolveStage).copy(light.radiosity, fresh.radiosity, bytes);
    frame.pass(kSolveStage).copy(light.indirect, fresh.indirect, bytes);
    frame.submit();
    fresh.gain = light.gain;
  }
  guard = std::move(fresh);
}

void watchSolve(SolveReport& report, const SolveResidual& r, float residual, DivergenceGuard& guard) {
  report.residual = residual;
  report.largestH = std::bit_cast<float>(r.maxH);
  report.largestGain = std::bit_cast<float>(r.maxGain);
  report.nonFinite = r.nonFinite;
  report.nan = r.nan;
  report.negative = r.negative;
  if (report.nonFinite == 0) guard.judge(report.largestGain, report.residual);
  report.growth = guard.growth;
  report.damped = guard.damped;
  report.diverging = guard.gaveUp;
}

void endSolve(Context& context, const FacetList& facets, Lighting& light, SolveReport& report, float litBefore) {
  if (report.diverging) {
    restoreLight(context, facets, light);
    light.litH = litBefore;
  }
  if (report.settled()) light.guard.radiosity = Buffer(), light.guard.indirect = Buffer();
  if (report.nonFinite + report.negative > 0) report.defect = findDefect(context, facets, light);
}

void DivergenceGuard::judge(float gain, float residual) {
  const float before = step;
  step = residual / omega;
  growth = step / before;
  growing = gain >= 1 && step > before ? growing + 1 : 0;
  if (growing < kPatience) return;
  growing = 0;
  gaveUp = damped;
  if (!damped) omega *= 0.5f;
  damped = true;
}

SolveReport solve(Context& context, const FacetList& facets, const FormFactors& matrix, Lighting& light,
                  const Settings& settings, uint32_t maxSweeps, const std::function<bool()>& goesOn) {
  IRAD_CHECK_OP(matrix.rows, ==, facets.count);
  SolveReport report;
  if (facets.count == 0) {
    report.converged = true;
    return light.report = report;
  }
  const SolverParams& params = settings.solver.gpu;
  Sweep sweep(context, facets, matrix, settings.solver);
  beginSolve(context, facets, light, params);
  DivergenceGuard& guard = light.guard;
  const float litBefore = light.litH;
  const bool accelerated = settings.solver.acceleration != SolverAcceleration::off;
  makeHistory(context, facets, light, accelerated);
  Acceleration history(context, facets, light, accelerated);

  // A CPU device sweeps slowly, so its submissions are short. The first is short everywhere, unless a solve goes on: a
  // warm start is often at its goal, and only after it the dark is put out.
  const uint32_t longest = context.device.isCpu ? 4 : SOLVE_RESIDUALS;
  const SolveReport& before = light.report;
  report.contraction = before.contraction;
  uint32_t batch = 2;
  if (!before.settled() && before.sweeps > 0 && before.largestGain < 1 && !before.dark)
    batch = std::min(sweepsToGo(before, guard.omega, settings.solver.tolerance), longest);
  bool steady = false;  // B held lambda when the history began
  report.kappa = before.kappa;
  report.kappaSlack = before.kappaSlack;
  bool proven = false;  // kappa, in this call, in which the matrix stays as it is
  float left = 0;       // residual, of this call's last sweep or mix
  while (report.sweeps < maxSweeps && !report.settled()) {
    if (goesOn && !goesOn()) throw WorkError("cancelled");
    const uint32_t count =
        std::min({batch, maxSweeps - report.sweeps, history.on() ? history.left() : SOLVE_RESIDUALS});
    sweep.omega = guard.omega;
    Frame frame = context.begin();
    frame.pass(kSolveStage).fill(light.residual, 0);
    if (history.left() == SOLVE_VECTORS)
      steady = std::abs(light.gain.radiosity - params.lambda) <= 1e-6f * params.lambda;
    for (uint32_t i = 0; i < count; ++i) {
      // As long as little is known of the gains' answer, every sweep goes on with it.
      const bool last = i + 1 == count, gains = report.kappaSlack > kTight || (last && !proven);
      const uint32_t work = gains ? SOLVE_GAINS : last ? SOLVE_WATCH : SOLVE_SWEEP;
      sweep.record(frame, kSolveStage, work, light.radiosity, light.radiosityNext, light, i);
      std::swap(light.radiosity, light.radiosityNext);
      history.keep(gains);
      SourceGain& gain = light.gain;
      gain.indirect = gain.radiosity;
      gain.radiosity += sweep.omega * (params.lambda - gain.radiosity);
    }
    report.sweeps += count;
    const bool mayMix = history.ready() && (history.left() == 0 || report.sweeps == maxSweeps);
    SweepSums sums;
    history.recordSums(frame, kSolveStage, mayMix, sums);
    std::array<SolveResidual, SOLVE_RESIDUALS> residuals{};
    frame.readback(light.residual, 0, sizeof(residuals),
                   [&](std::span<const uint8_t> b) { std::memcpy(residuals.data(), b.data(), b.size()); });
    frame.submitAndWait();
    if (report.kappaSlack > kTight || !proven) judgeGains(report, residuals[count - 1]);
    proven = true;
    watchSolve(report, residuals[count - 1], std::bit_cast<float>(residuals[count - 1].maxDelta), guard);
    judge(report, residuals[count - 1], sums.meanH, sweep.omega, settings.solver.tolerance);
    const float previous = count > 1 ? std::bit_cast<float>(residuals[count - 2].maxDelta) : 0;
    if (previous > 0)
      report.contraction = report.residual / previous;
    else if (left > 0)
      report.contraction = std::pow(report.residual / left, 1.0f / static_cast<float>(count));
    left = report.residual;
    // Where light may grow it is checked often, and while it does grow after every sweep.
    if (report.largestGain >= 1)
      batch = guard.growing > 0 || guard.damped ? 1 : std::min(4u, longest);
    else
      batch = std::min(sweepsToGo(report, sweep.omega, settings.solver.tolerance), longest);

    if (mayMix) {
      // Not where sweeps may grow, which the guard has to see; not while B still takes up another lambda; and not in
      // the dark, which is to end in zero by itself.
      const bool mixes = !report.settled() && report.negative == 0 && report.largestGain < 1 && !report.dark && steady;
      const float mixed = mixes ? history.mix(kSolveStage, sums, report.residual) : 0;
      history.forget();
      if (mixed > 0) {
        left = mixed;
        batch = std::min(batch, 2u);
      }
    }
    if (!report.dark) {
      light.litH = report.largestH;
      sweep.flush = params.flush;
    } else {
      // Lights off: light decays by rho per sweep, and ends in exact zero once it is below what fp32 kept of it.
      light.litH = std::max(light.litH, report.largestH);
      sweep.flush = std::max(params.flush, kDark * light.litH);
    }
  }
  endSolve(context, facets, light, report, litBefore);
  if (report.converged && params.lambda == 1 && !matrix.tinted) report.energy = balance(context, facets, light);
  return light.report = report;
}

}  // namespace irad
