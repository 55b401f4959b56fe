// Distance fields over the solid set (docs/method.md 3, T 5.2).
#include "gi/field.h"

#include "gi/facets.h"
#include "gi/subsystems.h"
#include "gi/thesis/jump_flood.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/voxelize.h"

namespace irad {
namespace {

/// Exact separable Chebyshev distance: rows, then y, then z.
Buffer recordChebyshev(Frame& frame, const char* stage, const FacetList& facets, const Buffer& gridRecord) {
  const Device& device = frame.context().device;
  const Grid& grid = facets.grid;
  const uint64_t bytes = (uint64_t{grid.voxels} + 3) / 4 * 4;
  Buffer distance(device, "chebyshev field", Subsystem::Field, bytes);
  const Buffer scratch(device, "chebyshev scratch", Subsystem::Field, bytes);
  Pass rows = frame.pass(stage);
  FieldPush push{};
  push.grid = rows.in(gridRecord);
  push.reverse = rows.in(facets.reverse);
  push.target = rows.out(distance);
  rows.shader("gi/chebyshev_row.comp").push(push).dispatch(uint64_t{grid.dims.y} * grid.dims.z);
  push.reverse = 0;
  for (push.step = 1; push.step <= 2; ++push.step) {
    Pass pass = frame.pass(stage);
    push.grid = pass.in(gridRecord);
    push.source = pass.in(push.step == 1 ? distance : scratch);
    push.target = pass.out(push.step == 1 ? scratch : distance);
    pass.shader("gi/chebyshev.comp").push(push).dispatch(grid.voxels);
  }
  return distance;
}

}  // namespace

Field recordField(Frame& frame, const char* stage, const FacetList& facets, const Buffer& gridRecord,
                  FieldMethod method) {
  Field field;
  field.method = method;
  if (method == FieldMethod::chebyshev)
    field.chebyshev = recordChebyshev(frame, stage, facets, gridRecord);
  else
    field.jumpFlood = recordJumpFloodField(frame, stage, facets, gridRecord);
  return field;
}

Field buildField(Context& context, const FacetList& facets, const Settings& settings) {
  const Buffer gridRecord = makeBuffer<Grid>(context, "grid", Subsystem::Field, std::span(&facets.grid, 1));
  Frame frame = context.begin();
  Field field = recordField(frame, "GI SDF", facets, gridRecord, settings.field.method);
  frame.submitAndWait();
  return field;
}

}  // namespace irad
