// The window itself: keys and mouse, layout, size, scenes opened, what it refuses to show.
#include "tests/scene_files.h"
#include "tests/window_fixture.h"

namespace irad::test::window_suite {
namespace {

TEST_F(WindowTest, ShowsBoxAndAnswersKeysAndMouse) {
  start();
  ASSERT_TRUE(viewportSettles(lit)) << "mean " << viewport().meanLuminance() << ", deviation "
                                    << viewport().deviation();
  const ScreenPart first = viewport();
  EXPECT_LT(first.meanLuminance(), 0.9);
  // The panels hold text: both columns and the strip vary.
  EXPECT_GT(screen_->grab(5, 40, 310, 600).deviation(), 0.03);
  EXPECT_GT(screen_->grab(1010, 40, 260, 600).deviation(), 0.03);
  EXPECT_GT(screen_->grab(340, 540, 400, 100).deviation(), 0.03);

  // What settles() waits for is stated once: an idle window does no work, no picture and no processor time.
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == first; }));
  const double used = window_->cpuSeconds();
  pause(3);
  EXPECT_LE(window_->cpuSeconds() - used, 0.05) << "seconds of processor time in 3 s of idling";

  // Another view and back: another picture, and the very same bits.
  key("2");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(first) > 0.05; }))
      << "key 2 changed nothing";
  key("1");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == first; }))
      << "key 1 did not bring the picture back";

  // W flies forward.
  xdotool("keydown w sleep 0.4 keyup w");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return lit(p) && p.difference(first) > 0.2; }))
      << "W changed nothing";

  // A right drag looks around.
  const ScreenPart nearer = viewport();
  xdotool("mousemove 360 510 sleep 0.4 mousedown 3 sleep 0.4 mousemove 420 515 sleep 0.4 mouseup 3");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(nearer) > 0.2; }))
      << "the drag changed nothing";

  // C returns to a camera of the scene: from the first to the second, and round to the first again.
  key("c");
  key("c");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == first; }))
      << "C twice did not return to the first camera";

  quit();
}

TEST_F(WindowTest, HelpAndHiddenPanelsComeAndGo) {
  start();
  ASSERT_TRUE(viewportSettles(lit));
  xdotool("mousemove 360 510");
  const ScreenPart first = viewport();
  const auto column = [this] { return screen_->grab(5, 40, 310, 600); };
  const ScreenPart panels = column();

  key("F1");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(first) > 0.1; })) << "F1 shows nothing";
  key("F1");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == first; }));

  key("F2");
  ASSERT_TRUE(settles(column, [&](const ScreenPart& p) { return p.difference(panels) > 0.5; })) << "F2 hides nothing";
  key("F2");
  ASSERT_TRUE(settles(column, [&](const ScreenPart& p) { return p.difference(panels) < 0.05; }));

  quit();
}

TEST_F(WindowTest, SaysWhyAPictureIsBlack) {
  start({}, "check:lights-off");
  xdotool("mousemove 360 510");
  const auto middle = [this] { return screen_->grab(530, 205, 270, 150); };
  const auto around = [this] { return screen_->grab(340, 60, 180, 440); };
  const auto text = [](const ScreenPart& p) { return p.deviation() > 0.05; };
  ASSERT_TRUE(settles(middle, text)) << "no word in the middle of the picture";
  EXPECT_EQ(around().meanLuminance(), 0.0) << "a scene without light is not black";
  const ScreenPart words = middle();
  const auto background =
      uint32_t{words.at(10, 10, 0)} << 16 | uint32_t{words.at(10, 10, 1)} << 8 | words.at(10, 10, 2);
  EXPECT_GT(words.count(background), 270 * 150 / 2);

  // The hint is not shown over a picture that is not of light, nor once there is a light.
  key("6");
  ASSERT_TRUE(settles(around, [](const ScreenPart& p) { return p.meanLuminance() > 0.1; })) << "no albedo";
  EXPECT_LT(middle().count(background), 270 * 150 / 10) << "albedo is no light";
  key("1");
  ASSERT_TRUE(settles(middle, text)) << "the words do not come back";
  click("Lights");
  click("Lights/point");
  away();
  ASSERT_TRUE(settles(around, [](const ScreenPart& p) { return p.meanLuminance() > 0.05; })) << "no light is added";
  EXPECT_LT(middle().count(background), 270 * 150 / 10) << "the words stay";
  quitDiscarding();  // the light
}

