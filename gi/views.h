// Views: what the window shows and `render` writes. "lit" is a view too.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gi/stages.h"
#include "gi/view_fields.h"
#include "renderer/forward.h"
#include "shaders/shared/debug_views.h"

namespace irad {

/// Identifiers are the VIEW_* constants of shaders/shared/debug_views.h.
using View = uint32_t;

struct ViewInfo {
  View view;
  const char* name;          ///< as --view takes it: "voxel-albedo"
  const char* label;         ///< as the combo box shows it
  const char* unit;          ///< "" where there is none
  const char* group;         ///< heading of the combo box
  uint32_t kind;             ///< VIEW_KIND_*
  float rangeMin, rangeMax;  ///< the standard range; the same: there is none

  /// Drawn through a colour map with a range.
  bool hasRange() const { return viewHasRange(kind); }
  /// Light: exposure and tone curve apply to the display image.
  bool toneMapped() const { return kind == VIEW_KIND_LIGHT || kind == VIEW_KIND_IRRADIANCE; }
};
const std::vector<ViewInfo>& views();
const ViewInfo* viewInfo(View view);  ///< null where there is none
std::optional<View> findView(std::string_view name);

/// How a view of a volume is shown: SHAPE_*. Facets have values on solid voxels only, so that an isosurface of theirs
/// is cubes; seeds have no mean, so that a projection of theirs is a slice. None for views that are no volumes.
std::optional<uint32_t> resolveShape(View view, ViewShape wanted);
/// Views of distances, seeds and their errors: those that view.isovalue, or for some view.jfa_pass, matter to.
bool showsField(View view);
bool showsJumpFloodPass(View view);

/// What the colours of a view with a range stand for, in the shape that it is shown in: "Chebyshev field" in "voxels".
struct Quantity {
  std::string name, unit;
};
Quantity shownQuantity(const ViewInfo& info, const Settings& settings);
/// The colour map that `info` is drawn with, COLOR_MAP_*.
uint32_t colorMapOf(const ViewInfo& info, const Settings& settings);
const char* colorMapName(uint32_t map);  ///< "violet-yellow", ... "blue-red"

/// Everything that a view may draw from; absent parts are null and draw as empty.
struct ViewInputs {
  const SceneOnDevice* scene = nullptr;
  const FacetList* facets = nullptr;
  const Field* field = nullptr;
  const FormFactors* matrix = nullptr;
  const Lighting* lighting = nullptr;
  const Emitters* emitters = nullptr;
  const EmissiveTriangles* emissiveTriangles = nullptr;  ///< where pixels look for emitters themselves
  const Buffer* reference = nullptr;                     ///< vec4 per facet: H by the oracle, W/m^2
  const ShadowMaps* shadows = nullptr;
  const Image* picture = nullptr;  ///< RGBA32F: the reference picture, radiance
  ViewFields* fields = nullptr;    ///< of `facets`
  const Buffer* range = nullptr;   ///< a ViewRange to draw with in place of the picture's own
};
/// Composes `view` from the targets (after drawForward and traceSpecular) into targets.linear and targets.display. Of a
/// view with a range targets.viewRange then holds what it is drawn with.
void drawView(Frame& frame, View view, const ViewInputs& inputs, const Buffer& camera, const Settings& settings,
              Targets& targets);

/// Two pictures of the view `info`, `values` less `reference`, all of one size: of light and colours the luminance,
/// between normals the angle in degrees. Into the linear, range and display targets of `out`, by the diverging map.
void drawDifference(Frame& frame, const ViewInfo& info, const Settings& settings, const Targets& values,
                    const Targets& reference, Targets& out);
Quantity differenceQuantity(const ViewInfo& info, const Settings& settings);

/// "RE Emitters": of every pixel the light that comes straight from emissive triangles, from their true outlines
/// (shaders/gi/emitters_light.comp), in place of what the facets around it have of it: in targets.emitted and within
/// targets.indirect. Between drawForward and traceSpecular; records nothing where there is no targets.emitted.
void lightByEmitters(Frame& frame, const ViewInputs& inputs, const Settings& settings, Targets& targets);

/// "RE Specular" in compute over the G-buffer (METHOD section 8): traces settings.specular.rays rays per pixel in the
/// GGX lobe through the voxels, radiance B/pi at the hit; rough surfaces take H/pi. Makes and writes
/// targets.specular; gives it back, and records nothing, where specular.mode is off or f0 or H is absent.
void traceSpecular(Frame& frame, const ViewInputs& inputs, const Buffer& camera, const Settings& settings,
                   Targets& targets);

}  // namespace irad
