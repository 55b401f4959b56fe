#include "gi/check/path_sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace irad::truth {

using glm::dvec2, glm::dvec3;
using std::numbers::pi;

SkyLight::SkyLight(Sky sky) : sky_(std::move(sky)) {
  if (!sky_.whole) return;
  if (sky_.model.w > 0) layGround();
  const glm::ivec2 size(sky_.whole->size);
  double sum = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      double light = 0;
      for (int k = 0; k < 9; ++k) {
        const dvec3 t = texel(x + k % 3 - 1, y + k / 3 - 1);
        light += (t.x + t.y + t.z) * (k == 4 ? 4 : 1);
      }
      cumulative_.push_back(sum += light * solidAngle(static_cast<uint32_t>(y)));
    }
  for (double& c : cumulative_) c /= sum;
  if (!(sum > 0)) cumulative_.clear();
}

void SkyLight::layGround() {
  SkyTexels own = *sky_.whole;
  const auto below = own.texels.begin() + static_cast<std::ptrdiff_t>(own.texels.size() / 2);
  std::fill(below, own.texels.end(), glm::vec3(0));
  // The irradiance as pi times the mean over directions that are even in the disc below the hemisphere.
  constexpr int kAcross = 512, kAround = 1024;
  const glm::uvec2 size = own.size;
  dvec3 mean(0);
  for (int i = 0; i < kAcross; ++i)
    for (int k = 0; k < kAround; ++k) {
      const double theta = std::asin(std::sqrt((i + 0.5) / kAcross));
      const auto row = static_cast<size_t>(theta / pi * size.y),
                 column = static_cast<size_t>((k + 0.5) / kAround * size.x);
      mean += dvec3(own.texels[row * size.x + column]) / double{kAcross * kAround};
    }
  const double height = double{sky_.model.y} / glm::length(dvec3(sky_.model));
  const dvec3 radiance = double{sky_.ground.albedo} * (mean + dvec3(sky_.ground.sun) * std::max(height, 0.0) / pi);
  std::fill(below, own.texels.end(), glm::vec3(radiance));
  sky_.whole = std::make_shared<const SkyTexels>(std::move(own));
}

dvec3 SkyLight::texel(int x, int y) const {
  const glm::ivec2 size(sky_.whole->size);
  const size_t column = static_cast<size_t>((x % size.x + size.x) % size.x),
               row = static_cast<size_t>(std::clamp(y, 0, size.y - 1));
  return dvec3(sky_.whole->texels[row * sky_.whole->size.x + column]) * dvec3(sky_.scale);
}

double SkyLight::solidAngle(uint32_t row) const {
  const glm::uvec2 size = sky_.whole->size;
  return 2 * pi / size.x * (std::cos(pi * row / size.y) - std::cos(pi * (row + 1.0) / size.y));
}

dvec2 SkyLight::place(const dvec3& d) const {
  const double turns = std::atan2(d.x, -d.z) / (2 * pi) + 0.5 + double{sky_.turn};
  return dvec2(turns - std::floor(turns), std::acos(std::clamp(d.y, -1.0, 1.0)) / pi) * dvec2(sky_.whole->size);
}

dvec3 SkyLight::radiance(const dvec3& direction) const {
  const dvec2 at = place(direction) - 0.5, low = glm::floor(at), f = at - low;
  const int x = static_cast<int>(low.x), y = static_cast<int>(low.y);
  return glm::mix(glm::mix(texel(x, y), texel(x + 1, y), f.x), glm::mix(texel(x, y + 1), texel(x + 1, y + 1), f.x),
                  f.y);
}

SkyLight::Drawn SkyLight::draw(Random& random) const {
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, random.next());
  const auto index = static_cast<size_t>(found - cumulative_.begin());
  const glm::uvec2 size = sky_.whole->size;
  const auto column = static_cast<double>(index % size.x), row = static_cast<double>(index / size.x);
  const double top = std::cos(pi * row / size.y), bottom = std::cos(pi * (row + 1) / size.y);
  const double y = glm::mix(top, bottom, random.next()), across = std::sqrt(std::max(0.0, 1 - y * y));
  const double azimuth = 2 * pi * ((column + random.next()) / size.x - 0.5 - double{sky_.turn});
  return {{across * std::sin(azimuth), y, -across * std::cos(azimuth)},
          share(index) / solidAngle(static_cast<uint32_t>(row))};
}

double SkyLight::density(const dvec3& direction) const {
  const glm::uvec2 size = sky_.whole->size;
  const glm::uvec2 at = glm::min(glm::uvec2(place(direction)), size - 1u);
  return share(size_t{at.y} * size.x + at.x) / solidAngle(at.y);
}

}  // namespace irad::truth
