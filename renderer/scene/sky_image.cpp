#include "renderer/scene/sky_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderer/base/error.h"
#include "renderer/image_io.h"
#include "renderer/scene/scene.h"

namespace irad {
namespace {

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

}  // namespace

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
  return {std::filesystem::absolute(path).lexically_normal(), sha256File(path), std::move(sky)};
}

SkyImage readSky(const std::filesystem::path& path) {
  return skyOf(path, readLinear(path));
}

}  // namespace irad
