#include "renderer/scene/sky_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include "renderer/base/error.h"
#include "renderer/base/image_io.h"
#include "renderer/base/sha256.h"
#include "renderer/scene/scene.h"

namespace irad {
namespace {

using std::numbers::pi;

/// What is no light among the texels, in words; empty where all is.
std::string faults(const LinearPicture& picture) {
  size_t nan = 0, infinite = 0, negative = 0;
  std::optional<size_t> first;
  for (size_t i = 0; i < picture.pixels.size(); ++i) {
    const glm::vec3 t(picture.pixels[i]);
    const bool isNan = glm::any(glm::isnan(t)), isInfinite = !isNan && glm::any(glm::isinf(t)),
               isNegative = !isNan && !isInfinite && glm::any(glm::lessThan(t, glm::vec3(0)));
    nan += isNan, infinite += isInfinite, negative += isNegative;
    if (!first && (isNan || isInfinite || isNegative)) first = i;
  }
  if (!first) return {};
  return fmt::format("{} NaN, {} infinite and {} negative of {} texels, the first at {}, {}: a sky needs light", nan,
                     infinite, negative, picture.pixels.size(), *first % picture.size.x, *first / picture.size.x);
}

// What makes a sun: how far above the mean its texels are, as a share of the brightest at least, what it covers at most
// (a disc of 9 degrees: pictures blur it), and its share of all light at least.
constexpr double kAboveMean = 20, kOfBrightest = 0.01, kLargestSun = 0.02, kLeastShare = 0.01;

double luminanceOf(const glm::vec3& t) {
  return 0.2126 * t.x + 0.7152 * t.y + 0.0722 * t.z;
}

/// Texels with their places on the sphere.
struct Sphere {
  const SkyTexels& sky;
  double solidAngle(size_t texel) const {
    const double row = static_cast<double>(texel / sky.size.x), rows = sky.size.y;
    return 2 * pi / sky.size.x * (std::cos(pi * row / rows) - std::cos(pi * (row + 1) / rows));
  }
  /// Those around, across the seam too; fewer at the poles.
  std::vector<size_t> around(size_t texel) const {
    std::vector<size_t> out;
    const auto x = static_cast<uint32_t>(texel % sky.size.x), y = static_cast<uint32_t>(texel / sky.size.x);
    for (uint32_t k = 0; k < 9; ++k) {
      const uint32_t column = (x + sky.size.x + k % 3 - 1) % sky.size.x, row = y + k / 3 - 1;
      if (k != 4 && row < sky.size.y) out.push_back(size_t{row} * sky.size.x + column);
    }
    return out;
  }
};

}  // namespace

glm::dvec3 SkyTexels::direction(size_t texel) const {
  const double theta = pi * (static_cast<double>(texel / size.x) + 0.5) / size.y,
               azimuth = 2 * pi * ((static_cast<double>(texel % size.x) + 0.5) / size.x - 0.5);
  return {std::sin(theta) * std::sin(azimuth), std::cos(theta), -std::sin(theta) * std::cos(azimuth)};
}

SkyImage withoutSun(std::shared_ptr<const SkyTexels> whole) {
  SkyImage image{.path = {}, .sha256 = {}, .whole = whole, .texels = whole, .sun = {}};
  const std::vector<glm::vec3>& texels = whole->texels;
  const Sphere sphere{*whole};
  double all = 0;
  size_t brightest = 0;
  for (size_t i = 0; i < texels.size(); ++i) {
    all += luminanceOf(texels[i]) * sphere.solidAngle(i);
    if (luminanceOf(texels[i]) > luminanceOf(texels[brightest])) brightest = i;
  }
  const double least = std::max(kAboveMean * all / (4 * pi), kOfBrightest * luminanceOf(texels[brightest]));
  if (!(luminanceOf(texels[brightest]) > least)) return image;

  // From the brightest texel to all that are bright and touch; what they touch besides is what is around.
  std::vector<size_t> sun{brightest}, rim;
  std::set<size_t> seen{brightest};
  double covered = 0;
  for (size_t next = 0; next < sun.size() && covered <= kLargestSun; ++next) {
    covered += sphere.solidAngle(sun[next]);
    for (const size_t i : sphere.around(sun[next]))
      if (seen.insert(i).second) (luminanceOf(texels[i]) > least ? sun : rim).push_back(i);
  }
  if (covered > kLargestSun || rim.empty()) return image;
  glm::dvec3 around(0), irradiance(0), towards(0);
  for (const size_t i : rim) around += glm::dvec3(texels[i]) / static_cast<double>(rim.size());
  for (const size_t i : sun) {
    const glm::dvec3 more = glm::max(glm::dvec3(texels[i]) - around, 0.0) * sphere.solidAngle(i);
    irradiance += more;
    towards += whole->direction(i) * luminanceOf(glm::vec3(more));
  }
  if (!(luminanceOf(glm::vec3(irradiance)) > kLeastShare * all)) return image;
  auto rest = std::make_shared<SkyTexels>(*whole);
  for (const size_t i : sun) rest->texels[i] = glm::vec3(around);
  image.texels = std::move(rest);
  image.sun = SkySun{glm::vec3(glm::normalize(towards)), glm::vec3(irradiance)};
  return image;
}

bool maySkyBe(const LinearPicture& picture) {
  return picture.size.x == 2 * picture.size.y;
}

SkyImage skyOf(const std::filesystem::path& path, const LinearPicture& picture) {
  const auto refuse = [&](const std::string& why) { throw InputError(fmt::format("{}: {}", path.string(), why)); };
  if (picture.integers)
    refuse("holds integers, which end at white: a sky needs light without an end, as .hdr, .exr and .pfm hold it");
  if (!maySkyBe(picture))
    refuse(fmt::format("is {} x {} pixels: a sky is a picture of the whole sphere, twice as wide as high",
                       picture.size.x, picture.size.y));
  if (const std::string what = faults(picture); !what.empty()) refuse(what);

  // Averaged to what is held. Squares of texels, so that it stays twice as wide as high.
  const uint32_t step = (picture.size.x + kMostSkyWidth - 1) / kMostSkyWidth;
  auto sky = std::make_shared<SkyTexels>();
  sky->size = glm::uvec2(2, 1) * std::max(1u, picture.size.y / step);
  sky->texels.assign(size_t{sky->size.x} * sky->size.y, glm::vec3(0));
  for (uint32_t y = 0; y < sky->size.y; ++y)
    for (uint32_t x = 0; x < sky->size.x; ++x) {
      glm::vec3 sum(0);
      for (uint32_t i = 0; i < step * step; ++i)
        sum += glm::vec3(picture.pixels[size_t{y * step + i / step} * picture.size.x + x * step + i % step]);
      sky->texels[size_t{y} * sky->size.x + x] = sum / static_cast<float>(step * step);
    }
  SkyImage image = withoutSun(std::move(sky));
  image.path = std::filesystem::absolute(path).lexically_normal();
  image.sha256 = sha256File(path);
  return image;
}

SkyImage readSky(const std::filesystem::path& path) {
  return skyOf(path, readLinear(path));
}

}  // namespace irad
