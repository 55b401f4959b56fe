#include "ui/inspection.h"

#include <algorithm>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <utility>

#include "gi/inspect.h"
#include "renderer/base/error.h"
#include "renderer/forward.h"
#include "renderer/scene/nearest_triangle.h"
#include "ui/session.h"

namespace irad {
namespace {

constexpr size_t kSamples = 400;  ///< samples of H that are remembered

}  // namespace

Inspection::Inspection() = default;
Inspection::~Inspection() = default;

double Inspection::edge() const {
  return inspector_ ? double{inspector_->grid().edge} : 0;
}

Inspector& Inspection::inspector(Session& session) {
  const Pipeline& pipeline = *session.pipeline;
  if (!inspector_ || of_ != &pipeline) {
    inspector_ = std::make_unique<Inspector>(session.context, pipeline);
    of_ = &pipeline;
    scene_ = pipeline.scene().path;
  } else if (revision_ != pipeline.revision()) {
    inspector_->refresh();
  }
  revision_ = pipeline.revision();
  return *inspector_;
}

void Inspection::reset() {
  voxel.reset();
  chosen = 0;
  other.reset();
  comparison.reset();
  ray.reset();
  replay.reset();
  live.clear();
  highlighted.reset();
  sweeps_ = 0;
  if (shown == Show::Comparison) shown = Show::Row;
}

void Inspection::pickFacet(uint32_t facet) {
  reset();
  voxel = inspector_->voxel(inspector_->voxelOf(facet));
  while (voxel->facets.at(chosen).facet != facet) ++chosen;
  live.push_back({0, glm::vec3(this->facet()->irradiance)});
}

void Inspection::open(Session& session, const glm::uvec3& at) {
  Inspector& in = inspector(session);
  in.requireFacets(at);
  trail.clear();
  pickFacet(in.facetsOf(at).front());
  ++serial;
}

namespace {

/// A pixel of the picture as it is shown, by its depths.
class PixelRay {
 public:
  PixelRay(const Session& session, const glm::uvec2& pixel)
      : inverse_(glm::inverse(
            glm::dmat4(makeGpuCamera(session.pipeline->scene(), session.shown, session.targets.size).viewProjection))),
        share_((glm::dvec2(pixel) + 0.5) / glm::dvec2(session.targets.size)),
        origin_(session.pipeline->scene().origin) {}
  /// World; depth 1 is the near plane.
  glm::dvec3 at(double depth) const {
    const glm::dvec4 p = inverse_ * glm::dvec4(share_.x * 2 - 1, 1 - share_.y * 2, depth, 1);
    return glm::dvec3(p) / p.w + origin_;
  }

