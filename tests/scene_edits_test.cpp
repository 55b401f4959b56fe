// What the window's user makes of a scene: lights, materials, objects, bookmarks and region, their names, what is
// unsaved, where it is kept.
#include <fmt/format.h>
#include <gtest/gtest.h>

#if IRAD_UI

#include "renderer/base/error.h"
#include "tests/scene_files.h"
#include "ui/scene_edits.h"

namespace irad::test::scene_edits_suite {
namespace {

struct SceneEditsTest : ::testing::Test {
  TemporaryFolder folder;
  std::filesystem::path path = triangleFile().write(folder.path), file = sidecarPath(path);
  Scene scene = loadScene(path);
  SceneEdits edits;
  void SetUp() override { edits.begin(scene, file, ""); }
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const Light& light : edits.lights) out.push_back(light.name);
    return out;
  }
  using Names = std::vector<std::string>;
};

TEST_F(SceneEditsTest, AddsUnderFreeNamesAndRemoves) {
  EXPECT_EQ(names(), (Names{"default sun"}));
  EXPECT_EQ(edits.light(), nullptr);
  EXPECT_FALSE(edits.modified());
  const Light lamp{.name = "lamp", .type = LightType::Point, .position = {1, 2, 3}};
  for (int i = 0; i < 3; ++i) edits.add(lamp);
  EXPECT_EQ(names(), (Names{"default sun", "lamp", "lamp 2", "lamp 3"}));
  EXPECT_EQ(edits.selected, 3);
  EXPECT_TRUE(edits.modified());

  edits.selected = 1;
  edits.remove();
  EXPECT_EQ(edits.light()->name, "lamp 2");
  edits.remove();
  EXPECT_EQ(names(), (Names{"default sun", "lamp 3"}));
  // What undo does: the light that comes back is chosen.
  const Sidecar before = edits.content();
  edits.selected = 0;
  edits.remove();
  edits.restore(before);
  EXPECT_EQ(names(), (Names{"default sun", "lamp 3"}));
  EXPECT_EQ(edits.selected, 0);
  EXPECT_EQ(edits.content(), before);
  edits.add(lamp);
  edits.restore(before);
  EXPECT_EQ(names(), (Names{"default sun", "lamp 3"}));
  EXPECT_EQ(edits.selected, 1) << "of those that are left";
  for (int i = 0; i < 5; ++i) edits.selected = 0, edits.remove();
  EXPECT_TRUE(edits.lights.empty());
  EXPECT_EQ(edits.light(), nullptr);
}

TEST_F(SceneEditsTest, SavesWhatDiffersFromTheSceneAndReverts) {
  const size_t door = edits.addBookmark(scene.cameras[0], "door");
  EXPECT_EQ(edits.addBookmark(scene.cameras[0], "door"), door + 1);
  EXPECT_EQ(edits.bookmarks[1].name, "door 2");
  edits.addBookmark(scene.cameras[0], scene.cameras[0].name);
  EXPECT_EQ(edits.bookmarks[2].name, scene.cameras[0].name + " 2") << "a camera of the scene has that name";
  edits.rename(1, "door");
  edits.rename(1, "");
  EXPECT_EQ(edits.bookmarks[1].name, "door 2") << "taken, or empty";
  edits.rename(1, "window");
  EXPECT_TRUE(edits.modified());
  edits.save();
  EXPECT_FALSE(edits.modified());
  EXPECT_TRUE(edits.kept());
  EXPECT_FALSE(readSidecar(file).lights) << "lights that are the file's own may change there";
  EXPECT_EQ(readSidecar(file).bookmarks, edits.bookmarks);
  EXPECT_EQ(readSidecar(file).sceneSha256, scene.sha256);

  edits.lights[0].intensity = 7;
  edits.bookmarks.clear();
  edits.save();
  ASSERT_TRUE(readSidecar(file).lights);
  EXPECT_EQ((*readSidecar(file).lights)[0].intensity, 7);
  EXPECT_TRUE(readSidecar(file).bookmarks.empty());
  edits.lights.clear();
  edits.revert();
  EXPECT_EQ(edits.lights.at(0).intensity, 7);
  EXPECT_FALSE(edits.modified());
  // From what was saved to the file's own lights, and no further.
  EXPECT_TRUE(edits.canRevert());
  edits.revert();
  EXPECT_EQ(edits.lights, scene.lights);
  EXPECT_TRUE(edits.modified()) << "the sidecar has others";
  edits.save();
  EXPECT_FALSE(readSidecar(file).lights);
  EXPECT_FALSE(edits.canRevert());
  edits.lights[0].intensity = 7;
  edits.save();

  // Loaded again, edits stay.
  edits.lights[0].intensity = 8;
  edits.again(scene);
  EXPECT_EQ(edits.lights[0].intensity, 8);
  EXPECT_TRUE(edits.modified());
}

TEST_F(SceneEditsTest, KeepsMaterialsByNameUntilTheyAreTheFilesOwn) {
  const MaterialEdit wall{.material = "wall", .roughness = 0.25f}, door{.material = "door", .emissionStrength = 2.0f};
  EXPECT_EQ(edits.material("wall"), MaterialEdit{.material = "wall"});
  edits.setMaterial(wall);
  edits.setMaterial(door);
  EXPECT_EQ(edits.materials, (std::vector<MaterialEdit>{door, wall})) << "sorted: the same whatever came first";
  EXPECT_EQ(edits.material("wall"), wall);
  EXPECT_TRUE(edits.modified());
  edits.save();
  EXPECT_FALSE(edits.modified());
  EXPECT_TRUE(edits.kept());
  EXPECT_EQ(readSidecar(file).materials, edits.materials);
  EXPECT_FALSE(readSidecar(file).lights);

  edits.setMaterial({.material = "wall", .roughness = 0.75f});
  EXPECT_EQ(edits.materials.size(), 2u);
  edits.setMaterial({.material = "door"});
  EXPECT_EQ(edits.materials, (std::vector<MaterialEdit>{{.material = "wall", .roughness = 0.75f}}));
  edits.setMaterial({.material = "never edited"});
  EXPECT_EQ(edits.materials.size(), 1u);
  EXPECT_TRUE(edits.modified());
  edits.revert();
  EXPECT_EQ(edits.materials, (std::vector<MaterialEdit>{door, wall}));
  edits.take(Sidecar());
  EXPECT_TRUE(edits.materials.empty());
  EXPECT_TRUE(edits.modified());
}

