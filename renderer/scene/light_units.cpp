#include "renderer/scene/light_units.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/scene/scene.h"

namespace irad {
namespace {

/// IEC 61966-2-1: linear sRGB to CIE XYZ, Y of white 1. Columns: X, Y and Z of red, green and blue.
const glm::dmat3 kXyzOfRgb{{0.4124, 0.2126, 0.0193}, {0.3576, 0.7152, 0.1192}, {0.1805, 0.0722, 0.9505}};

double distanceToLocus(const glm::dvec2& uv, double mired) {
  return glm::distance(uv, planckianUv(1e6 / mired));
}

}  // namespace

double solidAngle(const Light& light) {
  const LightKind& kind = lightKind(light.type);
  if (kind.has(LIGHT_DISTANT)) return 0;
  if (!kind.has(LIGHT_CONE)) return 4 * std::numbers::pi;
  // Of the cosine c from the axis: 1 down to the inner angle, then ((c - outer) / (inner - outer))^2, whose integral is
  // a third of the way.
  const double outer = light.outerCos, inner = std::max<double>(light.innerCos, outer);
  return 2 * std::numbers::pi * ((1 - inner) + (inner - outer) / 3);
}

glm::dvec2 planckianUv(double kelvin) {
  const double t = std::clamp(kelvin, kLeastTemperature, kMostTemperature);
  return {(0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * t * t) / (1 + 8.42420235e-4 * t + 7.08145163e-7 * t * t),
          (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * t * t) / (1 - 2.89741816e-5 * t + 1.61456053e-7 * t * t)};
}

glm::vec3 temperatureColor(double kelvin) {
  const glm::dvec2 uv = planckianUv(kelvin);
  // Y is 1: X = 3 u / (2 v), Z = (4 - u - 10 v) / (2 v).
  const glm::dvec3 xyz(1.5 * uv.x / uv.y, 1, (4 - uv.x - 10 * uv.y) / (2 * uv.y));
  const glm::dvec3 rgb = glm::max(glm::inverse(kXyzOfRgb) * xyz, glm::dvec3(0));
  return glm::vec3(rgb / std::max({rgb.r, rgb.g, rgb.b}));
}

std::optional<double> colorTemperature(const glm::vec3& color) {
  const glm::dvec3 xyz = kXyzOfRgb * glm::dvec3(color);
  const double weight = xyz.x + 15 * xyz.y + 3 * xyz.z;
  if (!(weight > 0)) return std::nullopt;
  const glm::dvec2 uv = glm::dvec2(4 * xyz.x, 6 * xyz.y) / weight;
  // Along the locus 1e6 / K runs evenly. The nearest of a few points, then a golden section about it.
  constexpr double least = 1e6 / kMostTemperature, most = 1e6 / kLeastTemperature;
  constexpr int steps = 64;
  const double step = (most - least) / steps;
  double nearest = least;
  for (int i = 1; i <= steps; ++i)
    if (const double at = least + i * step; distanceToLocus(uv, at) < distanceToLocus(uv, nearest)) nearest = at;
  double low = std::max(nearest - step, least), high = std::min(nearest + step, most);
  const double golden = std::numbers::phi - 1;
  for (int i = 0; i < 60; ++i) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    if (distanceToLocus(uv, a) < distanceToLocus(uv, b))
      high = b;
    else
      low = a;
  }
  const double mired = 0.5 * (low + high);
  return distanceToLocus(uv, mired) <= 0.05 ? std::optional(1e6 / mired) : std::nullopt;
}

}  // namespace irad
