// The loader on small files with known answers.
#include <fmt/ranges.h>

#include <ctime>

#include "renderer/base/sha256.h"
#include "tests/scene_files.h"

namespace irad::test::scene_suite {
namespace {

using nlohmann::json;

constexpr int kU8 = 5121, kI16 = 5122, kU16 = 5123, kU32 = 5125, kFloat = 5126;

class SceneLoading : public ::testing::Test {
 protected:
  Scene load(GltfFile& file, const LoadOptions& options = {}) {
    Scene scene = loadScene(file.write(folder.path), options);
    EXPECT_EQ(unsound(scene), "");
    return scene;
  }
  void refuse(GltfFile& file, const std::string& text) { expectRefused(file.write(folder.path), text); }
  TemporaryFolder folder;
};

glm::dvec3 world(const Scene& s, size_t corner) {
  return s.origin + glm::dvec3(s.positions[s.indices[corner]]);
}

void expectCorners(const Scene& s, const std::vector<glm::dvec3>& want) {
  ASSERT_EQ(s.indices.size(), want.size());
  for (size_t i = 0; i < want.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(world(s, i)[c], want[i][c], 1e-6) << "corner " << i << " component " << c;
}

// FIPS 180-4 example vectors.
TEST(Sha256, KnownVectors) {
  const auto of = [](const std::string& text) {
    return sha256(std::span(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
  };
  EXPECT_EQ(of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  const std::string million(1000000, 'a'), want = "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0";
  EXPECT_EQ(of(million), want);
  TemporaryFolder folder;
  std::ofstream(folder.path / "a") << million;
  EXPECT_EQ(sha256File(folder.path / "a"), want);
  EXPECT_THROW(sha256File(folder.path / "missing"), InputError);
}

TEST_F(SceneLoading, IndexTypesAndNone) {
  const std::vector<glm::dvec3> want = {{0, 1, 0}, {0, 0, 0}, {1, 0, 0}};
  const auto check = [&](auto example, int type) {
    GltfFile file = triangleFile();
    file.primitive()["indices"] = file.data(std::vector<decltype(example)>{2, 0, 1}, "SCALAR", type, 1);
    expectCorners(load(file), want);
  };
  check(uint8_t{}, kU8), check(uint16_t{}, kU16), check(uint32_t{}, kU32);
  GltfFile file = triangleFile();
  const Scene s = load(file);
  expectCorners(s, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  for (const glm::vec3& n : s.normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));  // flat, generated
  EXPECT_EQ(s.origin, glm::dvec3(0.5, 0.5, 0.0));
  EXPECT_EQ(s.boundsMax, glm::vec3(0.5f, 0.5f, 0.0f));
  EXPECT_EQ(s.sha256, sha256File(folder.path / "scene.gltf"));
}

TEST_F(SceneLoading, StripsFansAndPoints) {
  GltfFile file;
  file.attributes()["POSITION"] = file.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
  file.primitive()["mode"] = 5;
  expectCorners(load(file), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  file.attributes()["POSITION"] = file.vec3({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  file.json.erase("buffers");
  file.primitive()["mode"] = 6;
  expectCorners(load(file), {{1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}});
  file.primitive()["mode"] = 0;
  const Scene points = load(file);
  EXPECT_EQ(points.triangleCount(), 0u);
  EXPECT_TRUE(warns(points, "points or lines"));
  EXPECT_TRUE(warns(points, "no triangles"));
}

TEST_F(SceneLoading, InterleavedNormalizedAndQuantized) {
  GltfFile file;
  // Per vertex: three 16-bit positions, two bytes of padding, four colour bytes.
  struct Vertex {
    int16_t position[4];
    uint8_t color[4];
  };
  const int view = file.view(std::vector<Vertex>{{{0, 0, 0, 0}, {0, 51, 255, 255}},
                                                 {{32767, 0, 0, 0}, {0, 51, 255, 255}},
                                                 {{0, -32768, 0, 0}, {0, 51, 255, 255}}},
                             sizeof(Vertex));
  file.attributes()["POSITION"] = file.accessor(
      {{"bufferView", view}, {"componentType", kI16}, {"normalized", true}, {"type", "VEC3"}, {"count", 3}});
  file.attributes()["COLOR_0"] = file.accessor({{"bufferView", view},
                                                {"byteOffset", 8},
                                                {"componentType", kU8},
                                                {"normalized", true},
                                                {"type", "VEC4"},
                                                {"count", 3}});
  const Scene s = load(file);
  expectCorners(s, {{0, 0, 0}, {1, 0, 0}, {0, -1, 0}});  // -32768 means -1 too
  for (const glm::vec4& c : s.colors) EXPECT_EQ(c, glm::vec4(0.0f, 0.2f, 1.0f, 1.0f));
}

TEST_F(SceneLoading, SparseWithAndWithoutAView) {
  for (const bool withView : {true, false}) {
    GltfFile file;
    json a = {{"componentType", kFloat}, {"type", "VEC3"}, {"count", 3}};
    if (withView) a["bufferView"] = file.view(std::vector<float>{0, 0, 0, 9, 9, 9, 9, 9, 9});
    a["sparse"] = {{"count", 2},
                   {"indices", {{"bufferView", file.view(std::vector<uint16_t>{1, 2})}, {"componentType", kU16}}},
                   {"values", {{"bufferView", file.view(std::vector<float>{3, 0, 0, 0, 4, 0})}}}};
    file.attributes()["POSITION"] = file.accessor(a);
    expectCorners(load(file), {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}});
    file.json["accessors"][0]["sparse"]["indices"]["bufferView"] = file.view(std::vector<uint16_t>{2, 1});
    file.json.erase("buffers");
    refuse(file, "sparse");  // indices must increase
  }
}

TEST_F(SceneLoading, TransformsMirrorsAndInstances) {
  GltfFile file = triangleFile();
  file.json["nodes"] = {{{"children", {1}}, {"translation", {10, 0, 0}}}, {{"mesh", 0}, {"scale", {-2, 1, 1}}}};
  const Scene mirrored = load(file);
  // Rewound, so that it still faces +z.
  expectCorners(mirrored, {{10, 0, 0}, {10, 1, 0}, {8, 0, 0}});
  EXPECT_EQ(mirrored.normals[0], glm::vec3(0, 0, 1));
  file.json["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
      file.vec3({0, 0, 0, 0, 0, 5});
  file.json["extensionsRequired"] = file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  file.json.erase("buffers");
  const Scene two = load(file);
  EXPECT_EQ(two.triangleCount(), 2u);
  EXPECT_DOUBLE_EQ(world(two, 3).z, 5.0);
}

TEST_F(SceneLoading, SingularTransformsDropTheirTriangles) {
  GltfFile file = triangleFile();
  file.json["scenes"][0]["nodes"] = {0, 1};
  file.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"scale", {1, 0, 1}}, {"translation", {100, 0, 0}}}};
  const Scene s = load(file);
  expectCorners(s, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  EXPECT_EQ(s.origin, glm::dvec3(0.5, 0.5, 0.0));  // the dropped one is not in the bounds
  EXPECT_TRUE(warns(s, "1 triangles without area"));
}

TEST_F(SceneLoading, NonFiniteAndDegenerateTrianglesLeaveNothingBehind) {
  GltfFile clean = triangleFile();
  const Scene want = load(clean);
  GltfFile file;
  const float nan = std::nanf(""), inf = INFINITY;
  file.attributes()["POSITION"] = file.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0, nan, 0, 0, inf, 5, 5, 50, 50, 50, 3e38f, 0, 0});
  file.primitive()["indices"] =
      file.data(std::vector<uint16_t>{0, 1, 3, 0, 1, 4, 0, 1, 6, 5, 5, 0, 0, 1, 2}, "SCALAR", kU16, 1);
  const Scene s = load(file);
  EXPECT_TRUE(warns(s, "3 triangles with non-finite"));
  EXPECT_TRUE(warns(s, "1 triangles without area"));
  EXPECT_EQ(s.positions, want.positions);
  EXPECT_EQ(s.indices, want.indices);
  EXPECT_EQ(s.origin, want.origin);
}

TEST_F(SceneLoading, ZeroNormalsBecomeTheFacesOwn) {
  GltfFile file = triangleFile();
  file.attributes()["NORMAL"] = file.vec3({0, 0, 0, 0, 0, 2, 0, 0, 1});
  const Scene s = load(file);
  for (const glm::vec3& n : s.normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
  EXPECT_TRUE(warns(s, "1 normals of length 0"));
}

TEST_F(SceneLoading, FarAwayEqualsTheRecentredScene) {
  GltfFile near = triangleFile();
  near.json["nodes"][0]["scale"] = {10, 10, 10};
  GltfFile far = near;
  far.json["nodes"][0]["translation"] = {1e6, -1e6, 1e6};
  const Scene a = load(near), b = load(far);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(b.origin, glm::dvec3(1e6 + 5, -1e6 + 5, 1e6));
}

constexpr const char* kPng2x1 =  // RGBA (255,0,0,128), (10,20,30,255)
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAEUlEQVR4nGP4z8DQwCUi9x8ADCACu8ZPihQAAAAASUVORK5CYII=";

GltfFile texturedQuad() {
  GltfFile file;
  file.attributes()["POSITION"] = file.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
  file.attributes()["NORMAL"] = file.vec3({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  file.attributes()["TEXCOORD_0"] = file.vec2({0, 1, 1, 1, 0, 0, 1, 0});  // v down, as glTF has it
  file.primitive()["indices"] = file.data(std::vector<uint16_t>{0, 1, 2, 2, 1, 3}, "SCALAR", kU16, 1);
  file.primitive()["material"] = 0;
  file.json["images"] = {{{"uri", kPng2x1}}};
  file.json["textures"] = {{{"source", 0}}};
  file.json["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  return file;
}

TEST_F(SceneLoading, TangentsOfAQuad) {
  GltfFile file = texturedQuad();
  const Scene s = load(file);
  ASSERT_EQ(s.tangents.size(), 4u);
  for (const glm::vec4& t : s.tangents) {
    EXPECT_NEAR(t.x, 1.0f, 1e-6f);
    EXPECT_EQ(t.w, 1.0f);  // bitangent cross(z, x) = +y, where v falls
  }
  file.attributes()["TEXCOORD_0"] = file.vec2({1, 1, 0, 1, 1, 0, 0, 0});
  file.json.erase("buffers");
  for (const glm::vec4& t : load(file).tangents) {
    EXPECT_NEAR(t.x, -1.0f, 1e-6f);
    EXPECT_EQ(t.w, -1.0f);
  }
  // u mirrored about the diagonal's shared vertices: both keep their handedness, so vertices are split.
  file.attributes()["TEXCOORD_0"] = file.vec2({0, 1, 1, 1, 1, 0, 0, 1});
  file.json.erase("buffers");
  const Scene split = load(file);
  EXPECT_GT(split.positions.size(), 4u);
}

TEST_F(SceneLoading, TangentsFollowMirroredNodes) {
  GltfFile file = texturedQuad();
  file.json["nodes"][0]["scale"] = {-1, 1, 1};
  for (const glm::vec4& t : load(file).tangents) {
    EXPECT_NEAR(t.x, -1.0f, 1e-6f);
    EXPECT_EQ(t.w, -1.0f);  // cross(z, -x) * -1 = +y still
  }
}

TEST_F(SceneLoading, ImagesByUse) {
#ifndef IRAD_OIIO
  GTEST_SKIP() << "built without image decoders";
#endif
  GltfFile file = texturedQuad();
  file.json["materials"][0]["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", 0}}}};
  const Scene s = load(file);
  ASSERT_EQ(s.images.size(), 2u);  // the one image as colour and as data
  const Material& m = s.materials[0];
  EXPECT_TRUE(s.images[static_cast<size_t>(m.baseColorTexture.image)].srgb);
  EXPECT_FALSE(s.images[static_cast<size_t>(m.normalTexture.image)].srgb);
  for (const SceneImage& image : s.images)  // straight alpha: colours are not multiplied by it
    EXPECT_EQ(image.rgba, (std::vector<uint8_t>{255, 0, 0, 128, 10, 20, 30, 255}));
}

TEST_F(SceneLoading, MissingAndBrokenImagesArePink) {
  for (const char* uri :
       {"missing.png", "data:image/png;base64,iVBORw0KGgo=", "../outside.png", "http://127.0.0.1:9/a.png"}) {
    GltfFile file = texturedQuad();
    file.json["images"][0]["uri"] = uri;
    const Scene s = load(file);
    ASSERT_EQ(s.images.size(), 1u);
    EXPECT_EQ(s.images[0].width, 8u);
    EXPECT_EQ(s.images[0].rgba[0], 255);
    EXPECT_EQ(s.images[0].rgba[1], 0);
    EXPECT_TRUE(warns(s, "pink")) << uri;
  }
}

TEST_F(SceneLoading, TextureTransformAndSampler) {
  GltfFile file = texturedQuad();
  file.attributes()["TEXCOORD_1"] = file.vec2({0, 1, 1, 1, 0, 0, 1, 0});
  file.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9985}}};
  file.json["textures"][0]["sampler"] = 0;
  file.json["extensionsUsed"] = {"KHR_texture_transform"};
  file.json["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"] = {
      {"offset", {0.5, 0.25}}, {"scale", {2, 3}}, {"rotation", M_PI / 2}, {"texCoord", 1}};
  const Scene s = load(file);
  const TextureUse& use = s.materials[0].normalTexture;
  EXPECT_EQ(use.uvSet, 1u);
  // Scale, then a quarter turn counter-clockwise as seen (v down: u goes to -v), then the offset.
  const glm::vec2 uv = use.transform * glm::vec3(1.0f, 0.0f, 1.0f), vv = use.transform * glm::vec3(0.0f, 1.0f, 1.0f);
  EXPECT_NEAR(uv.x, 0.5f, 1e-6f);
  EXPECT_NEAR(uv.y, 0.25f - 2.0f, 1e-6f);
  EXPECT_NEAR(vv.x, 0.5f + 3.0f, 1e-6f);
  EXPECT_NEAR(vv.y, 0.25f, 1e-6f);
  EXPECT_EQ(use.sampler.u, Wrap::Clamp);
  EXPECT_EQ(use.sampler.v, Wrap::Mirror);
  EXPECT_FALSE(use.sampler.linearMag);
  EXPECT_TRUE(use.sampler.linearMin);  // LINEAR_MIPMAP_NEAREST
  EXPECT_FALSE(use.sampler.linearMips);
}

TEST_F(SceneLoading, FactorsAreClampedAndReported) {
  GltfFile file = triangleFile();
  file.primitive()["material"] = 0;
  file.json["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorFactor", {5, -1, 0.5, 1}}, {"roughnessFactor", 0.25}}},
       {"emissiveFactor", {1, 0.5, 0}},
       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}}};
  const Scene s = load(file);
  EXPECT_EQ(s.materials[0].baseColor, glm::vec4(1.0f, 0.0f, 0.5f, 1.0f));
  EXPECT_EQ(s.materials[0].emission, glm::vec3(8.0f, 4.0f, 0.0f));
  EXPECT_TRUE(warns(s, "baseColorFactor[0]: 5 is clamped to 1"));
  EXPECT_TRUE(warns(s, "baseColorFactor[1]: -1 is clamped to 0"));
  EXPECT_TRUE(s.lights.empty());  // it emits
  LoadOptions lambertian;
  lambertian.lambertian = true;
  const Scene flat = load(file, lambertian);
  EXPECT_EQ(flat.materials[0].metallic, 0.0f);
  EXPECT_EQ(flat.materials[0].roughness, 1.0f);
  EXPECT_EQ(flat.materials[0].emission, s.materials[0].emission);
  EXPECT_FALSE(flat.materials[0].doubleSided);
  LoadOptions both;
  both.doubleSided = true;
  EXPECT_TRUE(load(file, both).materials[0].doubleSided);
}

