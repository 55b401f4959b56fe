// A scene on the device: vertex arrays, materials, textures with mips, one descriptor set per material.
#pragma once

#include <map>
#include <vector>

#include "renderer/frame/frame.h"
#include "renderer/frame/material_sets.h"
#include "renderer/scene/scene.h"
#include "shaders/shared/scene_gpu.h"

namespace irad {

/// Which lights of a list shine on the scene.
using LightFilter = std::function<bool(const GpuLight&)>;
bool hasIntensity(const GpuLight& light);

class SceneOnDevice {
 public:
  SceneOnDevice(Context& context, const Scene& scene);

  const Scene& scene;  ///< must outlive this
  Buffer positions, normals, tangents, uv0, uv1, colors, indices, triangleMaterials, materials;
  Buffer lights;         ///< all of them
  Buffer shiningLights;  ///< those that passes sum up
  Buffer record;         ///< one GpuScene, of the latter
  std::vector<Image> textures;
  MaterialSets materialSets;  ///< per material, set 1: the file's textures, whether or not edits leave them out
  std::vector<GpuMaterial> materialValues;  ///< as uploaded
  std::vector<GpuLight> lightValues;        ///< as uploaded, with what drawShadows fills in
  std::vector<GpuLight> shining;            ///< likewise
  bool anyEmission = false;  ///< a factor and a texel of its texture (a texture's maximum counts) are > 0
  bool anyAlphaMask = false;

  /// Takes other values of the same materials, such as some without their emission.
  void setMaterials(Context& context, std::vector<GpuMaterial> values);
  /// Takes other lights, of any number, of which some shine on the scene: `lightValues`, `shining`, their buffers and
  /// `record`. The old ones stay when it throws.
  void setLights(Context& context, std::vector<GpuLight> values, const LightFilter& shines = hasIntensity);

 private:
  bool emits(uint32_t material, const glm::vec3& factor);
  void surveyMaterials();
  std::map<int, glm::vec3> brightest_;  ///< texel of each image that was asked for, by index
};

/// Materials as passes read them.
std::vector<GpuMaterial> gpuMaterials(const std::vector<Material>& materials);

/// Lights as passes read them; drawShadows adds their shadow maps.
std::vector<GpuLight> gpuLights(const std::vector<Light>& lights, const glm::dvec3& origin);

}  // namespace irad
