// Rays of the inspector: one by one, by the oracle and on the device.
#include <fmt/format.h>

#include "gi/inspect.h"
#include "gi/ray_kernel.h"
#include "renderer/base/error.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/trace.h"

namespace irad {

std::vector<uint32_t> Inspector::traceOnDevice(uint32_t facet) const {
  const MatrixParams& params = pipeline_.settings().matrix.gpu;
  const Buffer met(context_.device, "rays of a row", Subsystem::Staging, 4ull * params.rays);
  Frame frame = context_.beginUntimed();
  traceRows(frame, rayKernel(pipeline_.facets(), field(), params), params, facet, /*rows=*/1, met);
  frame.submitAndWait();
  std::vector<uint32_t> out = downloadAs<uint32_t>(context_, met);
  out.resize(oracle::raysOf(places_.list, facet, params));
  return out;
}

RayPath Inspector::path(const oracle::Ray& ray, const oracle::DistanceField* field, double& margin) const {
  std::vector<oracle::Passage::Step> cells;
  const oracle::Hit hit =
      oracle::trace(places_.list, ray, pipeline_.settings().matrix.gpu.hitRule, {.field = field, .steps = &cells});
  margin = std::min(margin, hit.margin);
  RayPath path{{}, hit.facet, hit.facet == TRACE_ESCAPED && !cells.empty() ? cells.back().t : hit.t};
  for (size_t i = 0; i < cells.size(); ++i) {
    const double end = i + 1 < cells.size() ? cells[i + 1].t : path.t;
    const bool in = places_.contains(cells[i].cell);
    path.steps.push_back({cells[i].cell, cells[i].t, std::max(end - cells[i].t, 0.0),
                          in ? static_cast<uint32_t>(places_.facetsOf(glm::uvec3(cells[i].cell)).size()) : 0});
  }
  return path;
}

InspectedRay Inspector::ray(uint32_t facet, uint32_t k) const {
  const MatrixParams& params = pipeline_.settings().matrix.gpu;
  IRAD_CHECK_OP(facet, <, places_.facets.count());
  IRAD_CHECK_OP(k, <, oracle::raysOf(places_.list, facet, params));
  const oracle::Ray ray = oracle::facetRay(places_.list, facet, k, params);
  InspectedRay r{facet, k, ray.origin, ray.direction, {}, {}, 0, 1e9};
  r.dda = path(ray, nullptr, r.margin);
  r.sdf = path(ray, &field_, r.margin);
  r.device = traceOnDevice(facet).at(k);
  return r;
}

std::string describeMet(uint32_t met) {
  switch (met) {
    case TRACE_ESCAPED:
      return "left the grid";
    case TRACE_BLOCKED:
      return "the back of a face";
    case TRACE_INVALID:
      return "invalid: not known which facet";
    default:
      return fmt::format("facet {}", met);
  }
}

std::string describe(const InspectedRay& r) {
  const auto end = [](const RayPath& p) {
    return fmt::format("{} at {:.2f} voxels in {} cells", describeMet(p.met), p.t, p.steps.size());
  };
  std::string text = r.dda.met == r.sdf.met
                         ? fmt::format("DDA and SDF agree: {} (SDF {})", end(r.dda), r.sdf.steps.size())
                         : fmt::format("DDA and SDF differ: DDA {}; SDF {}", end(r.dda), end(r.sdf));
  // Where the two paths part for good: the first cell of the SDF's path that the DDA never entered.
  if (r.dda.met != r.sdf.met)
    for (const RayStep& step : r.sdf.steps) {
      const auto known = [&](const RayStep& s) { return s.cell == step.cell; };
      if (std::any_of(r.dda.steps.begin(), r.dda.steps.end(), known)) continue;
      text += fmt::format(", off the ray's cells from ({}, {}, {}) on", step.cell.x, step.cell.y, step.cell.z);
      break;
    }
  if (r.device != r.dda.met && r.device != r.sdf.met)
    text += fmt::format("; the device met {}{}", describeMet(r.device),
                        r.margin < 1e-3 ? ", a decision too close for fp32" : "");
  return text;
}

}  // namespace irad
