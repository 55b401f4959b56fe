#include "gi/preetham.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace irad {
namespace {

using std::numbers::pi;

/// Perez' distribution over the sky: a x T + b for each of A to E, and of the zenith's value for chromaticities.
struct Distribution {
  std::array<glm::dvec2, 5> of;  ///< A to E: slope in the turbidity, and value at none
  double at(double turbidity, double cosine, double gamma) const {
    std::array<double, 5> c;
    for (size_t i = 0; i < c.size(); ++i) c[i] = of[i].x * turbidity + of[i].y;
    const double g = std::cos(gamma);
    return (1 + c[0] * std::exp(c[1] / cosine)) * (1 + c[2] * std::exp(c[3] * gamma) + c[4] * g * g);
  }
};

// Appendix A.2.
constexpr Distribution kLuminance{
    {{{0.1787, -1.4630}, {-0.3554, 0.4275}, {-0.0227, 5.3251}, {0.1206, -2.5771}, {-0.0670, 0.3703}}}};
constexpr Distribution kX{
    {{{-0.0193, -0.2592}, {-0.0665, 0.0008}, {-0.0004, 0.2125}, {-0.0641, -0.8989}, {-0.0033, 0.0452}}}};
constexpr Distribution kY{
    {{{-0.0167, -0.2608}, {-0.0950, 0.0092}, {-0.0079, 0.2102}, {-0.0441, -1.6537}, {-0.0109, 0.0529}}}};
/// Of the zenith's chromaticity: rows by powers of the turbidity, from the second down, columns by those of the sun's
/// angle, from the third down.
using Zenith = std::array<glm::dvec4, 3>;
constexpr Zenith kZenithX{
    {{0.00166, -0.00375, 0.00209, 0}, {-0.02903, 0.06377, -0.03202, 0.00394}, {0.11693, -0.21196, 0.06052, 0.25886}}};
constexpr Zenith kZenithY{
    {{0.00275, -0.00610, 0.00317, 0}, {-0.04214, 0.08970, -0.04153, 0.00516}, {0.15346, -0.26756, 0.06670, 0.26688}}};

double zenith(const Zenith& m, double turbidity, double s) {
  const glm::dvec4 powers(s * s * s, s * s, s, 1);
  return (glm::dot(m[0], powers) * turbidity + glm::dot(m[1], powers)) * turbidity + glm::dot(m[2], powers);
}

/// CIE xyY to linear Rec. 709.
glm::dvec3 linear(double x, double y, double luminance) {
  const glm::dvec3 c(x / y * luminance, luminance, (1 - x - y) / y * luminance);
  return {3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z, -0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z,
          0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z};
}

constexpr glm::uvec2 kSize(512, 256);

}  // namespace

double preethamZenith(double turbidity, double fromZenith) {
  const double chi = (4.0 / 9 - turbidity / 120) * (pi - 2 * fromZenith);
  return (4.0453 * turbidity - 4.9710) * std::tan(chi) - 0.2155 * turbidity + 2.4192;
}

double preethamSun(double turbidity, double fromZenith) {
  constexpr double kAboveAir = 133.8;     // klx
  constexpr double kMicrometres = 0.555;  // where eyes see best: of the spectrum of appendix A.1 the one wavelength
  constexpr double kOzone = 0.35, kOzoneAbsorption = 0.085;  // cm, 1/cm
  const double degrees = std::clamp(fromZenith * 180 / pi, 0.0, 85.0);
  const double mass = 1 / (std::cos(degrees * pi / 180) + 0.15 * std::pow(93.885 - degrees, -1.253));
  const double aerosols = (0.04608 * turbidity - 0.04586) * std::pow(kMicrometres, -1.3);
  const double rayleigh = 0.008735 * std::pow(kMicrometres, -4.08);
  return kAboveAir * std::exp(-mass * (rayleigh + aerosols + kOzone * kOzoneAbsorption));
}

SkyTexels preethamSky(float turbidity, const glm::vec3& towardsSun) {
  const double t = turbidity;
  glm::dvec3 sun(towardsSun);
  sun.y = std::max(sun.y, 0.0);
  sun = glm::length(sun) > 0 ? glm::normalize(sun) : glm::dvec3(0, 0, -1);
  const double fromZenith = std::acos(std::clamp(sun.y, 0.0, 1.0));
  // Each quantity at the zenith, over its distribution there.
  const double luminance = std::max(preethamZenith(t, fromZenith), 0.0) / kLuminance.at(t, 1, fromZenith);
  const double x = zenith(kZenithX, t, fromZenith) / kX.at(t, 1, fromZenith);
  const double y = zenith(kZenithY, t, fromZenith) / kY.at(t, 1, fromZenith);
  SkyTexels sky;
  sky.size = kSize;
  sky.texels.assign(size_t{kSize.x} * kSize.y, glm::vec3(0));
  for (size_t i = 0; i < sky.texels.size() / 2; ++i) {  // above the horizon
    const glm::dvec3 d = sky.direction(i);
    const double gamma = std::acos(std::clamp(glm::dot(d, sun), -1.0, 1.0));
    const glm::dvec3 color =
        linear(x * kX.at(t, d.y, gamma), y * kY.at(t, d.y, gamma), luminance * kLuminance.at(t, d.y, gamma));
    sky.texels[i] = glm::vec3(glm::max(color, 0.0));
  }
  return sky;
}

glm::dvec3 irradianceFromAbove(const SkyTexels& sky) {
  // Row by row: the integral of cos theta over its part of the sphere, times the mean of its texels.
  glm::dvec3 sum(0);
  for (uint32_t y = 0; y < sky.size.y / 2; ++y) {
    glm::dvec3 row(0);
    for (uint32_t x = 0; x < sky.size.x; ++x) row += glm::dvec3(sky.texels[size_t{y} * sky.size.x + x]);
    const double top = std::sin(pi * y / sky.size.y), bottom = std::sin(pi * (y + 1.0) / sky.size.y);
    sum += row * (pi * (bottom * bottom - top * top) / sky.size.x);
  }
  return sum;
}

}  // namespace irad
