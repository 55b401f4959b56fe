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
  // A color in the picker, which Esc closes: downwards it is darker. A drag there is one step.
  const ScreenPart bright = viewport();
  click("Materials/white wall");
  click("Materials/white wall/base/pick");
  drag("Materials/white wall/base/picker/square", 0, 40);
  hold("Escape");
  EXPECT_TRUE(appears("Materials/white wall/base/picker/square", /*wanted=*/false)) << "Esc does not close it";
  away();
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.levels(bright) > 5; })) << "it edits nothing";
  key("ctrl+z");
  away();
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.levels(bright) < 0.5; })) << "a drag is not one step";
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
  const auto sphere = [this] { return around(-280, 171, 259, 247); };
  const ScreenPart first = viewport(), firstSphere = sphere();
  bool redone = false;
  const auto isUndone = [&](const std::string& material, const char* field, const std::function<void()>& edit) {
    SCOPED_TRACE(material + '/' + field);
    // Roughness shows where the light is mirrored alone: in the sphere.
    const bool mirrored = field == std::string("roughness");
    const auto region = [&] { return mirrored ? sphere() : viewport(); };
    const ScreenPart& before = mirrored ? firstSphere : first;
    const auto shows = [&] {
      away();  // a tooltip may reach over the picture
      return settles(region, [&](const ScreenPart& p) { return p.levels(before) > (mirrored ? 1 : 5); });
    };
    // The light starts from that of the edit, and ends within solver.tolerance: what that leaves is less than a level
    // where the Box is not black.
    const auto undone = [&] {
      key("ctrl+z");
      away();
      return settles(region, [&](const ScreenPart& p) { return p.levels(before) < 0.5; });
    };
    edit();
    EXPECT_TRUE(shows()) << "the edit does not show";
    EXPECT_TRUE(undone()) << "not undone";
    if (!redone) return;
    key("ctrl+shift+z");
    EXPECT_TRUE(shows()) << "not redone";
    EXPECT_TRUE(undone()) << "not undone again";
  };
  const auto number = [&](const std::string& material, const char* field, const char* value, double across) {
    click("Materials/" + material);
    const std::string name = fmt::format("Materials/{}/{}", material, field);
    isUndone(material, field, [&] { enterNumber(name, value, across); });
  };
  number("green wall", "base", "1", /*across=*/0.1);  // of its three channels the first
  number("green wall", "metalness", "1", 0.5);
  click("Materials/floor tiles");
  isUndone("floor tiles", "texture", [&] { click("Materials/floor tiles/texture: base color"); });
  enter("Materials/search", "p");  // all in view
  redone = true;
  number("polished metal", "roughness", "0.6", 0.5);
  number("light panel", "emission", "0", 0.1);
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
