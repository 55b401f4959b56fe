// Small glTF files for the loader's suites.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "renderer/base/error.h"
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