TEST_F(SceneLoading, PanesTransmitAsTheirExtensionSays) {
  GltfFile file = triangleFile();
  file.primitive()["material"] = 0;
  file.json["extensionsUsed"] = {"KHR_materials_transmission", "KHR_materials_volume", "KHR_materials_ior"};
  file.json["materials"] = {{{"name", "pane"}, {"doubleSided", true}}};
  auto& extension = file.json["materials"][0]["extensions"]["KHR_materials_transmission"];
  extension = {{"transmissionFactor", 0.75}};
  const Scene s = load(file);
  EXPECT_EQ(s.materials[0].transmission, 0.75f);
  EXPECT_EQ(s.materials[0].transmissionTexture.image, -1);
  EXPECT_FALSE(warns(s, "KHR_materials_transmission"));
  EXPECT_TRUE(warns(s, "KHR_materials_volume is not rendered: what transmits light is a thin pane"));
  EXPECT_TRUE(warns(s, "KHR_materials_ior is not rendered"));
  extension = decltype(file.json)::object();
  EXPECT_EQ(load(file).materials[0].transmission, 0.0f) << "the extension's own";
  extension = {{"transmissionFactor", 3}};
  const Scene clamped = load(file);
  EXPECT_EQ(clamped.materials[0].transmission, 1.0f);
  EXPECT_TRUE(warns(clamped, "KHR_materials_transmission.transmissionFactor: 3 is clamped to 1"));
  extension = {{"transmissionFactor", "much"}};
  EXPECT_THROW(load(file), InputError);
  extension = {{"transmissionTexture", {{"index", 7}}}};
  EXPECT_THROW(load(file), InputError);
}

