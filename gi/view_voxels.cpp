// Views of the voxels and of what lies in them.
#include <optional>
#include <vector>

#include "gi/view_passes.h"
#include "shaders/shared/view.h"

namespace irad {
namespace {

/// The per-facet values of a view of light; null where it has none.
const Buffer* facetValues(View view, const ViewInputs& inputs) {
  if (view == VIEW_REFERENCE) return inputs.reference;
  if (view == VIEW_MATRIX_ROW) return nullptr;
  if (inputs.lighting == nullptr) return nullptr;
  if (view == VIEW_RADIOSITY) return &inputs.lighting->radiosity;
  if (view == VIEW_VOXEL_DIRECT) return &inputs.lighting->direct;
  return &inputs.lighting->indirect;
}

/// The method of the field that a view reads as it is stored; none: it reads none.
std::optional<FieldMethod> storedField(View view, const Field* inUse) {
  switch (view) {
    case VIEW_DISTANCE:
      return inUse != nullptr ? inUse->method : FieldMethod::chebyshev;
    case VIEW_DISTANCE_CHEBYSHEV:
    case VIEW_CHEBYSHEV_ERROR:
      return FieldMethod::chebyshev;
    case VIEW_DISTANCE_JFA:
    case VIEW_JFA_FIELD_ERROR:
      return FieldMethod::jfa;
    default:
      return std::nullopt;
  }
}

}  // namespace

void drawVoxels(Frame& frame, View view, const ViewInputs& inputs, const Buffer& camera, const Settings& settings,
                Targets& targets) {
  // Nothing to draw from: an empty picture.
  if (inputs.facets == nullptr || inputs.facets->count == 0 || (showsField(view) && inputs.fields == nullptr))
    return frame.pass("View").clear(targets.linear, ClearColor{});

  const FacetList& facets = *inputs.facets;
  const ViewSettings& chosen = settings.view;
  VoxelViewPush push{};
  push.camera = camera.address;
  push.grid = facets.grid;
  push.facets = facets.record.address;
  const uint32_t shape = resolveShape(view, chosen.shape).value();
  push.axis = static_cast<uint32_t>(chosen.axis);
  push.slice = chosen.slice;
  push.isovalue = chosen.isovalue;
  push.row = packRow(inputs.matrix != nullptr ? inputs.matrix->rays : 1,
                     inputs.matrix != nullptr && inputs.matrix->format == MatrixFormat::padded ? 1 : 0,
                     static_cast<uint32_t>(facets.encoding));

  // What the view needs beside the pipeline's products is recorded before its own pass.
  std::vector<const Buffer*> read;
  const auto use = [&](const Buffer& buffer) {
    read.push_back(&buffer);
    return buffer.address;
  };
  if (const auto method = storedField(view, inputs.field)) {
    const ViewFields::Bytes stored = inputs.fields->bytes(frame, facets, inputs.field, *method);
    push.bytes = use(stored.buffer);
    push.byteScale = stored.voxelsPerStep;
  }
  if (showsJumpFloodPass(view)) push.seeds = use(inputs.fields->seeds(frame, facets, chosen.jfaPass));
  if (view == VIEW_JFA_ERROR || view == VIEW_JFA_FIELD_ERROR)
    push.exact = use(inputs.fields->exact(frame, facets, METRIC_EUCLIDEAN));
  if (view == VIEW_CHEBYSHEV_ERROR) push.exact = use(inputs.fields->exact(frame, facets, METRIC_CHEBYSHEV));
  if (const Buffer* values = facetValues(view, inputs)) push.values = use(*values);
  if (view == VIEW_MATRIX_ROW && inputs.matrix != nullptr && inputs.fields != nullptr && chosen.facet < facets.count)
    push.values = use(inputs.fields->row(frame, *inputs.matrix, chosen.facet));
  if (inputs.matrix != nullptr) {
    push.matrix = use(inputs.matrix->record);
    use(inputs.matrix->rowStart);
    use(inputs.matrix->rowInfo);
    for (const Buffer& segment : inputs.matrix->segments) use(segment);
  }

  Pass pass = frame.pass("View");
  pass.shader("view/voxel_view.comp")
      .constant(0, view)
      .constant(1, shape)
      .read(camera, facets.record, facets.shape, facets.albedo, facets.emission, facets.reverse);
  for (const Buffer* buffer : read) pass.read(*buffer);
  pass.write(targets.linear).push(push).run([&](Commands& commands) {
    commands.dispatchGroups((targets.size.x + 7) / 8, (targets.size.y + 7) / 8);
  });
}

void drawPinHoles(Frame& frame, const ViewInputs& inputs, const Buffer& camera, Targets& targets) {
  if (inputs.facets == nullptr) return frame.pass("View").clear(targets.linear, ClearColor{});
  PinHolePush push{};
  push.camera = camera.address;
  push.grid = inputs.facets->grid;
  push.reverse = inputs.facets->reverse.address;
  frame.pass("View")
      .shader("view/pin_holes.comp")
      .read(camera, inputs.facets->reverse)
      .sample(targets.depth, pointSampler(frame.context().device))
      .write(targets.linear)
      .push(push)
      .run([&](Commands& commands) { commands.dispatchGroups((targets.size.x + 7) / 8, (targets.size.y + 7) / 8); });
}

}  // namespace irad
