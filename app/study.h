// What studies and `irad tune` are asked: how to measure, and by what to choose.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/arguments.h"
#include "app/reference.h"
#include "app/study_run.h"
#include "gi/study/pick.h"

namespace irad::app {

/// Scene, truth, seeds, repeats, folder.
struct MeasureArguments {
  std::vector<std::string> sweeps;
  std::optional<std::string> out, seeds, repeats, view, referenceSamples, secondReference;
  ReferenceArgument reference;
  SceneArguments sceneOptions;
  SettingArguments settings;
  DeviceArguments device;
  PictureArguments picture;
  void declare(Options& options, const std::string& defaultFolder);
  /// UsageError of what can be told before a device is opened.
  void check() const;
  /// The scene, and what to measure in it: out, seeds, repeats, view, truth, camera, size. `command` ("irad tune") is
  /// for messages. Without any reference the path tracer's with `otherwise` samples, where this build has one.
  std::pair<Scene, StudyTask> open(DeviceSession& session, const std::string& command,
                                   const std::optional<std::string>& scene,
                                   std::optional<uint32_t> otherwise = std::nullopt) const;
};

/// The files of a study's folder that say which study it is, and nothing of what was found.
inline const std::vector<std::string> kStudyLabels{"study.json", "named.json"};

/// --budget-ms, --budget-mib, --target-error, --cost.
struct BudgetArguments {
  std::optional<std::string> ms, mib, error, cost;
  void declare(Options& options, const std::string& prefix);
  Budget budget(const std::string& command) const;  ///< UsageError where there is none
  const CostKind& kind() const;                     ///< first_picture where --cost is absent
};

/// An even number of samples of an option.
uint32_t evenSamples(const std::string& option, const std::string& text);

/// Prints what a chosen point has and costs (`p`), and what the front of `points` has beside it.
void printChoice(const PointSummary& p, const std::vector<PointSummary>& points, const CostKind& cost);

}  // namespace irad::app
