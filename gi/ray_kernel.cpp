#include "gi/ray_kernel.h"

#include <algorithm>

#include "gi/facets.h"
#include "gi/subsystems.h"
#include "renderer/base/error.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/trace.h"

namespace irad {

RayKernel rayKernel(const FacetList& facets, const Field& field, const MatrixParams& params) {
  uint32_t method = field.chebyshev ? TRACE_DDA_FIELD : TRACE_DDA_REVERSE;
  if (params.traversal == Traversal::sdf) {
    method = field.method == FieldMethod::jfa ? TRACE_JFA : TRACE_SKIP;
    if (method == TRACE_JFA) IRAD_CHECK(field.jumpFlood.distance.handle, "an sdf traversal without its jfa volume");
    if (method == TRACE_SKIP) IRAD_CHECK(field.chebyshev.handle, "an sdf traversal without its chebyshev field");
  }
  return {method, params.hitRule, facets.encoding, facets, field};
}

uint32_t exactTraversal(const Field& field) {
  return field.chebyshev ? TRACE_SKIP : TRACE_DDA_REVERSE;
}

Pass& mayMeet(Pass& pass, const FacetList& facets) {
  return pass.constant(CONSTANT_TINTED, facets.surface.tinted).effect(CONSTANT_OUTER, static_cast<bool>(facets.outer));
}

Pass& RayKernel::configure(Pass& pass, const Device& device, const std::string& name) const {
  const bool jfa = method == TRACE_JFA;
  mayMeet(pass.shader(name + (jfa ? "_jfa.comp" : ".comp")), facets)
      .constant(CONSTANT_TRACE_METHOD, method)
      .constant(CONSTANT_TRACE_HIT_RULE, hitRule)
      .constant(CONSTANT_NORMALS, encoding);
  if (jfa)
    pass.sample(field.jumpFlood.distance, sampler(device, {.u = Wrap::Clamp,
                                                           .v = Wrap::Clamp,
                                                           .linearMag = false,
                                                           .linearMin = false,
                                                           .mips = false,
                                                           .linearMips = false}));
  return pass;
}

namespace {

/// Dispatches after the first: in each about half of the rays wait again, but in the last.
constexpr uint32_t kWaits = 4;

}  // namespace

WaitingLists makeWaitingLists(const Device& device, uint64_t rays) {
  static_assert(kWaitingBytes == sizeof(WaitingRay) / 4 + sizeof(WaitingRay) / 8);
  const uint64_t groups = device.limits.maxComputeWorkGroupCount[0];
  WaitingLists made;
  for (uint32_t i = 0; i < made.lists.size(); ++i) {
    const uint64_t wanted = ((rays >> (i + 2)) + WAITING_GROUP - 1) / WAITING_GROUP;
    made.room[i] = static_cast<uint32_t>(std::clamp<uint64_t>(wanted, 1, groups) * WAITING_GROUP);
    made.lists[i] = Buffer(device, "matrix scratch: rays that wait", Subsystem::Matrix,
                           sizeof(WaitingHead) + uint64_t{made.room[i]} * sizeof(WaitingRay));
  }
  return made;
}

bool raysWait(const Device& device, const RayKernel& kernel) {
  return !device.isCpu && kernel.hitRule == HitRule::triangles && !kernel.facets.surface.tinted && !kernel.facets.outer;
}

void traceRows(Frame& frame, const RayKernel& kernel, const MatrixParams& params, uint32_t firstRow, uint32_t rows,
               const Buffer& hits, bool sky, const char* stage, const WaitingLists& waiting) {
  const Device& device = frame.context().device;
  const bool triangles = params.hitRule == HitRule::triangles;
  const uint32_t waits = waiting.lists[0] ? kWaits : 0;
  for (uint32_t i = 0; i <= waits; ++i) {
    const Buffer &next = waiting.lists[i % 2], &resumed = waiting.lists[(i + 1) % 2];
    const bool resumes = i > 0, last = i == waits;
    if (!last) frame.pass(stage).update(next, WaitingHead{.groups = glm::uvec3(0, 1, 1), .count = 0});
    Pass pass = frame.pass(stage);
    TraceRaysPush push{};
    push.facets = kernel.facets.arrays([&](const Buffer& buffer) { return pass.in(buffer); });
    push.chebyshev = kernel.chebyshev(pass);
    push.hits = pass.out(hits);
    push.dims = kernel.facets.grid.dims;
    push.jfaMax = kernel.field.jumpFlood.largest;
    push.firstRow = firstRow;
    push.rows = rows;
    push.rays = params.rays;
    push.seed = params.seed;
    push.tintShift = kernel.tintShift;
    push.surface = pass.inIfAny(kernel.facets.surface.record);
    if (resumes) push.resumed = pass.in(resumed);
    if (!last) {
      push.waiting = pass.out(next);
      push.mostWaiting = waiting.room[i % 2];
    }
    kernel.configure(pass, device, triangles ? "gi/trace_triangle_rays" : "gi/trace_rays")
        .constant(CONSTANT_SKY, triangles && sky)
        .constant(CONSTANT_JITTER, params.jitter)
        .push(push);
    if (triangles)
      pass.constant(CONSTANT_FEW_RAYS, last ? 0u : device.subgroupSize / 2).constant(CONSTANT_RESUMES, resumes);
    if (resumes)
      pass.indirect(resumed).dispatchIndirect(resumed);
    else
      pass.dispatch(uint64_t{rows} * params.rays);
  }
}

}  // namespace irad
