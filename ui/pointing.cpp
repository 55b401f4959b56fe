#include "ui/pointing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstring>

#include "gi/facet_places.h"
#include "gi/facets.h"
#include "gi/settings.h"
#include "renderer/base/number_text.h"
#include "renderer/frame/frame.h"
#include "renderer/scene/material_edits.h"
#include "renderer/scene/nearest_triangle.h"
#include "ui/pixel_ray.h"
#include "ui/session.h"

namespace irad {

/// What is known of a scene as it was built, to find places in it.
struct Pointing::Known {
  Known(Session& session, const Pipeline& pipeline)
      : of(&pipeline),
        sha256(pipeline.scene().sha256),
        build(pipeline.revision().build),
        places(session.context, pipeline),
        triangles(pipeline.scene()),
        materials(materialNames(pipeline.scene())) {}
  bool fits(const Pipeline& pipeline) const {
    return of == &pipeline && sha256 == pipeline.scene().sha256 && build == pipeline.revision().build &&
           places.facets.count() == pipeline.facets().count;
  }
  const Pipeline* of;
  std::string sha256;
  uint64_t build;
  FacetPlaces places;
  TriangleFinder triangles;
  std::vector<std::string> materials;
};

Pointing::Pointing() = default;
Pointing::~Pointing() = default;

void Pointing::record(Session& session, Frame& frame) {
  const bool difference = session.showsDifference();
  if (over) {
    const Side& side = over->other && session.comparison ? session.comparison->other : session;
    const Targets& shown = over->reference && session.split ? session.split->targets
                           : difference                     ? session.comparison->difference
                                                            : side.targets;
    const Asked asked{*over, session.pictures};
    const auto holds = [&](const Targets& t) { return over->pixel.x < t.size.x && over->pixel.y < t.size.y; };
    if (asked_ != asked && session.pictures > 0 && holds(shown) && holds(side.targets)) {
      asked_ = asked;
      const auto into = [&](const Image& image, auto& to) {
        frame.readback(image, over->pixel, glm::uvec2(1),
                       [&to](std::span<const uint8_t> bytes) { std::memcpy(&to, bytes.data(), bytes.size()); });
      };
      texels_.surfaces = showsSurfaces(session);
      if (texels_.surfaces) {
        into(side.targets.depth, texels_.depth);
        into(side.targets.geometric, texels_.geometric);
      }
      frame.readback(shown.linear, over->pixel, glm::uvec2(1),
                     [this, over = *over, view = session.view, difference](std::span<const uint8_t> bytes) {
                       std::memcpy(&texels_.value, bytes.data(), bytes.size());
                       texels_.over = over;
                       texels_.view = view;
                       texels_.difference = difference;
                       fresh_ = true;
                     });
    }
  } else {
    asked_.reset();
  }
  if (large.size == glm::uvec2(0) || session.comparison || session.split) {
    askedRegion_.reset();
    values.clear();
  } else if (const AskedRegion asked{large, session.pictures};
             askedRegion_ != asked && glm::all(glm::lessThanEqual(large.corner + large.size, session.targets.size))) {
    askedRegion_ = asked;
    frame.readback(session.targets.linear, large.corner, large.size,
                   [this, region = large](std::span<const uint8_t> bytes) {
                     values.resize(bytes.size() / sizeof(glm::vec4));
                     std::memcpy(values.data(), bytes.data(), bytes.size());
                     valuesOf = region;
                   });
  }
}

bool Pointing::take(Session& session) {
  if (!std::exchange(fresh_, false) || !session.built) return false;
  read(session);
  return true;
}

const Pointing::Known& Pointing::known(Session& session, const Side& side, bool other) {
  std::unique_ptr<Known>& mine = known_[other ? 1 : 0];
  if (!mine || !mine->fits(*side.pipeline)) {
    std::swap(known_[0], known_[1]);  // the sides may have changed places
    if (!mine || !mine->fits(*side.pipeline)) mine = std::make_unique<Known>(session, *side.pipeline);
  }
  return *mine;
}

void Pointing::read(Session& session) {
  const Texels& t = texels_;
  const bool other = t.over.other && session.comparison;
  const Side& side = other ? session.comparison->other : session;
  const ViewInfo* info = viewInfo(t.view);
  if (info == nullptr || session.view != t.view || session.showsDifference() != t.difference) return;
  Reading r{.pixel = t.over.pixel, .value = {}, .material = {}, .facet = {}, .voxel = {}};

  const Quantity quantity =
      t.difference ? differenceQuantity(*info, session.edited) : shownQuantity(*info, session.edited);
  r.value = fmt::format("{}", fmt::join(pixelNumbers(t.difference ? VIEW_KIND_SIGNED : info->kind, t.value), "  "));
  if (!quantity.unit.empty() && t.value.w > 0) r.value += " " + prettyUnit(quantity.unit);

  // Where the light is not at rest, the facets may be about to be others.
  const std::optional<ShownPoint> surface =
      t.surfaces ? surfaceBehind(session, t.over.pixel, t.depth, t.geometric) : std::nullopt;
  if (side.built && (side.asleep() || session.paused)) {
    const Known& scene = known(session, side, other);
    if (const auto cell = cellBehind(session, scene.places, t.over.pixel, surface)) {
      r.voxel = cell->voxel;
      r.facet = cell->facet;
    }
    std::optional<uint32_t> triangle;
    if (surface)
      triangle = scene.triangles.nearest(side.pipeline->scene(), surface->position, surface->normal);
    else if (!t.surfaces && r.facet && *r.facet < scene.places.triangles.size())
      triangle = scene.places.triangles[*r.facet] & ~SURFEL_BACK;
    if (triangle) r.material = scene.materials.at(materialOf(side.pipeline->scene(), *triangle));
  }
  reading = std::move(r);
}

std::vector<std::string> pixelNumbers(uint32_t kind, const glm::vec4& linear) {
  if (!(linear.w > 0)) return {"nothing"};
  const auto number = [](float v) { return fmt::format("{:.4g}", v); };
  if (viewHasRange(kind)) return {number(linear.x)};
  return {number(linear.x), number(linear.y), number(linear.z)};
}

}  // namespace irad
