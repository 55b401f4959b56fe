#include "renderer/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/base/error.h"

namespace irad {

Metrics measure(std::span<const glm::vec4> values, std::span<const glm::vec4> reference) {
  IRAD_CHECK_OP(values.size(), ==, reference.size());
  Metrics m;
  double squares = 0, relative = 0, sum = 0, peak = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    const glm::dvec3 v(values[i]), r(reference[i]);
    const glm::dvec3 d = v - r;
    if (!std::isfinite(d.x + d.y + d.z)) {  // the difference of two infinities is NaN
      ++m.leftOut;
      continue;
    }
    ++m.elements;
    for (int c = 0; c < 3; ++c) {
      squares += d[c] * d[c];
      relative += d[c] * d[c] / (r[c] * r[c] + kRelMseEpsilon);
      sum += d[c];
      peak = std::max(peak, r[c]);
      m.largest = std::max(m.largest, std::abs(d[c]));
    }
  }
  if (m.elements == 0) return m;
  const double n = 3.0 * static_cast<double>(m.elements);
  m.rmse = std::sqrt(squares / n);
  m.relMse = relative / n;
  m.psnr = m.rmse > 0 ? 20 * std::log10(peak / m.rmse) : std::numeric_limits<double>::infinity();
  m.meanError = sum / n;
  return m;
}

}  // namespace irad
