#include "renderer/scene/material_edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/near_match.h"

namespace irad {
namespace {

OrderedJson rgbJson(const glm::vec3& v) {
  return {jsonNumber(v.x), jsonNumber(v.y), jsonNumber(v.z)};
}

OrderedJson editToJson(const MaterialEdit& edit) {
  OrderedJson json;
  json["name"] = edit.material;
  if (edit.baseColor) json["baseColor"] = rgbJson(*edit.baseColor);
  if (edit.metallic) json["metallic"] = jsonNumber(*edit.metallic);
  if (edit.roughness) json["roughness"] = jsonNumber(*edit.roughness);
  if (edit.emissionColor) json["emissionColor"] = rgbJson(*edit.emissionColor);
  if (edit.emissionStrength) json["emissionStrength"] = jsonNumber(*edit.emissionStrength);
  if (edit.alphaCutoff) json["alphaCutoff"] = jsonNumber(*edit.alphaCutoff);
  if (edit.transmission) json["transmission"] = jsonNumber(*edit.transmission);
  for (size_t i = 0; i < kMaterialTextures.size(); ++i)
    if ((edit.texturesOff >> i & 1) != 0) json["texturesOff"].push_back(kMaterialTextures[i].name);
  return json;
}

/// A member from 0 to `most`, where there is one.
std::optional<float> readFactor(const JsonObject& json, const char* member, double most) {
  if (!json.has(member)) return {};
  const double value = json.number(member);
  if (!(value >= 0 && value <= most)) json.refuse(member, fmt::format("expected 0 to {:g}", most), json.at(member));
  return static_cast<float>(value);
}

std::optional<glm::vec3> readRgb(const JsonObject& json, const char* member) {
  if (!json.has(member)) return {};
  const glm::dvec3 value = json.vector<3>(member);
  for (int c = 0; c < 3; ++c)
    if (!(value[c] >= 0 && value[c] <= 1)) json.refuse(member, "expected three numbers from 0 to 1", json.at(member));
  return glm::vec3(value);
}

uint32_t readTextures(const JsonObject& json, const char* member) {
  if (!json.has(member)) return 0;
  std::vector<std::string> known;
  for (const MaterialTexture& texture : kMaterialTextures) known.emplace_back(texture.name);
  if (!json.at(member).is_array()) json.refuse(member, "expected an array of names", json.at(member));
  uint32_t off = 0;
  for (const OrderedJson& name : json.at(member)) {
    const auto found = name.is_string() ? std::ranges::find(known, name.get<std::string>()) : known.end();
    if (found == known.end())
      json.refuse(member, fmt::format("unknown {}{}", jsonText(name),
                                      name.is_string() ? suggestion(name.get<std::string>(), known) : ""));
    off |= 1u << (found - known.begin());
  }
  return off;
}

MaterialEdit editFromJson(const OrderedJson& parsed, const std::string& label) {
  const JsonObject json(parsed, label,
                        {"name", "baseColor", "metallic", "roughness", "emissionColor", "emissionStrength",
                         "alphaCutoff", "transmission", "texturesOff"});
  return {.material = json.text("name"),
          .baseColor = readRgb(json, "baseColor"),
          .metallic = readFactor(json, "metallic", 1),
          .roughness = readFactor(json, "roughness", 1),
          .emissionColor = readRgb(json, "emissionColor"),
          .emissionStrength = readFactor(json, "emissionStrength", kMaxLightOrEmission),
          .alphaCutoff = readFactor(json, "alphaCutoff", 1),
          .transmission = readFactor(json, "transmission", 1),
          .texturesOff = readTextures(json, "texturesOff")};
}

}  // namespace

std::array<const TextureUse*, MATERIAL_TEXTURES> texturesOf(const Material& material) {
  std::array<const TextureUse*, MATERIAL_TEXTURES> uses{};
  for (size_t i = 0; i < uses.size(); ++i) uses[i] = &(material.*kMaterialTextures[i].use);
  return uses;
}

const std::vector<Material>& fileMaterials(const Scene& scene) {
  return scene.fileMaterials.empty() ? scene.materials : scene.fileMaterials;
}

std::vector<std::string> materialNames(const Scene& scene) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  std::map<std::string, int> next;  // so that a thousand of one name do not ask a thousand times each
  for (const Material& material : scene.materials) {
    std::string name = material.name;
    int& n = next.try_emplace(material.name, 2).first->second;
    while (!taken.insert(name).second) name = fmt::format("{} {}", material.name, n++);
    names.push_back(std::move(name));
  }
  return names;
}

