#include "renderer/base/ticks.h"

#include <cmath>
#include <utility>

namespace irad {

std::vector<double> ticks(double low, double high, int most) {
  if (low > high) std::swap(low, high);
  if (!std::isfinite(low) || !std::isfinite(high) || low == high) return {};
  // The smallest of the round steps that makes few enough.
  double power = std::pow(10.0, std::floor(std::log10((high - low) / most)));
  std::vector<double> out;
  for (;; power *= 10)
    for (const double step : {power, 2 * power, 5 * power}) {
      // A multiple that rounding puts beyond an end is still there.
      const double first = std::ceil(low / step - 1e-6), last = std::floor(high / step + 1e-6);
      if (last - first + 1 > most) continue;
      for (double k = first; k <= last; ++k) out.push_back(k * step + 0.0);  // + 0: no minus before a zero
      return out;
    }
}

}  // namespace irad
