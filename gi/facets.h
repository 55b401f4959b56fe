// The facet list (docs/method.md 4, T 5.3).
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "gi/outer.h"
#include "gi/region.h"
#include "gi/surface.h"
#include "renderer/resources.h"
#include "shaders/shared/facets.h"
#include "shaders/shared/grid.h"
#include "shaders/shared/normals.h"

namespace irad {

class Context;
class Device;
class HostTrace;
class SceneOnDevice;
struct SceneShape;
struct Settings;
struct Voxels;

struct FacetList {
  Grid grid;
  SceneRegion region;  ///< that the grid was made around
  uint32_t count = 0;  ///< facets
  uint32_t solidVoxels = 0;
  uint32_t clampedAlbedo = 0;  ///< facets, of a Surface pieces, whose albedo was outside [0, .98] or no number
  Buffer voxel, shape, albedo, emission, reverse;
  Buffer triangle;  ///< that has won its voxel; of lists that compactFacets makes alone
  Buffer area;      ///< voxel faces: of the surface that the facet stands for
  Buffer record;    ///< one FacetArrays
  Outer outer;      ///< what lies outside of the grid
  Surface surface;  ///< what the facets are classes of, where the hit rule is `triangles`
  bool hasEmission = false;
  NormalEncoding encoding = NormalEncoding::oct16;
  mutable std::shared_ptr<const HostTrace> hostTrace;  ///< by whoever first needs it: hostTraceIfAny()
  /// What the record holds; `addressOf` gives the addresses: a pass's in() or a RecordMaker's of().
  FacetArrays arrays(const std::function<uint64_t(const Buffer&)>& addressOf) const;
};
/// The list that the hit rule goes by: by classes of surfels (listFacets), or a plane facet for each solid voxel.
/// `watch`, which may be empty, is called between submissions: what it throws ends the work.
FacetList makeFacets(Context& context, const SceneOnDevice& scene, const SceneShape& shape, const Settings& settings,
                     const std::function<void()>& watch = {});
/// With the shape that this scene has by these settings.
FacetList makeFacets(Context& context, const SceneOnDevice& scene, const Settings& settings);
/// Albedo, exitance and normals of a list anew, by the scene's materials as they are: the same bits as in a list that
/// is made with them. `parts`: listParts(), of a list that has a surface.
void shadeAnew(Context& context, const SceneOnDevice& scene, const Buffer& gridRecord, const Settings& settings,
               FacetList& list, const FacetParts& parts);
/// A plane facet for each solid voxel, for the thesis's hit rule: Morton-ordered compaction by prefix sum, then the
/// attributes of every facet. Frees the keys of `voxels`.
FacetList compactFacets(Context& context, Voxels& voxels, const Settings& settings);
/// Whether facets have an M.
bool keepsEmission(const SceneOnDevice& scene, const Settings& settings);
/// Room for the attributes of list.count facets (WorkError where these are too many), and the record of it.
void allocateFacets(const Device& device, FacetList& list);
void recordFacets(Context& context, FacetList& list);
/// For tests and check scenes: the list from host arrays (already in Morton order), reverse map included.
FacetList uploadFacets(Context& context, const Grid& grid, const std::vector<uint32_t>& voxel,
                       const std::vector<uint32_t>& shape, const std::vector<glm::uvec2>& albedo,
                       const std::vector<glm::vec3>& emission, NormalEncoding encoding);

}  // namespace irad