/// A triangle of rough metal under the default sun: nothing diffuse.
std::filesystem::path metalScene(const std::filesystem::path& folder) {
  GltfFile file = triangleFile();
  file.json["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 1}}}}};
  file.primitive()["material"] = 0;
  return file.write(folder, "metal.gltf");
}

TEST_F(WindowTest, ExposesFilesByThemselvesAndSaysWhyMetalIsBlack) {
  exposesFiles_ = true;
  start({}, metalScene(folder_.path));
  away();  // keys go to the window under the mouse
  EXPECT_TRUE(isOn("View/camera.auto_exposure"));
  // The words in the picture's lower left corner, which go with a view that is not of light.
  const auto corner = [this] { return screen_->grab(350, 440, 200, 60); };
  const auto text = [](const ScreenPart& p) { return p.deviation() > 0.05; };
  EXPECT_TRUE(settles(corner, text)) << "no word in the corner";
  key("6");
  EXPECT_TRUE(settles(corner, [&](const ScreenPart& p) { return !text(p); })) << "the words stay";
  quit();
  start();
  away();
  EXPECT_FALSE(isOn("View/camera.auto_exposure")) << "a built-in scene is made for 0 EV";
  quit();
  start({"--set", "camera.exposure=1"}, metalScene(folder_.path));
  away();
  EXPECT_FALSE(isOn("View/camera.auto_exposure")) << "the user has chosen";
  quit();
}

TEST_F(WindowTest, EffectsAreInViewAndCanBeForced) {
  start();
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = viewport();
  // In the list behind the arrow of emissive facets: "off", and "auto" again.
  ASSERT_TRUE(control("Effects/emission").area.bottom() <= 720) << "the effects are out of view";
  choose("Effects/emission", "off");
  away();
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(first) > 0.1; }))
      << "the lamp still shines";
  choose("Effects/emission", "auto");
  away();
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(first) < 0.01; })) << "not auto again";
  quit();
}

TEST_F(WindowTest, RemembersItsLayoutUntilItIsReset) {
  start();
  ASSERT_TRUE(viewportSettles(lit));
  xdotool("mousemove 360 510");
  const auto left = [this] { return screen_->grab(286, 60, 40, 400); };  // of the left column; then of the viewport
  const auto background = [this] { return screen_->grab(10, 500, 250, 200).deviation() < 0.01; };
  ASSERT_FALSE(background());
  // The edge of the left column, and the headers of the settings and, below it then, of the effects.
  drag("edge-left", -52);
  const auto black = [](const ScreenPart& p) { return p.count(0x000000) > 0.9 * 40 * 400; };
  ASSERT_TRUE(settles(left, black)) << "the edge cannot be dragged";
  click("Settings");
  click("Effects");
  away();
  ASSERT_TRUE(settles(left, [&](const ScreenPart&) { return background(); })) << "the settings and effects do not fold";
  quit();

  start();
  ASSERT_TRUE(settles(left, black)) << "the column's width is forgotten";
  EXPECT_TRUE(background()) << "they are unfolded again";
  choose("Menu/View", "Reset the layout");
  xdotool("mousemove 600 510");
  ASSERT_TRUE(settles(left, [&](const ScreenPart& p) { return !black(p) && !background(); })) << "not reset";
  quit();
}

TEST_F(WindowTest, OpensScenesFromFoldersAndSaysWhyItsLayoutIsLost) {
  std::filesystem::copy(assets() / "box.glb", folder_.path / "a.glb");
  const std::filesystem::path config = screen_->environment().at("XDG_CONFIG_HOME");
  std::filesystem::create_directories(config / "irad");
  std::ofstream(config / "irad/window.json") << "{\"format\": 1, \"left\": \"wide\"}";
  start();
  EXPECT_TRUE(says("left is \"wide\""));
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart before = viewport();
  key("o");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(before) > 0.5; })) << "no dialog";
  enter("Open a scene/path", (folder_.path / "a.glb").string());
  ASSERT_TRUE(viewportSettles([&](const ScreenPart&) {
    return slurp(config / "irad/window.json").find("a.glb") != std::string::npos;
  })) << "the scene is not loaded, or not remembered";
  quit();
}

TEST_F(WindowTest, FollowsItsSize) {
  start();
  ASSERT_TRUE(viewportSettles(lit));
  const auto resize = [&](int width, int height) {
    xdotool(fmt::format("search --onlyvisible --name irad windowsize --sync {} {}", width, height));
  };
  // Beyond the old right edge there is nothing; after growing, the right column is there.
  const auto right = [this] { return screen_->grab(1300, 50, 280, 600); };
  EXPECT_EQ(right().deviation(), 0.0);
  resize(1600, 900);
  ASSERT_TRUE(settles(right, [](const ScreenPart& p) { return p.deviation() > 0.03; })) << "the window did not grow";
  ASSERT_TRUE(viewportSettles(lit));
  // Too small for anything, and back.
  resize(40, 30);
  pause(1);
  ASSERT_TRUE(window_->running());
  resize(1280, 720);
  ASSERT_TRUE(viewportSettles(lit));

  xdotool("mousemove 360 510");
  quit();
}

