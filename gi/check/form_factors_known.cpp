// What the light of some of the check scenes is known to be.
#include <cmath>
#include <numbers>

#include "gi/check/scenes.h"

namespace irad {

double formFactorPolygon(const glm::dvec3& position, const glm::dvec3& normal,
                         const std::array<glm::dvec3, 4>& corners) {
  double sum = 0;
  for (size_t i = 0; i < 4; ++i) {
    const glm::dvec3 a = glm::normalize(corners[i] - position), b = glm::normalize(corners[(i + 1) % 4] - position);
    const glm::dvec3 c = glm::cross(a, b);
    sum += glm::dot(glm::normalize(c), normal) * std::atan2(glm::length(c), glm::dot(a, b));
  }
  return std::abs(sum) / (2 * std::numbers::pi);
}

double formFactorParallelSquares(double d) {
  const double x = 1 / d, x2 = 1 + x * x;
  return 2 / (std::numbers::pi * x * x) *
         (0.5 * std::log(x2 * x2 / (1 + 2 * x * x)) + 2 * x * std::sqrt(x2) * std::atan(x / std::sqrt(x2)) -
          2 * x * std::atan(x));
}

double formFactorPerpendicularSquares() {
  // Howell C-14 with H = W = 1.
  const double atan1 = std::atan(1.0);
  return (2 * atan1 - std::sqrt(2.0) * std::atan(1 / std::sqrt(2.0)) +
          0.25 * std::log(4.0 / 3.0 * (3.0 / 4.0) * (3.0 / 4.0))) /
         std::numbers::pi;
}

std::pair<double, double> plateRadiosity(double gap, double rho0, double rho1) {
  constexpr int n = 32;
  std::vector<double> kernel(n * n);  // F between patches (dx, dz) apart, by 4 x 4 points of the receiver's patch
  for (int dz = 0; dz < n; ++dz)
    for (int dx = 0; dx < n; ++dx)
      for (int s = 0; s < 16; ++s) {
        const double x = (dx + (s % 4 - 1.5) / 4) / n, z = (dz + (s / 4 - 1.5) / 4) / n;
        const double r2 = x * x + z * z + gap * gap;
        kernel[dz * n + dx] += gap * gap / (std::numbers::pi * r2 * r2) / (n * n) / 16;
      }
  const auto product = [&](const std::vector<double>& b) {
    std::vector<double> h(n * n, 0.0);
    for (int i = 0; i < n * n; ++i)
      for (int j = 0; j < n * n; ++j) h[i] += kernel[std::abs(i / n - j / n) * n + std::abs(i % n - j % n)] * b[j];
    return h;
  };
  std::vector<double> b0(n * n, 0.0), b1(n * n, 0.0);
  for (int sweep = 0; sweep < 40; ++sweep) {
    const std::vector<double> h0 = product(b1), h1 = product(b0);
    for (int i = 0; i < n * n; ++i) b0[i] = 1 + rho0 * h0[i], b1[i] = rho1 * h1[i];
  }
  double mean0 = 0, mean1 = 0;
  for (int i = 0; i < n * n; ++i) mean0 += b0[i] / (n * n), mean1 += b1[i] / (n * n);
  return {mean0, mean1};
}

}  // namespace irad
