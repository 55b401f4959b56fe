// What lies behind a pixel of the picture as it is shown.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "gi/facet_places.h"
#include "ui/session.h"

namespace irad {

/// Its line of sight, by depths.
class PixelRay {
 public:
  PixelRay(const Session& session, const glm::uvec2& pixel);
  /// World; depth 1 is the near plane.
  glm::dvec3 at(double depth) const;
  glm::dvec3 start() const { return at(1); }
  glm::dvec3 direction() const { return glm::normalize(at(0) - at(1)); }

 private:
  glm::dmat4 inverse_;
  glm::dvec2 share_;
  glm::dvec3 origin_;
};

/// A point of a surface that was seen.
struct ShownPoint {
  glm::dvec3 position, normal;  ///< world
};
/// From a pixel's texels of Targets::depth and Targets::geometric; none where nothing is drawn.
std::optional<ShownPoint> surfaceBehind(const Session& session, const glm::uvec2& pixel, float depth,
                                        uint64_t geometric);
/// Whether the view's picture has left depth and normal of the surfaces that it shows.
bool showsSurfaces(const Session& session);
/// The cell of a slice, the facet of the surface in the pixel, or that of the first voxel on the way, as the view shows
/// them; none where it does not show the scene.
std::optional<SliceCell> cellBehind(const Session& session, const FacetPlaces& places, const glm::uvec2& pixel,
                                    const std::optional<ShownPoint>& surface);

}  // namespace irad
