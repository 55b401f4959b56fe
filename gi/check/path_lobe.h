// The specular lobe of metallic-roughness materials as the path tracer has it: GGX microfacets, Smith's
// height-correlated masking and shadowing, Schlick's Fresnel (docs/method.md 8), in double precision and by code of its
// own. It is added to the diffuse part, which it takes nothing from, as in the program's pictures.
#pragma once

#include <glm/glm.hpp>

#include "gi/check/path_surfaces.h"

namespace irad::truth {

/// Two unit directions across `normal`, and it.
glm::dmat3 frameAbout(const glm::dvec3& normal);

/// The lobe at a point, seen from one side. Vectors are unit; in local ones z is along the normal.
class Lobe {
 public:
  /// A lobe whose alpha (roughness squared) is below this is a mirror: its rays go one way, as the program's do.
  static constexpr double kMirrorAlpha = 1e-3;
  /// Towards suns, points and spots, whose mirror image has no size, no lobe is narrower: the program's
  /// GGX_LEAST_ALPHA.
  static constexpr double kLeastAlpha = 2e-3;
  /// What the view's cosine is lifted to where the normal leans away from it; the program's, too.
  static constexpr double kLeastCosine = 1e-3;

  Lobe() = default;
  Lobe(const glm::dvec3& f0, double roughness, const glm::dvec3& normal, const glm::dvec3& towardsViewer,
       double weight = 1);
  explicit operator bool() const { return there_; }  ///< false: no lobe
  bool mirror() const { return alpha_ < kMirrorAlpha; }
  /// Schlick's Fresnel at the normal: about what the lobe reflects.
  glm::dvec3 reflectance() const { return fresnel(view_.z); }

  /// Reflected radiance by incident radiance and steradian, without the cosine; 0 below the horizon and of a mirror.
  glm::dvec3 value(const glm::dvec3& towards) const;
  /// The same towards a light that has no size, or is taken for one.
  glm::dvec3 valueOfPoint(const glm::dvec3& towards) const;
  /// A direction by the normals that are seen (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical
  /// Caps"), or the mirror's; it may lie below the horizon.
  glm::dvec3 draw(Random& random) const;
  double density(const glm::dvec3& towards) const;  ///< of draw(), per steradian; 0 of a mirror
  /// Of a mirror: the share of the radiance along draw().
  glm::dvec3 mirrored() const { return fresnel(view_.z); }

 private:
  glm::dvec3 fresnel(double cosine) const;
  glm::dvec3 value(const glm::dvec3& towards, double alpha) const;

  bool there_ = false;
  glm::dvec3 f0_{0};
  double alpha_ = 1, weight_ = 1;
  glm::dmat3 frame_{1};
  glm::dvec3 view_{0, 0, 1};  ///< local
};

/// D of the half vector whose squared sine to the normal this is.
double ggxDensity(double sine2, double alpha);
/// Smith's Lambda.
double smithLambda(double cosine, double alpha);

}  // namespace irad::truth