TEST_F(WindowTest, SurvivesBeingUnmappedAndResizedInAHurry) {
  start();
  ASSERT_TRUE(viewportSettles(lit));
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = viewport();
  xdotool("search --onlyvisible --name irad windowunmap --sync");
  pause(0.5);
  xdotool("search --name irad windowmap --sync");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == first; })) << "not drawn again when mapped";

  // Sizes that come faster than frames.
  std::string sizes;
  for (const char* size : {"900 500", "1500 800", "700 700", "1100 400", "1280 720"})
    sizes += fmt::format(" search --name irad windowsize {} sleep 0.03", size);
  xdotool(sizes);
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == first; })) << "the picture did not come back";
  quit();
}

TEST_F(WindowTest, ScreenshotOfTheWholeWindow) {
  start({"--exit-after", "3", "--screenshot", "window.png"});
  ASSERT_EQ(window_->wait(120), 0);
  // The PNG header's width and height.
  const std::string png = slurp(folder_.path / "window.png");
  ASSERT_GT(png.size(), 10000u);
  const auto word = [&](size_t at) {
    uint32_t value = 0;
    for (size_t b = 0; b < 4; ++b) value = value << 8 | static_cast<uint8_t>(png[at + b]);
    return value;
  };
  EXPECT_EQ(word(16), 1280u);
  EXPECT_EQ(word(20), 720u);
}

TEST_F(WindowTest, RefusesWhatItCannotShow) {
  window_ = std::make_unique<Program>(std::vector<std::string>{iradProgram(), "view", "absent.glb"}, folder_.path,
                                      screen_->environment());
  EXPECT_EQ(window_->wait(60), 3);
  EXPECT_NE(window_->log().find("absent.glb"), std::string::npos);
  start({"--view", "lti"});
  EXPECT_EQ(window_->wait(60), 2);
  EXPECT_NE(window_->log().find("lit"), std::string::npos) << "the near match is named";
  start({"--inspect", "16,16,16"});
  EXPECT_EQ(window_->wait(60), 2);
  EXPECT_NE(window_->log().find("the nearest solid voxel is"), std::string::npos) << window_->log();
}

TEST(Controls, AreFoundByNameOrTheNearOnesAreSaid) {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "controls") << "10 20 30 40 0 0 300 700 1 0\tSettings/voxel.resolution\n"
                                             "10 60 30 40 0 0 300 700 0 1\tSettings/voxel.method\n"
                                             "10 90 30 40 0 0 300 700 0 0\tLights/Save\n"
                                             "10 99 30 40 0 0 300 700 0 0\tLights/Save\n";
  const std::vector<Control> all = readControls(folder.path / "controls");
  ASSERT_EQ(all.size(), 4u);
  const Control resolution = findControl(all, "Settings/voxel.resolution");
  EXPECT_EQ(resolution.area.x, 10);
  EXPECT_EQ(resolution.area.bottom(), 60);
  EXPECT_EQ(resolution.region.height, 700);
  EXPECT_TRUE(resolution.on);
  EXPECT_FALSE(resolution.disabled);
  EXPECT_TRUE(findControl(all, "Settings/voxel.method").disabled);
  const auto refusal = [&](const char* name) {
    try {
      findControl(all, name);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_TRUE(contains(refusal("Settings/voxel.resolutoin"), "near: Settings/voxel.resolution"));
  EXPECT_TRUE(contains(refusal("Settings/q"), "in its place: Settings/voxel.resolution, Settings/voxel.method"));
  EXPECT_TRUE(contains(refusal("Lights/Save"), "two controls are called 'Lights/Save'"));
}

/// A control that is drawn through ui/imgui.h has a name that a test can click.
TEST(WindowCode, DrawsItsControlsThroughTheHeaderThatNamesThem) {
  const std::filesystem::path ui = sourceFolder() / "ui";
  size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(ui)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_regular_file() || name == "imgui.h" || name == "controls.cpp" || name == "imgui_layer.cpp") continue;
    const std::string text = slurp(entry.path());
    EXPECT_FALSE(contains(text, "<imgui.h>")) << entry.path();
    EXPECT_FALSE(contains(text, "::ImGui")) << entry.path();
    ++files;
  }
  EXPECT_GT(files, 50u);
}

}  // namespace
}  // namespace irad::test::window_suite
