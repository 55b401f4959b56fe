// `irad study attribution`: which stage an error comes from.
#pragma once

#include <optional>
#include <string>

#include "app/study.h"

namespace irad::app {

struct AttributionArguments {
  std::optional<std::string> finer, gatherRays;
  void declare(Options& options);
};
void attributionStudy(Machine& machine, const MeasureArguments& measure, const AttributionArguments& arguments,
                      const std::optional<std::string>& scene);

}  // namespace irad::app
