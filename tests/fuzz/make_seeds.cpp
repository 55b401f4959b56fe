// fuzz_make_seeds FOLDER: writes the seeds that the fuzzer starts from, one small file per feature of a format, into
// FOLDER/READER/. tests/fuzz/seeds holds its output; regression-* there are inputs that once broke a reader.
#include <OpenImageIO/imageio.h>
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <cmath>
#include <iostream>

#include "gi/check/path_state.h"
#include "gi/settings.h"
#include "renderer/base/image_io.h"
#include "renderer/scene/light_json.h"
#include "tests/scene_files.h"

namespace irad {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::GltfFile;
using Bytes = std::vector<uint8_t>;

constexpr int kU8 = 5121, kI16 = 5122, kU16 = 5123, kU32 = 5125;

void write(const fs::path& path, const std::string& bytes) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
}

Bytes read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The file as .glb: its buffer becomes the BIN chunk.
std::string glb(GltfFile file) {
  while (file.buffer.size() % 4 != 0) file.buffer.push_back(0);
  if (!file.json.contains("buffers")) file.json["buffers"] = {{{"byteLength", file.buffer.size()}}};
  std::string text = file.json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string out = "glTF";
  const auto word = [&](size_t value) {
    for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(value >> shift);
  };
  word(2), word(28 + text.size() + file.buffer.size());
  word(text.size()), out += "JSON" + text;
  word(file.buffer.size()), out += std::string("BIN\0", 4) + std::string(file.buffer.begin(), file.buffer.end());
  return out;
}

/// A unit square of two triangles, facing +z.
GltfFile square() {
  GltfFile file;
  file.attributes() = {{"POSITION", file.vec3({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})},
                       {"NORMAL", file.vec3({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1})},
                       {"TEXCOORD_0", file.vec2({0, 1, 1, 1, 1, 0, 0, 0})}};
  file.primitive()["indices"] = file.data(std::vector<uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", kU16, 1);
  return file;
}

/// `size` x `size` pixels in the file format of its name.
Bytes image(const fs::path& path, int size, int channels, OIIO::TypeDesc type = OIIO::TypeDesc::UINT8) {
  fs::create_directories(path.parent_path());
  std::vector<float> pixels(static_cast<size_t>(size * size * channels));
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<float>(i * 37 % 101) / 100.0f;
  const auto out = OIIO::ImageOutput::create(path.string());
  if (!out || !out->open(path.string(), OIIO::ImageSpec(size, size, channels, type)) ||
      !out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) || !out->close())
    throw WorkError(path.string() + ": cannot be written");
  return read(path);
}

void writeImages(const fs::path& folder) {
  image(folder / "grey.png", 5, 1), image(folder / "grey_alpha.png", 4, 2), image(folder / "rgb.png", 4, 3);
  image(folder / "rgba.png", 7, 4), image(folder / "rgb16.png", 4, 3, OIIO::TypeDesc::UINT16);
  image(folder / "grey.jpg", 9, 1), image(folder / "rgb.jpg", 17, 3);
  image(folder / "rgb.webp", 4, 3), image(folder / "rgba.webp", 8, 4);
}

GltfFile textured(const fs::path& images) {
  GltfFile file = square();
  file.attributes()["TEXCOORD_1"] = file.vec2({0, 0, 1, 0, 1, 1, 0, 1});
  for (const char* name : {"rgba.png", "rgb.jpg", "rgb.webp"}) {
    const int view = file.view(read(images / name));
    file.json["images"].push_back(
        {{"bufferView", view}, {"mimeType", "image/" + fs::path(name).extension().string().substr(1)}});
  }
  file.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9985}}};
  file.json["textures"] = {
      {{"source", 0}, {"sampler", 0}}, {{"source", 1}}, {{"extensions", {{"EXT_texture_webp", {{"source", 2}}}}}}};
  const json transform = {{"KHR_texture_transform", {{"offset", {0.5, 0.25}}, {"rotation", 1.5}, {"scale", {2, 3}}}}};
  file.json["materials"] = {{{"name", "all"},
                             {"pbrMetallicRoughness",
                              {{"baseColorFactor", {1, 0.5, 0.25, 1}},
                               {"metallicFactor", 0.5},
                               {"roughnessFactor", 0.5},
                               {"baseColorTexture", {{"index", 0}, {"extensions", transform}}},
                               {"metallicRoughnessTexture", {{"index", 1}, {"texCoord", 1}}}}},
                             {"normalTexture", {{"index", 2}, {"scale", 0.5}}},
                             {"occlusionTexture", {{"index", 1}, {"strength", 0.5}}},
                             {"emissiveTexture", {{"index", 0}}},
                             {"emissiveFactor", {1, 1, 0}},
                             {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}},
                             {"alphaMode", "MASK"},
                             {"alphaCutoff", 0.25},
                             {"doubleSided", true}}};
  file.json["extensionsUsed"] = {"EXT_texture_webp", "KHR_texture_transform", "KHR_materials_emissive_strength"};
  file.primitive()["material"] = 0;
  return file;
}

