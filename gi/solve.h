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

/// Runs sweeps until the bound is met, `maxSweeps` at most; warm start from light.radiosity (from the dark where the
/// last report has something not finite). Blocking.
SolveReport solve(Context& context, const FacetList& facets, const FormFactors& matrix, Lighting& light,
                  const Settings& settings, uint32_t maxSweeps);

}  // namespace irad
