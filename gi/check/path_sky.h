// The sky as the path tracer has it: the texels that the program has, looked up and drawn from by code of its own. What
// a computed sky has below its horizon is computed here once more.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "gi/check/path_surfaces.h"
#include "gi/sky.h"

namespace irad::truth {

class SkyLight {
 public:
  explicit SkyLight(Sky sky);
  bool shines() const { return !cumulative_.empty(); }
  /// Interpolated between the texels' middles, the sun included.
  glm::dvec3 radiance(const glm::dvec3& direction) const;
  /// A direction in proportion to what its texel and those around shine, and the density there, per steradian. Only
  /// where it shines.
  struct Drawn {
    glm::dvec3 direction{0};
    double density = 0;
  };
  Drawn draw(Random& random) const;
  double density(const glm::dvec3& direction) const;

 private:
  void layGround();                                     ///< in place of what the program has below the horizon
  glm::dvec2 place(const glm::dvec3& direction) const;  ///< in texels
  glm::dvec3 texel(int x, int y) const;                 ///< any x, the nearest y
  double solidAngle(uint32_t row) const;
  double share(size_t texel) const { return cumulative_[texel] - (texel > 0 ? cumulative_[texel - 1] : 0); }

  Sky sky_;
  std::vector<double> cumulative_;  ///< of the texels' shares, ends in 1
};

}  // namespace irad::truth