TEST_F(SceneLoading, DefaultCameraSeesEverythingAndDefaultSunIsNoted) {
  GltfFile file = triangleFile();
  const Scene s = load(file);
  ASSERT_TRUE(s.defaultCamera && s.defaultLight);
  EXPECT_TRUE(warns(s, "no camera in scene.gltf"));
  EXPECT_TRUE(warns(s, "no light in scene.gltf"));
  const Camera& camera = s.cameras[0];
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p(corner & 1 ? s.boundsMax.x : s.boundsMin.x, corner & 2 ? s.boundsMax.y : s.boundsMin.y,
                      corner & 4 ? s.boundsMax.z : s.boundsMin.z);
    const glm::vec3 view = glm::inverse(camera.orientation) * glm::vec3(s.origin + glm::dvec3(p) - camera.position);
    const float limit = std::tan(camera.yfov / 2) * -view.z;
    EXPECT_LT(view.z, -camera.znear);
    EXPECT_LT(std::abs(view.x), limit);
    EXPECT_LT(std::abs(view.y), limit);
  }
  EXPECT_LT(s.lights[0].direction.y, -0.5f);
}

TEST_F(SceneLoading, NothingOutsideTheFolderIsRead) {
  GltfFile file = triangleFile();
  std::filesystem::create_directory(folder.path / "inside");
  std::ofstream(folder.path / "secret.bin", std::ios::binary)
      .write(reinterpret_cast<const char*>(file.buffer.data()), static_cast<std::streamsize>(file.buffer.size()));
  std::filesystem::create_symlink(folder.path / "secret.bin", folder.path / "inside" / "link.bin");
  std::filesystem::copy(folder.path / "secret.bin", folder.path / "inside" / "own data \xc3\xbc.bin");
  const auto with = [&](const std::string& uri) {
    file.json["buffers"] = {{{"byteLength", file.buffer.size()}, {"uri", uri}}};
    return file.write(folder.path / "inside");
  };
  EXPECT_EQ(loadScene(with("own%20data%20%C3%BC.bin")).triangleCount(), 1u);
  EXPECT_EQ(loadScene(with("own data \xc3\xbc.bin")).triangleCount(), 1u);
  for (const std::string uri :
       {"../secret.bin", "%2e%2e/secret.bin", "..\\secret.bin", "x/../../secret.bin", "link.bin"})
    expectRefused(with(uri), uri);
  expectRefused(with((folder.path / "secret.bin").string()), "absolute");
  expectRefused(with("file://" + (folder.path / "secret.bin").string()), "scheme");
}

