// Objects in the window: chosen in the list and in the picture, outlined, hidden, isolated, kept in the sidecar.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "renderer/scene/sidecar.h"
#include "tests/window_fixture.h"

namespace irad::test::window_objects_suite {
namespace {

class WindowObjectsTest : public WindowTest {
 protected:
  // Nodes of box.glb.
  static constexpr const char *kFloor = "Objects/1", *kScreen = "Objects/6", *kSphere = "Objects/30";

  /// A scene of the test's own, whose sidecar may be written.
  std::filesystem::path begin(std::vector<std::string> more = {}) {
    fold(R"(["Accuracy", "Scene", "Lights", "Materials", "Cameras", "History", "Settings", "Effects", "Compare"])");
    const std::filesystem::path scene = folder_.path / "own.glb";
    if (!std::filesystem::exists(scene)) std::filesystem::copy_file(assets() / "box.glb", scene);
    start(more, scene);
    away();
    EXPECT_TRUE(viewportSettles(lit));
    return scene;
  }
  void find(const std::string& name, const char* row) {
    enter("Objects/search", name);
    click(row);
    away();
  }
  /// Around the metal sphere of the Box.
  ScreenPart sphere() { return around(-280, 171, 259, 247); }
  bool sphereIs(const ScreenPart& wanted) {
    away();
    return settles([this] { return sphere(); }, [&](const ScreenPart& p) { return p.difference(wanted) < 0.01; });
  }
  bool sphereIsNot(const ScreenPart& wanted) {
    away();
    return settles([this] { return sphere(); }, [&](const ScreenPart& p) { return p.difference(wanted) > 0.3; });
  }
  std::map<std::string, std::string> capture(int number) {
    key("F12");
    const std::string name = fmt::format("own.{:03}", number);
    EXPECT_TRUE(says(name));
    return contents(folder_.path / "out/captures" / name);
  }
};

/// The pixels around those that the object covers, and no others; in the window alone.
TEST_F(WindowObjectsTest, OutlinesToThePixel) {
  firstSizes_ = true;  // pixels are counted
  begin({"--view", "albedo"});
  const ScreenPart plain = sphere();
  find("metal", kSphere);
  EXPECT_TRUE(appears(kFloor, false)) << "the search leaves others";
  ASSERT_TRUE(settles([this] { return sphere(); }, [&](const ScreenPart& p) { return p.difference(plain) > 0.01; }))
      << "no outline";
  const ScreenPart outlined = sphere();
  // A metal has no diffuse albedo: the sphere is all that is black there, and nothing is before it.
  const auto covered = [&](int x, int y) {
    return plain.at(x, y, 0) == 0 && plain.at(x, y, 1) == 0 && plain.at(x, y, 2) == 0;
  };
  int line = 0, inside = 0;
  constexpr int reach = 3, accent[] = {237, 168, 66};
  for (int y = reach; y < plain.height - reach; ++y)
    for (int x = reach; x < plain.width - reach; ++x) {
      int nearest = 100;
      for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx)
          if (covered(x + dx, y + dy)) nearest = std::min(nearest, dx * dx + dy * dy);
      inside += nearest == 0;
      line += nearest > 0 && nearest <= 4;
      for (int c = 0; c < 3; ++c) {
        const int was = plain.at(x, y, c), is = outlined.at(x, y, c);
        const std::string where = fmt::format("pixel {} {} channel {}, {} from the sphere", x, y, c, nearest);
        if (nearest > 0 && nearest <= 4)
          ASSERT_EQ(is, accent[c]) << where;
        else if (nearest > 0 && nearest <= 9)
          ASSERT_NEAR(is, 0.4 * was, 1.0) << where;
        else
          ASSERT_EQ(is, was) << where;
      }
    }
  EXPECT_GT(inside, 5000);
  EXPECT_GT(line, 400);
  // Esc: nothing is chosen, and nothing is left of it.
  hold("Escape");
  EXPECT_FALSE(isOn(kSphere));
  EXPECT_TRUE(settles([this] { return sphere(); }, [&](const ScreenPart& p) { return p == plain; }));
  const auto before = capture(1);
  click(kSphere);
  const auto after = capture(2);
  EXPECT_TRUE(isOn(kSphere));
  EXPECT_EQ(before.at("albedo.png"), after.at("albedo.png")) << "captures have it";
  EXPECT_EQ(before.at("albedo.exr"), after.at("albedo.exr"));
  quit();
}

/// Of all of the object the outline is drawn; where something is before it, with less of the colour.
TEST_F(WindowObjectsTest, TheOutlineIsFaintBehindOtherThings) {
  firstSizes_ = true;  // pixels are counted
  begin({"--view", "albedo"});
  enter("Objects/search", "pedestal");
  away();
  const ScreenPart plain = viewport();
  click("Objects/28");  // a sphere stands before its lower edge
  away();
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p != plain; })) << "no outline";
  const ScreenPart outlined = viewport();
  int clear = 0, faint = 0, rim = 0, other = 0;
  constexpr int accent[] = {237, 168, 66};
  for (int y = 0; y < plain.height; ++y)
    for (int x = 0; x < plain.width; ++x) {
      const auto is = [&](double opacity, bool black) {
        for (int c = 0; c < 3; ++c)
          if (std::abs(outlined.at(x, y, c) - ((1 - opacity) * plain.at(x, y, c) + (black ? 0 : opacity * accent[c]))) >
              1)
            return false;
        return true;
      };
      if (is(0, false)) continue;
      (is(1, false) ? clear : is(0.3, false) ? faint : is(0.6, true) || is(0.18, true) ? rim : other)++;
    }
  EXPECT_GT(clear, 200);
  EXPECT_GT(faint, 60);
  EXPECT_GT(rim, 100);
  EXPECT_EQ(other, 0);
  quit();
}

