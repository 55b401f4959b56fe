// The metrics of pictures as panels show them (docs/conventions.md, Metrics): one list, the headline first.
#pragma once

#include <string>
#include <vector>

#include "renderer/metrics.h"

namespace irad {

struct MetricRow {
  const char* name;
  std::string text;  ///< "—" where there is none
  std::string help;
};
/// `value` and `reference`: what they are called, "B" and "A"; `unit`: of both, prettyUnit(). blockRelMse with its
/// interval where it is known, PSNR infinite and FLIP NaN as "—".
std::vector<MetricRow> metricRows(const PictureMetrics& metrics, const std::string& value, const std::string& reference,
                                  const std::string& unit);
/// The same rows of values that are no picture: no blocks, no FLIP.
std::vector<MetricRow> metricRows(const Metrics& metrics, const std::string& value, const std::string& reference,
                                  const std::string& unit);

}  // namespace irad