TEST_F(SceneLoading, MalformedFilesAreNamed) {
  const auto text = [&](const std::string& content, const std::string& why) {
    std::ofstream(folder.path / "bad.gltf", std::ios::binary) << content;
    expectRefused(folder.path / "bad.gltf", why);
  };
  text("", "empty");
  text(std::string(200000, '['), "nested deeper");
  text("{\"asset\":{\"version\":\"2.0\"},\"extras\":\"\xff\"}", "JSON");
  text("{\"asset\":{\"version\":\"2.0\"},\"asset\":{}}", "duplicate key \"asset\"");
  for (const char* twice :
       {R"("mesh":0,"mesh":0)", R"("extras":{"mesh":0},"mesh":0,"extras":1)", R"("extras":[{"mesh":0,"mesh":1}])"})
    text(fmt::format(R"({{"asset":{{"version":"2.0"}},"nodes":[{{}},{{{}}}]}})", twice), "JSON: duplicate key");
  text(R"({"asset":{"version":"2.0"},"nodes":[],"nodes":[]})", "duplicate key \"nodes\"");
  text(R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0)", "JSON: parse error");
  expectRefused(folder.path / "missing.gltf", "no such file");
  GltfFile file = triangleFile();
  const json good = file.json;
  const auto broken = [&](const char* pointer, const json& value, const std::string& why) {
    file.json = good;
    file.json[json::json_pointer(pointer)] = value;
    refuse(file, why);
  };
  broken("/asset/version", "3.0", "asset.version");
  broken("/nodes/0/mesh", 7, "nodes[0].mesh: 7 points past");
  broken("/nodes/0/mesh", -1, "nodes[0].mesh: -1 is not an integer from 0");
  broken("/nodes/0/mesh", 0.5, "nodes[0].mesh: 0.5 is not an integer from 0");
  broken("/nodes/0/mesh", "x", "nodes[0].mesh: is not an integer (\"x\")");
  broken("/nodes/0/camera", json::object(), "nodes[0].camera: is not an integer ({})");
  broken("/nodes/0/skin", 3, "nodes[0].skin: 3 points past \"skins\", which has 0");
  broken("/nodes/0/name", 5, "nodes[0].name: is not a string");
  broken("/nodes/0/scale", {1, 2}, "nodes[0].scale: is not an array of 3 numbers");
  broken("/nodes/0/rotation", 1, "nodes[0].rotation: is not an array of 4 numbers");
  broken("/nodes/0/translation", {1, nullptr, 2}, "nodes[0].translation[1]: is not a number (null)");
  broken("/nodes/0/translation", {1, 2e30, 2}, "nodes[0].translation[1]: 2e+30 is out of range");
  broken("/nodes/0/weights", json::array(), "nodes[0].weights: is not an array of numbers");
  broken("/nodes/0/children", json::array({json::array()}), "nodes[0].children[0]: is not an integer ([])");
  broken("/nodes/0/children", json::array({7}), "nodes[0].children: 7 points past \"nodes\", which has 1");
  broken("/nodes/0/extensions", 1, "nodes[0].extensions: is not an object");
  broken("/nodes/0/extensions", {{"KHR_lights_punctual", json::object()}}, "KHR_lights_punctual.light: is missing");
  broken("/nodes/0/extensions", {{"KHR_lights_punctual", {{"light", 0}}}}, "KHR_lights_punctual.light: 0 points past");
  broken("/nodes/0/extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"SCALE", 99}}}}}},
         "EXT_mesh_gpu_instancing.attributes.SCALE: 99 points past");
  broken("/nodes/0/extensions", {{"KHR_node_visibility", {{"visible", 0}}}}, "visible: is neither true nor false");
  broken("/nodes/0", 7, "nodes[0]: is not an object");
  broken("/nodes", {{"a", 1}}, "nodes: is not an array");
  broken("/nodes/0", {{"matrix", std::vector<int>(16, 1)}, {"scale", {1, 1, 1}}}, "nodes[0]: has both a matrix and");
  broken("/nodes/0/children", json::array({0}), "its own child");
  broken("/accessors/0/count", 4, "accessors[0]: 4 elements end at byte 48");
  broken("/accessors/0/count", 4000000000u, "4000000000");
  broken("/accessors/0/byteOffset", 18446744073709551604ull, "byteOffset");
  broken("/accessors/0/componentType", 5130, "componentType");
  broken("/bufferViews/0/byteLength", 4000, "bufferViews[0]");
  broken("/bufferViews/0/byteStride", 8, "stride of 8");
  broken("/extensionsRequired", json::array({"VENDOR_x"}), "VENDOR_x");
  // Two nodes, each the child of the other.
  broken("/nodes", {{{"children", {1}}}, {{"children", {0}}}}, "cycle");
  // A node a thousand deep is no trouble.
  file.json = good;
  for (int i = 1; i <= 1000; ++i) {
    file.json["nodes"].push_back({{"mesh", 0}});
    file.json["nodes"][static_cast<size_t>(i - 1)] = {{"children", {i}}, {"translation", {0, 0, 1}}};
  }
  EXPECT_DOUBLE_EQ(world(load(file), 0).z, 1000.0);
}

