// Distance fields (docs/method.md 3, T 5.2).
#pragma once

#include "gi/settings.h"
#include "renderer/resources.h"

namespace irad {

class Context;
class Frame;
struct FacetList;

struct Field {
  FieldMethod method = FieldMethod::chebyshev;
  Buffer
      chebyshev;  ///< one byte per voxel, 4 per uint, x fastest: exact Chebyshev distance to the nearest solid, 0..255
  // By jump flooding (gi/thesis/jump_flood.h).
  Image jfaDistance;  ///< R8_UNORM volume: Euclidean distance / jfaMax
  float jfaMax = 0;   ///< voxels that 1.0 stands for
  Image jfaSeeds;     ///< R32_UINT packVoxel of the nearest seed, the last pass
  /// False: no field was made.
  explicit operator bool() const { return chebyshev || jfaDistance; }
};
/// Builds what `settings` and the solid set (facets.reverse) call for.
Field buildField(Context& context, const FacetList& facets, const Settings& settings);
/// The field of one method, recorded into a frame; `grid` holds the list's one Grid.
Field recordField(Frame& frame, const char* stage, const FacetList& facets, const Buffer& grid, FieldMethod method);

}  // namespace irad
