#include "renderer/base/student.h"

#include <cmath>
#include <limits>

#include "renderer/base/error.h"

namespace irad {
namespace {

/// The regularized incomplete beta function I_x(a, b) for x below (a + 1) / (a + b + 2), by its continued fraction
/// (Abramowitz and Stegun 1964, 26.5.8), evaluated as Lentz does it.
double betaFraction(double x, double a, double b) {
  const double tiny = 1e-300;
  const auto away = [&](double value) { return std::abs(value) < tiny ? tiny : value; };
  double c = 1, d = 1 / away(1 - (a + b) * x / (a + 1)), fraction = d;
  for (int m = 1; m <= 1000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double step = 1;
    for (const double term : {even, odd}) {
      d = 1 / away(1 + term * d);
      c = away(1 + term / c);
      step = c * d;
      fraction *= step;
    }
    if (std::abs(step - 1) < 1e-15) break;
  }
  const double front =
      std::exp(a * std::log(x) + b * std::log1p(-x) + std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b));
  return front * fraction / a;
}

/// P(T > t), t >= 0.
double studentTail(double t, double freedom) {
  const double x = freedom / (freedom + t * t), a = freedom / 2, b = 0.5;
  if (t <= 0) return 0.5;
  return 0.5 * (x < (a + 1) / (a + b + 2) ? betaFraction(x, a, b) : 1 - betaFraction(1 - x, b, a));
}

}  // namespace

double studentQuantile(double upper, double freedom) {
  IRAD_CHECK_OP(upper, >, 0.0);
  IRAD_CHECK_OP(upper, <, 0.5);
  double low = 0, high = 1;
  while (studentTail(high, freedom) > upper) high *= 2;
  for (int i = 0; i < 80; ++i) {
    const double t = 0.5 * (low + high);
    (studentTail(t, freedom) > upper ? low : high) = t;
  }
  return low;
}

MeanInterval meanInterval(std::span<const double> samples) {
  MeanInterval out;
  const double n = static_cast<double>(samples.size());
  for (const double sample : samples) out.mean += sample;
  out.mean /= n;
  if (samples.size() < 2) {
    out.half = std::numeric_limits<double>::infinity();
    return out;
  }
  double squares = 0;
  for (const double sample : samples) squares += (sample - out.mean) * (sample - out.mean);
  out.half = studentQuantile(0.025, n - 1) * std::sqrt(squares / (n - 1) / n);
  return out;
}

}  // namespace irad
