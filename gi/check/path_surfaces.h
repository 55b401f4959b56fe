// What the path tracer's rays meet: triangles with their sides, textures and emission, and the lights. Plain code of
// its own, in double precision.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "renderer/scene/scene.h"

namespace irad::truth {

constexpr uint32_t kNoTriangle = ~0u;

/// SplitMix64 (Steele, Lea and Flood 2014): a stream of independent numbers for every seed and index.
class Random {
 public:
  Random(uint64_t seed, uint64_t index) : state_(mixed(seed) + mixed(~index)) {}
  /// Uniform in [0, 1), 53 bits.
  double next() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  uint64_t bits() { return mixed(state_ += kStep); }

 private:
  static constexpr uint64_t kStep = 0x9e3779b97f4a7c15;
  static uint64_t mixed(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    return x ^ (x >> 31);
  }
  uint64_t state_;
};

struct Triangle {
  glm::uvec3 corner{0};  ///< vertices
  uint32_t material = 0;
  glm::dvec3 normal{0};  ///< unit, of the front
  double area = 0;       ///< m^2, > 0
  double share = 0;      ///< probability that Surfaces::drawEmitter takes it
};

/// A point of a surface as it is seen from one side.
struct PathVertex {
  glm::dvec3 position{0};  ///< local
  glm::dvec3 face{0};      ///< unit, of the triangle, on the side that is seen
  glm::dvec3 smooth{0};    ///< unit, interpolated between the vertices, on the same side
  glm::dvec3 normal{0};    ///< unit, by the normal map about `smooth`
  glm::dvec3 albedo{0};    ///< 0..0.98; 0 on the back of a single-sided face; of rays that meet what lets some through
  glm::dvec3 emission{0};  ///< radiance, W/(m^2 sr)
};

/// What a point has beside the diffuse part.
struct Gloss {
  glm::dvec3 f0{0};      ///< reflectance at right angles, 0..1
  double roughness = 1;  ///< 0..1
  double weight = 1;     ///< of the lobe: of rays that meet what lets some through
};

/// A point of an emissive triangle.
struct EmitterPoint {
  uint32_t triangle = 0;
  glm::dvec2 uv{0};        ///< barycentric: of corners 1 and 2
  glm::dvec3 position{0};  ///< local
  double density = 0;      ///< per m^2
};

/// Light from a sun, point or spot at a place, or from one point of it.
struct Arriving {
  glm::dvec3 towards{0};     ///< unit
  double distance = 0;       ///< m; infinite for a sun
  glm::dvec3 irradiance{0};  ///< of a surface that faces it, W/m^2
};

/// The share of the light from a direction that reaches a normal which a map has tilted: what leans towards light that
/// grazes the surface is in the shadow of other bumps (Chiang, Li and Burley 2019, "Taming the Shadow Terminator").
inline double pastBumps(const PathVertex& p, const glm::dvec3& towards) {
  const double g = glm::dot(p.smooth, towards) / (glm::dot(p.smooth, p.normal) * glm::dot(p.normal, towards));
  return g >= 1 ? 1 : g > 0 ? g + g * g - g * g * g : 0;
}

class Surfaces {
 public:
  explicit Surfaces(Scene scene);
  const Scene& scene() const { return scene_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }  ///< those with an area
  bool singleSided(uint32_t triangle) const { return !material(triangle).doubleSided; }
  bool masked(uint32_t triangle) const { return material(triangle).alpha == AlphaMode::Mask; }
  /// Whether the mask cuts this point out.
  bool cutOut(uint32_t triangle, glm::dvec2 uv) const;
  /// It blends, or transmits light.
  bool blended(uint32_t triangle) const {
    return material(triangle).alpha == AlphaMode::Blend || material(triangle).transmission > 0;
  }
  /// What passes such a surface at a point, straight on: what alpha leaves, and of the rest what is transmitted.
  glm::dvec3 passing(uint32_t triangle, glm::dvec2 uv) const;
  /// The share of rays that meet the surface: by chance, of the others each channel keeps passing() over theirs.
  double cover(uint32_t triangle, glm::dvec2 uv) const {
    if (!(material(triangle).transmission > 0)) return alpha(triangle, uv);
    const glm::dvec3 p = passing(triangle, uv);
    return 1 - std::max({p.x, p.y, p.z});
  }
  /// A point of a triangle as a ray along `direction` sees it.
  PathVertex at(uint32_t triangle, glm::dvec2 uv, const glm::dvec3& direction) const;
  /// Nothing where the material is Lambertian, and on the back of a single-sided face.
  std::optional<Gloss> glossAt(uint32_t triangle, glm::dvec2 uv, const glm::dvec3& direction) const;
  /// How far a ray's start is moved off the face, m: a few units in the last place of the largest coordinate.
  double offset(uint32_t triangle) const;

  bool emits() const { return !cumulative_.empty(); }
  /// In proportion to the power of triangles, uniform on each. Only where emits().
  EmitterPoint drawEmitter(Random& random) const;
  /// Density of drawEmitter on a triangle, per m^2.
  double emitterDensity(uint32_t triangle) const { return triangles_[triangle].share / triangles_[triangle].area; }

  size_t lights() const { return scene_.lights.size(); }
  /// KHR_lights_punctual: I / d^2 with the range's window 1 - (d / range)^4 and the square of the cone's ramp; a sun's
  /// illuminance as it is. Nothing where none arrives. All of it comes from one point of a light with a size, uniform
  /// on the disc that is seen of it.
  std::optional<Arriving> arriving(size_t light, const glm::dvec3& position, Random& random) const;

 private:
  const Material& material(uint32_t triangle) const { return scene_.materials[triangles_[triangle].material]; }
  glm::dvec3 position(uint32_t triangle, glm::dvec2 uv) const;
  /// White where the material has no such texture; sRGB is decoded.
  glm::dvec4 texel(uint32_t triangle, const TextureUse& use, glm::dvec2 uv) const;
  /// What the normal map makes of the vertices' normal.
  glm::dvec3 bumped(uint32_t triangle, glm::dvec2 uv, const glm::dvec3& normal) const;
  glm::dvec4 baseColor(uint32_t triangle, glm::dvec2 uv) const;
  double metallic(uint32_t triangle, glm::dvec2 uv) const;
  /// Of what alpha covers: the share of the diffuse part that passes through.
  double transmitted(uint32_t triangle, glm::dvec2 uv) const;
  double alpha(uint32_t triangle, glm::dvec2 uv) const;
  /// What a pane does to a ray that meets it, over what alpha says: fewer do.
  double weight(uint32_t triangle, glm::dvec2 uv) const;

  Scene scene_;
  std::vector<Triangle> triangles_;
  std::vector<uint32_t> emitters_;
  std::vector<double> cumulative_;  ///< of the emitters' shares, ends in 1
};

}  // namespace irad::truth
