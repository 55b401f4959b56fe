#include "ui/metric_rows.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "ui/words.h"

namespace irad {
namespace {

const char* const kNone = "\u2014";

}  // namespace

std::vector<MetricRow> metricRows(const PictureMetrics& metrics, const std::string& value, const std::string& reference,
                                  const std::string& unit) {
  const Metrics& m = metrics.pixels;
  const std::string units = unit.empty() ? "No unit." : fmt::format("In {}.", unit);
  const std::string relMse =
      std::isfinite(metrics.blockRelMseHalf)
          ? fmt::format("{} \u00B1 {}", withDigits(metrics.blockRelMse), withDigits(metrics.blockRelMseHalf))
          : withDigits(metrics.blockRelMse);
  return {
      {"relMSE", relMse,
       fmt::format("({0} \u2212 {1})\u00B2 / ({1}\u00B2 + (0.1 mean {1})\u00B2), the mean over blocks of {2} \u00D7 "
                   "{2} pixels; of voxels, over voxels. It has no unit.",
                   value, reference, kBlockSide)},
      {"RMSE", withDigits(m.rmse), "Root of the mean squared difference. " + units},
      {"mean error", fmt::format("{}{}", m.meanError > 0 ? "+" : "", withDigits(m.meanError)),
       fmt::format("Mean of {} \u2212 {}: signed. {}", value, reference, units)},
      {"PSNR", std::isfinite(m.psnr) ? fmt::format("{:.1f} dB", m.psnr) : kNone,
       fmt::format("20 log10(largest {} / RMSE); \u2014: equal", reference)},
      {"FLIP", std::isfinite(metrics.flip) ? withDigits(metrics.flip) : kNone,
       "How different they look to one who flips between them, 0 to 1, at the exposure shown; of pictures, where "
       "it was asked for"},
      {"largest", withDigits(m.largest), fmt::format("Of |{} \u2212 {}|. {}", value, reference, units)}};
}

std::vector<MetricRow> metricRows(const Metrics& metrics, const std::string& value, const std::string& reference,
                                  const std::string& unit) {
  PictureMetrics all;
  all.pixels = metrics;
  all.blockRelMse = metrics.scaledRelMse;
  all.flip = std::numeric_limits<double>::quiet_NaN();
  return metricRows(all, value, reference, unit);
}

}  // namespace irad
