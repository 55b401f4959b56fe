// Folders of captures and recordings, read back from the manifests beside them.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "gi/captures.h"
#include "gi/manifest.h"
#include "renderer/base/error.h"
#include "renderer/base/recording.h"
#include "tests/support.h"

namespace irad::test::capture_list_suite {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct CaptureListTest : ::testing::Test {
  TemporaryFolder folder;
  Scene scene = loadScene(assets() / "box.glb");
  Settings settings = defaultSettings(/*cpuDevice=*/true);
  DeviceInfo device;

  CaptureListTest() { device.name = "a device", device.driver = "its driver"; }
  Manifest manifest(int64_t time, const char* view = "lit") const {
    return {.program = {"1.2", "abc"},
            .subcommand = "render",
            .time = time,
            .device = &device,
            .scene = &scene,
            .settings = &settings,
            .cpuDevice = true,
            .size = glm::uvec2(320, 200),
            .cameras = {scene.cameras.front()},
            .views = {view}};
  }
  void write(const fs::path& name, const std::string& text) const {
    fs::create_directories((folder.path / name).parent_path());
    std::ofstream(folder.path / name) << text;
  }
  CaptureList list() const { return listCaptures(folder.path, settings); }
};

TEST_F(CaptureListTest, AManifestSaysAllThatItWasMadeOf) {
  settings.voxel.resolution = 48;
  scene.lights.push_back({.name = "lamp", .type = LightType::Point, .position = {1, 2, 3}});
  scene.materialEdits = {{.material = "red", .roughness = 0.25f}};
  scene.hidden.paths = {"metal sphere"};
  Settings other = settings;
  other.matrix.gpu.rays = 77;
  Manifest made = manifest(1795650607, "direct");
  made.details.emplace_back("other_settings", settingsToJson(other));
  write("box.001/manifest.json", made.toJson());
  write("box.001/direct.png", "");
  write("box.001/direct.exr", "");

  const CaptureEntry entry = readCapture(folder.path / "box.001/manifest.json", defaultSettings(true));
  EXPECT_EQ(entry.name, "box.001");
  EXPECT_EQ(entry.folder, folder.path / "box.001");
  EXPECT_EQ(entry.time, 1795650607);
  EXPECT_EQ(entry.settings, settings);
  EXPECT_EQ(entry.other, other);
  EXPECT_EQ(entry.view, findView("direct"));
  EXPECT_FALSE(entry.recording);
  EXPECT_EQ(entry.picture, folder.path / "box.001/direct.png");
  EXPECT_EQ(*entry.config.scene, fs::absolute(scene.path).lexically_normal());
  EXPECT_EQ(entry.config.sceneSha256, scene.sha256);
  EXPECT_EQ(entry.config.lights, scene.lights);
  EXPECT_EQ(entry.config.materials, scene.materialEdits);
  EXPECT_EQ(entry.config.hidden, scene.hidden);
  EXPECT_EQ(entry.config.cameras, made.cameras);
  EXPECT_EQ(entry.config.size, made.size);
  EXPECT_EQ(entry.config.device, "a device");
  EXPECT_EQ(entry.config.driver, "its driver");
  EXPECT_EQ(entry.config.program, "1.2, abc");
}

TEST_F(CaptureListTest, TheNewestIsTheFirst) {
  write("box.001/manifest.json", manifest(100).toJson());
  write("box.002/a/manifest.json", manifest(300).toJson());
  write("box.002/b/manifest.json", manifest(300).toJson());
  Recording recording{.device = "", .scene = "", .frames = {}, .manifest = manifest(200).toJson()};
  writeRecording(folder.path / "recording.001", recording);
  write("memory.001/memory.csv", "");
  write("a file", "");
  write(".box.003.12.irad-tmp/manifest.json", manifest(400).toJson());
  const CaptureList found = list();
  std::vector<std::string> names;
  for (const CaptureEntry& entry : found.entries) names.push_back(entry.name);
  EXPECT_EQ(names, (std::vector<std::string>{"box.002/a", "box.002/b", "recording.001", "box.001"}));
  EXPECT_TRUE(found.entries[2].recording);
  EXPECT_TRUE(found.entries[3].picture.empty());
  EXPECT_EQ(found.problems, std::vector<std::string>());
}

TEST_F(CaptureListTest, WhatIsWrongIsNamedAndTheRestIsListed) {
  write("good/manifest.json", manifest(1).toJson());
  const Json whole = Json::parse(manifest(1).toJson());
  const auto with = [&](const char* name, const Json& value) {
    Json json = whole;
    json[name] = value;
    return json.dump();
  };
  Json lacking = whole;
  lacking.erase("scene");
  const std::array wrong{
      std::pair(std::string("{"), "not JSON"),
      std::pair(std::string("[]"), "expected a JSON object"),
      std::pair(std::string("{\"voxel.resolution\": 32}"), "settings: not there: no manifest of a run"),
      std::pair(lacking.dump(), "scene: not there: no manifest of a run"),
      std::pair(with("settings", {{"voxel.resolution", -4}}), "voxel.resolution"),
      std::pair(with("other_settings", {{"wind", 4}}), "wind"),
      std::pair(with("views", {"moonlight"}), "views: 'moonlight' is no view"),
      std::pair(with("time", "noon"), "time: expected YYYY-MM-DDThh:mm:ssZ, not noon"),
      std::pair(with("device", {{"name", 5}}), "name: unexpected value 5"),
      std::pair(with("format", 99), "is of format 99"),
  };
  for (size_t i = 0; i < wrong.size(); ++i) write(fmt::format("wrong.{}/manifest.json", i), wrong[i].first);
  const CaptureList found = list();
  ASSERT_EQ(found.entries.size(), 1u);
  EXPECT_EQ(found.entries[0].name, "good");
  ASSERT_EQ(found.problems.size(), wrong.size());
  for (size_t i = 0; i < wrong.size(); ++i) {
    EXPECT_TRUE(found.problems[i].starts_with((folder.path / fmt::format("wrong.{}/manifest.json: ", i)).string()))
        << found.problems[i];
    EXPECT_NE(found.problems[i].find(wrong[i].second), std::string::npos) << found.problems[i];
    EXPECT_EQ(found.problems[i].find("json.exception"), std::string::npos) << found.problems[i];
  }
}

TEST_F(CaptureListTest, ARecordingOfAnOlderVersionIsListedThoughItDoesNotSayWhatItIsOf) {
  writeRecording(folder.path / "recording.001", {.device = "a device", .scene = "box.glb", .frames = {}});
  write("recording.002/manifest.json", manifest(1).toJson());
  write("recording.002/frames.csv", "");
  const CaptureList found = list();
  EXPECT_EQ(found.problems, std::vector<std::string>());
  ASSERT_EQ(found.entries.size(), 2u);
  const CaptureEntry& old = found.entries[0];  // its files have just been written
  EXPECT_EQ(old.name, "recording.001");
  EXPECT_EQ(old.folder, folder.path / "recording.001");
  EXPECT_GT(old.time, 1'700'000'000);
  EXPECT_TRUE(old.recording);
  EXPECT_FALSE(old.described());
  EXPECT_TRUE(found.entries[1].described());
}

TEST_F(CaptureListTest, AFolderThatIsNotThereHoldsNothing) {
  const CaptureList found = listCaptures(folder.path / "none", settings);
  EXPECT_TRUE(found.entries.empty() && found.problems.empty());
}

}  // namespace
}  // namespace irad::test::capture_list_suite
