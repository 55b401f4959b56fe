// Views: what the window shows and `render` writes. "lit" is a view too.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "gi/stages.h"
#include "renderer/forward.h"
#include "shaders/shared/debug_views.h"

namespace irad {

/// Identifiers are the VIEW_* constants of shaders/shared/debug_views.h.
using View = uint32_t;

struct ViewInfo {
  View view;
  const char* name;   ///< as --view takes it: "voxel-albedo"
  const char* label;  ///< as the combo box shows it
  const char* unit;   ///< "" where there is none
  bool scalar;        ///< drawn through a colour map with a range
  float rangeMin, rangeMax;
  bool toneMapped;  ///< light: exposure and tone curve apply to the display image
};
const std::vector<ViewInfo>& views();
std::optional<View> findView(std::string_view name);
/// Shown on the voxels' cubes, not on the surfaces.
bool drawnOnVoxels(View view);

/// Everything that a view may draw from; absent parts are null and draw as empty.
struct ViewInputs {
  const SceneOnDevice* scene = nullptr;
  const FacetList* facets = nullptr;
  const Field* field = nullptr;
  const FormFactors* matrix = nullptr;
  const Lighting* lighting = nullptr;
  const Emitters* emitters = nullptr;
  const Buffer* reference = nullptr;  ///< vec4 per facet: H by the oracle, W/m^2
};
/// Composes `view` from the targets (after drawForward and traceSpecular) into targets.linear and targets.display.
void drawView(Frame& frame, View view, const ViewInputs& inputs, const Buffer& camera, const Settings& settings,
              Targets& targets);

/// "RE Specular" in compute over the G-buffer (METHOD section 8): traces settings.specular.rays rays per pixel in the
/// GGX lobe through the voxels, radiance B/pi at the hit; rough surfaces take H/pi. Writes targets.specular.
void traceSpecular(Frame& frame, const ViewInputs& inputs, const Buffer& camera, const Settings& settings,
                   Targets& targets);

}  // namespace irad
