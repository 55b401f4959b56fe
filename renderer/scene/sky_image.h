// A picture of the whole sphere around a scene.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace irad {

struct LinearPicture;

/// Radiance, equirectangular, top row first (shaders/shared/sky.h), finite and not negative.
struct SkyTexels {
  glm::uvec2 size{1};
  std::vector<glm::vec3> texels{glm::vec3(1)};
  /// Towards a texel's middle, unit.
  glm::dvec3 direction(size_t texel) const;
};

/// A sun that was taken out of a picture.
struct SkySun {
  glm::vec3 towards{0};     ///< unit, in the unturned picture
  glm::vec3 irradiance{0};  ///< of a surface that faces it
  bool operator==(const SkySun&) const = default;
};

struct SkyImage {
  std::filesystem::path path;               ///< absolute
  std::string sha256;                       ///< of the file
  std::shared_ptr<const SkyTexels> whole;   ///< as it was given
  std::shared_ptr<const SkyTexels> texels;  ///< without the sun, if it has one
  std::optional<SkySun> sun;
};
/// A sun is texels far above the mean, close together, with a share of all light: few rays would meet it, and those
/// would be white dots. Where they were, the result has what is around.
SkyImage withoutSun(std::shared_ptr<const SkyTexels> whole);

/// Skies are held at most so wide; wider ones are averaged.
inline constexpr uint32_t kMostSkyWidth = 4096;

/// Whether a picture may be one of the whole sphere: twice as wide as high.
bool maySkyBe(const LinearPicture& picture);
/// What a file (renderer/base/image_io.h, readLinear) holds as a sky. InputError where that is no picture of the
/// sphere, holds integers, which end at white, or numbers that are no light.
SkyImage skyOf(const std::filesystem::path& path, const LinearPicture& picture);
SkyImage readSky(const std::filesystem::path& path);

}  // namespace irad
