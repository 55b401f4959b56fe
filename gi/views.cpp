#include "gi/views.h"

#include <algorithm>
#include <cmath>

#include "renderer/error.h"
#include "shaders/shared/passes.h"

namespace irad {
namespace {

constexpr uint32_t kindOf(View view) {
  switch (view) {
#define IRAD_VIEW_KIND(constant, number, name, label, unit, kind, low, high) \
  case number:                                                               \
    return VIEW_KIND_##kind;
    IRAD_VIEWS(IRAD_VIEW_KIND)
#undef IRAD_VIEW_KIND
    default:
      return VIEW_KIND_COLOR;
  }
}

constexpr bool toneMapped(uint32_t kind) {
  return kind == VIEW_KIND_LIGHT || kind == VIEW_KIND_IRRADIANCE;
}

}  // namespace

const std::vector<ViewInfo>& views() {
  static const std::vector<ViewInfo> table{
#define IRAD_VIEW_ROW(constant, number, name, label, unit, kind, low, high) \
  ViewInfo{number, name, label, unit, VIEW_KIND_##kind == VIEW_KIND_SCALAR, low, high, toneMapped(VIEW_KIND_##kind)},
      IRAD_VIEWS(IRAD_VIEW_ROW)
#undef IRAD_VIEW_ROW
  };
  return table;
}

std::optional<View> findView(std::string_view name) {
  const auto& all = views();
  const auto found = std::find_if(all.begin(), all.end(), [&](const ViewInfo& v) { return name == v.name; });
  return found != all.end() ? std::optional(found->view) : std::nullopt;
}

bool drawnOnVoxels(View view) {
  return (view >= VIEW_VOXEL_ALBEDO && view <= VIEW_INVALID_RAYS) || view == VIEW_REFERENCE;
}

void drawView(Frame& frame, View view, const ViewInputs& inputs, const Buffer& camera, const Settings& settings,
              Targets& targets) {
  ViewPush push{};
  push.camera = camera.address;
  push.view = view;
  push.kind = kindOf(view);
  push.exposure = settings.camera.gpu.exposure * std::exp2(settings.camera.exposureEv);
  push.toneCurve = settings.camera.gpu.toneCurve;
  for (const ViewInfo& info : views())
    if (info.view == view) {
      push.low = info.rangeMin;
      push.high = info.rangeMax;
    }
  const uint32_t groupsX = (targets.size.x + 7) / 8, groupsY = (targets.size.y + 7) / 8;
  SamplerDesc nearest{Wrap::Clamp, Wrap::Clamp, /*linearMag*/ false, /*linearMin*/ false, /*mips*/ false};
  nearest.linearMips = false;
  const VkSampler point = sampler(frame.context().device, nearest);

  if (!drawnOnVoxels(view)) {
    frame.pass("View")
        .shader("view/debug_view.comp")
        .constant(0, view)
        .read(camera)
        .sample(targets.depth, point)
        .read(targets.normal, targets.geometric, targets.albedo, targets.direct, targets.highlight, targets.indirect,
              targets.emitted, targets.specular)
        .write(targets.linear, targets.display)
        .push(push)
        .run([&](Commands& commands) { commands.dispatchGroups(groupsX, groupsY); });
    return;
  }

  // Nothing to draw from: an empty picture.
  const bool needsField = view == VIEW_DISTANCE;
  const bool fromVolume = needsField && inputs.field != nullptr && inputs.field->method == FieldMethod::jfa &&
                          static_cast<bool>(inputs.field->jfaDistance);
  const bool fromBytes =
      needsField && !fromVolume && inputs.field != nullptr && static_cast<bool>(inputs.field->chebyshev);
  if (inputs.facets == nullptr || (needsField && !fromVolume && !fromBytes)) {
    frame.pass("View").clear(targets.linear, ClearColor{});
    frame.pass("View").clear(targets.display, ClearColor{0, 0, 0, 1});
    return;
  }
  const FacetList& facets = *inputs.facets;
  push.grid = facets.grid;
  push.facets = facets.record.address;
  push.normalEncoding = static_cast<uint32_t>(facets.encoding);
  push.rays = settings.matrix.gpu.rays;
  Pass pass = frame.pass("View");
  pass.shader(fromVolume ? "view/voxel_view_volume.comp" : "view/voxel_view.comp")
      .read(camera, facets.record, facets.shape, facets.albedo, facets.emission, facets.reverse)
      .write(targets.linear, targets.display);
  if (fromVolume) {
    push.jfaMax = inputs.field->jfaMax;
    pass.sample(inputs.field->jfaDistance, point);
  }
  if (fromBytes) {
    push.chebyshev = inputs.field->chebyshev.address;
    pass.read(inputs.field->chebyshev);
  }
  if (view == VIEW_REFERENCE) {
    if (inputs.reference != nullptr) {
      push.values = inputs.reference->address;
      pass.read(*inputs.reference);
    }
  } else if (inputs.lighting != nullptr) {
    const Buffer& values = view == VIEW_RADIOSITY ? inputs.lighting->radiosity : inputs.lighting->indirect;
    push.values = values.address;
    pass.read(values);
  }
  if (inputs.matrix != nullptr) {
    push.matrix = inputs.matrix->record.address;
    push.rays = inputs.matrix->rays;
    push.padded = inputs.matrix->format == MatrixFormat::padded ? 1 : 0;
    pass.read(inputs.matrix->record, inputs.matrix->rowStart, inputs.matrix->rowInfo);
    for (const Buffer& segment : inputs.matrix->segments) pass.read(segment);
  }
  pass.push(push).run([&](Commands& commands) { commands.dispatchGroups(groupsX, groupsY); });
}

}  // namespace irad