GltfFile lightsAndCameras() {
  GltfFile file = square();
  file.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_pbrSpecularGlossiness"};
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "directional"}, {"intensity", 3}, {"color", {1, 1, 0.5}}},
      {{"type", "point"}, {"intensity", 50}, {"range", 9}},
      {{"type", "spot"},
       {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}},
       {"extras", {{"radius", 0.25}}}}};
  file.json["cameras"] = {
      {{"type", "perspective"},
       {"perspective", {{"yfov", 0.75}, {"znear", 0.125}, {"zfar", 64}, {"aspectRatio", 1.5}}}},
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 1}, {"znear", 0}, {"zfar", 8}}}}};
  file.json["materials"] = {
      {{"extensions",
        {{"KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {1, 0, 0, 1}}, {"glossinessFactor", 0.5}}}}}}};
  file.primitive()["material"] = 0;
  file.json["nodes"] = {{{"mesh", 0}, {"scale", {-1, 2, 1}}, {"rotation", {0, 0, 0, 1}}, {"children", {1, 2, 3, 4}}}};
  for (int light = 0; light < 3; ++light)
    file.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
  file.json["nodes"].push_back({{"camera", 0}, {"translation", {0, 0, 4}}, {"children", {5}}});
  file.json["nodes"].push_back({{"camera", 1}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1}}});
  return file;
}

GltfFile skinnedAndMorphed() {
  GltfFile file = square();
  file.attributes()["JOINTS_0"] =
      file.data(std::vector<uint8_t>{0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}, "VEC4", kU8, 4);
  file.attributes()["WEIGHTS_0"] =
      file.data(std::vector<uint8_t>{128, 127, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0}, "VEC4", kU8, 4, true);
  file.primitive()["targets"] = {{{"POSITION", file.vec3({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0})}}};
  file.json["meshes"][0]["weights"] = {0.5};
  std::vector<float> identities(32, 0.0f);
  for (size_t i = 0; i < 8; ++i) identities[i / 4 * 16 + i % 4 * 5] = 1.0f;
  file.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", file.data(identities, "MAT4", 5126, 16)}}};
  file.json["nodes"] = {
      {{"mesh", 0}, {"skin", 0}}, {{"translation", {0, 1, 0}}, {"children", {2}}}, {{"scale", {2, 2, 2}}}};
  file.json["scenes"][0]["nodes"] = {0, 1};
  return file;
}

GltfFile instanced() {
  GltfFile file = square();
  file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", file.vec3({0, 0, 0, 2, 0, 0})},
      {"ROTATION", file.data(std::vector<int16_t>{0, 0, 0, 32767, 0, 32767, 0, 0}, "VEC4", kI16, 4, true)},
      {"SCALE", file.vec3({1, 1, 1, 2, 1, 1})}};
  return file;
}

/// Sparse, interleaved, quantized and normalized accessors, all index types, strips and fans.
GltfFile accessors() {
  GltfFile file = square();
  const int indices = file.view(std::vector<uint8_t>{1, 2}), values = file.view(std::vector<float>{2, 0, 0, 2, 2, 0});
  file.json["accessors"][0]["sparse"] = {{"count", 2},
                                         {"indices", {{"bufferView", indices}, {"componentType", kU8}}},
                                         {"values", {{"bufferView", values}}}};
  const int packed = file.view(std::vector<int16_t>{0, 0, 0, 99, 9, 0, 0, 99, 9, 9, 0, 99}, /*stride=*/8);
  const int corners = file.accessor({{"bufferView", packed}, {"componentType", kI16}, {"type", "VEC3"}, {"count", 3}});
  const int colors =
      file.data(std::vector<uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255}, "VEC4", kU8, 4, true);
  file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const int bytes = file.data(std::vector<uint8_t>{0, 1, 2}, "SCALAR", kU8, 1);
  const int words = file.data(std::vector<uint32_t>{0, 1, 2}, "SCALAR", kU32, 1);
  for (const int index : {bytes, words})
    file.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", corners}, {"COLOR_0", colors}}},
                                                    {"indices", index},
                                                    {"mode", index == bytes ? 5 : 6}});
  return file;
}

