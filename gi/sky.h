// Light from a sky (docs/method.md 6): a picture of the sphere around the scene, of which facets know the means over
// bins of directions.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "renderer/resources.h"
#include "renderer/scene/sky_image.h"
#include "shaders/shared/sky.h"

namespace irad {

class Context;
class Frame;
struct FormFactors;
struct Light;
struct Lighting;
struct Scene;
struct SkySettings;

/// What is below the horizon of a computed sky: a diffuse plane, lit by that sky and by the sun of the scene that it is
/// coupled to.
struct SkyGround {
  float albedo = 0;
  glm::vec3 sun{0};  ///< irradiance of what faces the sun, in the unit of the texels
  bool operator==(const SkyGround&) const = default;
};

/// What the settings make of it: `scale` times the texels, turned. Without texels it is black.
struct Sky {
  std::shared_ptr<const SkyTexels> texels;  ///< without a sun that is a light
  std::shared_ptr<const SkyTexels> whole;   ///< with it, as one sees it
  float turn = 0;                           ///< about +Y, as a share of a full turn
  glm::vec3 scale{0};
  glm::vec3 most{0};                                     ///< of the texels, by channel
  std::optional<SkySun> sun;                             ///< which shines as a light (gi/pipeline.h); turned and scaled
  glm::vec4 model{0};                                    ///< what texels were computed from: towards the sun, turbidity
  SkyGround ground;                                      ///< and what those below the horizon are
  glm::vec3 radiance(const glm::vec3& direction) const;  ///< without the sun
  float largest() const;                                 ///< radiance, of any channel
  bool operator==(const Sky&) const = default;
};
/// Where a sky takes what is not in its settings from.
struct SkyInputs {
  const SkyImage* image = nullptr;  ///< null: there is none, and sky.source = image is black
  std::optional<SkySun> sun;        ///< the scene's first that shines
};
/// With these lights in place of the scene's.
SkyInputs skyInputs(const Scene& scene, std::span<const Light> lights);
/// `before`: one whose computed texels may serve again.
Sky makeSky(const SkySettings& settings, const SkyInputs& inputs, const Sky* before = nullptr);

/// The mean radiance of each bin of directions, of those with `edge` x `edge` squares on a face of the cube.
std::vector<glm::vec4> skyBins(const Sky& sky, uint32_t edge = SKY_EDGE);

/// A sky as shaders read it; black ones have no buffers.
struct SkyOnDevice {
  Sky sky;                     ///< that it was made from
  Buffer texels, whole, bins;  ///< whole: none without a sun
  Buffer record;               ///< one SkyPicture
  explicit operator bool() const { return static_cast<bool>(record); }
};
/// Brings it up to date; what has not changed is kept.
void place(Context& context, const Sky& sky, SkyOnDevice& onDevice);

/// light.sky becomes the irradiance from the sky, pi x mean radiance x share of rays summed over the bins into which a
/// facet's rays escape; where there is no sky it is freed. `bins`: the sky's, or those with what lies outside
/// (gi/outer.h).
void gatherSky(Frame& frame, const FormFactors& matrix, const Buffer& bins, Lighting& light);

}  // namespace irad
