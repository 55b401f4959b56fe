#include "renderer/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "renderer/base/error.h"

namespace irad {
namespace {

using Plane = std::vector<double>;
using Kernel = std::vector<double>;  // odd, its middle over the pixel

/// X Y Z of Y = 1 by CIE 1931 x and y.
glm::dvec3 ofChromaticity(double x, double y) {
  return {x / y, 1, (1 - x - y) / y};
}
/// Rec. 709's primaries, so bright that together they are the white D65. To all digits: with the four that
/// IEC 61966-2-1 rounds them to FLIP of single pixels is off by 2e-4 of itself.
const glm::dvec3 kWhite = ofChromaticity(.31271, .32902);
const glm::dmat3 kPrimaries{ofChromaticity(.64, .33), ofChromaticity(.30, .60), ofChromaticity(.15, .06)};
const glm::dvec3 kBrightness = glm::inverse(kPrimaries) * kWhite;
const glm::dmat3 kToXyz{kPrimaries[0] * kBrightness.x, kPrimaries[1] * kBrightness.y, kPrimaries[2] * kBrightness.z};
const glm::dmat3 kFromXyz = glm::inverse(kToXyz);

glm::dvec3 toXyz(const glm::dvec3& c) {
  return kToXyz * c;
}

/// The linear opponent space of the contrast sensitivities, Y C_x C_z, and back to linear light.
glm::dvec3 toOpponents(const glm::dvec3& linear) {
  const glm::dvec3 n = toXyz(linear) / kWhite;
  return {116 * n.y - 16, 500 * (n.x - n.y), 200 * (n.y - n.z)};
}
glm::dvec3 fromOpponents(const glm::dvec3& o) {
  const double y = (o.x + 16) / 116;
  return kFromXyz * (glm::dvec3(y + o.y / 500, y, y - o.z / 200) * kWhite);
}

/// CIE L*a*b*, its chromaticities scaled by lightness (Hunt 1952).
glm::dvec3 toHuntLab(const glm::dvec3& linear) {
  const auto f = [](double t) {
    const double d = 6.0 / 29;
    return t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4.0 / 29;
  };
  const glm::dvec3 n = toXyz(linear) / kWhite;
  const double l = 116 * f(n.y) - 16;
  return {l, .01 * l * 500 * (f(n.x) - f(n.y)), .01 * l * 200 * (f(n.y) - f(n.z))};
}
double hyab(const glm::dvec3& a, const glm::dvec3& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

/// Filters rows by one kernel and columns by another; the picture goes on with its last pixel.
Plane filter(glm::ivec2 size, const Plane& plane, const Kernel& across, const Kernel& down) {
  const auto pass = [&](const Plane& from, const Kernel& kernel, int length, int lines, int step, int lineStep) {
    const int reach = static_cast<int>(kernel.size()) / 2;
    Plane to(from.size());
    for (int line = 0; line < lines; ++line)
      for (int i = 0; i < length; ++i) {
        double sum = 0;
        for (int k = -reach; k <= reach; ++k)
          sum += kernel[static_cast<size_t>(k + reach)] *
                 from[static_cast<size_t>(line * lineStep + std::clamp(i + k, 0, length - 1) * step)];
        to[static_cast<size_t>(line * lineStep + i * step)] = sum;
      }
    return to;
  };
  return pass(pass(plane, across, size.x, size.y, 1, size.x), down, size.y, size.x, size.x, 1);
}

/// exp(-pi^2 x^2 / b), x in degrees, over `reach` pixels to either side.
Kernel gaussian(double b, int reach, double pixelsPerDegree) {
  Kernel kernel;
  for (int k = -reach; k <= reach; ++k) {
    const double x = k / pixelsPerDegree;
    kernel.push_back(std::exp(-std::numbers::pi * std::numbers::pi * x * x / b));
  }
  return kernel;
}
double sum(const Kernel& kernel) {
  return std::accumulate(kernel.begin(), kernel.end(), 0.0);
}
Kernel scaled(Kernel kernel, double factor) {
  for (double& weight : kernel) weight *= factor;
  return kernel;
}
/// What is positive sums to 1 and what is negative to -1.
Kernel balanced(Kernel kernel) {
  double positive = 0, negative = 0;
  for (const double weight : kernel) (weight > 0 ? positive : negative) += weight;
  for (double& weight : kernel) weight /= weight > 0 ? positive : -negative;
  return kernel;
}

/// Weight and width of a Gaussian of a contrast sensitivity (the paper's Table 1).
struct Sensitivity {
  double a, b;
};
constexpr Sensitivity kLuminance[] = {{1, .0047}}, kRedGreen[] = {{1, .0053}},
                      kBlueYellow[] = {{34.1, .04}, {13.5, .025}};

/// One opponent channel as the eye resolves it: a sum of Gaussians, each a sqrt(pi / b) exp(-pi^2 x^2 / b), of sum 1.
Plane seen(glm::ivec2 size, const Plane& plane, std::span<const Sensitivity> gaussians, double pixelsPerDegree) {
  // Three standard deviations of the widest of all.
  const int reach = static_cast<int>(
      std::ceil(3 * std::sqrt(kBlueYellow[0].b / (2 * std::numbers::pi * std::numbers::pi)) * pixelsPerDegree));
  double total = 0;
  Plane out(plane.size(), 0.0);
  for (const auto& [a, b] : gaussians) {
    const Kernel kernel = gaussian(b, reach, pixelsPerDegree);
    const double weight = a * std::sqrt(std::numbers::pi / b);
    total += weight * sum(kernel) * sum(kernel);
    const Plane part = filter(size, plane, scaled(kernel, weight), kernel);
    for (size_t i = 0; i < out.size(); ++i) out[i] += part[i];
  }
  for (double& value : out) value /= total;
  return out;
}

/// A picture as the two halves of the metric see it.
struct Perceived {
  std::vector<glm::dvec3> colors;  ///< filtered, L*a*b* with Hunt's adjustment
  Plane edges, points;             ///< how strong they are
};

Perceived perceive(glm::ivec2 size, std::span<const glm::vec4> picture, double pixelsPerDegree) {
  const size_t count = picture.size();
  std::array<Plane, 3> opponents;
  Plane luminance(count);
  for (Plane& plane : opponents) plane.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const glm::dvec3 o = toOpponents(glm::clamp(glm::dvec3(picture[i]), 0.0, 1.0));
    for (int c = 0; c < 3; ++c) opponents[static_cast<size_t>(c)][i] = o[c];
    luminance[i] = (o.x + 16) / 116;
  }
  Perceived out;
  const Plane y = seen(size, opponents[0], kLuminance, pixelsPerDegree),
              cx = seen(size, opponents[1], kRedGreen, pixelsPerDegree),
              cz = seen(size, opponents[2], kBlueYellow, pixelsPerDegree);
  for (size_t i = 0; i < count; ++i)
    out.colors.push_back(toHuntLab(glm::clamp(fromOpponents({y[i], cx[i], cz[i]}), 0.0, 1.0)));

  // First and second derivative of a Gaussian whose width makes an edge of .082 degrees.
  const double deviation = .5 * .082 * pixelsPerDegree;
  const int reach = static_cast<int>(std::ceil(3 * deviation));
  Kernel smooth, edge, point;
  for (int k = -reach; k <= reach; ++k) {
    const double g = std::exp(-.5 * k * k / (deviation * deviation));
    smooth.push_back(g);
    edge.push_back(-k * g);
    point.push_back((k * k / (deviation * deviation) - 1) * g);
  }
  smooth = scaled(smooth, 1 / sum(smooth));
  const auto strength = [&](const Kernel& kernel) {
    const Plane across = filter(size, luminance, balanced(kernel), smooth),
                down = filter(size, luminance, smooth, balanced(kernel));
    Plane both(count);
    for (size_t i = 0; i < count; ++i) both[i] = std::hypot(across[i], down[i]);
    return both;
  };
  out.edges = strength(edge);
  out.points = strength(point);
  return out;
}

}  // namespace

double huntHyab(const glm::dvec3& linear, const glm::dvec3& other) {
  return hyab(toHuntLab(linear), toHuntLab(other));
}

std::vector<double> flipErrors(glm::uvec2 size, std::span<const glm::vec4> picture,
                               std::span<const glm::vec4> reference, double pixelsPerDegree) {
  IRAD_CHECK_OP(picture.size(), ==, reference.size());
  IRAD_CHECK_OP(picture.size(), ==, size_t{size.x} * size.y);
  const Perceived a = perceive(size, picture, pixelsPerDegree), b = perceive(size, reference, pixelsPerDegree);
  // Differences up to .4 of the largest (green against blue), to the power .7, fill .95 of the range.
  const double power = .7, knee = .4, below = .95;
  const double largest = std::pow(huntHyab({0, 1, 0}, {0, 0, 1}), power);
  std::vector<double> errors;
  for (size_t i = 0; i < picture.size(); ++i) {
    const double distance = std::pow(hyab(a.colors[i], b.colors[i]), power);
    const double color = distance < knee * largest
                             ? below * distance / (knee * largest)
                             : below + (1 - below) * (distance - knee * largest) / (largest - knee * largest);
    const double feature =
        std::sqrt(std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i])) / std::sqrt(2.0));
    errors.push_back(std::pow(std::min(color, 1.0), 1 - std::min(feature, 1.0)));
  }
  return errors;
}

double flip(glm::uvec2 size, std::span<const glm::vec4> picture, std::span<const glm::vec4> reference,
            double pixelsPerDegree) {
  const std::vector<double> errors = flipErrors(size, picture, reference, pixelsPerDegree);
  return errors.empty() ? 0 : std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
}

}  // namespace irad