 private:
  glm::dmat4 inverse_;
  glm::dvec2 share_;
  glm::dvec3 origin_;
};

}  // namespace

/// None where there is no surface.
std::optional<Inspection::Surface> Inspection::surfaceUnder(Session& session, const glm::uvec2& pixel) {
  const Targets& targets = session.targets;
  float depth = 0;
  std::memcpy(&depth, downloadTexel(session.context, targets.depth, pixel).data(), sizeof(depth));
  if (depth <= 0) return std::nullopt;
  uint64_t packed = 0;
  std::memcpy(&packed, downloadTexel(session.context, targets.geometric, pixel).data(), sizeof(packed));
  return Surface{PixelRay(session, pixel).at(depth), glm::dvec3(glm::unpackHalf4x16(packed))};
}

/// Picks from the picture as it is shown: the cell of a slice, the first cube on the way, or the surface in the pixel.
std::optional<SliceCell> Inspection::under(Session& session, const glm::uvec2& pixel) {
  const auto cell = [&](std::optional<uint32_t> facet) {
    return facet ? std::optional(SliceCell{inspector_->voxelOf(*facet), facet}) : std::nullopt;
  };
  if (const auto shape = resolveShape(session.view, session.edited.view.shape)) {
    const PixelRay ray(session, pixel);
    const glm::dvec3 start = ray.at(1), direction = glm::normalize(ray.at(0) - start);
    if (*shape != ViewShape::slice) return cell(inspector_->facetAlong(start, direction));
    const glm::dvec3 forward(session.shown.orientation * glm::vec3(0, 0, -1));
    return inspector_->inSlice(start, direction, forward, session.edited.view);
  }
  const std::optional<Surface> surface = surfaceUnder(session, pixel);
  return surface ? cell(inspector_->facetAt(surface->position, surface->normal)) : std::nullopt;
}

/// That of the surface in the pixel; of a view of voxels that of the facet that has just been picked.
std::optional<uint32_t> Inspection::materialUnder(Session& session, const glm::uvec2& pixel) {
  const Scene& scene = session.pipeline->scene();
  if (resolveShape(session.view, session.edited.view.shape)) {
    if (facet() == nullptr || !facet()->mesh) return std::nullopt;
    return materialOf(scene, facet()->mesh->triangle);
  }
  const std::optional<Surface> surface = surfaceUnder(session, pixel);
  if (!surface) return std::nullopt;
  const std::optional<uint32_t> triangle = nearestTriangle(scene, surface->position, surface->normal);
  return triangle ? std::optional(materialOf(scene, *triangle)) : std::nullopt;
}

void Inspection::compareWith(uint32_t facet) {
  other = inspector_->facet(facet);
  comparison = compareRows(this->facet()->row, other->row);
  shown = Show::Comparison;
}

void Inspection::serveRequests(Session& session) {
  Inspector& in = inspector(session);
  if (std::exchange(clear, false)) {
    reset();
    trail.clear();
  }
  if (const auto wanted = std::exchange(pick, std::nullopt)) {
    const std::optional<SliceCell> found = under(session, wanted->pixel);
    if (found && found->facet && wanted->compare && facet()) {
      compareWith(*found->facet);
    } else if (!wanted->compare) {
      trail.clear();
      reset();
      if (found && found->facet)
        pickFacet(*found->facet);
      else if (found)
        voxel = in.voxel(found->voxel);
      session.material = materialUnder(session, wanted->pixel);
    }
  }
  if (const auto wanted = std::exchange(follow, std::nullopt)) {
    if (facet()) trail.push_back(facet()->facet);
    pickFacet(*wanted);
  }
  if (const auto wanted = std::exchange(choose, std::nullopt); wanted && voxel)
    pickFacet(voxel->facets.at(*wanted).facet);
  if (std::exchange(goBack, false) && !trail.empty()) {
    pickFacet(trail.back());
    trail.pop_back();
  }
  if (const auto wanted = std::exchange(traceRay, std::nullopt); wanted && facet())
    ray = in.ray(facet()->facet, std::min(*wanted, facet()->rays.rays - 1));
  if (std::exchange(wantReplay, false) && facet()) {
    replay = replaySolve(session.context, *session.pipeline, {facet()->facet});
    session.context.finish();
    session.context.timings.forget();  // its sweeps belong to no frame
  }
}

/// After a rebuild the voxels are other ones: the facet at the same place, or none; none in another scene.
bool Inspection::update(Session& session) {
  if (!voxel || (of_ == session.pipeline.get() && revision_ == session.pipeline->revision())) return false;
  const bool rebuilt = of_ != session.pipeline.get() || revision_.build != session.pipeline->revision().build;
  const bool sameScene = scene_ == session.pipeline->scene().path;
  const std::optional<InspectedFacet> before = facet() ? std::optional(*facet()) : std::nullopt;
  Inspector& in = inspector(session);
  if (rebuilt) {
    const std::optional<uint32_t> same =
        sameScene && before ? in.facetAt(before->position, before->normal) : std::optional<uint32_t>();
    reset();
    trail.clear();
    if (same) pickFacet(*same);
    return true;
  }
  if (!before) return false;  // light does not reach into an empty voxel
  voxel = in.voxel(voxel->voxel);
  sweeps_ += session.built->solve.sweeps;
  live.push_back({sweeps_, glm::vec3(facet()->irradiance)});
  if (live.size() > kSamples) live.pop_front();
  replay.reset();
  if (other) {
    other = in.facet(other->facet);
    comparison = compareRows(facet()->row, other->row);
  }
  return true;
}

bool Inspection::serve(Session& session) {
  if (!session.built || session.halted) {
    if (!wanted()) return false;
    forgetRequests();
    session.note("Nothing can be inspected until the rebuild has succeeded");
    return true;
  }
  try {
    const bool asked = wanted();
    if (pick && pick->other && pick->compare) {
      pick.reset();
      session.note("Rows are compared within one side: Shift-click the side that is edited");
    } else if (pick && pick->other) {
      session.swapSides();
    }
    const bool updated = update(session);
    if (asked) serveRequests(session);
    if (facet() != nullptr) session.edited.view.facet = facet()->facet;
    if (asked || updated) ++serial;
    return asked || updated;
  } catch (const Error& error) {
    forgetRequests();
    reset();
    session.error(error.what());
    return true;
  }
}

void Inspection::forgetRequests() {
  pick.reset();
  follow.reset();
  choose.reset();
  traceRay.reset();
  goBack = wantReplay = clear = false;
}

}  // namespace irad