Emission emissionOf(const Material& material) {
  const glm::vec3& e = material.emission;
  const float most = std::max({e.x, e.y, e.z});
  return most > 0 ? Emission{e / most, most} : Emission{};
}

bool cutByAlpha(const Material& m) {
  return m.alpha == AlphaMode::Mask || (m.alpha == AlphaMode::Blend && m.baseColorTexture.image >= 0);
}

bool isEmpty(const MaterialEdit& edit) {
  return edit == MaterialEdit{.material = edit.material};
}

Material edited(const Material& file, const MaterialEdit& edit) {
  Material m = file;
  if (edit.baseColor) m.baseColor = glm::vec4(*edit.baseColor, file.baseColor.a);
  if (!m.lambertian) {
    m.metallic = edit.metallic.value_or(m.metallic);
    m.roughness = edit.roughness.value_or(m.roughness);
  }
  if (edit.emissionColor || edit.emissionStrength) {
    const Emission own = emissionOf(file);
    m.emission = edit.emissionColor.value_or(own.color) * edit.emissionStrength.value_or(own.strength);
  }
  m.transmission = edit.transmission.value_or(m.transmission);
  if (m.alpha == AlphaMode::Mask) m.alphaCutoff = edit.alphaCutoff.value_or(m.alphaCutoff);
  for (size_t i = 0; i < kMaterialTextures.size(); ++i)
    if ((edit.texturesOff >> i & 1) != 0) m.*kMaterialTextures[i].use = {};
  return m;
}

std::vector<Material> editedMaterials(const Scene& scene, std::span<const MaterialEdit> edits) {
  std::vector<Material> materials = fileMaterials(scene);
  if (edits.empty()) return materials;
  std::map<std::string_view, const MaterialEdit*> byName;
  for (const MaterialEdit& edit : edits) byName[edit.material] = &edit;
  const std::vector<std::string> names = materialNames(scene);
  for (size_t i = 0; i < materials.size(); ++i)
    if (const auto found = byName.find(names[i]); found != byName.end())
      materials[i] = edited(materials[i], *found->second);
  return materials;
}

void replaceMaterialEdits(Scene& scene, std::vector<MaterialEdit> edits) {
  if (edits == scene.materialEdits) return;
  if (scene.fileMaterials.empty()) scene.fileMaterials = scene.materials;
  scene.materials = editedMaterials(scene, edits);
  scene.materialEdits = std::move(edits);
}

std::vector<std::string> unknownMaterials(const Scene& scene, std::span<const MaterialEdit> edits) {
  std::vector<std::string> said;
  if (edits.empty()) return said;
  const std::vector<std::string> names = materialNames(scene);
  const std::set<std::string_view> known(names.begin(), names.end());
  for (const MaterialEdit& edit : edits)
    if (!known.contains(edit.material))
      said.push_back(fmt::format("materials: no material is called '{}'{}; its edit is kept, and changes nothing",
                                 edit.material, suggestion(edit.material, names)));
  return said;
}

std::string materialEditsToJson(std::span<const MaterialEdit> edits) {
  OrderedJson json = OrderedJson::array();
  for (const MaterialEdit& edit : edits) json.push_back(editToJson(edit));
  return jsonText(json);
}

std::vector<MaterialEdit> materialEditsFromJson(std::string_view text, const std::string& label) {
  const OrderedJson json = parseJson(text, label);
  if (!json.is_array()) throw UsageError(label + ": expected an array of materials");
  std::vector<MaterialEdit> edits;
  std::set<std::string> names;
  for (size_t i = 0; i < json.size(); ++i) {
    edits.push_back(editFromJson(json[i], fmt::format("{}[{}]", label, i)));
    if (const std::string& name = edits.back().material; !names.insert(name).second)
      throw UsageError(fmt::format("{}[{}]: name '{}': is taken", label, i, name));
  }
  std::ranges::sort(edits, {}, &MaterialEdit::material);
  return edits;
}

}  // namespace irad