GltfFile draco() {
  ::draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int position = builder.AddAttribute(::draco::GeometryAttribute::POSITION, 3, ::draco::DT_FLOAT32);
  const int uv = builder.AddAttribute(::draco::GeometryAttribute::TEX_COORD, 2, ::draco::DT_FLOAT32);
  const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const int triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
  for (uint32_t t = 0; t < 2; ++t) {
    const auto corner = [&](int k) { return corners[triangles[t][k]]; };
    builder.SetAttributeValuesForFace(position, ::draco::FaceIndex(t), corner(0), corner(1), corner(2));
    builder.SetAttributeValuesForFace(uv, ::draco::FaceIndex(t), corner(0), corner(1), corner(2));
  }
  const std::unique_ptr<::draco::Mesh> mesh = builder.Finalize();
  ::draco::Encoder encoder;
  encoder.SetAttributeQuantization(::draco::GeometryAttribute::POSITION, 11);
  ::draco::EncoderBuffer encoded;
  if (!encoder.EncodeMeshToBuffer(*mesh, &encoded).ok()) throw WorkError("Draco cannot encode");

  GltfFile file;
  const int view = file.view(Bytes(encoded.data(), encoded.data() + encoded.size()));
  const auto unbacked = [&](const char* type, int componentType, int count) {
    return file.accessor({{"componentType", componentType}, {"type", type}, {"count", count}});
  };
  file.attributes() = {{"POSITION", unbacked("VEC3", 5126, 4)}, {"TEXCOORD_0", unbacked("VEC2", 5126, 4)}};
  file.primitive()["indices"] = unbacked("SCALAR", kU16, 6);
  file.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view},
                                                                  {"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}};
  file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return file;
}

GltfFile meshopt() {
  GltfFile file = square();
  std::vector<float> positions(12);
  std::memcpy(positions.data(), file.buffer.data(), 48);
  Bytes vertices(meshopt_encodeVertexBufferBound(4, 12)), indices(meshopt_encodeIndexBufferBound(6, 4));
  vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), positions.data(), 4, 12));
  const uint32_t list[] = {0, 1, 2, 0, 2, 3};
  indices.resize(meshopt_encodeIndexBuffer(indices.data(), indices.size(), list, 6));
  GltfFile out;
  const auto compressed = [&](const Bytes& data, uint32_t count, uint32_t stride, const char* mode) {
    const int view = out.view(data);
    json& v = out.json["bufferViews"][static_cast<size_t>(view)];
    json extension = v;
    extension.update({{"count", count}, {"byteStride", stride}, {"mode", mode}});
    v = {{"buffer", 1}, {"byteOffset", 0}, {"byteLength", count * stride}};
    v["extensions"]["EXT_meshopt_compression"] = extension;
    return view;
  };
  const int p = compressed(vertices, 4, 12, "ATTRIBUTES"), i = compressed(indices, 6, 4, "TRIANGLES");
  out.attributes()["POSITION"] =
      out.accessor({{"bufferView", p}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 4}});
  out.primitive()["indices"] =
      out.accessor({{"bufferView", i}, {"componentType", kU32}, {"type", "SCALAR"}, {"count", 6}});
  out.json["extensionsUsed"] = out.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  out.json["buffers"] = {{{"byteLength", out.buffer.size()}}, {{"byteLength", 48}}};  // the second has no data
  return out;
}

