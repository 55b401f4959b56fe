// Small glTF files for the loader's suites, and what every loaded scene must satisfy.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "renderer/error.h"
#include "renderer/scene/scene.h"
#include "tests/support.h"

namespace irad::test {

inline std::string base64(const std::vector<uint8_t>& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const uint32_t b1 = i + 1 < bytes.size() ? bytes[i + 1] : 0, b2 = i + 2 < bytes.size() ? bytes[i + 2] : 0;
    const uint32_t word = uint32_t{bytes[i]} << 16 | b1 << 8 | b2;
    for (int k = 0; k < 4; ++k)
      out += i + static_cast<size_t>(k) > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63];
  }
  return out;
}

/// Builds a glTF file with one buffer as a data URI; `json` may be changed freely before writing.
struct GltfFile {
  nlohmann::json json = {{"asset", {{"version", "2.0"}}},
                         {"scene", 0},
                         {"scenes", {{{"nodes", {0}}}}},
                         {"nodes", {{{"mesh", 0}}}},
                         {"meshes", {{{"primitives", {{{"attributes", nlohmann::json::object()}}}}}}}};
  std::vector<uint8_t> buffer;

  nlohmann::json& primitive() { return json["meshes"][0]["primitives"][0]; }
  nlohmann::json& attributes() { return primitive()["attributes"]; }

  template <class T>
  int view(const std::vector<T>& values, uint32_t stride = 0) {
    while (buffer.size() % 4 != 0) buffer.push_back(0);
    const size_t offset = buffer.size(), bytes = values.size() * sizeof(T);
    buffer.resize(offset + bytes);
    std::memcpy(buffer.data() + offset, values.data(), bytes);
    nlohmann::json v = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}};
    if (stride != 0) v["byteStride"] = stride;
    json["bufferViews"].push_back(v);
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }
  int accessor(nlohmann::json a) {
    json["accessors"].push_back(std::move(a));
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  template <class T>
  int data(const std::vector<T>& values, const char* type, int componentType, size_t components,
           bool normalized = false) {
    nlohmann::json a = {{"bufferView", view(values)},
                        {"componentType", componentType},
                        {"type", type},
                        {"count", values.size() / components}};
    if (normalized) a["normalized"] = true;
    return accessor(a);
  }
  int vec3(const std::vector<float>& v) { return data(v, "VEC3", 5126, 3); }
  int vec2(const std::vector<float>& v) { return data(v, "VEC2", 5126, 2); }

  std::filesystem::path write(const std::filesystem::path& folder, const std::string& name = "scene.gltf") {
    if (!buffer.empty() && !json.contains("buffers"))
      json["buffers"] = {
          {{"byteLength", buffer.size()}, {"uri", "data:application/octet-stream;base64," + base64(buffer)}}};
    std::ofstream(folder / name, std::ios::binary) << json.dump();
    return folder / name;
  }
};

/// A right triangle in the xy plane, facing +z.
inline GltfFile triangleFile() {
  GltfFile file;
  file.attributes()["POSITION"] = file.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0});
  return file;
}

/// What is wrong with a scene; empty where it is sound.
inline std::string unsound(const Scene& s) {
  const size_t n = s.positions.size();
  if (s.normals.size() != n || s.tangents.size() != n || s.uv0.size() != n || s.uv1.size() != n || s.colors.size() != n)
    return "arrays of different lengths";
  for (size_t i = 0; i < n; ++i) {
    for (int c = 0; c < 3; ++c)
      if (!std::isfinite(s.positions[i][c])) return "a position is not finite";
    if (!(std::abs(glm::length(s.normals[i]) - 1.0f) < 1e-4f)) return "a normal is not unit";
    if (!(std::abs(glm::length(glm::vec3(s.tangents[i])) - 1.0f) < 1e-4f)) return "a tangent is not unit";
    if (std::abs(s.tangents[i].w) != 1.0f) return "a handedness is not +-1";
    if (!(std::abs(glm::dot(glm::vec3(s.tangents[i]), s.normals[i])) < 1e-3f)) return "a tangent is not orthogonal";
    for (int c = 0; c < 4; ++c)
      if (!(s.colors[i][c] >= 0.0f && s.colors[i][c] <= 1.0f)) return "a vertex colour is out of range";
    for (int c = 0; c < 2; ++c)
      if (!std::isfinite(s.uv0[i][c]) || !std::isfinite(s.uv1[i][c])) return "a texture coordinate is not finite";
  }
  for (const uint32_t index : s.indices)
    if (index >= n) return "an index is out of range";
  uint64_t next = 0;
  for (const Draw& draw : s.draws) {
    if (draw.firstIndex != next || draw.indexCount == 0 || draw.indexCount % 3 != 0 ||
        draw.material >= s.materials.size())
      return "a draw is out of range";
    next += draw.indexCount;
  }
  if (next != s.indices.size()) return "the draws do not cover the triangles";
  if (s.materials.empty() || s.cameras.empty()) return "no material or camera";
  for (const Material& m : s.materials) {
    for (int c = 0; c < 4; ++c)
      if (!(m.baseColor[c] >= 0.0f && m.baseColor[c] <= 1.0f)) return "a base colour is out of range";
    for (int c = 0; c < 3; ++c)
      if (!(m.emission[c] >= 0.0f && std::isfinite(m.emission[c]))) return "an emission is negative or not finite";
    for (const TextureUse* use :
         {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.occlusionTexture, &m.emissiveTexture})
      if (use->image >= static_cast<int>(s.images.size()) || use->uvSet > 1) return "a texture use is out of range";
  }
  for (const SceneImage& image : s.images)
    if (image.width == 0 || image.rgba.size() != size_t{image.width} * image.height * 4)
      return "an image has the wrong size";
  for (const Light& light : s.lights)
    if (!std::isfinite(light.intensity) || !(std::abs(glm::length(light.direction) - 1.0f) < 1e-4f))
      return "a light is unsound";
  return "";
}

inline bool warns(const Scene& s, const std::string& text) {
  for (const std::string& warning : s.warnings)
    if (warning.find(text) != std::string::npos) return true;
  return false;
}

/// Expects InputError (exit status 3) whose message names the file and holds `text`.
inline void expectRefused(const std::filesystem::path& path, const std::string& text) {
  try {
    loadScene(path);
    ADD_FAILURE() << path << " was accepted; expected a refusal with \"" << text << "\"";
  } catch (const InputError& error) {
    EXPECT_EQ(error.exitStatus, 3);
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(path.filename().string()), std::string::npos) << error.what();
  }
}

}  // namespace irad::test
