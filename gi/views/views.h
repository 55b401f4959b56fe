// Views: what the window shows and `render` writes. "lit" is a view too.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shaders/shared/color_map.h"
#include "shaders/shared/debug_views.h"
#include "shaders/shared/view.h"

namespace irad {

struct Settings;

/// Identifiers are the VIEW_* constants of shaders/shared/debug_views.h.
using View = uint32_t;

struct ViewInfo {
  View view;
  const char* name;                ///< as --view takes it: "voxel-albedo"
  const char* label;               ///< as the combo box shows it
  const char* unit;                ///< "" where there is none
  const char* group;               ///< heading of the combo box
  uint32_t kind;                   ///< VIEW_KIND_*
  float rangeMin, rangeMax;        ///< the standard range; the same: there is none
  std::optional<ViewShape> shape;  ///< what view.shape = auto stands for; none: it is not of a volume
  uint32_t from;                   ///< what it is drawn from: a sum of FROM_*

  /// Drawn from any of these.
  bool isFrom(uint32_t sources) const { return (from & sources) != 0; }
  /// Radiance of what is seen, or a term of it: what lies behind panes adds to that of the panes, as in "lit".
  bool addsUp() const { return kind == VIEW_KIND_LIGHT && isFrom(FROM_TARGETS); }
  /// Of distances, seeds and their errors: a value in every voxel, which view.isovalue cuts.
  bool ofField() const { return isFrom(FROM_ANY_FIELD); }
  /// Drawn through a colour map with a range.
  bool hasRange() const { return viewHasRange(kind); }
  /// Light: exposure and tone curve apply to the display image.
  bool toneMapped() const { return kind == VIEW_KIND_LIGHT || kind == VIEW_KIND_IRRADIANCE; }
};
const std::vector<ViewInfo>& views();
const ViewInfo* viewInfo(View view);  ///< null where there is none
std::optional<View> findView(std::string_view name);
/// Names to views, in order, each once, `all` standing for every one; UsageError lists near matches of an unknown name.
std::vector<ViewInfo> findViews(const std::vector<std::string>& names);

/// How a view of a volume is shown, never `automatic`. Facets have values on solid voxels only, so that an isosurface
/// of theirs is cubes; seeds have no mean, so that a projection of theirs is a slice. None for views that are no
/// volumes.
std::optional<ViewShape> resolveShape(View view, ViewShape wanted);

/// Why there is nothing to draw a view from with these settings, in a sentence; empty: there is.
std::string whatIsMissing(const ViewInfo& info, const Settings& settings);

/// What a picture of the view is drawn from, FROM_*: what its row says, what is shown around it, and what the reference
/// is a picture of where it is compared with it.
uint32_t sourcesOf(View view, const Settings& settings, View pictureOf);

/// What the colours of a view with a range stand for, in the shape that it is shown in: "Chebyshev field" in "voxels".
struct Quantity {
  std::string name, unit;
};
Quantity shownQuantity(const ViewInfo& info, const Settings& settings);
/// The same of two pictures' difference (drawDifference).
Quantity differenceQuantity(const ViewInfo& info, const Settings& settings);
/// The colour map that `info` is drawn with.
ColorMap colorMapOf(const ViewInfo& info, const Settings& settings);
const char* colorMapName(ColorMap map);  ///< "violet-yellow", ... "blue-red"

}  // namespace irad