TEST_F(WindowObjectsTest, AreFoldedUnderTheirNode) {
  begin();
  ASSERT_TRUE(appears("Objects/7"));
  click("Objects/6/fold");
  EXPECT_TRUE(appears("Objects/7", false)) << "what is under the node is still listed";
  EXPECT_TRUE(has("Objects/6"));
  // One that is chosen in the picture is listed again.
  press(at(-114, 53));
  EXPECT_TRUE(appears("Objects/8"));
  EXPECT_TRUE(isOn("Objects/8"));
  quit();
}

TEST_F(WindowObjectsTest, AreHiddenAsIfTheFileHadThemNotAndKept) {
  const std::filesystem::path scene = begin(), sidecar = sidecarPath(scene);
  const ScreenPart first = sphere();
  // A click in the picture chooses it in the list, too.
  press(at(-147, 319));
  ASSERT_TRUE(appears(kSphere)) << "the list does not follow";
  EXPECT_TRUE(isOn(kSphere));
  hold("Escape");  // the inspected facet
  EXPECT_TRUE(isOn(kSphere));
  away();
  const ScreenPart outlined = sphere();
  hold("h");
  ASSERT_TRUE(sphereIsNot(first)) << "it is not hidden";
  EXPECT_FALSE(isOn(std::string(kSphere) + "/shown"));
  const ScreenPart without = sphere();

  key("ctrl+z");
  EXPECT_TRUE(sphereIs(outlined)) << "not undone";
  EXPECT_TRUE(isOn(std::string(kSphere) + "/shown"));
  key("ctrl+shift+z");
  EXPECT_TRUE(sphereIs(without)) << "not redone";

  // The same bits as by its manifest, and as of a file whose node has no mesh.
  const auto captured = capture(1);
  const std::string manifest = (folder_.path / "out/captures/own.001/manifest.json").string();
  EXPECT_EQ(nlohmann::json::parse(captured.at("manifest.json"))["hidden"], nlohmann::json{"metal sphere"});
  ASSERT_EQ(runIrad({"render", "--config", manifest, "--out", (folder_.path / "again").string()}).status, 0);
  EXPECT_EQ(captured.at("lit.exr"), slurp(folder_.path / "again/lit.exr"));
  std::string bytes = slurp(scene);
  const size_t node = bytes.find("\"metal sphere\""), mesh = bytes.find("\"mesh\":11", node - 200);
  ASSERT_LT(std::max(node, mesh) - std::min(node, mesh), 200u);
  bytes.replace(mesh, 6, "\"mosh\"");
  std::ofstream(folder_.path / "stripped.glb", std::ios::binary) << bytes;
  const RunResult stripped = runIrad({"render", (folder_.path / "stripped.glb").string(), "--config", manifest, "--out",
                                      (folder_.path / "stripped").string()});
  ASSERT_EQ(stripped.status, 0) << stripped.err;
  EXPECT_TRUE(contains(stripped.err, "no node \"metal sphere\" to hide")) << stripped.err;
  EXPECT_EQ(captured.at("lit.exr"), slurp(folder_.path / "stripped/lit.exr"));

  click("Objects/Save");
  ASSERT_TRUE(says("Saved lights, materials, objects, bookmarks and region to " + sidecar.string()));
  EXPECT_EQ(readSidecar(sidecar).hidden, (HiddenNodes{{"metal sphere"}, ""}));
  quit();

  begin();
  EXPECT_TRUE(says("hidden objects of own.glb.irad.json"));
  EXPECT_TRUE(sphereIs(without)) << "the sidecar's are not hidden";
  click("Objects/Show all");
  EXPECT_TRUE(sphereIs(first)) << "nothing is chosen, and all is shown";
  EXPECT_TRUE(control("Objects/Show all").disabled);
  quitDiscarding();
}

