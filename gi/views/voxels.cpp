// Views of the voxels and of what lies in them.
#include <optional>

#include "gi/facets.h"
#include "gi/field.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/settings.h"
#include "gi/views/fields.h"
#include "gi/views/passes.h"
#include "renderer/frame/frame.h"
#include "renderer/targets.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/view.h"

namespace irad {
namespace {

/// The per-facet values that a view reads; null where it reads none, or there are none.
const Buffer* facetValues(const ViewInfo& info, const ViewInputs& inputs) {
  if (info.isFrom(FROM_ORACLE)) return inputs.reference;
  const Lighting* light = inputs.lighting;
  if (light == nullptr) return nullptr;
  return info.isFrom(FROM_D)                                                  ? &light->direct
         : info.isFrom(FROM_H)                                                ? &light->indirect
         : info.isFrom(FROM_B)                                                ? &light->radiosity
         : info.isFrom(FROM_STANDARD_ERROR) && light->frameMean.standardError ? &light->frameMean.standardError
         : info.isFrom(FROM_SKY) && light->sky                                ? &light->sky
         : info.isFrom(FROM_WRITTEN) && light->writeback.drawn                ? &light->writeback.drawn
                                                                              : nullptr;
}

/// The method of the field that a view reads as it is stored; none: it reads none.
std::optional<FieldMethod> storedField(const ViewInfo& info, const Field* inUse) {
  if (info.isFrom(FROM_FIELD) && inUse != nullptr) return inUse->method;
  if (info.isFrom(FROM_FIELD | FROM_CHEBYSHEV)) return FieldMethod::chebyshev;
  if (info.isFrom(FROM_JFA)) return FieldMethod::jfa;
  return std::nullopt;
}

}  // namespace

void drawVoxels(Frame& frame, const ViewInfo& info, const ViewInputs& inputs, const Buffer& camera,
                const Settings& settings, Targets& targets) {
  // Nothing to draw from: an empty picture.
  if (inputs.facets == nullptr || inputs.facets->count == 0 || (info.ofField() && inputs.fields == nullptr))
    return frame.pass("View").clear(targets.linear, ClearColor{});

  const FacetList& facets = *inputs.facets;
  const ViewSettings& chosen = settings.view;
  VoxelViewPush push{};
  push.grid = facets.grid;
  const ViewShape shape = resolveShape(info.view, chosen.shape).value();
  push.axis = chosen.axis;
  push.slice = chosen.slice;
  push.isovalue = chosen.isovalue;
  push.row =
      packRow(inputs.matrix != nullptr ? inputs.matrix->rays : 1,
              inputs.matrix != nullptr && inputs.matrix->format == MatrixFormat::padded ? 1 : 0, facets.encoding);

  // What the view needs beside the pipeline's products is recorded before its own pass is.
  Pass pass = frame.pass("View");
  push.camera = pass.in(camera);
  push.facets = pass.in(facets.record);
  if (const auto method = storedField(info, inputs.field)) {
    const ViewFields::Bytes stored = inputs.fields->bytes(frame, facets, inputs.field, *method);
    push.bytes = pass.in(stored.buffer);
    push.byteScale = stored.voxelsPerStep;
  }
  if (info.isFrom(FROM_JUMP_FLOOD)) push.seeds = pass.in(inputs.fields->seeds(frame, facets, chosen.jfaPass));
  if (info.isFrom(FROM_EXACT))
    push.exact =
        pass.in(inputs.fields->exact(frame, facets, info.isFrom(FROM_CHEBYSHEV) ? METRIC_CHEBYSHEV : METRIC_EUCLIDEAN));
  if (const Buffer* values = facetValues(info, inputs)) push.values = pass.in(*values);
  if (info.isFrom(FROM_MATRIX_ROW) && inputs.matrix != nullptr && inputs.fields != nullptr &&
      chosen.facet < facets.count)
    push.values = pass.in(inputs.fields->row(frame, *inputs.matrix, chosen.facet));
  if (info.isFrom(FROM_MATRIX) && inputs.matrix != nullptr) push.matrix = pass.in(inputs.matrix->record);
  pass.shader("view/voxel_view.comp")
      .constant(CONSTANT_VIEW, info.view)
      .constant(CONSTANT_VIEW_SHAPE, shape)
      .constant(CONSTANT_VIEW_FROM, info.from)
      .write(targets.linear)
      .push(push)
      .dispatch(targets.size);
}

void drawPinHoles(Frame& frame, const ViewInputs& inputs, const Buffer& camera, Targets& targets) {
  if (inputs.facets == nullptr) return frame.pass("View").clear(targets.linear, ClearColor{});
  Pass pass = frame.pass("View");
  PinHolePush push{};
  push.camera = pass.in(camera);
  push.grid = inputs.facets->grid;
  push.reverse = pass.in(inputs.facets->reverse);
  pass.shader("view/pin_holes.comp")
      .sample(targets.depth, pointSampler(frame.context().device))
      .write(targets.linear)
      .push(push)
      .dispatch(targets.size);
}

}  // namespace irad
