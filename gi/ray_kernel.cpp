#include "gi/ray_kernel.h"

#include "gi/facets.h"
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

Pass& RayKernel::configure(Pass& pass, const Device& device, const std::string& name) const {
  const bool jfa = method == TRACE_JFA;
  pass.shader(name + (jfa ? "_jfa.comp" : ".comp"))
      .constant(CONSTANT_TRACE_METHOD, method)
      .constant(CONSTANT_TRACE_HIT_RULE, hitRule)
      .constant(CONSTANT_NORMALS, encoding)
      .constant(CONSTANT_TINTED, facets.surface.tinted);
  if (jfa)
    pass.sample(field.jumpFlood.distance, sampler(device, {.u = Wrap::Clamp,
                                                           .v = Wrap::Clamp,
                                                           .linearMag = false,
                                                           .linearMin = false,
                                                           .mips = false,
                                                           .linearMips = false}));
  return pass;
}

void traceRows(Frame& frame, const RayKernel& kernel, const MatrixParams& params, uint32_t firstRow, uint32_t rows,
               const Buffer& hits, bool sky, const char* stage) {
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
  push.jitter = params.jitter;
  push.seed = params.seed;
  push.tintShift = kernel.tintShift;
  push.surface = pass.inIfAny(kernel.facets.surface.record);
  const bool triangles = params.hitRule == HitRule::triangles;
  kernel.configure(pass, frame.context().device, triangles ? "gi/trace_triangle_rays" : "gi/trace_rays")
      .constant(CONSTANT_SKY, triangles && sky)
      .push(push)
      .dispatch(uint64_t{rows} * params.rays);
}

}  // namespace irad
