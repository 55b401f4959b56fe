#include "gi/ray_kernel.h"

#include "renderer/error.h"

namespace irad {

RayKernel rayKernel(const FacetList& facets, const Field& field, const MatrixParams& params) {
  uint32_t method = field.chebyshev ? TRACE_DDA_FIELD : TRACE_DDA_REVERSE;
  if (params.traversal == TRAVERSAL_SDF) {
    method = field.method == FieldMethod::jfa ? TRACE_JFA : TRACE_SKIP;
    if (method == TRACE_JFA) IRAD_CHECK(field.jfaDistance.handle, "an sdf traversal without its jfa volume");
    if (method == TRACE_SKIP) IRAD_CHECK(field.chebyshev.handle, "an sdf traversal without its chebyshev field");
  }
  return {method, params.hitRule, static_cast<uint32_t>(facets.encoding), facets, field};
}

Pass& RayKernel::configure(Pass& pass, const Device& device, const std::string& name) const {
  const bool jfa = method == TRACE_JFA;
  pass.shader("gi/" + name + (jfa ? "_jfa.comp" : ".comp"))
      .constant(0, method)
      .constant(1, hitRule)
      .constant(2, encoding)
      .constant(4, facets.slots > 2)
      .read(facets.voxel, facets.shape, facets.reverse, facets.around);
  if (field.chebyshev) pass.read(field.chebyshev);
  if (jfa)
    pass.sample(field.jfaDistance, sampler(device, {.u = Wrap::Clamp,
                                                    .v = Wrap::Clamp,
                                                    .linearMag = false,
                                                    .linearMin = false,
                                                    .mips = false,
                                                    .linearMips = false}));
  return pass;
}

void markCorners(Context& context, FacetList& list, uint32_t slots) {
  if (list.count == 0) return;
  FacetCornersPush push{};
  push.facets = list.record.address;
  push.dims = list.grid.dims;
  push.slots = slots;
  Frame frame = context.begin();
  frame.pass("GI CompactList")
      .shader("gi/facet_corners.comp")
      .constant(0, static_cast<uint32_t>(list.encoding))
      .read(list.record, list.voxel, list.reverse)
      .write(list.shape, list.around)
      .push(push)
      .dispatch(list.count);
  frame.submit();
}

void traceRows(Frame& frame, const RayKernel& kernel, const MatrixParams& params, uint32_t firstRow, uint32_t rows,
               const Buffer& hits) {
  TraceRaysPush push{};
  push.facets = kernel.facets.addresses();
  push.chebyshev = kernel.chebyshev();
  push.hits = hits.address;
  push.dims = kernel.facets.grid.dims;
  push.jfaMax = kernel.field.jfaMax;
  push.firstRow = firstRow;
  push.rows = rows;
  push.rays = params.rays;
  push.jitter = params.jitter;
  push.seed = params.seed;
  Pass pass = frame.pass("GI BuildMatrix");
  kernel.configure(pass, frame.context().device, "trace_rays")
      .write(hits)
      .push(push)
      .dispatch(uint64_t{rows} * params.rays);
}

}  // namespace irad
