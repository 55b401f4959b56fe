// Indirect light between the facets.
#pragma once

#include <cstdint>

namespace irad {

class Context;
struct FacetList;
struct FormFactors;
struct Lighting;
struct Settings;
struct SolveReport;
struct SolverParams;

/// Runs sweeps until the bound is met, `maxSweeps` at most; warm start from light.radiosity (from the dark where the
/// last report has something not finite). Blocking.
SolveReport solve(Context& context, const FacetList& facets, const FormFactors& matrix, Lighting& light,
                  const Settings& settings, uint32_t maxSweeps);

/// Makes the guard of a solve that begins, or that goes on: the window calls for a few sweeps at a time. Where light
/// may grow without bound it keeps what is there.
void beginSolve(Context& context, const FacetList& facets, Lighting& light, const SolverParams& params);
/// The light from before that, where it was kept.
void restoreLight(Context& context, const FacetList& facets, Lighting& light);

}  // namespace irad
