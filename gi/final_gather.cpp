#include "gi/final_gather.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <numbers>
#include <thread>

#include "gi/facets.h"
#include "gi/host_facets.h"
#include "gi/host_trace.h"
#include "gi/oracle/rays.h"
#include "gi/sky.h"
#include "renderer/base/error.h"
#include "renderer/scene/scene.h"
#include "shaders/shared/trace.h"

namespace irad {
namespace {

/// A line through a pixel's middle, voxel units.
struct EyeRay {
  glm::dvec3 origin, direction;
};

EyeRay eyeRay(const Camera& camera, const glm::dvec3& origin, const Grid& grid, glm::uvec2 size, glm::uvec2 pixel) {
  const glm::dvec2 p = (glm::dvec2(pixel) + 0.5) / glm::dvec2(size) * glm::dvec2(2, -2) + glm::dvec2(-1, 1);
  const glm::dmat3 axes = glm::mat3_cast(glm::dquat(glm::normalize(camera.orientation)));
  const double high = camera.orthographic ? camera.ymag : std::tan(0.5 * camera.yfov);
  const glm::dvec3 aside = axes[0] * (p.x * high * size.x / size.y) + axes[1] * (p.y * high);
  EyeRay ray{camera.position - origin, -axes[2]};
  (camera.orthographic ? ray.origin : ray.direction) += aside;
  ray.origin = (ray.origin - glm::dvec3(grid.origin)) / double{grid.edge};
  return ray;
}

}  // namespace

std::vector<std::optional<glm::dvec3>> gatherAtPixels(Context& context, const FacetList& list, const Camera& camera,
                                                      const glm::dvec3& origin, const GatherTask& task) {
  IRAD_CHECK_OP(task.seen.size(), ==, size_t{task.size.x} * task.size.y);
  IRAD_CHECK_OP(task.radiosity.size(), ==, size_t{list.count});
  const auto watch = [&] {
    if (task.watch) task.watch();
  };
  watch();
  const oracle::Facets facets = oracleFacets(context, list);
  watch();
  const std::unique_ptr<HostTrace> trace = makeHostTrace(context, list);
  std::vector<std::optional<glm::dvec3>> out(task.seen.size());

  const auto pixel = [&](uint32_t index) -> std::optional<glm::dvec3> {
    const std::optional<SeenPoint>& seen = task.seen[index];
    if (!seen || 3 * size_t{seen->triangle} + 2 >= facets.corners.size()) return std::nullopt;
    // The triangle itself, where another one in the same place has the pieces.
    uint32_t own = seen->triangle;
    if (facets.repeats(own)) own = static_cast<uint32_t>(facets.corners[3 * own + 2].w) - 1;
    const EyeRay eye = eyeRay(camera, origin, list.grid, task.size, {index % task.size.x, index / task.size.x});
    const glm::dvec3 a = facets.corner(own, 0), b = facets.corner(own, 1), c = facets.corner(own, 2);
    glm::dvec3 face = glm::normalize(glm::cross(b - a, c - a));
    const double along = glm::dot(eye.direction, face);
    if (!(std::abs(along) > 0)) return std::nullopt;
    const glm::dvec3 at = eye.origin + eye.direction * (glm::dot(a - eye.origin, face) / along);
    if (along > 0) face = -face;
    glm::vec3 about(face);
    if (!task.byFace && glm::dot(seen->normal, seen->normal) > 0.5f) about = glm::normalize(seen->normal);

    const uvec4 shifts = rayShifts(hashUint(index), task.seed, 1);
    const glm::vec3 start = liftedStart(glm::vec3(at), glm::vec3(face));
    std::vector<HostRay> rays;
    for (uint32_t k = 0; k < task.rays; ++k) {
      const glm::vec3 direction = rayDirection(about, k, task.rays, shifts);
      if (glm::dot(direction, glm::vec3(face)) > 0) rays.push_back({start, direction, own});  // else: nothing comes
    }
    std::vector<uint32_t> hits(rays.size());
    trace->rays(rays, hits);
    glm::dvec3 sum(0);
    uint32_t counted = task.rays;
    for (size_t k = 0; k < rays.size(); ++k) {
      if (hits[k] <= TRACE_LAST_FACET)
        sum += task.radiosity[hits[k]];
      else if (hits[k] == TRACE_ESCAPED && task.sky)
        sum += std::numbers::pi * glm::dvec3(task.sky->radiance(rays[k].direction));
      else if (hits[k] == TRACE_INVALID)
        --counted;
    }
    if (counted == 0) return std::nullopt;
    return sum / static_cast<double>(counted);
  };

  std::atomic<uint32_t> next = 0;
  std::atomic<bool> ended = false;  // before it is done
  const auto work = [&](bool watches) {
    for (uint32_t row; (row = next++) < task.size.y;)
      for (uint32_t x = 0; x < task.size.x && !ended; ++x) {
        out[row * task.size.x + x] = pixel(row * task.size.x + x);
        if (watches) watch();
      }
  };
  std::vector<std::jthread> others;
  for (uint32_t t = 1; t < std::max(1u, std::thread::hardware_concurrency()); ++t) others.emplace_back(work, false);
  try {
    work(true);
  } catch (...) {
    ended = true;
    throw;
  }
  return out;
}

}  // namespace irad
