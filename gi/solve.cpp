// Jacobi (docs/method.md 1 and 6, T 5.8): H <- F B, then B <- lambda (M + rho (D + H)).
#include "gi/solve.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

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
constexpr uint32_t kBatch = 16;           ///< sweeps per submission at most; the last one is watched
constexpr float kDark = 1e-6f;            ///< share of the last lit H below which an unlit scene is put out
constexpr float kTameLambda = 1 / 0.98f;  ///< albedos are <= .98 and row sums of F <= 1: no divergence up to here

/// How far B may still be from its fixed point, and H from F times it. q: the contraction; |dB|: the last change.
void judge(SolveReport& report, const SolveResidual& r, float omega, float tolerance) {
  report.residual = std::bit_cast<float>(r.maxDelta);
  report.largestH = std::bit_cast<float>(r.maxH);
  report.largestGain = std::bit_cast<float>(r.maxGain);
  report.nonFinite = r.nonFinite;
  report.nan = r.nan;
  report.negative = r.negative;
  report.omega = omega;
  const float q = (1 - omega) + omega * report.largestGain;
  const float reach = q < 1 ? report.residual / (1 - q) : std::numeric_limits<float>::infinity();
  report.bound = report.residual == 0 ? 0 : q * reach;
  report.allowed = q * tolerance * report.largestH;
  // H is one product behind B: its error is bounded by |dB| / (1 - q), row sums being <= 1.
  report.converged = report.nonFinite == 0 && (report.residual == 0 || reach <= tolerance * report.largestH);
}

/// Makes the guard of a solve that begins, or that goes on: the window calls for a few sweeps at a time.
void begin(Context& context, const FacetList& facets, Lighting& light, const SolverParams& params) {
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

/// The light from before the solve.
void restore(Context& context, const FacetList& facets, Lighting& light) {
  if (!light.guard.radiosity) return;
  const uint64_t bytes = 16ull * facets.count;
  Frame frame = context.begin();
  frame.pass(kSolveStage).copy(light.guard.radiosity, light.radiosity, bytes);
  frame.pass(kSolveStage).copy(light.guard.indirect, light.indirect, bytes);
  frame.submit();
  light.gain = light.guard.gain;
}

}  // namespace

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
                  const Settings& settings, uint32_t maxSweeps) {
  IRAD_CHECK_OP(matrix.rows, ==, facets.count);
  SolveReport report;
  if (facets.count == 0) {
    report.converged = true;
    return light.report = report;
  }
  const SolverParams& params = settings.solver.gpu;
  Sweep sweep(context, facets, matrix, settings.solver);
  begin(context, facets, light, params);
  DivergenceGuard& guard = light.guard;
  const float litBefore = light.litH;

  // A CPU device sweeps slowly, so its submissions are short. The first is short everywhere: a warm start is often at
  // its goal.
  const uint32_t longest = context.device.isCpu ? 4 : kBatch;
  uint32_t batch = std::min(2u, longest);
  while (report.sweeps < maxSweeps && !report.settled()) {
    const uint32_t count = std::min(batch, maxSweeps - report.sweeps);
    sweep.omega = guard.omega;
    Frame frame = context.begin();
    frame.pass(kSolveStage).fill(light.residual, 0);
    if (report.sweeps == 0) sweep.begin(frame, kSolveStage, light.radiosity);
    for (uint32_t i = 0; i < count; ++i) {
      sweep.record(frame, kSolveStage, i + 1 == count ? SOLVE_WATCH : SOLVE_SWEEP, light.radiosity, light.radiosityNext,
                   light);
      std::swap(light.radiosity, light.radiosityNext);
      SourceGain& gain = light.gain;
      gain.indirect = gain.radiosity;
      gain.radiosity += sweep.omega * (params.lambda - gain.radiosity);
    }
    SolveResidual residual{};
    frame.readback(light.residual, 0, sizeof(residual),
                   [&](std::span<const uint8_t> b) { std::memcpy(&residual, b.data(), b.size()); });
    frame.submitAndWait();
    report.sweeps += count;
    judge(report, residual, sweep.omega, settings.solver.tolerance);
    if (report.nonFinite == 0) guard.judge(report.largestGain, report.residual);
    report.growth = guard.growth;
    report.damped = guard.damped;
    report.diverging = guard.gaveUp;
    // Where light may grow it is checked often, and while it does grow after every sweep.
    batch = report.largestGain < 1 ? longest : guard.growing > 0 || guard.damped ? 1 : std::min(4u, longest);

    if (residual.maxSource != 0) {
      light.litH = report.largestH;
      sweep.flush = params.flush;
    } else {
      // Lights off: light decays by rho per sweep, and ends in exact zero once it is below what fp32 kept of it.
      light.litH = std::max(light.litH, report.largestH);
      sweep.flush = std::max(params.flush, kDark * light.litH);
    }
  }
  if (report.diverging) {
    restore(context, facets, light);
    light.litH = litBefore;
  }
  if (report.settled()) guard.radiosity = Buffer(), guard.indirect = Buffer();
  if (report.nonFinite + report.negative > 0) report.defect = findDefect(context, facets, light);
  if (report.converged && params.lambda == 1) report.energy = balance(context, facets, light);
  return light.report = report;
}

}  // namespace irad
