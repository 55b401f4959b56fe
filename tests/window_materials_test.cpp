// Materials in the window: picked in the picture and in the list, edited by their fields, kept in the sidecar, taken
// back.
#include <gtest/gtest.h>

#include "renderer/base/sha256.h"
#include "renderer/scene/material_edits.h"
#include "renderer/scene/sidecar.h"
#include "tests/scene_files.h"
#include "tests/window_fixture.h"

namespace irad::test::window_materials_suite {
namespace {

using WindowMaterialsTest = WindowTest;

TEST_F(WindowMaterialsTest, AreEditedInThePictureAndKept) {
  fold(R"(["Scene", "Lights", "Materials", "Cameras", "Settings", "Effects"])");
  const std::filesystem::path scene = folder_.path / "a.glb", sidecar = sidecarPath(scene);
  std::filesystem::copy_file(assets() / "box.glb", scene);
  const std::string sha = sha256File(scene);
  start({}, scene);
  away();
  ASSERT_TRUE(viewportSettles(lit));
  const double first = viewport().meanLuminance();

  // A click on the red wall, and a button that opens its fields.
  press(at(-490, -49));
  click("Inspector/Material");
  ASSERT_TRUE(appears("Materials/red wall/roughness")) << "the click does not pick the wall";
  EXPECT_TRUE(isOn("Materials/red wall"));
  hold("Escape");  // the inspected facet
  // By its name: search, choose, edit.
  enter("Materials/search", "GREEN");
  EXPECT_TRUE(appears("Materials/red wall", false));
  click("Materials/green wall");
  ASSERT_TRUE(appears("Materials/green wall/strength"));
  away();
  enterNumber("Materials/green wall/strength", "4");
  away();
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.meanLuminance() > 1.2 * first; }))
      << "it does not shine";
  EXPECT_FALSE(std::filesystem::exists(sidecar)) << "saved without being asked";
  const std::vector<Control> all = controls();
  EXPECT_TRUE(std::ranges::any_of(all, [](const Control& c) { return c.name.starts_with("Materials/last edit="); }))
      << "its time is not shown";
  const double shining = viewport().meanLuminance();
  key("ctrl+z");
  away();
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return std::abs(p.meanLuminance() - first) < 0.01 * first; }))
      << "undo does not take it back";
  key("ctrl+shift+z");
  away();
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) {
    return std::abs(p.meanLuminance() - shining) < 0.01 * shining;
  })) << "redo does not bring it back";
  // Facets were shaded anew and the light solved: no ray was traced again.
  click("Timings/One-time");
  EXPECT_TRUE(appears("Timings/GI BuildMatrix=1")) << "the matrix was built again";
  click("Timings/Plot");
  click("Materials/Save");
  ASSERT_TRUE(says("Saved lights, materials, objects, bookmarks and region to " + sidecar.string()));
  const std::vector<MaterialEdit> kept{{.material = "green wall", .emissionStrength = 4.0f}};
  EXPECT_EQ(readSidecar(sidecar).materials, kept);
  EXPECT_FALSE(readSidecar(sidecar).lights);

  // Back to the file's own: the picture, and what is saved, follow.
  click("Materials/green wall/File's own");
  away();
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return std::abs(p.meanLuminance() - first) < 0.01 * first; }))
      << "it still shines";
  key("ctrl+q");
  ASSERT_TRUE(appears("Unsaved changes/Discard")) << "the edit was not saved: it is asked";
  click("Unsaved changes/Discard");
  EXPECT_EQ(window_->wait(20), 0);
  EXPECT_EQ(sha256File(scene), sha) << "the scene's file was written to";

  start({}, scene);
  EXPECT_TRUE(says("materials of a.glb.irad.json"));
  away();
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) {
    return std::abs(p.meanLuminance() - shining) < 0.01 * shining;
  })) << "the sidecar's edit is not shown";
  // Its color in the picker, which Esc closes.
  click("Materials/green wall");
  away();
  const auto column = [this] { return screen_->grab(0, 40, picture().x, 640); };
  const ScreenPart closed = column();
  press(placeOf("Materials/green wall/base", /*across=*/0.96));
  away();
  EXPECT_GT(column().difference(closed), 0.03) << "no color picker";
  hold("Escape");
  EXPECT_EQ(column(), closed) << "Esc does not close it";
  away();
  const ScreenPart near = viewport();
  key("Home");  // farther away than the file's camera
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(near) > 0.05; })) << "Home does nothing";
  quit();
}

TEST_F(WindowMaterialsTest, UndoGivesThePictureBack) {
  fold(R"(["Accuracy", "Scene", "Lights", "Objects", "Cameras", "Settings", "Effects", "Inspector", "Compare",
           "View", "Memory"])");
  start();
  away();
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = viewport();
  const auto isUndone = [&](const std::string& material, const char* field, const std::function<void()>& edit) {
    SCOPED_TRACE(material + '/' + field);
    edit();
    away();  // a tooltip may reach over the picture
    EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.levels(first) > 5; })) << "the edit does not show";
    key("ctrl+z");
    away();
    // The light starts from that of the edit, and ends within solver.tolerance: what that leaves is less than a level
    // where the Box is not black.
    EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.levels(first) < 0.5; })) << "not undone";
  };
  const auto number = [&](const std::string& material, const char* field, double across) {
    click("Materials/" + material);
    const std::string name = fmt::format("Materials/{}/{}", material, field);
    isUndone(material, field, [&] { enterNumber(name, "1", across); });
  };
  number("green wall", "base", /*across=*/0.1);  // of its three channels the first
  number("green wall", "metalness", 0.5);
  click("Materials/floor tiles");
  isUndone("floor tiles", "texture", [&] { click("Materials/floor tiles/texture: base color"); });
  // Solved from the dark, as the first was, it has the same bits.
  click("Solver/H = 0");
  away();
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == first; })) << "something has stayed of the edits";
  quit();  // nothing is unsaved
}

/// Above the material's alpha there is no surface.
TEST_F(WindowMaterialsTest, UndoGivesBackWhatACutoffCutAway) {
  fold(R"(["Accuracy", "Scene", "Lights", "Objects", "Cameras", "Settings", "Effects", "Inspector", "Compare",
           "View", "Solver", "Memory"])");
  GltfFile file = triangleFile();
  file.json["materials"] = {{{"name", "leaf"},
                             {"alphaMode", "MASK"},
                             {"alphaCutoff", 0.25},
                             {"doubleSided", true},
                             {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}, {"metallicFactor", 0}}}}};
  file.primitive()["material"] = 0;
  start({}, file.write(folder_.path, "leaf.gltf"));
  away();
  ASSERT_TRUE(viewportSettles(lit)) << "no triangle is seen";
  const ScreenPart there = viewport();
  click("Materials/leaf");
  enterNumber("Materials/leaf/cutoff", "0.75");
  away();
  // But for the handle of the sun that the scene was given.
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.meanLuminance() < 0.1 * there.meanLuminance(); }))
      << "it is not cut away";
  key("ctrl+z");
  away();
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == there; })) << "not undone";
  quit();
}

}  // namespace
}  // namespace irad::test::window_materials_suite
