// Indirect light between the facets.
#pragma once

#include <cstdint>
#include <functional>

namespace irad {

class Context;
struct DivergenceGuard;
struct FacetList;
struct FormFactors;
struct Lighting;
struct Settings;
struct SolveReport;
struct SolveResidual;
struct SolverParams;

/// Runs sweeps until the bound is met, `maxSweeps` at most; warm start from light.radiosity (from the dark where the
/// last report has something not finite). Blocking. `goesOn` is asked before each submission, and may be empty: where
/// it returns false a WorkError "cancelled" leaves the light as far as it came.
SolveReport solve(Context& context, const FacetList& facets, const FormFactors& matrix, Lighting& light,
                  const Settings& settings, uint32_t maxSweeps, const std::function<bool()>& goesOn = {});

/// Makes the guard of a solve that begins, or that goes on: the window calls for a few sweeps at a time. Where light
/// may grow without bound it keeps what is there.
void beginSolve(Context& context, const FacetList& facets, Lighting& light, const SolverParams& params);
/// What a sweep or a frame has reduced, and what the guard makes of it where all is finite. `residual`:
/// report.residual.
void watchSolve(SolveReport& report, const SolveResidual& reduced, float residual, DivergenceGuard& guard);
/// Ends it, or leaves it until it goes on. What diverged gives way to the light from before, whose litH was
/// `litBefore`; a defect is looked for.
void endSolve(Context& context, const FacetList& facets, Lighting& light, SolveReport& report, float litBefore);

}  // namespace irad
