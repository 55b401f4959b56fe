// The list of views, and what follows from a view and the settings.
#include "gi/views/views.h"

#include <fmt/format.h>

#include <algorithm>

#include "gi/settings.h"
#include "renderer/base/error.h"
#include "renderer/base/near_match.h"
#include "shaders/shared/view.h"

namespace irad {
namespace {

constexpr std::optional<ViewShape> SHAPE_NONE;

}  // namespace

const std::vector<ViewInfo>& views() {
  static const std::vector<ViewInfo> table{
#define IRAD_VIEW_ROW(constant, number, name, label, unit, group, kind, low, high, shape, from) \
  ViewInfo{number, name, label, unit, group, VIEW_KIND_##kind, low, high, SHAPE_##shape, from},
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

std::vector<ViewInfo> findViews(const std::vector<std::string>& names) {
  std::vector<std::string> known{"all"};
  for (const ViewInfo& view : views()) known.emplace_back(view.name);
  std::vector<ViewInfo> out;
  const auto add = [&](const ViewInfo& view) {
    const bool twice = std::any_of(out.begin(), out.end(), [&](const ViewInfo& v) { return v.view == view.view; });
    if (!twice) out.push_back(view);  // one file each
  };
  for (const std::string& name : names) {
    if (name == "all") {
      for (const ViewInfo& view : views()) add(view);
      continue;
    }
    const std::optional<View> found = findView(name);
    if (!found) throw UsageError(fmt::format("unknown view '{}'{}", name, suggestion(name, known)));
    add(*viewInfo(*found));
  }
  return out;
}

std::optional<ViewShape> resolveShape(View view, ViewShape wanted) {
  const ViewInfo* info = viewInfo(view);
  if (info == nullptr || !info->shape || wanted == ViewShape::automatic) return info ? info->shape : std::nullopt;
  if (wanted == ViewShape::isosurface && !info->ofField()) return ViewShape::cubes;
  if (wanted == ViewShape::projection && info->kind == VIEW_KIND_SITE) return ViewShape::slice;
  return wanted;
}

uint32_t sourcesOf(View view, const Settings& settings, View pictureOf) {
  const ViewInfo* info = viewInfo(view);
  if (info == nullptr) return FROM_TARGETS;  // shown in magenta
  uint32_t from = info->from;
  if (info->isFrom(FROM_PICTURE) && info->isFrom(FROM_TARGETS) && viewInfo(pictureOf) != nullptr)
    from |= viewInfo(pictureOf)->from;
  if (resolveShape(view, settings.view.shape) == ViewShape::slice)
    from |= FROM_TARGETS | FROM_DIRECT_LIGHT | FROM_INDIRECT_LIGHT;  // the lit scene around it
  return from;
}

std::string whatIsMissing(const ViewInfo& info, const Settings& settings) {
  const bool framewise = settings.solver.method == SolverMethod::bruteForce;
  if (framewise && info.isFrom(FROM_MATRIX | FROM_MATRIX_ROW))
    return "solver.method = brute_force: there is no matrix.";
  if (!framewise && info.isFrom(FROM_STANDARD_ERROR))
    return "solver.method = matrix: only frames of brute_force have a standard error.";
  if (info.isFrom(FROM_SKY) && (framewise || settings.sky.source == SkySource::none))
    return framewise ? "solver.method = brute_force: what comes from the sky is in H and nowhere by itself."
                     : "sky.source = none: there is no sky.";
  return {};
}

Quantity shownQuantity(const ViewInfo& info, const Settings& settings) {
  if (resolveShape(info.view, settings.view.shape) != ViewShape::projection) return {info.label, info.unit};
  if (viewIsDistance(info.from)) return {std::string(info.label) + ": sum of 1 / distance", ""};
  if (info.isFrom(FROM_EXACT)) return {std::string(info.label) + ": largest along the ray", info.unit};
  return {std::string(info.label) + ": mean along the ray", info.unit};
}

ColorMap colorMapOf(const ViewInfo& info, const Settings& settings) {
  return info.kind == VIEW_KIND_SIGNED ? COLOR_MAP_BLUE_RED : settings.view.colorMap;
}

const char* colorMapName(ColorMap map) {
  return map == COLOR_MAP_BLUE_RED ? "blue-red" : nameOf(map);
}

}  // namespace irad
