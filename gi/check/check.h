// `irad check`: the catalogue of hard cases, each with its set-up, its oracle (a closed form, a conservation law, a
// bound, a converged solve) and its marks. A case measures figures; a figure with a mark is judged, others are printed.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gi/check/run.h"

namespace irad {

struct Family;

struct CheckCase {
  const char* name;
  const char* setup;
  const char* oracle;
  const char* mark;
  void (*run)(CheckRun&) = nullptr;  ///< none: it cannot be run yet
  /// What `irad view check:NAME` opens; none where the case has no scene (a sampler, an encoding), or is a family.
  Scene (*scene)() = nullptr;
  /// What H should be in `scene`; none where the oracle does not give it.
  glm::dvec3 (*expected)(const glm::dvec3& position, const glm::dvec3& normal) = nullptr;
  /// Why it cannot be run yet or, where there is something to run, until when it is known to fail: then it is run only
  /// where it is asked for by name.
  const char* pending = nullptr;
  bool soak = false;               ///< long: CheckRun::quick shortens it
  const Family* family = nullptr;  ///< whose members it opens
};

/// All cases, in the catalogue's order.
std::span<const CheckCase> checkCases();
/// UsageError lists near matches of an unknown name.
const CheckCase& findCheckCase(std::string_view name);

/// "check:NAME" or, of a family, "check:NAME:SEED" and "check:NAME:SEED:N" (its member for N voxels; 1 and 64 where
/// they are not said), as `irad view` takes it.
bool isCheckScene(const std::filesystem::path& path);
/// The case of such a path; UsageError where there is none, or not such a member of it.
const CheckCase& caseOf(const std::filesystem::path& path);
/// loadScene, or the scene of a case, which has no sidecar. UsageError where a case has none, or is no family and a
/// seed is given.
Scene openScene(const std::filesystem::path& path, const LoadOptions& options = {});
/// What is known about a scene that openScene made; empty: nothing.
ExpectedIrradiance expectedIrradiance(const Scene& scene);

struct CheckOutcome {
  std::vector<CheckFigure> figures;
  std::string error;  ///< the case threw: what
  double milliseconds = 0;
  bool passed() const;
  /// The figure that the case's line shows: the judged one with the greatest strain or, where several share it, the one
  /// that strains `beside` most. Null: there is none.
  const CheckFigure* decisive(const CheckOutcome* beside = nullptr) const;
  const CheckFigure* find(const std::string& figure) const;
};
/// Runs one case. Errors of the program become CheckOutcome::error.
CheckOutcome runCheck(Context& context, const CheckCase& check, const Settings& settings, const CheckOptions& options);

/// N = 64, 384 rays: the least at which the marks hold.
void applyCheckSizes(Settings& settings);
/// The thesis's mode with the sizes and the seed of `settings`; its figures are shown beside ours.
Settings thesisBeside(const Settings& settings);

}  // namespace irad
