// `irad study attribution`: which stage an error comes from.
#pragma once

#include <optional>
#include <string>

#include "app/study.h"
#include "gi/study/report.h"

namespace irad::app {

struct AttributionTask;

struct AttributionArguments {
  std::optional<std::string> finer, gatherRays;
  void declare(Options& options);
  AttributionTask task() const;  ///< UsageError
};
void attributionStudy(Machine& machine, const MeasureArguments& measure, const AttributionArguments& arguments,
                      const std::optional<std::string>& scene);

/// UsageError, in the name of `command`, where there is no splitting errors of these settings in this view.
void requireSplittable(const std::string& command, const Settings& settings, const ViewInfo& view);
/// Splits the errors of up to `most` points on a cost study's front of first pictures, from end to end of it, each in a
/// folder split/point-0001 of the study's. One that there is no memory for is left out, with a note.
std::vector<SplitPoint> splitFront(DeviceSession& session, const Scene& scene, const SettingGrid& grid,
                                   const StudyResults& results, const StudyTask& study, const AttributionTask& task,
                                   size_t most);

}  // namespace irad::app
