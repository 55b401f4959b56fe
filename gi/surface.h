// The true surface by voxels, and the facets that it is divided into (docs/method.md 4).
#pragma once

#include <functional>

#include "renderer/resources.h"

namespace irad {

class Context;
class Device;
class SceneOnDevice;
struct FacetList;
struct SceneShape;
struct Settings;

/// What rays meet: the triangles that have a piece in a voxel, which facet each side of a piece belongs to, and points
/// of every facet. Empty where facets are planes (matrix.hit_rule is not triangles).
struct Surface {
  Buffer corners, firstPiece, pieces, boxes, groups, sides, cuts;  ///< of SurfaceArrays
  Buffer surfels, wideSides, linkMasks, firstLinks, links;
  Buffer record;        ///< one SurfaceArrays
  bool tinted = false;  ///< some of it are panes that tint
  explicit operator bool() const { return static_cast<bool>(record); }
};

/// What the facets of a Surface are shaded from beside the list: pieces, and the points that facets are classes of.
struct FacetParts {
  uint32_t pieces = 0;
  Buffer solid;                       ///< packVoxel of each solid voxel
  Buffer pieceVoxel, firstPoint;      ///< per piece
  Buffer points, classes, pointArea;  ///< per point
  explicit operator bool() const { return static_cast<bool>(solid); }
};

/// Who finds what makes up a facet, and links: kernels, or the host in their place (gi/surface_on_host.h), which
/// finds the same.
enum class ListedBy { kernels, host };
/// By whom it takes less time.
ListedBy listsFaster(const Device& device);
/// The list of facets by classes of surfels: as many in a voxel as its surface has sides. `watch`: as makeFacets has
/// it.
FacetList listFacets(Context& context, const SceneOnDevice& scene, const SceneShape& shape, const Settings& settings,
                     ListedBy by, const std::function<void()>& watch = {});
/// The parts of the list that listFacets() makes: it does not keep them, since they are larger than itself and only
/// edits of materials ask for them again.
FacetParts listParts(Context& context, const SceneOnDevice& scene, const SceneShape& shape, const Settings& settings);
/// Albedo, exitance and normals of such a list. `stage`: whose time it is. Returns how many albedos had to be clamped.
uint32_t shadeParts(Context& context, const char* stage, const SceneOnDevice& scene, const Buffer& gridRecord,
                    const FacetParts& parts, const FacetList& list, ListedBy by);

}  // namespace irad
