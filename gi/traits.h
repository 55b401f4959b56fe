// What a scene has that decides which effects it calls for (gi/plan.h), as plain numbers: measured on the CPU when it
// is loaded, kept current under edits of its lights, and added to by what the pipeline learns of it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "gi/region.h"
#include "gi/settings.h"
#include "gi/solve_report.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/texel_range.h"
#include "shaders/shared/scene_gpu.h"

namespace irad {

/// What a material may hold, over all its texels: upper bounds where nothing else is said.
struct MaterialTraits {
  uint32_t triangles = 0;    ///< that have it
  float emission = 0;        ///< emitted radiance, luminance, W/(m^2 sr); > 0 where any channel of any texel is
  bool evenEmission = true;  ///< no texture or alpha mask varies it
  float albedo = 0;          ///< of the largest channel
  float f0 = 0;              ///< specular reflectance at normal incidence; 0: Lambertian
  float leastRoughness = 1;  ///< lower bound
  bool alphaTest = false, normalMap = false;
  bool glass = false;        ///< blended, with alpha below 1 in any texel or vertex, or tinted
  bool tinted = false;       ///< transmits light in its base colour
  bool cutIfOpaque = false;  ///< blended and textured: an alpha mask where there is no glass
};

struct LightTraits {
  LightType type = LightType::Sun;
  bool shines = false;  ///< intensity > 0
  bool cube = false;    ///< six shadow maps instead of one (lightUsesCube)
  /// Voxels between what its range and cone leave and the scene's bounds; conservative.
  float gap = 0;
  bool size = false;  ///< soft shadows
  /// Of what lights the scene, which is above 1: a facet's points may lie a voxel outside of the bounds in each axis,
  /// so that two are allowed for, and four (0.5) where a light that is on stays on.
  double share() const { return shines ? 2 / double{gap} : 0; }
};

/// What the voxels and their matrix have shown, once they are built.
struct BuildTraits {
  uint64_t voxels = 0;
  uint32_t facets = 0;
  uint32_t emitters = 0;   ///< facets that emit
  float sampledShare = 0;  ///< Lighting::sampledShare
  bool sampled = false;    ///< the emitters' light is by samples
  bool matrix = false;     ///< there is one
  double escaped = 0;      ///< share of its rays that left the grid
  bool sky = false;        ///< these are kept, for a sky
};

/// The light as it is.
struct LightState {
  Redo due = Redo::Voxels;  ///< first stage that has to run again
  SolveReport report;       ///< the last one
  /// Largest change that the blur makes to H, as a share of the largest H; none before there was light.
  std::optional<float> noise;
};

struct SceneTraits {
  std::vector<MaterialTraits> materials;
  bool emitted = false;              ///< a material emits, or did before an edit of it
  std::map<int, TexelRange> texels;  ///< of images that were looked at, by index
  std::vector<LightTraits> lights;
  std::optional<BuildTraits> build;
  LightState light;
  float sky = 0;                 ///< largest radiance of the sky that the settings ask for
  SceneRegion region;            ///< that has voxels, by the settings
  uint64_t pixels = 0;           ///< of the picture that was drawn last
  std::optional<bool> redraw{};  ///< the window has to draw its picture again; none: pictures are drawn on request
};

/// Reads every texel of the images that decide something, once each. `resolution`: voxels along the longest axis.
SceneTraits measure(const Scene& scene, uint32_t resolution);
/// `materials` anew, were these the scene's, and `emitted`.
void measureMaterials(const Scene& scene, const std::vector<Material>& materials, SceneTraits& traits);

/// `light` is in the scene's local space.
LightTraits measureLight(const GpuLight& light, const Scene& scene, uint32_t resolution);

}  // namespace irad
