// The part of the scene that has voxels, as a box in the picture.
#include <nlohmann/json.hpp>

#include "gi/check/scenes.h"
#include "renderer/scene/sidecar.h"
#include "tests/window_fixture.h"

namespace irad::test::window_region_suite {
namespace {

class WindowRegionTest : public WindowTest {
 protected:
  WindowRegionTest() { windowSize_ = kLow; }
  /// What the panel Scene says of `name`.
  std::string row(const std::string& name) {
    for (const Control& c : controls())
      if (c.name.starts_with("Scene/" + name + "=")) return c.name.substr(c.name.find('=') + 1);
    return {};
  }
};

TEST_F(WindowRegionTest, ABoxIsDraggedByItsFaces) {
  fold(R"(["Accuracy", "Effects", "Lights", "Materials", "Inspector", "Compare", "Solver", "Memory", "Timings"])");
  start();
  away();
  ASSERT_TRUE(viewportSettles(lit));
  EXPECT_EQ(row("region"), "whole");
  EXPECT_FALSE(has("region/largest x")) << "a box that nobody wants";
  click("Scene/region");
  ASSERT_TRUE(appears("region/largest x"));
  EXPECT_EQ(row("region"), "whole") << "it begins as all of the scene";

  // The right wall, a third of the room to the left; the mouse's way down moves nothing.
  const Control before = control("region/largest x");
  drag("region/largest x", -picture().height / 4, 20);
  EXPECT_TRUE(says("voxels are made of")) << window_->log();
  away();
  const Control after = control("region/largest x");
  EXPECT_LT(after.area.x, before.area.x - 50);
  EXPECT_LE(std::abs(after.area.y - before.area.y), 4) << "Box's camera looks along z, with y up";
  EXPECT_NE(row("region"), "whole");
  // Voxels are as much smaller as what is left is; one step takes it back.
  key("ctrl+z");
  rests();
  EXPECT_EQ(row("region"), "whole");
  EXPECT_EQ(control("region/largest x").area.x, before.area.x);
  key("ctrl+z");
  rests();
  EXPECT_FALSE(has("region/largest x"));
  quit();
}

/// Small things in a room that reflects: auto would take them alone where it did not.
TEST_F(WindowRegionTest, WhyTheWholeIsKeptIsSaid) {
  const std::filesystem::path scene = folder_.path / "ship.irscene";
  SceneBuilder b;
  const uint32_t dome = b.material(glm::vec3(0.5f), glm::vec3(1)), ship = b.material(glm::vec3(0.5f));
  b.sphere(dome, glm::vec3(0), 100, /*inward=*/true, 16);
  b.sphere(ship, glm::vec3(0), 1, /*inward=*/false, 16);
  writeSceneCache(b.finish("ship"), scene);
  start({}, scene);
  EXPECT_TRUE(says("scene.region: whole, since 50 % of the light outside of")) << window_->log();
  quit();
}

/// It belongs to the scene: its sidecar keeps it, a capture's manifest says it as a setting, and the same bits come of
/// it.
TEST_F(WindowRegionTest, TheBoxIsSavedAndComesBack) {
  fold(R"(["Accuracy", "Effects", "Lights", "Materials", "Inspector", "Compare", "Solver", "Memory", "Timings"])");
  const std::filesystem::path scene = folder_.path / "own.glb", sidecar = sidecarPath(scene);
  std::filesystem::copy_file(assets() / "box.glb", scene);
  const auto begin = [&] {
    start({}, scene);
    away();
    ASSERT_TRUE(viewportSettles(lit));
  };
  begin();
  click("Scene/region");
  ASSERT_TRUE(appears("region/largest x"));
  drag("region/largest x", -picture().height / 4, 20);
  EXPECT_TRUE(says("voxels are made of")) << window_->log();
  away();
  const std::string part = row("region");
  EXPECT_NE(part, "whole");
  click("Objects/Save");
  ASSERT_TRUE(says("to " + sidecar.string()));
  const std::optional<RegionBox> kept = readSidecar(sidecar).region;
  ASSERT_TRUE(kept);
  EXPECT_LT(kept->largest.x, 5);
  quit();

  begin();
  EXPECT_TRUE(says("region of own.glb.irad.json"));
  EXPECT_EQ(row("region"), part);
  EXPECT_TRUE(has("region/largest x"));
  quit();
  // A run without the window takes it, too, and its manifest repeats it without the sidecar.
  const std::string first = (folder_.path / "first").string(), again = (folder_.path / "again").string();
  ASSERT_EQ(runIrad({"render", scene.string(), "--set", "voxel.resolution=16", "--set", "matrix.rays=16", "--set",
                     "light.shadow_resolution=64", "--size", "32x24", "--out", first})
                .status,
            0);
  const std::string manifest = first + "/manifest.json";
  EXPECT_EQ(nlohmann::json::parse(slurp(manifest))["settings"]["scene.region"], "box");
  std::filesystem::remove(sidecar);
  ASSERT_EQ(runIrad({"render", "--config", manifest, "--out", again}).status, 0);
  EXPECT_EQ(slurp(first + "/lit.exr"), slurp(again + "/lit.exr"));
}

}  // namespace
}  // namespace irad::test::window_region_suite
