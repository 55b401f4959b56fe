#include "ui/pixel_ray.h"

#include <glm/gtc/packing.hpp>

#include "gi/settings.h"
#include "gi/views/views.h"
#include "renderer/forward.h"

namespace irad {

PixelRay::PixelRay(const Session& session, const glm::uvec2& pixel)
    : inverse_(glm::inverse(
          glm::dmat4(makeGpuCamera(session.pipeline->scene(), session.shown, session.targets.size).viewProjection))),
      share_((glm::dvec2(pixel) + 0.5) / glm::dvec2(session.targets.size)),
      origin_(session.pipeline->scene().origin) {}

glm::dvec3 PixelRay::at(double depth) const {
  const glm::dvec4 p = inverse_ * glm::dvec4(share_.x * 2 - 1, 1 - share_.y * 2, depth, 1);
  return glm::dvec3(p) / p.w + origin_;
}

std::optional<ShownPoint> surfaceBehind(const Session& session, const glm::uvec2& pixel, float depth,
                                        uint64_t geometric) {
  if (!(depth > 0)) return std::nullopt;
  return ShownPoint{PixelRay(session, pixel).at(depth), glm::dvec3(glm::unpackHalf4x16(geometric))};
}

bool showsSurfaces(const Session& session) {
  const View pictureOf = session.reference ? session.reference->of : VIEW_LIT;
  return !resolveShape(session.view, session.edited.view.shape) &&
         (sourcesOf(session.view, session.edited, pictureOf) & FROM_TARGETS) != 0;
}

std::optional<SliceCell> cellBehind(const Session& session, const FacetPlaces& places, const glm::uvec2& pixel,
                                    const std::optional<ShownPoint>& surface) {
  const auto cell = [&](std::optional<uint32_t> facet) {
    return facet ? std::optional(SliceCell{places.facets.voxel.at(*facet), facet}) : std::nullopt;
  };
  if (showsSurfaces(session)) return surface ? cell(places.facetAt(surface->position, surface->normal)) : std::nullopt;
  const ViewInfo* info = viewInfo(session.view);
  if (info == nullptr || info->isFrom(FROM_SHADOW_MAPS)) return std::nullopt;  // seen from a light
  const PixelRay ray(session, pixel);
  if (resolveShape(session.view, session.edited.view.shape) != ViewShape::slice)
    return cell(places.facetAlong(ray.start(), ray.direction()));
  const glm::dvec3 forward(session.shown.orientation * glm::vec3(0, 0, -1));
  return places.inSlice(ray.start(), ray.direction(), forward, session.edited.view);
}

}  // namespace irad
