// A view as a picture.
#pragma once

#include "gi/views/views.h"

namespace irad {

class Buffer;
class Frame;
class Image;
class SceneOnDevice;
class ViewFields;
struct Emitters;
struct EmissiveTriangles;
struct FacetList;
struct Field;
struct FormFactors;
struct Lighting;
struct ShadowMaps;
struct Targets;
struct Writeback;

/// Everything that a view may draw from; absent parts are null and draw as empty.
struct ViewInputs {
  const SceneOnDevice* scene = nullptr;
  const FacetList* facets = nullptr;
  const Field* field = nullptr;
  const FormFactors* matrix = nullptr;
  const Lighting* lighting = nullptr;
  Writeback* written = nullptr;  ///< of `lighting`, which what a picture shows is written back to
  const Emitters* emitters = nullptr;
  const EmissiveTriangles* emissiveTriangles = nullptr;  ///< where pixels look for emitters themselves
  const Buffer* reference = nullptr;                     ///< vec4 per facet: H by the oracle, W/m^2
  const ShadowMaps* shadows = nullptr;
  const Image* picture = nullptr;  ///< RGBA32F: the reference picture, radiance
  View pictureOf = VIEW_LIT;       ///< the view that it is a picture of
  const Buffer* sky = nullptr;     ///< a SkyPicture
  bool composed = false;           ///< targets.linear holds the picture already (gi/glass.h)
  ViewFields* fields = nullptr;    ///< of `facets`
  const Buffer* range = nullptr;   ///< a ViewRange to draw with in place of the picture's own
};
/// Composes `view` from the targets (after drawScene and traceSpecular) into targets.linear and targets.display. Of a
/// view with a range targets.viewRange then holds what it is drawn with.
void drawView(Frame& frame, View view, const ViewInputs& inputs, const Buffer& camera, const Settings& settings,
              Targets& targets);

/// Two pictures of the view `info`, `values` less `reference`, all of one size: of light and colours the luminance,
/// between normals the angle in degrees. Into the linear, range and display targets of `out`, by the diverging map.
void drawDifference(Frame& frame, const ViewInfo& info, const Settings& settings, const Targets& values,
                    const Targets& reference, Targets& out);

/// What such a difference is shown as: a view that is not in the list.
const ViewInfo& differenceInfo();

}  // namespace irad
