// The part of the scene that has voxels, as a box in the picture.
#include "tests/window_fixture.h"

namespace irad::test::window_region_suite {
namespace {

class WindowRegionTest : public WindowTest {
 protected:
  /// What the panel Scene says of `name`.
  std::string row(const std::string& name) {
    for (const Control& c : controls())
      if (c.name.starts_with("Scene/" + name + "=")) return c.name.substr(c.name.find('=') + 1);
    return {};
  }
};

TEST_F(WindowRegionTest, ABoxIsDraggedByItsFaces) {
  fold(R"(["Accuracy", "Effects", "Lights", "Materials", "Inspector", "Compare", "Solver", "Memory", "Timings"])");
  start({"--set", "voxel.resolution=16", "--set", "matrix.rays=16"});
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

}  // namespace
}  // namespace irad::test::window_region_suite
