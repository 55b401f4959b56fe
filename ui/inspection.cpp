#include "ui/inspection.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "gi/inspect.h"
#include "renderer/base/error.h"
#include "renderer/scene/nearest_triangle.h"
#include "renderer/scene/nodes.h"
#include "ui/pixel_ray.h"
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

void Inspection::leavePipeline() {
  inspector_.reset();  // another pipeline may come to lie where this one is
  of_ = nullptr;
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
  pickFacet(in.places().facetsOf(at).front());
  ++serial;
}

/// None where there is no surface.
std::optional<ShownPoint> Inspection::surfaceUnder(Session& session, const glm::uvec2& pixel) {
  const Targets& targets = session.targets;
  float depth = 0;
  std::memcpy(&depth, downloadTexel(session.context, targets.depth, pixel).data(), sizeof(depth));
  uint64_t packed = 0;
  std::memcpy(&packed, downloadTexel(session.context, targets.geometric, pixel).data(), sizeof(packed));
  return surfaceBehind(session, pixel, depth, packed);
}

/// Picks from the picture as it is shown.
std::optional<SliceCell> Inspection::under(Session& session, const glm::uvec2& pixel) {
  return cellBehind(session, inspector_->places(), pixel,
                    showsSurfaces(session) ? surfaceUnder(session, pixel) : std::optional<ShownPoint>());
}

/// That of the surface in the pixel; of a view of voxels that of the facet that has just been picked.
std::optional<uint32_t> Inspection::triangleUnder(Session& session, const glm::uvec2& pixel) {
  if (!showsSurfaces(session)) {
    if (facet() == nullptr || !facet()->mesh) return std::nullopt;
    return facet()->mesh->triangle;
  }
  const std::optional<ShownPoint> surface = surfaceUnder(session, pixel);
  if (!surface) return std::nullopt;
  return nearestTriangle(session.pipeline->scene(), surface->position, surface->normal);
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
      const Scene& scene = session.pipeline->scene();
      const std::optional<uint32_t> triangle = triangleUnder(session, wanted->pixel);
      session.material = triangle ? std::optional(materialOf(scene, *triangle)) : std::nullopt;
      session.object = triangle ? nodeOf(scene, *triangle) : std::nullopt;
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
        sameScene && before ? in.places().facetAt(before->position, before->normal) : std::optional<uint32_t>();
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
