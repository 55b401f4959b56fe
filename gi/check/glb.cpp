#include "gi/check/glb.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "renderer/base/error.h"
#include "renderer/base/output_file.h"
#include "renderer/base/temporary_folder.h"

namespace irad {
namespace {

using Json = nlohmann::json;

constexpr uint32_t kUnsignedInt = 5125, kFloat = 5126;  // componentType

template <class Vector>
Json numbers(const Vector& v) {
  Json out = Json::array();
  for (int i = 0; i < Vector::length(); ++i) out.push_back(v[i]);
  return out;
}

Json rotation(const glm::quat& q) {
  return {q.x, q.y, q.z, q.w};
}

/// Appends `values` to the binary chunk; returns the index of their accessor.
template <class T>
size_t append(Json& json, std::string& chunk, std::span<const T> values, uint32_t componentType, const char* type) {
  const size_t bytes = values.size_bytes();
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", chunk.size()}, {"byteLength", bytes}});
  json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                               {"componentType", componentType},
                               {"type", type},
                               {"count", values.size()}});
  chunk.append(reinterpret_cast<const char*>(values.data()), bytes);
  return json["accessors"].size() - 1;
}

Json toJson(const Material& m) {
  IRAD_CHECK(m.baseColorTexture.image < 0 && m.emissiveTexture.image < 0, "{} is textured", m.name);
  const float strength = std::max({m.emission.r, m.emission.g, m.emission.b, 1.0f});
  return {
      {"name", m.name},
      {"doubleSided", m.doubleSided},
      {"emissiveFactor", numbers(m.emission / strength)},
      {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", strength}}}}},
      {"pbrMetallicRoughness",
       {{"baseColorFactor", numbers(m.baseColor)}, {"metallicFactor", m.metallic}, {"roughnessFactor", m.roughness}}}};
}

Json toJson(const Light& light) {
  const LightKind& kind = lightKind(light.type);
  Json out = {{"name", light.name},
              {"type", kind.gltf},
              {"color", numbers(light.color)},
              {"intensity", light.on ? light.intensity : 0}};
  if (light.range > 0) out["range"] = light.range;
  if (kind.has(LIGHT_CONE))
    out["spot"] = {{"innerConeAngle", std::acos(light.innerCos)}, {"outerConeAngle", std::acos(light.outerCos)}};
  if (light.angle > 0) out["extras"]["angle"] = light.angle;
  if (light.radius > 0) out["extras"]["radius"] = light.radius;
  return out;
}

/// Turns -z towards `direction`.
glm::quat facing(const glm::vec3& direction) {
  return glm::quatLookAt(direction, std::abs(direction.y) > 0.99f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0));
}

std::string chunkHead(size_t bytes, const char* type) {
  const auto length = static_cast<uint32_t>(bytes);
  std::string out(8, '\0');
  std::memcpy(out.data(), &length, 4);
  std::memcpy(out.data() + 4, type, 4);
  return out;
}

std::string toGlb(const Scene& scene, const glm::dvec3& offset, const std::vector<MeshNode>& nodes) {
  Json json = {{"asset", {{"version", "2.0"}}},
               {"extensionsUsed", {"KHR_lights_punctual", "KHR_materials_emissive_strength"}},
               {"scene", 0},
               {"scenes", {{{"nodes", {0}}}}},
               {"nodes", {{{"translation", numbers(offset)}, {"children", Json::array()}}}}};
  const auto child = [&](Json node) {
    json["nodes"][0]["children"].push_back(json["nodes"].size());
    json["nodes"].push_back(std::move(node));
  };
  for (const MeshNode& node : nodes)
    child({{"mesh", 0}, {"translation", numbers(node.translation)}, {"scale", numbers(node.scale)}});

  std::string chunk;
  const Json attributes = {{"POSITION", append<glm::vec3>(json, chunk, scene.positions, kFloat, "VEC3")},
                           {"NORMAL", append<glm::vec3>(json, chunk, scene.normals, kFloat, "VEC3")}};
  for (const Draw& draw : scene.draws) {
    const std::span indices(scene.indices.begin() + draw.firstIndex, draw.indexCount);
    json["meshes"][0]["primitives"].push_back(
        {{"attributes", attributes},
         {"indices", append<uint32_t>(json, chunk, indices, kUnsignedInt, "SCALAR")},
         {"material", draw.material}});
  }
  json["buffers"] = {{{"byteLength", chunk.size()}}};
  for (const Material& material : scene.materials) json["materials"].push_back(toJson(material));
  Json& lights = json["extensions"]["KHR_lights_punctual"]["lights"] = Json::array();
  for (const Light& light : scene.lights) {
    child({{"translation", numbers(light.position)},
           {"rotation", rotation(facing(light.direction))},
           {"extensions", {{"KHR_lights_punctual", {{"light", lights.size()}}}}}});
    lights.push_back(toJson(light));
  }
  for (const Camera& camera : scene.cameras) {
    IRAD_CHECK(!camera.orthographic, "{}: only perspective cameras are written", camera.name);
    json["cameras"].push_back({{"name", camera.name},
                               {"type", "perspective"},
                               {"perspective", {{"yfov", camera.yfov}, {"znear", camera.znear}}}});
    child({{"camera", json["cameras"].size() - 1},
           {"translation", numbers(camera.position)},
           {"rotation", rotation(camera.orientation)}});
  }

  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string body = chunkHead(text.size(), "JSON") + text + chunkHead(chunk.size(), "BIN\0") + chunk;
  const uint32_t head[3] = {0x46546C67u, 2, static_cast<uint32_t>(12 + body.size())};  // "glTF", version, length
  return std::string(reinterpret_cast<const char*>(head), sizeof(head)) + body;
}

}  // namespace

void writeGlb(const std::filesystem::path& file, const Scene& scene, glm::dvec3 offset,
              const std::vector<MeshNode>& nodes) {
  writeFile(file, toGlb(scene, offset, nodes));
}

Scene throughLoader(const Scene& scene, glm::dvec3 offset, const std::vector<MeshNode>& nodes) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "scene.glb";
  writeGlb(file, scene, offset, nodes);
  return loadScene(file);
}

}  // namespace irad
