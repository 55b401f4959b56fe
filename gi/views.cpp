#include "gi/views.h"

#include <algorithm>
#include <cmath>

#include "gi/view_passes.h"
#include "shaders/shared/view.h"

namespace irad {
namespace {

bool showsDistance(View view) {
  return view == VIEW_DISTANCE || view == VIEW_DISTANCE_CHEBYSHEV || view == VIEW_DISTANCE_JFA;
}
bool showsFieldError(View view) {
  return view >= VIEW_JFA_ERROR && view <= VIEW_CHEBYSHEV_ERROR;
}
bool showsFacets(View view) {
  return (view >= VIEW_VOXEL_ALBEDO && view <= VIEW_INVALID_RAYS && view != VIEW_DISTANCE) || view == VIEW_REFERENCE ||
         view == VIEW_VOXEL_DIRECT || view == VIEW_MATRIX_ROW;
}

}  // namespace

const std::vector<ViewInfo>& views() {
  static const std::vector<ViewInfo> table{
#define IRAD_VIEW_ROW(constant, number, name, label, unit, group, kind, low, high) \
  ViewInfo{number, name, label, unit, group, VIEW_KIND_##kind, low, high},
      IRAD_VIEWS(IRAD_VIEW_ROW)
#undef IRAD_VIEW_ROW
  };
  return table;
}

const ViewInfo* viewInfo(View view) {
  return view < views().size() ? &views()[view] : nullptr;  // identifiers are the rows' numbers
}

std::optional<View> findView(std::string_view name) {
  const auto& all = views();
  const auto found = std::find_if(all.begin(), all.end(), [&](const ViewInfo& v) { return name == v.name; });
  return found != all.end() ? std::optional(found->view) : std::nullopt;
}

bool showsField(View view) {
  return showsDistance(view) || showsFieldError(view) || view == VIEW_JFA_SEEDS;
}

bool showsJumpFloodPass(View view) {
  return view == VIEW_JFA_SEEDS || view == VIEW_JFA_ERROR;
}

std::optional<uint32_t> resolveShape(View view, ViewShape wanted) {
  if (showsFacets(view))
    return wanted == ViewShape::slice ? SHAPE_SLICE : wanted == ViewShape::projection ? SHAPE_PROJECTION : SHAPE_CUBES;
  if (!showsField(view)) return std::nullopt;
  if (wanted == ViewShape::automatic) return view == VIEW_DISTANCE ? SHAPE_PROJECTION : SHAPE_SLICE;
  if (view == VIEW_JFA_SEEDS && wanted == ViewShape::projection) return SHAPE_SLICE;
  return static_cast<uint32_t>(wanted);
}

Quantity shownQuantity(const ViewInfo& info, const Settings& settings) {
  if (resolveShape(info.view, settings.view.shape) != SHAPE_PROJECTION) return {info.label, info.unit};
  if (showsDistance(info.view)) return {std::string(info.label) + ": sum of 1 / distance", ""};
  if (showsFieldError(info.view)) return {std::string(info.label) + ": largest along the ray", info.unit};
  return {std::string(info.label) + ": mean along the ray", info.unit};
}

uint32_t colorMapOf(const ViewInfo& info, const Settings& settings) {
  return info.kind == VIEW_KIND_SIGNED ? COLOR_MAP_BLUE_RED : static_cast<uint32_t>(settings.view.colorMap);
}

const char* colorMapName(uint32_t map) {
  return map == COLOR_MAP_BLUE_RED ? "blue-red" : EnumNames<ColorMap>::names.at(map);
}

VkSampler pointSampler(const Device& device) {
  SamplerDesc nearest{Wrap::Clamp, Wrap::Clamp, /*linearMag*/ false, /*linearMin*/ false, /*mips*/ false};
  nearest.linearMips = false;
  return sampler(device, nearest);
}

float linearExposure(const Settings& settings) {
  return settings.camera.gpu.exposure * std::exp2(settings.camera.exposureEv);
}

void drawTargets(Frame& frame, View view, const Buffer& camera, const Settings& settings, Targets& targets) {
  const ViewInfo* info = viewInfo(view);
  ViewPush push{};
  push.camera = camera.address;
  push.kind = info != nullptr ? info->kind : VIEW_KIND_COLOR;
  push.exposure = linearExposure(settings);
  push.toneCurve = settings.camera.gpu.toneCurve;
  frame.pass("View")
      .shader("view/debug_view.comp")
      .constant(0, view)
      .constant(1, targets.present())
      .read(camera)
      .sample(targets.depth, pointSampler(frame.context().device))
      .read(targets.normal, targets.geometric, targets.albedo, targets.direct, targets.bound(&Targets::highlight),
            targets.bound(&Targets::indirect), targets.bound(&Targets::emitted), targets.bound(&Targets::specular))
      .write(targets.linear, targets.display)
      .push(push)
      .run([&](Commands& commands) { commands.dispatchGroups((targets.size.x + 7) / 8, (targets.size.y + 7) / 8); });
}

void drawView(Frame& frame, View view, const ViewInputs& inputs, const Buffer& camera, const Settings& settings,
              Targets& targets) {
  const ViewInfo* info = viewInfo(view);
  if (inputs.fields != nullptr && !showsField(view) && view != VIEW_MATRIX_ROW)
    *inputs.fields = {};  // no memory for what is not shown

  if (resolveShape(view, settings.view.shape)) {
    drawVoxels(frame, view, inputs, camera, settings, targets);
  } else if (view == VIEW_PIN_HOLES) {
    drawPinHoles(frame, inputs, camera, targets);
  } else if (view == VIEW_SHADOW_MAP || view == VIEW_SHADOW) {
    drawShadowView(frame, view, inputs, camera, settings, targets);
  } else if (view == VIEW_REFERENCE_PICTURE || view == VIEW_ERROR) {
    if (view == VIEW_ERROR) drawTargets(frame, VIEW_LIT, camera, settings, targets);
    drawReference(frame, view, inputs, targets);
  } else {
    drawTargets(frame, view, camera, settings, targets);
    if (info == nullptr || !info->hasRange()) return;  // the display picture is there
  }
  if (info->hasRange()) {
    if (inputs.range != nullptr)
      frame.pass("View range").copy(*inputs.range, targets.viewRange, sizeof(ViewRange));
    else
      findRange(frame, *info, settings, targets);
  }
  finishView(frame, *info, settings, inputs.facets != nullptr ? inputs.facets->grid.dims : glm::uvec3(1), targets);
}

}  // namespace irad
