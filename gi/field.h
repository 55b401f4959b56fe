// Distance fields (docs/method.md 3, T 5.2).
#pragma once

#include "gi/settings.h"
#include "gi/thesis/jump_flood.h"
#include "renderer/resources.h"

namespace irad {

class Context;
class Frame;
struct FacetList;

struct Field {
  FieldMethod method = FieldMethod::chebyshev;
  /// One byte per voxel, 4 per uint, x fastest: exact Chebyshev distance to the nearest solid, 0..255.
  Buffer chebyshev;
  JumpFloodField jumpFlood;  ///< in its place, where `method` is jfa
  /// False: no field was made.
  explicit operator bool() const { return chebyshev || jumpFlood; }
};
/// Builds what `settings` and the solid set (facets.reverse) call for.
Field buildField(Context& context, const FacetList& facets, const Settings& settings);
/// The field of one method, recorded into a frame; `grid` holds the list's one Grid.
Field recordField(Frame& frame, const char* stage, const FacetList& facets, const Buffer& grid, FieldMethod method);

}  // namespace irad
