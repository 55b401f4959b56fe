// Wrong input with known answers: numbers that do not fit, texts nested too deeply, caches that break a scene's
// promises. (The fuzzer's seeds: fuzz_seeds_test.)
#include <functional>
#include <limits>
#include <map>

#include "app/arguments.h"
#include "gi/picture.h"
#include "renderer/base/console.h"
#include "renderer/base/json_extent.h"
#include "renderer/base/output_file.h"
#include "renderer/scene/camera_json.h"
#include "renderer/scene/image_header.h"
#include "renderer/scene/light_json.h"
#include "renderer/scene/srgb.h"
#include "tests/scene_files.h"

namespace irad::test::wrong_input_suite {
namespace {

using nlohmann::json;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

/// What an Error says; empty where there is none.
std::string refusal(const std::function<void()>& read) {
  try {
    read();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(JsonExtent, CountsBracketsOutsideStrings) {
  EXPECT_EQ(jsonExtent("").depth, 0u);
  EXPECT_EQ(jsonExtent(R"({"a": [1, 2, {"b": 3}]})").depth, 3u);
  EXPECT_EQ(jsonExtent(R"({"a": [1, 2, {"b": 3}]})").elements, 7u);  // three containers, two colons, two commas
  EXPECT_EQ(jsonExtent(R"(["[[[", "\"[[[", "\\", []])").depth, 2u);
  EXPECT_EQ(jsonExtent("]]]][").depth, 1u);
  EXPECT_EQ(jsonExtent("[\"\\").depth, 1u);
  EXPECT_EQ(jsonExtent(std::string(1000, '[')).depth, 1000u);
}

TEST(DeepJson, IsRefusedByEveryReader) {
  const std::string deep = std::string(200000, '[') + std::string(200000, ']');
  Settings settings;
  EXPECT_NE(refusal([&] { settingsFromJson(settings, R"({"matrix.rays": )" + deep + "}"); }).find("too deeply"),
            std::string::npos);
  EXPECT_NE(refusal([&] { cameraFromJson(R"({"position": )" + deep + "}"); }).find("too deeply"), std::string::npos);
  TemporaryFolder folder;
  std::ofstream(folder.path / "deep.json") << R"({"settings": {}, "cameras": )" << deep << "}";
  const std::string config = refusal([&] { readConfigFile(folder.path / "deep.json"); });
  EXPECT_NE(config.find("deep.json: JSON nested too deeply"), std::string::npos) << config;
}

TEST(CameraJson, NumbersOutsideFp32AreRefused) {
  const std::string good = R"({"position": [0, 0, 2], "target": [0, 0, 0], "aspect": 1.5, "yfov": 0.5})";
  EXPECT_EQ(cameraFromJson(good).aspect, 1.5f);
  for (const char* field : {"aspect", "yfov", "znear", "zfar"})
    for (const double value : {1e39, 1e300, 0.0, 1e-60, -1.0}) {
      json camera = json::parse(good);
      camera[field] = value;
      const std::string text = refusal([&] { cameraFromJson(camera.dump()); });
      EXPECT_NE(text.find(fmt::format("camera: {}", field)), std::string::npos)
          << field << " " << value << ": " << text;
    }
  json camera = json::parse(good);
  camera["position"] = {0, 1e30, 0};
  EXPECT_NE(refusal([&] { cameraFromJson(camera.dump()); }).find("position"), std::string::npos);
}

TEST(Manifest, CountsThatAreNoWholeNumbersAreRefused) {
  TemporaryFolder folder;
  const auto read = [&](const char* name, const json& value) {
    std::ofstream(folder.path / "m.json") << json{{"settings", json::object()}, {name, value}};
    return refusal([&] { readConfigFile(folder.path / "m.json"); });
  };
  EXPECT_EQ(read("frames", 3), "");
  EXPECT_EQ(read("size", {640, 480}), "");
  for (const json& bad : {json(-1), json(2.5), json(1e39), json(0), json(4294967297), json("3"), json(nullptr)}) {
    EXPECT_NE(read("frames", bad).find("m.json: frames: "), std::string::npos) << bad;
    EXPECT_NE(read("size", {640, bad}).find("m.json: size: "), std::string::npos) << bad;
  }
  EXPECT_NE(read("size", 640).find("m.json: size: "), std::string::npos);
}

TEST(Manifest, ATimeThatIsNoneIsRefused) {
  TemporaryFolder folder;
  const auto read = [&](const json& time) {
    std::ofstream(folder.path / "m.json") << json{{"settings", json::object()}, {"time", time}};
    return refusal([&] { readConfigFile(folder.path / "m.json"); });
  };
  EXPECT_EQ(read("2026-11-25T23:50:07Z"), "");
  EXPECT_EQ(readConfigFile(folder.path / "m.json").time, 1795650607);
  EXPECT_EQ(timeText(1795650607), "2026-11-25T23:50:07Z");
  for (const json& bad :
       {json("2026-11-25T23:50:07"), json("2026-02-30T00:00:00Z"), json("yesterday"), json(""), json(7), json(nullptr)})
    EXPECT_NE(read(bad).find("m.json: time: "), std::string::npos) << bad;
}

TEST(Manifest, ASceneWithAnImpossibleNameIsNoSuchFile) {
  Config config;
  const std::string text = refusal([&] { app::findScene(std::string(10000, 'x') + ".glb", config, std::nullopt); });
  EXPECT_NE(text.find("no such file"), std::string::npos) << text;
}

TEST(Printable, QuotesWhatATerminalCannotTake) {
  EXPECT_EQ(printable("plain \t\n\xC3\xBC \xE2\x82\xAC \xF0\x9F\x92\xA1"),
            "plain \t\n\xC3\xBC \xE2\x82\xAC \xF0\x9F\x92\xA1");
  EXPECT_EQ(printable("a\xFF"
                      "b"),
            "a\\xFFb");
  EXPECT_EQ(printable("\x1b[31m\r\x7f"), "\\x1B[31m\\x0D\\x7F");
  EXPECT_EQ(printable("\xC2\x9B"), "\\xC2\\x9B") << "a control character of two bytes";
  EXPECT_EQ(printable("\xC3"), "\\xC3") << "a character cut off";
  EXPECT_EQ(printable("\xC0\xAF \xE0\x80\xAF"), "\\xC0\\xAF \\xE0\\x80\\xAF") << "overlong";
  EXPECT_EQ(printable("\xED\xA0\x80 \xF4\x90\x80\x80"), "\\xED\\xA0\\x80 \\xF4\\x90\\x80\\x80")
      << "surrogates, too large";
}

TEST(MadeFolder, GoesWhereNothingWasWritten) {
  TemporaryFolder folder;
  const std::filesystem::path there = folder.path / "there", made = there / "a" / "b";
  std::filesystem::create_directory(there);
  {
    const MadeFolder work(made);
    std::filesystem::create_directory(made / "pictures");
  }
  EXPECT_TRUE(std::filesystem::exists(there));
  EXPECT_FALSE(std::filesystem::exists(there / "a"));
  {
    const MadeFolder work(made);
    std::ofstream(made / "result") << "x";
  }
  EXPECT_TRUE(std::filesystem::exists(made / "result"));
  { const MadeFolder work(there / "a"); }
  EXPECT_TRUE(std::filesystem::exists(made / "result"));
  {
    const MadeFolder work(there / "a", {"result"});  // was there before
  }
  EXPECT_TRUE(std::filesystem::exists(made / "result"));
  EXPECT_THROW(MadeFolder(made / "result"), WorkError);
}

/// A file that says only what was to come into the folder goes with it; where there is more, it stays.
TEST(MadeFolder, TakesLabelsAlong) {
  TemporaryFolder folder;
  const std::filesystem::path made = folder.path / "a" / "b", inner = made / "c";
  for (const bool more : {false, true}) {
    {
      const MadeFolder work(made, {"label"});
      std::filesystem::create_directory(inner);
      for (const auto& where : {made, inner}) std::ofstream(where / "label") << "x";
      if (more) std::ofstream(inner / "result") << "x";
    }
    EXPECT_EQ(std::filesystem::exists(folder.path / "a"), more);
    EXPECT_EQ(std::filesystem::exists(made / "label"), more);
    EXPECT_EQ(std::filesystem::exists(inner / "label"), more);
  }
}

/// A PNG's first 29 bytes.
std::vector<uint8_t> pngHeader(uint32_t width, uint32_t height, uint8_t depth, uint8_t interlaced) {
  std::vector<uint8_t> out{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n', 0, 0, 0, 13, 'I', 'H', 'D', 'R'};
  for (const uint32_t value : {width, height})
    for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<uint8_t>(value >> shift));
  out.insert(out.end(), {depth, 6, 0, 0, interlaced});
  return out;
}

TEST(ImageHeader, StatesSizeAndCostByFormat) {
  const std::filesystem::path seeds = sourceFolder() / "tests/fuzz/seeds/image";
  const std::map<std::string, std::tuple<std::string, uint32_t, uint32_t>> want{
      {"grey.png", {"png", 5, 3}},  {"rgba.png", {"png", 7, 3}},   {"grey.jpg", {"jpeg", 9, 5}},
      {"rgb.jpg", {"jpeg", 17, 9}}, {"rgb.webp", {"webp", 4, 12}}, {"rgba.webp", {"webp", 8, 12}}};
  for (const auto& [name, expected] : want) {
    std::ifstream in(seeds / name, std::ios::binary);
    const std::vector<uint8_t> bytes((std::istreambuf_iterator<char>(in)), {});
    const std::optional<ImageHeader> header = readImageHeader(bytes);
    ASSERT_TRUE(header) << name;
    const auto& [format, side, scratch] = expected;
    EXPECT_EQ(header->format, format) << name;
    EXPECT_EQ(header->width, side) << name;
    EXPECT_EQ(header->height, side) << name;
    EXPECT_EQ(header->scratch, scratch) << name;
    for (size_t length = 0; length < std::min<size_t>(bytes.size(), 29); ++length)
      EXPECT_FALSE(readImageHeader(std::span(bytes).first(length))) << name << " " << length;
  }
  EXPECT_EQ(readImageHeader(pngHeader(300, 20, 16, 1))->scratch, 11u);
  EXPECT_EQ(imageTooLarge(*readImageHeader(pngHeader(8192, 8192, 8, 0))), "");
  EXPECT_NE(imageTooLarge(*readImageHeader(pngHeader(0, 4, 8, 0))), "");
  EXPECT_NE(imageTooLarge(*readImageHeader(pngHeader(16385, 4, 8, 0))), "");
  EXPECT_NE(imageTooLarge(*readImageHeader(pngHeader(16384, 16384, 16, 1))), "");
}

TEST(ImageHeader, AnImageThatStatesGigabytesIsPinkAndTakesNone) {
  TemporaryFolder folder;
  const std::vector<uint8_t> png = pngHeader(16384, 16384, 16, 1);
  std::ofstream(folder.path / "huge.png", std::ios::binary).write(reinterpret_cast<const char*>(png.data()), 29);
  GltfFile file = triangleFile();
  file.json["images"] = {{{"uri", "huge.png"}}};
  file.json["textures"] = {{{"source", 0}}};
  file.json["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
  file.primitive()["material"] = 0;
  const Scene s = loadScene(file.write(folder.path));
  EXPECT_EQ(s.images.at(0).width, 8u);
  EXPECT_TRUE(warns(s, "16384 x 16384 pixels and needs 2816 MiB to decode; 600 MiB are accepted"));
}

TEST(Gltf, LightsCamerasAndLensesBeyondFp32AreRefused) {
  TemporaryFolder folder;
  GltfFile file = triangleFile();
  file.json["nodes"].push_back({{"camera", 0}});
  file.json["scenes"][0]["nodes"].push_back(1);
  file.json["cameras"] = {
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 1}, {"znear", 0.5}, {"zfar", 9}}}}};
  EXPECT_EQ(unsound(loadScene(file.write(folder.path))), "");
  GltfFile far = file, wide = file;
  far.json["nodes"][1]["translation"] = {0, 1e20, 0};
  expectRefused(far.write(folder.path), "light or camera lies at");
  wide.json["cameras"][0]["orthographic"]["xmag"] = 1e29;
  expectRefused(wide.write(folder.path), "cameras[0].xmag");
}

TEST(Gltf, SizesOfLightsAreNumbersInTheirRange) {
  TemporaryFolder folder;
  GltfFile file = triangleFile();
  file.json["extensionsUsed"] = {"KHR_lights_punctual"};
  auto& lights = file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "directional"}, {"extras", {{"angle", 0.53}, {"radius", 3}}}},
      {{"type", "point"}, {"extras", {{"angle", 3}, {"radius", 0.25}}}},
      {{"type", "point"}, {"extras", "of any kind"}}};
  for (int i = 0; i < 3; ++i) file.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  file.json["scenes"][0]["nodes"] = {0, 1, 2, 3};
  const Scene scene = loadScene(file.write(folder.path));
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].angle, 0.53f);
  EXPECT_EQ(scene.lights[0].radius, 0);
  EXPECT_EQ(scene.lights[1].angle, 0);
  EXPECT_EQ(scene.lights[1].radius, 0.25f);
  EXPECT_EQ(scene.lights[2].radius, 0);
  const std::vector<Light> again = lightsFromJson(lightsToJson(scene.lights));
  ASSERT_EQ(again.size(), 3u);
  EXPECT_EQ(again[0].angle, 0.53f);
  EXPECT_EQ(again[1].radius, 0.25f);
  writeSceneCache(scene, folder.path / "scene.irscene");
  EXPECT_EQ(loadScene(folder.path / "scene.irscene").lights, scene.lights);

  lights[1]["extras"]["radius"] = -1;
  expectRefused(file.write(folder.path), "lights[1].extras.radius: -1 is not a number from 0 to");
  lights[1]["extras"]["radius"] = "wide";
  expectRefused(file.write(folder.path), "lights[1].extras.radius: \"wide\" is not a number");
  lights[1]["extras"]["radius"] = 1;
  lights[0]["extras"]["angle"] = 120;
  expectRefused(file.write(folder.path), "lights[0].extras.angle: 120 is not a number from 0 to 90");
}

