#include "renderer/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/flip.h"

namespace irad {
namespace {

/// The difference of two infinities is NaN.
bool comparable(const glm::vec4& v, const glm::vec4& r) {
  const glm::dvec3 d = glm::dvec3(v) - glm::dvec3(r);
  return std::isfinite(d.x + d.y + d.z);
}

double square(double value) {
  return value * value;
}

}  // namespace

Metrics measure(std::span<const glm::vec4> values, std::span<const glm::vec4> reference) {
  IRAD_CHECK_OP(values.size(), ==, reference.size());
  Metrics m;
  double squares = 0, relative = 0, sum = 0, sumReference = 0, peak = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    if (!comparable(values[i], reference[i])) {
      ++m.leftOut;
      continue;
    }
    const glm::dvec3 r(reference[i]), d = glm::dvec3(values[i]) - r;
    ++m.elements;
    for (int c = 0; c < 3; ++c) {
      squares += d[c] * d[c];
      relative += d[c] * d[c] / (r[c] * r[c] + kRelMseEpsilon);
      sum += d[c];
      sumReference += r[c];
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
  m.meanReference = sumReference / n;
  const double epsilon = square(.1 * m.meanReference);
  for (size_t i = 0; i < values.size(); ++i) {
    if (!comparable(values[i], reference[i])) continue;
    const glm::dvec3 r(reference[i]), d = glm::dvec3(values[i]) - r;
    for (int c = 0; c < 3; ++c)
      if (d[c] != 0) m.scaledRelMse += d[c] * d[c] / (r[c] * r[c] + epsilon) / n;
  }
  return m;
}

PairedMetrics measurePaired(std::span<const glm::vec4> values, std::span<const glm::vec4> first,
                            std::span<const glm::vec4> second) {
  IRAD_CHECK_OP(values.size(), ==, first.size());
  IRAD_CHECK_OP(values.size(), ==, second.size());
  const auto counts = [&](size_t i) { return comparable(values[i], first[i]) && comparable(values[i], second[i]); };
  double n = 0, sum = 0;
  for (size_t i = 0; i < values.size(); ++i)
    if (counts(i))
      for (int c = 0; c < 3; ++c) ++n, sum += .5 * (double{first[i][c]} + double{second[i][c]});
  const double epsilon = square(.1 * sum / n);
  double products = 0, relative = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    if (!counts(i)) continue;
    for (int c = 0; c < 3; ++c) {
      const double v = values[i][c], r = first[i][c], s = second[i][c], product = (v - r) * (v - s);
      products += product;
      if (product != 0) relative += product / (square(.5 * (r + s)) + epsilon);
    }
  }
  if (n == 0) return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  return {std::sqrt(std::max(products / n, 0.0)), relative / n};
}

PictureMetrics measurePicture(glm::uvec2 size, std::span<const glm::vec4> values, std::span<const glm::vec4> reference,
                              std::span<const glm::vec4> second, std::optional<double> exposure,
                              std::span<const glm::vec4> error) {
  IRAD_CHECK_OP(values.size(), ==, size_t{size.x} * size.y);
  IRAD_CHECK(error.empty() || (error.size() == values.size() && !second.empty()), "{} standard errors for {} pixels",
             error.size(), values.size());
  IRAD_CHECK_OP(reference.size(), ==, values.size());
  const std::span<const glm::vec4> other = second.empty() ? reference : second;
  IRAD_CHECK_OP(other.size(), ==, values.size());
  PictureMetrics out;
  std::vector<glm::vec4> middle(values.size());
  for (size_t i = 0; i < middle.size(); ++i) middle[i] = 0.5f * (reference[i] + other[i]);
  out.pixels = measure(values, middle);

  const double epsilon = square(.1 * out.pixels.meanReference);
  double relative = 0, variance = 0;
  size_t blocks = 0;
  for (uint32_t y0 = 0; y0 + kBlockSide <= size.y; y0 += kBlockSide)
    for (uint32_t x0 = 0; x0 + kBlockSide <= size.x; x0 += kBlockSide) {
      glm::dvec3 v(0), r(0), s(0), squaredError(0);
      bool whole = true;
      for (uint32_t y = y0; y < y0 + kBlockSide; ++y)
        for (uint32_t x = x0; x < x0 + kBlockSide; ++x) {
          const size_t i = size_t{y} * size.x + x;
          whole = whole && comparable(values[i], middle[i]);
          v += glm::dvec3(values[i]);
          r += glm::dvec3(reference[i]);
          s += glm::dvec3(other[i]);
          if (!error.empty()) squaredError += glm::dvec3(error[i]) * glm::dvec3(error[i]);
        }
      if (!whole) continue;
      ++blocks;
      const double n = square(kBlockSide);
      for (int c = 0; c < 3; ++c) {
        const double product = (v[c] - r[c]) * (v[c] - s[c]) / (n * n);
        const double against = square((r[c] + s[c]) / (2 * n)) + epsilon;
        if (product != 0) relative += product / against;
        // product = (v - m)^2 - ((r - s) / 2)^2: normal deviates of variance e^2 both, the first about the difference
        // d, so that its own variance is 4 d^2 e^2 + 4 e^4.
        const double e2 = squaredError[c] / (n * n);
        if (e2 > 0) variance += 4 * e2 * (std::max(product, 0.0) + e2) / square(against);
      }
    }
  out.blockRelMse =
      blocks > 0 ? relative / (3.0 * static_cast<double>(blocks)) : std::numeric_limits<double>::quiet_NaN();
  if (!error.empty() && blocks > 0)
    out.blockRelMseHalf = 1.96 * std::sqrt(variance) / (3.0 * static_cast<double>(blocks));

  if (!exposure) {
    out.flip = std::numeric_limits<double>::quiet_NaN();
    return out;
  }
  const auto exposed = [&](std::span<const glm::vec4> from) {
    std::vector<glm::vec4> to(from.begin(), from.end());
    for (glm::vec4& pixel : to)
      for (int c = 0; c < 3; ++c) {
        const double value = *exposure * static_cast<double>(pixel[c]);
        pixel[c] = std::isfinite(value) ? static_cast<float>(std::clamp(value, 0.0, 1.0)) : value > 0 ? 1.0f : 0.0f;
      }
    return to;
  };
  out.flip = flip(size, exposed(values), exposed(middle));
  return out;
}

}  // namespace irad
