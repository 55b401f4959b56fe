// Which cells a slice through a volume shows (view.shape slice): its picture and the picks in it.
#ifndef IRAD_SHARED_SLICE_H
#define IRAD_SHARED_SLICE_H
#include "shared/view.h"
IRAD_BEGIN

/// The axis across a slice: view.axis, resolved. `forward`: where the camera looks.
IRAD_FN uint sliceAxis(IRAD_AS(Axis) axis, vec3 forward) {
  if (axis != AXIS_OF_CAMERA) return uint(axis);
  vec3 a = abs(forward);
  return a.x > a.y && a.x > a.z ? 0u : (a.y > a.z ? 1u : 2u);
}
/// Its layer of cells. `share`: view.slice, 0..1.
IRAD_FN float sliceLayer(float layers, float share) { return min(floor(share * layers), layers - 1.0f); }

IRAD_END
#endif
