// The numerical watch: what the solver counts on the device (shared/solve.h), traced to its stage, and said in words.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "shaders/shared/grid.h"

namespace irad {

class Context;
struct Defect;
struct EnergyBalance;
struct FacetList;
struct Lighting;
struct SolveReport;

/// Where the light of a solve went wrong; nothing where every number is finite and >= 0. Reads everything back, so it
/// is called only when the solver's counts say that there is something to find.
std::optional<Defect> findDefect(Context& context, const FacetList& facets, const Lighting& light);

/// The energy balance of B, H, D and M as they are (gi/energy.comp). Deterministic, blocking.
EnergyBalance balance(Context& context, const FacetList& facets, const Lighting& light);

/// "in 3.21, absorbed 3.20, escaped 0.01 W, imbalance -0.05 %": all channels; voxels of this edge.
std::string describe(const EnergyBalance& energy, double edge);

/// Largest |imbalance| that is no finding. Voxels alone make .2 % in Sponza at N = 64, and in the Box scene 1.7 % at N
/// = 64 and 6 % at N = 24; a lost light, bounce or wall makes far more.
inline constexpr double kImbalance = 0.1;

struct Finding {
  enum class Severity { Warning, Error } severity;
  std::string text;  ///< one line
};
/// What there is to say about a solve, errors first. `origin`: world position of the grid's corner. `frame`: of the
/// relight.
std::vector<Finding> findings(const SolveReport& report, const Grid& grid, glm::dvec3 origin, uint64_t frame);

/// "12 NaN, 0 infinite, 3 negative of 4096 pixels, the first at X, Y" (from the top left) of a linear picture; negative
/// ones count where it `showsLight`. Empty: none.
std::string findBadPixels(std::span<const glm::vec4> linear, glm::uvec2 size, bool showsLight);

}  // namespace irad
