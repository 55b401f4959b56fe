// Lights in the window: their axes in the picture, snapping, on and off, units, temperatures.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "renderer/scene/first_surface.h"
#include "renderer/scene/light_json.h"
#include "tests/window_fixture.h"

namespace irad::test::window_lamps_suite {
namespace {

class WindowLampsTest : public WindowTest {
 protected:
  WindowLampsTest() { windowSize_ = kLow; }
  void begin() {
    fold(
        R"(["Accuracy", "Settings", "Scene", "Effects", "View", "Materials", "Inspector", "Compare", "Solver", "Memory",
         "Timings", "History", "Cameras"])");
    start();
    away();
    ASSERT_TRUE(viewportSettles(lit));
  }
  /// Where the middle of what is drawn is.
  glm::ivec2 at(const std::string& name) {
    const Control c = control(name);
    return {c.area.x + c.area.width / 2, c.area.y + c.area.height / 2};
  }
  bool differs(const ScreenPart& from) {
    away();
    return viewportSettles([&](const ScreenPart& p) { return p.levels(from) > 1; });
  }
  /// As it was, up to what is left of a solve that began from other light, which is less than a grey level.
  bool shows(const ScreenPart& wanted) {
    away();
    return viewportSettles([&](const ScreenPart& p) { return p.levels(wanted) < 1; });
  }
  void strike(const std::string& keys) {
    key(keys);
    rests();
  }
  /// Drags in steps, as a hand does.
  void pull(const std::string& name, glm::ivec2 by, const std::string& with = "") {
    const glm::ivec2 from = at(name), half = from + by / 2, to = from + by;
    const auto place = [](const glm::ivec2& p) { return fmt::format("{} {}", p.x, p.y); };
    if (!with.empty()) act("keydown " + with);
    mouse().dragThrough({place(from), place(half), place(to)});
    if (!with.empty()) act("keyup " + with);
    rests();
  }
};

TEST_F(WindowLampsTest, AxesMoveALightAlongThemselvesAndInTheirPlanes) {
  begin();
  const ScreenPart first = viewport();
  click("Lights/point");
  ASSERT_TRUE(differs(first)) << "no light is added";
  EXPECT_TRUE(appears("picture/x"));
  EXPECT_TRUE(has("picture/y"));
  // It begins where the camera looks, in the middle of the picture.
  const glm::ivec2 middle = at("picture/light");
  const Control::Area p = picture();
  EXPECT_LE(std::abs(middle.x - (p.x + p.width / 2)), 2);
  EXPECT_LE(std::abs(middle.y - (p.y + p.height / 2)), 2);

  // Along x: to the right, and the mouse's way up moves nothing.
  pull("picture/x", {60, -40});
  const glm::ivec2 right = at("picture/light");
  EXPECT_GT(right.x, middle.x + 30);
  EXPECT_LE(std::abs(right.y - middle.y), 3) << "Box's camera looks along z, with y up";
  // Along y: up.
  pull("picture/y", {30, -50});
  const glm::ivec2 up = at("picture/light");
  EXPECT_LT(up.y, right.y - 25);
  EXPECT_LE(std::abs(up.x - right.x), 3);
  // In the plane of both: with the mouse.
  pull("picture/xy", {-60, 40});
  const glm::ivec2 both = at("picture/light");
  EXPECT_NEAR(both.x, up.x - 60, 3);
  EXPECT_NEAR(both.y, up.y + 40, 3);

  // Onto the surface under the mouse, with Ctrl: a voxel before it. A step like every drag.
  away();  // no tooltip in what is compared
  const ScreenPart before = viewport();
  const glm::ivec2 from = at("picture/light"), on = from + glm::ivec2(0, 150);
  pull("picture/light", on - from, "ctrl");
  ASSERT_TRUE(differs(before));
  int captures = 0;
  const auto capture = [&] {
    ++captures;
    key("F12");
    EXPECT_TRUE(says(fmt::format("box.{:03}", captures)));
    return contents(folder_.path / fmt::format("out/captures/box.{:03}", captures));
  };
  const auto lights = nlohmann::json::parse(capture().at("manifest.json")).at("lights");
  const Light put = lightsFromJson(lights.dump()).at(1);
  const Scene box = loadScene(assets() / "box.glb");
  const Camera& camera = box.cameras.at(0);
  const double focal = 0.5 * p.height / std::tan(camera.yfov / 2);
  const glm::dvec3 direction = glm::dquat(camera.orientation) * glm::dvec3(on.x + 0.5 - p.x - 0.5 * p.width,
                                                                           0.5 * p.height - (on.y + 0.5 - p.y), -focal);
  const auto surface = firstSurface(box, camera.position, direction);
  ASSERT_TRUE(surface);
  const double inFront = glm::dot(put.position - surface->position, surface->normal);
  EXPECT_NEAR(glm::distance(put.position, surface->position), inFront, 0.05) << "beside what is under the mouse";
  EXPECT_NEAR(inFront, 0.666, 0.01) << "the edge of a voxel";
  strike("ctrl+z");
  EXPECT_TRUE(shows(before)) << "a drag is one step";

  // Captures have no handles; the window has none where they are turned off.
  const std::string with = capture().at("lit.png");
  click("Lights/handles in the picture");
  EXPECT_TRUE(appears("picture/x", /*wanted=*/false));
  EXPECT_EQ(capture().at("lit.png"), with);
  quitDiscarding();
}

TEST_F(WindowLampsTest, ALightIsTurnedOffAndOn) {
  begin();
  click("Lights/0");
  away();
  const ScreenPart on = viewport();
  click("Lights/0/on");
  EXPECT_FALSE(isOn("Lights/0/on"));
  ASSERT_TRUE(differs(on)) << "it still shines";
  strike("ctrl+z");
  EXPECT_TRUE(isOn("Lights/0/on"));
  EXPECT_TRUE(shows(on)) << "undone, the picture is another";
  strike("ctrl+shift+z");
  EXPECT_TRUE(differs(on));
  click("Lights/0/on");
  EXPECT_TRUE(shows(on)) << "on again, the picture is another";
  // The lamp before its name in the list does the same.
  for (const bool shines : {false, true}) {
    press(placeOf("Lights/0", /*across=*/0.02));
    EXPECT_EQ(isOn("Lights/0/on"), shines);
  }
  quit();
}

TEST_F(WindowLampsTest, UnitsChangeNoLightAndTemperaturesColorIt) {
  begin();
  const ScreenPart first = viewport();
  click("Lights/point");
  ASSERT_TRUE(differs(first));
  const ScreenPart candela = viewport();
  // The rule of each unit is said.
  EXPECT_TRUE(contains(helpOf("Lights/1/intensity"), "1 cd = 1 W/sr")) << helpOf("Lights/1/intensity");
  choose("Lights/1/unit", "lx");
  EXPECT_TRUE(contains(helpOf("Lights/1/intensity"), "1 lx = 1 W/m\u00B2")) << helpOf("Lights/1/intensity");
  choose("Lights/1/unit", "W");
  EXPECT_TRUE(contains(helpOf("Lights/1/intensity"), "4\u03C0 sr of a point")) << helpOf("Lights/1/intensity");
  EXPECT_TRUE(shows(candela)) << "the unit shown is no edit";
  enterNumber("Lights/1/intensity", "100");
  EXPECT_TRUE(differs(candela));
  const ScreenPart white = viewport();
  enterNumber("Lights/1/temperature", "2000");
  EXPECT_TRUE(differs(white)) << "no other colour";
  strike("ctrl+z");
  EXPECT_TRUE(shows(white));
  // Its colour in the picker: full, of a hue.
  click("Lights/1/color/pick");
  drag("Lights/1/color/picker/square", 80, 0);
  click("Lights/1/color/picker/hue");
  hold("Escape");
  EXPECT_TRUE(differs(white)) << "the picker edits nothing";
  strike("ctrl+z");
  strike("ctrl+z");
  EXPECT_TRUE(shows(white));
  quitDiscarding();
}

}  // namespace
}  // namespace irad::test::window_lamps_suite
