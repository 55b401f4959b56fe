// A path tracer on the triangles: what pictures are judged by. It shares the scene with the program and nothing else:
// no facets, no shaders or headers of theirs, no sampler; its rays are Embree's, its random numbers its own.
//
// Surfaces are Lambertian with the albedo of docs/method.md (base colour x (1 - metallic), clamped to [0, .98]). With
// TraceOptions::glossy they have the specular lobe, too (path_lobe.h).
// Texels that a mask cuts out let every ray through; where a surface blends it is there with the probability alpha.
// The back of a single-sided face stops all rays and is black, but for those of the camera, which see through it.
// Cosines, at lights and of bounces, are taken with the vertices' interpolated normal, turned to the side that was
// met, and the normal map about it; what comes from behind the face itself adds nothing, and of the diffuse part what
// grazes bumps less (pastBumps), both as in Cycles.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "gi/sky.h"

namespace irad {

struct Camera;
struct Scene;

/// How light is found that may both be drawn and be come upon, emissive triangles and the sky: all are unbiased.
enum class TraceStrategy { both, lights, bounces };

struct TraceOptions {
  uint32_t samples = 64;  ///< per pixel, > 1
  uint64_t seed = 1;
  /// Rays through the middle of each pixel, as a rasterizer samples; otherwise spread over it evenly.
  bool centred = false;
  uint32_t threads = 0;  ///< 0: all cores; the picture does not depend on it, to the bit
  bool glossy = false;   ///< the full metallic-roughness material, not its diffuse part alone
  /// With `glossy`: what is not seen by the camera itself has its diffuse part alone, so that light comes to what is
  /// seen as the program's H does.
  bool glossySeen = false;
  uint32_t bounces = 0;  ///< TracedPicture::bounces, how many
  TraceStrategy strategy = TraceStrategy::both;
};

/// Radiance of every pixel, top row first, W/(m^2 sr).
struct TracedLight {
  std::vector<glm::dvec3> mean;
  std::vector<glm::dvec3> error;  ///< standard error of `mean`
  /// Means of every other sample, from the first and from the second on: independent of each other, so that in products
  /// of their deviations noise cancels.
  std::array<std::vector<glm::dvec3>, 2> half;
  glm::dvec3 pictureMean{0}, pictureError{0};  ///< over all pixels, with its standard error
};

struct TracedPicture {
  glm::uvec2 size{0};
  uint32_t samples = 0;
  TracedLight lit;       ///< everything, the sky behind the scene included
  TracedLight indirect;  ///< without emission and sky that are seen and without suns, points and spots at what is seen:
                         ///< rho H/pi, what is seen reflecting by its diffuse part alone
  /// With TraceOptions::glossy what the lobe of what is seen reflects, but for suns, points and spots; otherwise empty.
  TracedLight specular;
  /// The part of `lit` that was reflected k times before it came to what is seen: [0] is what is emitted there, the sky
  /// behind, and all light that comes there straight from where it is made.
  std::vector<TracedLight> bounces;
  uint64_t rays = 0;  ///< that were traced
  double seconds = 0;
};

/// What the samples of each pixel come to so far. A sample's random numbers depend on seed, pixel and its own number
/// alone, and sums are in its order, so that their bits show neither threads nor the calls that they were made in.
struct TracedSums {
  struct Light {
    std::array<std::vector<glm::dvec3>, 2> half;  ///< samples 0, 2, 4, … and 1, 3, 5, …
    std::vector<glm::dvec3> squares;
    bool operator==(const Light&) const = default;
  };
  glm::uvec2 size{0};
  uint32_t samples = 0;  ///< per pixel
  Light lit, indirect;
  Light specular;  ///< empty, or as TracedPicture's
  std::vector<Light> bounces;
  uint64_t rays = 0;
  double seconds = 0;
};
/// Their means and standard errors; at least two samples.
TracedPicture pictureOf(const TracedSums& sums);
/// As pictures are, with w = 1.
std::vector<glm::vec4> pixelsOf(const std::vector<glm::dvec3>& light);
/// The root of the mean over pixels and channels of error^2 / (value^2 + (mean / 10)^2): sqrt(relMSE) that the picture
/// has from its own noise; 0 of a black one.
double relativeNoise(const TracedLight& light);

class PathTracer {
 public:
  virtual ~PathTracer() = default;
  /// `options.samples` further samples of each pixel; `sums` is empty, or from calls with the same camera and options.
  /// Unbiased: paths end by Russian roulette alone. Sums are in double precision. Light: suns, points and spots in full
  /// at every vertex of a path, by one point of those with a size; emissive triangles by one point in proportion to
  /// their power and by the bounce, joined by the balance heuristic (Veach and Guibas 1995); the sky likewise, by one
  /// direction. With a lobe, rays go by it or by the cosine, and every density is that of both.
  virtual void add(const Camera& camera, glm::uvec2 size, const TraceOptions& options, TracedSums& sums) const = 0;
  /// All in one go.
  TracedPicture render(const Camera& camera, glm::uvec2 size, const TraceOptions& options) const;
};

/// Whether this build has one (IRAD_EMBREE).
bool hasPathTracer();
/// Takes scene and sky by value and keeps them. WorkError where this build has none.
std::unique_ptr<PathTracer> makePathTracer(Scene scene, Sky sky = {});

}  // namespace irad
