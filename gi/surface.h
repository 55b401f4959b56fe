// The true surface by voxels, and the facets that it is divided into (docs/method.md 4).
#pragma once

#include "renderer/resources.h"

namespace irad {

class Context;
class SceneOnDevice;
struct FacetList;
struct Settings;

/// What rays meet: the triangles that have a piece in a voxel, which facet each side of a piece belongs to, and points
/// of every facet. Empty where facets are planes (matrix.hit_rule is not triangles).
struct Surface {
  Buffer corners, firstPiece, pieces, boxes, groups, sides, cuts;  ///< of SurfaceArrays
  Buffer surfels, wideSides, linkMasks, firstLinks, links;
  Buffer record;  ///< one SurfaceArrays
  explicit operator bool() const { return static_cast<bool>(record); }
};

/// The list of facets by classes of surfels: as many in a voxel as its surface has sides.
FacetList listFacets(Context& context, const SceneOnDevice& scene, const Settings& settings);

}  // namespace irad