/// Processor time of this thread, s.
double threadSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A file of `count` root nodes that stand somewhere, a triangle in every fifth, as text.
std::string manyNodes(size_t count) {
  GltfFile file = triangleFile();
  file.json.erase("nodes");
  file.json.erase("scenes");
  file.json["buffers"] = {
      {{"byteLength", file.buffer.size()}, {"uri", "data:application/octet-stream;base64," + base64(file.buffer)}}};
  std::string nodes, roots;
  for (size_t i = 0; i < count; ++i) {
    nodes += fmt::format(
        R"({}{{{}"name":"n{}","translation":[{},0.125,{}],"rotation":[0,0.6,0,0.8],"scale":[1.5,1.5,1.5]}})",
        i == 0 ? "" : ",", i % 5 == 0 ? R"("mesh":0,)" : "", i, i % 1000, i / 1000);
    roots += fmt::format("{}{}", i == 0 ? "" : ",", i);
  }
  const std::string rest = file.json.dump();
  return fmt::format(R"({},"scenes":[{{"nodes":[{}]}}],"nodes":[{}]}})", rest.substr(0, rest.size() - 1), roots, nodes);
}

/// 300,000 nodes, in time that goes with their number: a reader that walks all nodes at the end of each takes sixteen
/// times as long for four times as many. They are to take 2 s of a processor. As seconds that would be a mark that a
/// slow machine misses, and a fast one meets whatever we do: so it is one of the time in which the JSON library makes
/// values of the same text. Of each the least of three: other work on the machine lengthens now one, now another.
TEST_F(SceneLoading, TimeIsLinearInNodesAndManyAreTaken) {
  struct Seconds {
    double parsed, loaded;
  };
  const auto least = [&](size_t count) {
    const std::string text = manyNodes(count);
    const std::filesystem::path path = folder.path / fmt::format("{}.gltf", count);
    std::ofstream(path) << text;
    Seconds out{1e9, 1e9};
    for (int i = 0; i < 3; ++i) {
      const double begun = threadSeconds();
      EXPECT_EQ(nlohmann::json::parse(text)["nodes"].size(), count);
      const double before = threadSeconds();
      EXPECT_EQ(loadScene(path).triangleCount(), count / 5);
      out = {std::min(out.parsed, before - begun), std::min(out.loaded, threadSeconds() - before)};
    }
    return out;
  };
  const double few = least(75'000).loaded;
  const auto [parsed, many] = least(300'000);
  fmt::print("75,000 nodes: {:.2f} s, 300,000: {:.2f} s; JSON by its library takes {:.2f} s\n", few, many, parsed);
  EXPECT_LT(many, 6 * few) << few << " s and " << many << " s";
  EXPECT_LT(many, 1.4 * parsed) << many << " s, and JSON alone " << parsed << " s";
}

TEST_F(SceneLoading, NodesThatAreListedTwiceAreTakenOnce) {
  GltfFile file = triangleFile();
  file.json["nodes"] = {{{"mesh", 0}, {"children", {1}}, {"translation", {10, 0, 0}}},
                        {{"mesh", 0}, {"translation", {0, 5, 0}}}};
  file.json["scenes"][0]["nodes"] = {0, 1, 0};
  const Scene both = load(file);
  expectCorners(both, {{10, 0, 0}, {11, 0, 0}, {10, 1, 0}, {10, 5, 0}, {11, 5, 0}, {10, 6, 0}});
  EXPECT_TRUE(warns(both, "scenes[0]: lists node 1, which is a child of node 0, and 1 more like it; it is taken once"));
  // One whose parents the scene does not list is shown where the tree has it.
  file.json["scenes"][0]["nodes"] = {1};
  const Scene child = load(file);
  expectCorners(child, {{10, 5, 0}, {11, 5, 0}, {10, 6, 0}});
  EXPECT_FALSE(warns(child, "lists node"));
  file.json["scenes"][0]["nodes"] = {0, 0};
  EXPECT_TRUE(warns(load(file), "scenes[0]: lists node 0 twice"));
}

TEST_F(SceneLoading, WhatIsInvisibleIsLeftOut) {
  GltfFile file = triangleFile();
  const json hidden = {{"KHR_node_visibility", {{"visible", false}}}},
             shown = {{"KHR_node_visibility", {{"visible", true}}}};
  file.json["extensionsRequired"] = file.json["extensionsUsed"] = {"KHR_node_visibility"};
  // One that is not seen hides what is under it, whatever that says; what says nothing is seen.
  file.json["nodes"] = {
      {{"mesh", 0}, {"extensions", hidden}, {"children", {1}}},
      {{"mesh", 0}, {"extensions", shown}, {"children", {2}}},
      {{"camera", 0}},
      {{"mesh", 0}, {"extensions", shown}, {"translation", {0, 5, 0}}},
      {{"mesh", 0}, {"extensions", {{"KHR_node_visibility", json::object()}}}, {"translation", {9, 0, 0}}}};
  file.json["scenes"][0]["nodes"] = {0, 3, 4};
  file.json["cameras"] = {{{"type", "perspective"}, {"name", "own"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  const Scene s = load(file);
  expectCorners(s, {{0, 5, 0}, {1, 5, 0}, {0, 6, 0}, {9, 0, 0}, {10, 0, 0}, {9, 1, 0}});
  EXPECT_TRUE(warns(s, "KHR_node_visibility: 2 nodes with meshes are invisible and left out"));
  ASSERT_EQ(s.cameras.size(), 1u);
  EXPECT_EQ(s.cameras[0].name, "own") << "cameras stay, whatever they lie under";
  file.json["scenes"][0]["nodes"] = {0};
  EXPECT_TRUE(warns(load(file), "none of the file's 1 meshes is shown: its nodes are invisible"));
}

TEST_F(SceneLoading, OddLensesLightsAndRotationsAreMendedAndNamed) {
  GltfFile file = triangleFile();
  file.json["extensionsUsed"] = {"KHR_lights_punctual"};
  file.json["cameras"] = {{{"type", "perspective"}, {"name", "wide"}, {"perspective", {{"yfov", 60}, {"znear", 0.1}}}},
                          {{"type", "perspective"}, {"perspective", {{"yfov", 0}, {"znear", 0.1}}}},
                          {{"type", "perspective"}, {"perspective", {{"yfov", 1000}, {"znear", 0.1}}}}};
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "area"}, {"name", "panel"}},
                                                              {{"type", "point"}, {"name", "bulb"}, {"range", 0}},
                                                              {{"type", "point"}, {"range", -4}}};
  for (int i = 0; i < 3; ++i)
    file.json["nodes"].push_back({{"camera", i}, {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  file.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
  file.json["nodes"][0]["name"] = "flat";
  file.json["scenes"][0]["nodes"] = {0, 1, 2, 3};
  const Scene s = load(file);
  expectCorners(s, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  ASSERT_EQ(s.cameras.size(), 3u);
  EXPECT_NEAR(s.cameras[0].yfov, M_PI / 3, 1e-6);
  EXPECT_EQ(s.cameras[1].yfov, Camera{}.yfov);
  EXPECT_EQ(s.cameras[2].yfov, Camera{}.yfov);
  ASSERT_EQ(s.lights.size(), 2u);
  EXPECT_EQ(s.lights[0].range, 0.0f);
  EXPECT_EQ(s.lights[1].range, 0.0f);
  for (const char* said :
       {"cameras[0] \"wide\".perspective.yfov: 60 is not from 0.0001 to 3.1415 radians; 1.0472 is taken, as if it were "
        "degrees",
        "cameras[1].perspective.yfov: 0 is not from", "cameras[2].perspective.yfov: 1000 is not from",
        "lights[0].type: \"area\" is not directional, point or spot; the light \"panel\" is left out",
        "lights[1].range: 0 is not above 0; the light \"bulb\" reaches without limit",
        "lights[2].range: -4 is not above 0", "nodes[0] \"flat\".rotation: (0, 0, 0, 0) is no rotation"})
    EXPECT_TRUE(warns(s, said)) << said << "\n" << fmt::format("{}", fmt::join(s.warnings, "\n"));
}

TEST_F(SceneLoading, HardConesAndOddPlanesAreTaken) {
  GltfFile file = triangleFile();
  file.json["extensionsUsed"] = {"KHR_lights_punctual"};
  const auto spot = [](const char* name, double inner, double outer) {
    return nlohmann::json{
        {"type", "spot"}, {"name", name}, {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}};
  };
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {spot("hard", .5, .5),
                                                              {{"type", "spot"}, {"name", "bare"}}};
  file.json["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = -3;
  file.json["cameras"] = {
      {{"type", "perspective"},
       {"name", "near"},
       {"perspective", {{"yfov", 1}, {"znear", 0}, {"zfar", -1}, {"aspectRatio", 0}}}},
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 1}, {"znear", -5}, {"zfar", 0}}}}};
  for (int i = 0; i < 2; ++i)
    file.json["nodes"].push_back({{"camera", i}, {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  file.json["scenes"][0]["nodes"] = {0, 1, 2};
  const Scene s = load(file);
  expectCorners(s, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  ASSERT_EQ(s.lights.size(), 2u);
  EXPECT_EQ(s.lights[0].innerCos, s.lights[0].outerCos);
  EXPECT_NEAR(s.lights[0].outerCos, std::cos(.5), 1e-6);
  EXPECT_EQ(s.lights[0].intensity, 0.0f);
  EXPECT_NEAR(s.lights[1].outerCos, std::cos(M_PI / 4), 1e-6);
  EXPECT_EQ(s.lights[1].innerCos, 1.0f);
  ASSERT_EQ(s.cameras.size(), 2u);
  EXPECT_EQ(s.cameras[0].znear, Camera{}.znear);
  EXPECT_EQ(s.cameras[0].zfar, 0.0f);
  EXPECT_EQ(s.cameras[0].aspect, 0.0f);
  EXPECT_EQ(s.cameras[1].znear, 0.0f);
  EXPECT_EQ(unsound(s), "");
  for (const char* said :
       {"lights[0].intensity: -3 is clamped to 0", "lights[1]: a spot light without \"spot\"",
        "cameras[0] \"near\".perspective.aspectRatio: 0 is not from",
        "cameras[0] \"near\".perspective.znear: 0 is not above 0",
        "cameras[0] \"near\".perspective.zfar: -1 is not beyond znear",
        "cameras[1].orthographic.znear: -5 is not 0 or more", "cameras[1].orthographic.zfar: 0 is not beyond znear"})
    EXPECT_TRUE(warns(s, said)) << said << "\n" << fmt::format("{}", fmt::join(s.warnings, "\n"));
  // three.js writes both angles the same by default, and Blender for a blend of 0: nothing to speak of.
  EXPECT_FALSE(warns(s, "lights[0].spot"));
}

TEST_F(SceneLoading, RotationsOfInstancesThatAreNoneAreNamed) {
  GltfFile file = triangleFile();
  file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] =
      file.data(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 0}, "VEC4", kFloat, 4);
  EXPECT_TRUE(warns(load(file), "nodes[0].EXT_mesh_gpu_instancing.ROTATION[1]: (0, 0, 0, 0) is no rotation"));
}

TEST_F(SceneLoading, TheFormatsFirstVersionIsNamed) {
  const auto text = [&](const std::string& content) {
    std::ofstream(folder.path / "old.gltf", std::ios::binary) << content;
    expectRefused(folder.path / "old.gltf", "this is glTF 1.0");
  };
  text(R"({"asset": {"version": "1.0"}, "scene": "main", "scenes": {"main": {"nodes": ["a"]}}, "nodes": {"a": {}}})");
  text(R"({"asset": {"version": 1}, "scenes": {}})");
  text(R"({"scene": "main", "scenes": {"main": {"nodes": []}}})");
  const std::string glb("glTF\x01\0\0\0\x18\0\0\0\x04\0\0\0\0\0\0\0{}  ", 24);
  std::ofstream(folder.path / "old.glb", std::ios::binary) << glb;
  expectRefused(folder.path / "old.glb", "GLB header: version 1: this is glTF 1.0");
}

TEST_F(SceneLoading, WhatIsTheMatterWhereNothingIsDrawnIsSaid) {
  GltfFile file = triangleFile();
  file.json["scenes"][0].erase("nodes");
  EXPECT_TRUE(warns(load(file), "none of the file's 1 meshes is shown: scenes[0] lists no nodes"));
  file.json["scenes"][0]["nodes"] = {0};
  file.json["nodes"][0] = {{"name", "empty"}};
  EXPECT_TRUE(warns(load(file), "none of the file's 1 meshes is shown: no node of scenes[0] names one"));
  file.json.erase("scenes"), file.json.erase("scene");
  EXPECT_TRUE(warns(load(file), "is shown: no node names one"));
  file.json.erase("nodes");
  EXPECT_TRUE(warns(load(file), "is shown: it has no nodes"));
  file.json.erase("meshes");
  EXPECT_TRUE(warns(load(file), "the scene has no triangles: the file has no meshes"));
}

TEST_F(SceneLoading, APlaceOnTheGlobeIsLeftAside) {
  GltfFile file = triangleFile();
  file.json["extensionsRequired"] = file.json["extensionsUsed"] = {"CESIUM_RTC"};
  file.json["extensions"]["CESIUM_RTC"] = {{"center", {6378137, 0, 0}}};
  const Scene s = load(file);
  expectCorners(s, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  EXPECT_TRUE(warns(s, "CESIUM_RTC is left aside"));
}

TEST_F(SceneLoading, CompressedTexturesAreRefusedInWords) {
  GltfFile file = texturedQuad();
  file.json["extensionsUsed"] = {"KHR_texture_basisu"};
  EXPECT_TRUE(
      warns(load(file), "KHR_texture_basisu is ignored: KTX2 images are not decoded here; PNG, JPEG and WebP are"));
  file.json["extensionsRequired"] = {"KHR_texture_basisu"};
  refuse(file, "\"KHR_texture_basisu\" is not supported: KTX2 images are not decoded here");
}

TEST_F(SceneLoading, FoldersAndDevicesAreCalledSo) {
  expectRefused(folder.path, "is a folder, not a file");
  expectRefused("/dev/null", "is a device or a pipe, not a file");
}

/// A box of quads from (-x, 0, -z) to (x, 2 y, z) that faces inwards or outwards.
GltfFile boxFile(glm::vec3 half, bool inwards) {
  GltfFile file;
  std::vector<float> corners;
  for (int i = 0; i < 8; ++i)
    corners.insert(corners.end(), {i & 1 ? half.x : -half.x, i & 2 ? 2 * half.y : 0.0f, i & 4 ? half.z : -half.z});
  file.attributes()["POSITION"] = file.vec3(corners);
  std::vector<uint16_t> indices;
  // Counter-clockwise from outside.
  for (const auto& q : std::vector<std::array<int, 4>>{
           {0, 2, 3, 1}, {0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {4, 5, 7, 6}}) {
    for (const int k : inwards ? std::array{0, 2, 1, 0, 3, 2} : std::array{0, 1, 2, 0, 2, 3})
      indices.push_back(static_cast<uint16_t>(q[static_cast<size_t>(k)]));
  }
  file.primitive()["indices"] = file.data(indices, "SCALAR", kU16, 1);
  return file;
}

TEST_F(SceneLoading, TheFittedCameraStandsInsideOfWhatFacesInwards) {
  GltfFile hall = boxFile({4, 3, 10}, /*inwards=*/true);
  hall.json["nodes"][0]["translation"] = {100, 0, 0};
  const Scene inside = load(hall);
  ASSERT_TRUE(inside.defaultCamera);
  EXPECT_TRUE(warns(inside, "a fitted one is used, which stands inside: 100 % of the surface face inwards"));
  const Camera& camera = inside.cameras[0];
  EXPECT_EQ(camera.name, "fitted");
  const glm::dvec3 p = camera.position - glm::dvec3(100, 0, 0);
  EXPECT_LT(std::abs(p.x), 3);
  EXPECT_GT(p.y, 1);
  EXPECT_LT(p.y, 4);
  EXPECT_GT(std::abs(p.z), 4) << "nearer to one end";
  EXPECT_LT(std::abs(p.z), 10);
  const glm::vec3 forward = camera.orientation * glm::vec3(0, 0, -1);
  EXPECT_GT(-forward.z * (p.z > 0 ? 1 : -1), 0.9) << "along the hall, to the other end";
  EXPECT_NEAR(forward.y, 0, 1e-6);

  GltfFile solid = boxFile({4, 3, 10}, /*inwards=*/false);
  const Scene outside = load(solid);
  EXPECT_FALSE(warns(outside, "stands inside"));
  EXPECT_GT(glm::length(outside.cameras[0].position - outside.origin),
            1.02 * glm::length(glm::dvec3(outside.boundsMax)))
      << "around the sphere";
  // Most of a plane faces what stands on it; that is no room.
  GltfFile plane;
  plane.attributes()["POSITION"] = plane.vec3({-9, 0, -9, -9, 0, 9, 9, 0, 9, 9, 0, -9, 0, 0, 0, 0, 2, 0, 1, 0, 0});
  plane.primitive()["indices"] = plane.data(std::vector<uint16_t>{0, 1, 2, 0, 2, 3, 4, 5, 6}, "SCALAR", kU16, 1);
  EXPECT_FALSE(warns(load(plane), "stands inside"));
}

TEST_F(SceneLoading, IndexErrors) {
  GltfFile file = triangleFile();
  file.primitive()["indices"] = file.data(std::vector<uint16_t>{0, 1, 3}, "SCALAR", kU16, 1);
  refuse(file, "3 is past the 3 vertices");
  GltfFile restart = triangleFile();
  restart.primitive()["indices"] = restart.data(std::vector<uint16_t>{0, 1, 65535}, "SCALAR", kU16, 1);
  refuse(restart, "primitive restart");
}

TEST_F(SceneLoading, SizeLimits) {
  // 4,096 triangles (one, repeated) in 5,000 instances, placed by an accessor of zeros: 20 million, 2^24 is the limit.
  GltfFile file = triangleFile();
  std::vector<uint16_t> repeated;
  for (int i = 0; i < 4096; ++i) repeated.insert(repeated.end(), {0, 1, 2});
  file.primitive()["indices"] = file.data(repeated, "SCALAR", kU16, 1);
  const int zeros = file.accessor({{"componentType", kFloat}, {"type", "VEC3"}, {"count", 5000}});
  file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = zeros;
  refuse(file, "more than 16777216 triangles");
  // A few hundred bytes that ask for gigabytes.
  file.json["accessors"][static_cast<size_t>(zeros)]["count"] = 100'000'000;
  refuse(file, "a scene may hold");
}

TEST_F(SceneLoading, CacheRoundTripAndDamage) {
  GltfFile file = texturedQuad();
  file.json["materials"][0]["alphaMode"] = "MASK";
  file.json["nodes"].push_back({{"camera", 0}, {"translation", {1, 2, 3}}});
  file.json["scenes"][0]["nodes"].push_back(1);
  file.json["cameras"] = {
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 1}, {"znear", 0.5}, {"zfar", 9}}}}};
  const Scene a = load(file);
  const auto path = folder.path / "scene.irscene";
  writeSceneCache(a, path);
  const Scene b = loadScene(path);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.tangents, b.tangents);
  EXPECT_EQ(a.uv0, b.uv0);
  EXPECT_EQ(a.indices, b.indices);
  EXPECT_EQ(a.sha256, b.sha256);
  EXPECT_EQ(a.warnings, b.warnings);
  ASSERT_EQ(b.images.size(), a.images.size());
  EXPECT_EQ(a.images[0].rgba, b.images[0].rgba);
  EXPECT_EQ(b.materials[0].alpha, AlphaMode::Mask);
  EXPECT_EQ(b.materials[0].normalTexture.image, 0);
  EXPECT_TRUE(b.cameras[0].orthographic);
  EXPECT_EQ(b.cameras[0].aspect, 2.0f);
  EXPECT_EQ(b.cameras[0].position, glm::dvec3(1, 2, 3));

  std::ifstream in(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const auto damaged = folder.path / "damaged.irscene";
  for (size_t length = 0; length < bytes.size(); length += 1 + length / 16) {
    std::ofstream(damaged, std::ios::binary) << bytes.substr(0, length);
    EXPECT_THROW(loadScene(damaged), InputError) << length;
  }
  // Any byte may be wrong: the result is an error or a sound scene, never a crash.
  for (size_t at = 0; at < bytes.size(); at += 3) {
    std::string bent = bytes;
    bent[at] = static_cast<char>(bent[at] ^ 0xFF);
    std::ofstream(damaged, std::ios::binary) << bent;
    try {
      const Scene s = loadScene(damaged);
      for (const uint32_t index : s.indices) ASSERT_LT(index, s.positions.size());
    } catch (const InputError&) {
    }
  }
  EXPECT_THROW(writeSceneCache(a, folder.path / "no such folder" / "x.irscene"), WorkError);
}

TEST_F(SceneLoading, BuiltInBox) {
  const Scene s = loadScene(assets() / "box.glb");
  EXPECT_EQ(unsound(s), "");
  EXPECT_GT(s.triangleCount(), 12u);
  EXPECT_FALSE(s.defaultCamera);
  EXPECT_FALSE(s.defaultLight);
  EXPECT_EQ(s.cameras.size(), 2u);
}

}  // namespace
}  // namespace irad::test::scene_suite