/// The old picture stays, and what is hidden.
TEST_F(WindowObjectsTest, HidingIsCancelled) {
  begin({"--set", "voxel.resolution=64", "--set", "matrix.rays=256"});
  const ScreenPart all = part();  // above the messages
  // By its box in the list.
  const std::string box = placeOf(std::string(kFloor) + "/shown");
  const auto corner = [this] { return around(200, -400, 300, 200); };  // above the progress, beside the tooltip
  const ScreenPart before = corner();
  cancel([&] {
    mouse().tap(box);
    ASSERT_TRUE(appears("progress/cancel", true, 90));
    EXPECT_EQ(corner(), before) << "the picture does not stay meanwhile";
  });
  EXPECT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == all; }));
  EXPECT_TRUE(isOn(std::string(kFloor) + "/shown"));
  quit();
}

TEST_F(WindowObjectsTest, AreIsolatedAndFramed) {
  begin();
  const ScreenPart all = viewport();
  // With all under it.
  click(kScreen);
  click("Objects/Isolate");
  away();
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(all) > 0.3; })) << "not isolated";
  EXPECT_TRUE(isOn("Objects/7/shown"));
  EXPECT_FALSE(isOn(std::string(kFloor) + "/shown"));
  EXPECT_TRUE(control(std::string(kFloor) + "/shown").disabled);
  const ScreenPart alone = viewport();
  hold("f");
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(alone) > 0.1; })) << "not framed";
  // Around it; what moves the camera one after the other is one step.
  const ScreenPart framed = viewport();
  act("keydown alt");
  mouse().dragThrough({"600 360", "640 370", "680 380"});
  act("keyup alt");
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(framed) > 0.03; })) << "no orbit";
  key("ctrl+z");
  away();
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(alone) < 0.01; })) << "not undone";
  click("Objects/Hide");
  away();
  // Below the notice that says why it is dark.
  ASSERT_TRUE(settles([this] { return around(-528, 235, 994, 99); },
                      [](const ScreenPart& p) { return p.count(0) == p.width * p.height; }))
      << "something is left";
  key("ctrl+h");
  away();
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(all) < 0.1; })) << "not all is shown";
  hold("Escape");  // its outline; in the middle of the rebuild this would end that
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(all) < 0.01; }));
  quit();
}

}  // namespace
}  // namespace irad::test::window_objects_suite