TEST_F(SceneEditsTest, HidesAndIsolatesNodes) {
  std::vector<SceneNode> nodes(4);
  for (uint32_t i = 0; i < 4; ++i) nodes[i].name = std::string(1, static_cast<char>('a' + i));
  nodes[1].parent = nodes[3].parent = 0;
  nodes[2].parent = 1;
  edits.hide(nodes, 3, true);
  edits.hide(nodes, 1, true);
  edits.hide(nodes, 1, true);
  EXPECT_EQ(edits.hidden, (HiddenNodes{{"a/b", "a/d"}, ""})) << "sorted, each once";
  EXPECT_TRUE(edits.modified());
  const Sidecar before = edits.content();
  // What is isolated is shown, with what it is under.
  edits.isolate(nodes, 2);
  EXPECT_EQ(edits.hidden, (HiddenNodes{{"a/d"}, "a/b/c"}));
  edits.save();
  EXPECT_TRUE(edits.kept());
  EXPECT_FALSE(edits.modified());
  EXPECT_EQ(readSidecar(file).hidden, edits.hidden);
  edits.restore(before);
  EXPECT_EQ(edits.hidden, before.hidden);
  edits.hide(nodes, 3, false);
  EXPECT_EQ(edits.hidden, (HiddenNodes{{"a/b"}, ""}));
  edits.revert();
  EXPECT_EQ(edits.hidden.isolated, "a/b/c");
  edits.showAll();
  EXPECT_TRUE(edits.hidden.empty());
  EXPECT_TRUE(edits.modified());
}

TEST_F(SceneEditsTest, TheRegionIsSavedAndComesBack) {
  EXPECT_FALSE(edits.region);
  const RegionBox box{{-0.1f, 0, 1e-3f}, {0.3f, 2, 1234.5f}};
  edits.region = box;
  EXPECT_TRUE(edits.modified());
  edits.save();
  EXPECT_TRUE(edits.kept());
  EXPECT_FALSE(edits.modified());
  EXPECT_EQ(readSidecar(file).region, box) << "to the last bit";
  const Scene again = loadScene(path, {.sidecar = true});
  EXPECT_EQ(again.region, box);
  EXPECT_NE(sidecarNote(again).find("region"), std::string::npos) << sidecarNote(again);
  EXPECT_FALSE(loadScene(path).region);
  edits.begin(again, file, "");
  EXPECT_EQ(edits.region, box);
  edits.region.reset();
  EXPECT_TRUE(edits.modified());
  edits.revert();
  EXPECT_EQ(edits.region, box);
  // What is wrong with a box is an error that names it.
  for (const char* bad :
       {R"([0, 0, 0, 1, 1, 1])", R"({"least": [0, 0, 0]})", R"({"least": [0, 0], "largest": [1, 1, 1]})",
        R"({"least": [0, 0, 0], "largest": [1, 0, 1]})", R"({"least": [0, 0, 0], "largest": [1, "a", 1]})"})
    try {
      (void)sidecarFromJson(fmt::format(R"({{"format": 1, "cameras": [], "region": {}}})", bad), "X");
      ADD_FAILURE() << bad;
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find("X: region"), std::string::npos) << error.what();
    }
}

TEST_F(SceneEditsTest, AreSavedElsewhereAndTakenFromThere) {
  edits.begin(scene, "", "nowhere");
  edits.add({.name = "lamp", .type = LightType::Point, .position = {1, 2, 3}});
  edits.addBookmark(scene.cameras[0], "door");
  EXPECT_THROW(edits.save(), WorkError);
  const std::filesystem::path elsewhere = folder.path / "not/yet/there" / (std::string("lamps") + kSidecarExtension);
  edits.saveAs(elsewhere);
  EXPECT_FALSE(edits.modified());
  EXPECT_EQ(edits.file(), elsewhere) << "save() writes there from then on";
  const SceneEdits before = edits;
  edits.begin(scene, "", "nowhere");
  edits.take(readSidecar(elsewhere));
  EXPECT_EQ(edits.lights, before.lights);
  EXPECT_EQ(edits.bookmarks, before.bookmarks);
  EXPECT_TRUE(edits.modified()) << "it is nobody's file here";
  edits.take(Sidecar());
  EXPECT_EQ(names(), (Names{"default sun"})) << "no lights in the sidecar: the scene's own";
  EXPECT_FALSE(edits.modified());
}

TEST_F(SceneEditsTest, WhatCannotBeSavedStays) {
  edits.lights[0].intensity = 7;
  std::filesystem::create_directory(file);  // a file cannot take its place
  try {
    edits.save();
    ADD_FAILURE() << "saved over a folder";
  } catch (const WorkError& error) {
    EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos) << error.what();
  }
  EXPECT_TRUE(edits.modified());
  EXPECT_EQ(edits.lights[0].intensity, 7);
  edits.begin(scene, {}, "nowhere");
  EXPECT_THROW(edits.save(), WorkError);
}

}  // namespace
}  // namespace irad::test::scene_edits_suite

#else

TEST(SceneEdits, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_UI";
}

#endif
