// Edits of materials beside a scene's file: what they make of its materials, and how files keep them.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/scene/scene.h"
#include "shaders/shared/scene_gpu.h"

namespace irad {

/// A texture of a material: its member, and its name in files.
struct MaterialTexture {
  TextureUse Material::*use;
  const char* name;
};
/// In the order of shaders' TEXTURE_*.
inline constexpr std::array<MaterialTexture, MATERIAL_TEXTURES> kMaterialTextures{
    {{&Material::baseColorTexture, "baseColor"},
     {&Material::metallicRoughnessTexture, "metallicRoughness"},
     {&Material::normalTexture, "normal"},
     {&Material::occlusionTexture, "occlusion"},
     {&Material::emissiveTexture, "emissive"},
     {&Material::transmissionTexture, "transmission"}}};
std::array<const TextureUse*, MATERIAL_TEXTURES> texturesOf(const Material& material);

/// The materials of the scene's file.
const std::vector<Material>& fileMaterials(const Scene& scene);
/// A name for each of the scene's materials, which no other has: its own, or "wall 2" where one before it has that.
std::vector<std::string> materialNames(const Scene& scene);

/// Emitted radiance as a colour whose largest channel is 1 (white where nothing is emitted), times a strength.
struct Emission {
  glm::vec3 color{1.0f};
  float strength = 0;  ///< W/(m^2 sr)
};
Emission emissionOf(const Material& material);

/// Alpha cuts pieces out of surfaces that have it (an opaque one has no use for it).
bool cutByAlpha(const Material& material);

/// It changes nothing.
bool isEmpty(const MaterialEdit& edit);
/// The file's material with an edit. Textures that are off are absent.
Material edited(const Material& file, const MaterialEdit& edit);
/// The file's materials with these edits.
std::vector<Material> editedMaterials(const Scene& scene, std::span<const MaterialEdit> edits);
/// Puts other edits in place of the scene's.
void replaceMaterialEdits(Scene& scene, std::vector<MaterialEdit> edits);
/// In words, each edit whose name no material of the scene has.
std::vector<std::string> unknownMaterials(const Scene& scene, std::span<const MaterialEdit> edits);

/// An array of objects: name; baseColor and emissionColor [r, g, b]; metallic, roughness, emissionStrength,
/// alphaCutoff, transmission; texturesOff, names of kMaterialTextures. Numbers keep their bits.
std::string materialEditsToJson(std::span<const MaterialEdit> edits);
/// Sorted by name. UsageError "LABEL[2]: FIELD: ...".
std::vector<MaterialEdit> materialEditsFromJson(std::string_view json, const std::string& label = "materials");

}  // namespace irad