GltfFile external() {
  GltfFile file = square();
  file.json["buffers"] = {{{"byteLength", 256}, {"uri", "data.bin"}}};
  file.json["images"] = {{{"uri", "./image.png"}}, {{"uri", "missing%20one.png"}}};
  file.json["textures"] = {{{"source", 0}}, {{"source", 1}}};
  file.json["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}, {"emissiveTexture", {{"index", 1}}}}};
  file.primitive() = {{"attributes", {{"POSITION", 0}}}, {"material", 0}};
  return file;
}

void writeScenes(const fs::path& folder, const fs::path& images) {
  write(folder / "gltf/square.glb", glb(square()));
  write(folder / "gltf/textured.glb", glb(textured(images)));
  write(folder / "gltf/lights_cameras.glb", glb(lightsAndCameras()));
  write(folder / "gltf/skin_morph.glb", glb(skinnedAndMorphed()));
  write(folder / "gltf/instances.glb", glb(instanced()));
  write(folder / "gltf/accessors.glb", glb(accessors()));
  write(folder / "gltf/draco.glb", glb(draco()));
  write(folder / "gltf/meshopt.glb", glb(meshopt()));
  write(folder / "gltf/external.gltf", external().json.dump());
  square().write(folder / "gltf", "data_uri.gltf");
  for (const char* name : {"textured", "lights_cameras", "instances"}) {
    fs::create_directories(folder / "scene_cache");
    Scene scene = loadScene(folder / "gltf" / (std::string(name) + ".glb"));
    writeSceneCache(scene, folder / "scene_cache" / (std::string(name) + ".irscene"));
  }
}

void writeTexts(const fs::path& folder) {
  write(folder / "settings/default.json", settingsToJson(defaultSettings(/*cpuDevice=*/false)));
  for (const char* preset : {"thesis", "fast"}) {
    Settings settings;
    applyPreset(settings, preset, /*cpuDevice=*/true);
    write(folder / "settings" / (std::string(preset) + ".json"), settingsToJson(settings));
  }
  const json camera = {{"name", "above"}, {"position", {0, 4, 9}}, {"target", {0, 4, 0}}, {"up", {0, 1, 0}},
                       {"yfov", 0.8},     {"aspect", 1.5},         {"znear", 0.1},        {"zfar", 100}};
  const json box = {{"position", {1e6, 0.1, 9}}, {"orientation", {0, 0.6, 0, 0.8}}, {"ymag", 2.5}, {"znear", 0}};
  write(folder / "camera_json/target.json", camera.dump());
  write(folder / "camera_json/orthographic.json", box.dump());
  const std::vector<Light> lights{
      {.name = "sky", .direction = {0, -0.6f, 0.8f}, .color = {1, 0.5f, 0}, .intensity = 3},
      {.name = "bulb", .type = LightType::Point, .position = {1e6, 2, 3.25}, .range = 4, .radius = 0.1f},
      {.name = "stage", .type = LightType::Spot, .position = {1, 2, 3}, .innerCos = 0.9f, .outerCos = 0.7f}};
  const json manifest = {{"program", {{"name", "irad"}}},
                         {"format", 1},
                         {"scene", {{"path", "scenes/a.glb"}, {"sha256", std::string(64, '0')}}},
                         {"settings", {{"matrix.rays", 64}, {"solver.omega", 0.7}, {"sample.filter", "blur"}}},
                         {"size", {640, 480}},
                         {"frames", 3},
                         {"views", {"lit", "direct"}},
                         {"lights", json::parse(lightsToJson(lights))},
                         {"hidden", {"hall/table"}},
                         {"isolated", "hall"},
                         {"cameras", {camera, box}}};
  write(folder / "config/manifest.json", manifest.dump(1));
  json recording = manifest;
  recording["program"] = {{"name", "irad"}, {"version", "1.2"}, {"commit", "abc"}};
  recording["device"] = {{"name", "a device"}, {"driver", "its driver"}};
  recording["time"] = "2026-11-25T23:50:07Z";
  recording["other_settings"] = {{"matrix.rays", 128}};
  write(folder / "capture/manifest.json", recording.dump(1));
  json named = box;
  named["name"] = "b";
  const json sidecar = {{"format", 1},
                        {"scene_sha256", std::string(64, '0')},
                        {"lights", json::parse(lightsToJson(lights))},
                        {"materials",
                         {{{"name", "wall"},
                           {"baseColor", {0.5, 0.25, 0.125}},
                           {"metallic", 0.5},
                           {"roughness", 0.25},
                           {"emissionColor", {1, 0.5, 0}},
                           {"emissionStrength", 4},
                           {"alphaCutoff", 0.75},
                           {"texturesOff", {"normal", "occlusion"}}}}},
                        {"hidden", {"hall/table", "a\\/b"}},
                        {"isolated", "hall"},
                        {"cameras", {camera, named}}};
  write(folder / "sidecar/all.json", sidecar.dump(1));
  write(folder / "sidecar/cameras.json", json{{"format", 1}, {"cameras", {camera}}}.dump());
  write(folder / "config/settings.json", R"({"matrix.rays": 64, "voxel.resolution": 32})");
}

/// Of 2 x 1 pixels.
void writeState(const fs::path& folder) {
  SavedSums saved{.made = R"({"camera":{"yfov":0.8},"seed":1})", .sums = {.size = {2, 1}, .samples = 3, .rays = 70}};
  for (TracedSums::Light* light : {&saved.sums.lit, &saved.sums.indirect})
    for (auto* values : {&light->half[0], &light->half[1], &light->squares})
      *values = {glm::dvec3(0.25, 1, 2), glm::dvec3(0)};
  fs::create_directories(folder);
  writeSums(folder / "sums.state", saved);
}

/// A sky with a sun, in each format; and what is refused: the suite fuzz_seeds lets a regression be.
void writeSkies(const fs::path& folder) {
  fs::create_directories(folder);
  constexpr glm::uvec2 kSize(16, 8);
  std::vector<glm::vec4> pixels(kSize.x * kSize.y, glm::vec4(0.25f, 0.5f, 1, 1));
  pixels[35] = glm::vec4(900, 800, 600, 1);
  writePfm(folder / "sun.pfm", kSize, pixels);
  writeLinear(folder / "sun", kSize, pixels);  // .exr
  const auto hdr = OIIO::ImageOutput::create((folder / "sun.hdr").string());
  if (!hdr || !hdr->open((folder / "sun.hdr").string(), OIIO::ImageSpec(16, 8, 3, OIIO::TypeDesc::FLOAT)) ||
      !hdr->write_image(OIIO::TypeDesc::FLOAT, pixels.data(), sizeof(glm::vec4)) || !hdr->close())
    throw WorkError("sun.hdr cannot be written");
  for (const auto& [name, value] :
       {std::pair("nan", NAN), std::pair("infinite", INFINITY), std::pair("negative", -1.0f)}) {
    pixels[5].y = value;
    writePfm(folder / fmt::format("regression-{}.pfm", name), kSize, pixels);
  }
  write(folder / "regression-large.pfm", "PF\n16384 8192\n-1.0\n");
  write(folder / "regression-short.pfm", "PF\n4 2\n-1.0\n0123456789");
  write(folder / "regression-big_endian.pfm", "PF\n2 1\n1.0\n" + std::string(24, '\0'));
  write(folder / "regression-large.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8192 +X 16384\n");
}

}  // namespace
}  // namespace irad

int main(int argc, char** argv) {
  using namespace irad;
  if (argc != 2) return std::cerr << "usage: fuzz_make_seeds FOLDER\n", 2;
  const std::filesystem::path folder = argv[1];
  try {
    writeImages(folder / "image");
    writeScenes(folder, folder / "image");
    writeTexts(folder);
    writeState(folder / "path_state");
    writeSkies(folder / "sky");
  } catch (const std::exception& error) {
    return std::cerr << error.what() << "\n", 1;
  }
}
