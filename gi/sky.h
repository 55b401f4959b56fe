// Light from a sky (docs/method.md 6): a picture of the sphere around the scene, of which facets know the means over
// bins of directions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "renderer/resources.h"
#include "shaders/shared/sky.h"

namespace irad {

class Context;
class Frame;
struct FormFactors;
struct Lighting;
struct SkySettings;

/// Radiance, equirectangular, top row first (shared/sky.h), finite and not negative.
struct SkyTexels {
  glm::uvec2 size{1};
  std::vector<glm::vec3> texels{glm::vec3(1)};
};

/// A sky by others.
struct SkyImage {
  std::filesystem::path path;  ///< absolute
  std::string sha256;          ///< of the file
  std::shared_ptr<const SkyTexels> texels;
};

/// What the settings make of it: `scale` times the texels, turned. Without texels it is black.
struct Sky {
  std::shared_ptr<const SkyTexels> texels;
  float turn = 0;  ///< about +Y, as a share of a full turn
  glm::vec3 scale{0};
  glm::vec3 radiance(const glm::vec3& direction) const;
  float largest() const;  ///< radiance, of any channel
  bool operator==(const Sky&) const = default;
};
/// `image`: of sky.source = image; null: there is none, and the sky is black.
Sky makeSky(const SkySettings& settings, const SkyImage* image);

/// The mean radiance of each bin of directions, of those with `edge` x `edge` squares on a face of the cube.
std::vector<glm::vec4> skyBins(const Sky& sky, uint32_t edge = SKY_EDGE);

/// A sky as shaders read it; black ones have no buffers.
struct SkyOnDevice {
  Sky sky;  ///< that it was made from
  Buffer texels, bins;
  Buffer record;  ///< one SkyPicture
  explicit operator bool() const { return static_cast<bool>(record); }
};
/// Brings it up to date; what has not changed is kept.
void place(Context& context, const Sky& sky, SkyOnDevice& onDevice);

/// light.sky becomes the irradiance from the sky, pi x mean radiance x share of rays summed over the bins into which a
/// facet's rays escape; where there is no sky it is freed.
void gatherSky(Frame& frame, const FormFactors& matrix, const SkyOnDevice& sky, Lighting& light);

}  // namespace irad