TEST(SceneCache, UnsoundScenesAreRefused) {
  TemporaryFolder folder;
  GltfFile file = triangleFile();
  file.json["extensionsUsed"] = {"KHR_lights_punctual"};
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  file.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  const Scene good = loadScene(file.write(folder.path));
  const std::filesystem::path path = folder.path / "scene.irscene";
  writeSceneCache(good, path);
  EXPECT_EQ(unsound(loadScene(path)), "");
  struct Damage {
    const char* said;
    std::function<void(Scene&)> change;
  };
  const std::vector<Damage> all{
      {"position 1 is not finite", [](Scene& s) { s.positions[1].x = kNan; }},
      {"normal 2 is not unit", [](Scene& s) { s.normals[2] *= 2.0f; }},
      {"tangent 0 is not unit", [](Scene& s) { s.tangents[0] = glm::vec4(0, 0, 0, 1); }},
      {"handedness", [](Scene& s) { s.tangents[0].w = 0.5f; }},
      {"not orthogonal", [](Scene& s) { s.tangents[1] = glm::vec4(s.normals[1], 1.0f); }},
      {"vertex colour 0", [](Scene& s) { s.colors[0].a = 1.5f; }},
      {"texture coordinate 2", [](Scene& s) { s.uv1[2].y = kInfinity; }},
      {"different lengths", [](Scene& s) { s.uv0.pop_back(); }},
      {"index 3 of 3", [](Scene& s) { s.indices[0] = 3; }},
      {"a draw is out of range", [](Scene& s) { s.draws[0].material = 9; }},
      {"do not cover", [](Scene& s) { s.draws.clear(); }},
      {"bounds", [](Scene& s) { s.boundsMax.y = kInfinity; }},
      {"bounds", [](Scene& s) { s.origin.z = 1e16; }},
      {"no material", [](Scene& s) { s.materials.clear(); }},
      {"base colour", [](Scene& s) { s.materials[0].baseColor.g = -0.5f; }},
      {"emits", [](Scene& s) { s.materials[0].emission.b = kInfinity; }},
      {"a factor", [](Scene& s) { s.materials[0].roughness = kNan; }},
      {"a texture", [](Scene& s) { s.materials[0].normalTexture.image = 0; }},
      {"a texture", [](Scene& s) { s.materials[0].normalTexture.transform[2].x = kNan; }},
      {"pixels",
       [](Scene& s) {
         s.images.push_back({"x", 2, 2, false, std::vector<uint8_t>(15)});
       }},
      {"light", [](Scene& s) { s.lights[0].position.x = 1e300; }},
      {"light", [](Scene& s) { s.lights[0].intensity = -1.0f; }},
      {"light", [](Scene& s) { s.lights[0].outerCos = 2.0f; }},
      {"no camera", [](Scene& s) { s.cameras.clear(); }},
      {"camera", [](Scene& s) { s.cameras[0].yfov = 0.0f; }},
      {"camera", [](Scene& s) { s.cameras[0].orientation = glm::quat(0, 0, 0, 0); }},
      {"camera", [](Scene& s) { s.cameras[0].znear = kNan; }},
  };
  for (const Damage& damage : all) {
    Scene bad = good;
    damage.change(bad);
    writeSceneCache(bad, path);
    expectRefused(path, damage.said);
  }
}

#ifdef IRAD_OIIO
TEST(ReferencePicture, IntegersAreDecodedAndSaid) {
  TemporaryFolder folder;
  const glm::uvec2 size(4, 1);
  const std::vector<glm::u8vec4> codes{{0, 0, 0, 255}, {10, 128, 188, 255}, {255, 255, 255, 255}, {1, 2, 3, 255}};
  const ReferencePicture png = readReference(writeDisplay(folder.path / "shown", size, codes));
  for (size_t i = 0; i < codes.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(png.picture.pixels[i][c], linearFromSrgb(codes[i][c]), 1e-6);
  EXPECT_NE(png.note.find("shown.png holds integers and is decoded from sRGB"), std::string::npos) << png.note;
  const std::vector<glm::vec4> light{{0.5f, 2, 0.25f, 1}, glm::vec4(0), glm::vec4(7), glm::vec4(1)};
  const ReferencePicture exr = readReference(writeLinear(folder.path / "light", size, light));
  EXPECT_EQ(exr.note, "");
  EXPECT_EQ(exr.picture.pixels[0].y, 2.0f);
}
#endif

}  // namespace
}  // namespace irad::test::wrong_input_suite
