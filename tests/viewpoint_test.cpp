// Where the fitted camera stands: in the room that is lit, neither within a wall nor in a sealed passage.
#include "renderer/scene/viewpoint.h"

#include "gi/check/scenes.h"
#include "renderer/scene/scene.h"
#include "tests/support.h"

namespace irad::test::viewpoint_suite {
namespace {

/// A hall of 12 x 6 x 12 at the origin, with a passage 7 wide all around its walls.
SceneBuilder hall() {
  SceneBuilder scene;
  const std::vector<uint32_t> walls(6, scene.material(glm::vec3(0.5f)));
  scene.box(walls, {-6, 0.5f, -6}, {6, 6.5f, 6}, /*inward=*/true);
  scene.box(walls, {-7, 0.1f, -7}, {7, 7, 7}, /*inward=*/false);
  scene.box(walls, {-14, 0, -14}, {14, 7.1f, 14}, /*inward=*/true);
  return scene;
}

std::optional<Viewpoint> standIn(SceneBuilder builder) {
  const Scene scene = builder.finish("hall");
  std::optional<Viewpoint> out = viewpointInside(scene);
  if (out) out->position += scene.origin;
  return out;
}
double outOfTheMiddle(const Viewpoint& v) {
  return std::max(std::abs(v.position.x), std::abs(v.position.z));
}

TEST(Viewpoint, IsWhereTheLightIs) {
  SceneBuilder lamp = hall();
  lamp.point({0, 4, 0}, 10);
  const auto inside = standIn(std::move(lamp));
  ASSERT_TRUE(inside);
  EXPECT_LT(outOfTheMiddle(*inside), 6) << "in the hall with the lamp";

  SceneBuilder other = hall();
  other.point({10, 4, 0}, 10);
  const auto around = standIn(std::move(other));
  ASSERT_TRUE(around);
  EXPECT_GT(outOfTheMiddle(*around), 7) << "in the passage with the lamp";

  SceneBuilder glowing = hall();
  const uint32_t panel = glowing.material(glm::vec3(0.5f), glm::vec3(1));
  glowing.box(std::vector<uint32_t>(6, panel), {-1, 5, -1}, {1, 5.5f, 1}, /*inward=*/false);
  const auto under = standIn(std::move(glowing));
  ASSERT_TRUE(under);
  EXPECT_LT(outOfTheMiddle(*under), 6) << "in the hall with the panel that glows";
}

// Six cells around a block of 14 x 7 x 14, which is the largest space, and seen from within all backs.
TEST(Viewpoint, IsNotWithinAWall) {
  SceneBuilder cells;
  const std::vector<uint32_t> walls(6, cells.material(glm::vec3(0.5f)));
  const auto cell = [&](glm::vec3 lo, glm::vec3 hi) { cells.box(walls, lo, hi, /*inward=*/true); };
  cell({-12, 0, -7}, {-7, 7, 7}), cell({7, 0, -7}, {12, 7, 7});
  cell({-7, 0, -12}, {7, 7, -7}), cell({-7, 0, 7}, {7, 7, 12});
  cell({-7, -4, -7}, {7, 0, 7}), cell({-7, 7, -7}, {7, 11, 7});
  const auto stand = standIn(std::move(cells));
  ASSERT_TRUE(stand);
  const double y = stand->position.y;
  EXPECT_TRUE(outOfTheMiddle(*stand) > 7 || y < 0 || y > 7) << outOfTheMiddle(*stand) << ", at a height of " << y;
}

}  // namespace
}  // namespace irad::test::viewpoint_suite
