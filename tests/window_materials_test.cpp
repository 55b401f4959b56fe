// Materials in the window: picked in the picture and in the list, edited by their fields, kept in the sidecar, taken
// back.
#include <gtest/gtest.h>

#include "renderer/base/sha256.h"
#include "renderer/scene/material_edits.h"
#include "renderer/scene/sidecar.h"
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

}  // namespace
}  // namespace irad::test::window_materials_suite
