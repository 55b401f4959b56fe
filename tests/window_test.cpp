// The window itself: keys and mouse, layout, size, scenes opened, what it refuses to show.
#include "tests/scene_files.h"
#include "tests/window_fixture.h"

namespace irad::test::window_suite {
namespace {

TEST_F(WindowTest, ShowsBoxAndAnswersKeysAndMouse) {
  startsProgram_ = true;
  start();
  ASSERT_TRUE(viewportSettles(lit)) << "mean " << viewport().meanLuminance() << ", deviation "
                                    << viewport().deviation();
  const ScreenPart first = viewport();
  EXPECT_LT(first.meanLuminance(), 0.9);
  // What users need first is in view.
  for (const char* name : {"Settings/voxel", "Effects/emission", "Lights", "View/view", "Timings"}) {
    const Control c = control(name);
    EXPECT_LE(c.area.bottom(), c.region.bottom()) << name;
  }
  // The left column has room for all of its panels, the settings and the effects unfolded; what is off is one line.
  const Control lastPanel = control("History");
  EXPECT_LE(lastPanel.area.bottom(), lastPanel.region.bottom()) << "the left column scrolls";
  EXPECT_FALSE(has("Effects/sun"));
  // The panels hold text: both columns and the strip vary.
  const Control::Area p = picture();
  EXPECT_GT(screen_->grab(5, 40, p.x - 20, 600).deviation(), 0.03);
  EXPECT_GT(screen_->grab(p.right() + 10, 40, 1280 - p.right() - 20, 600).deviation(), 0.03);
  EXPECT_GT(screen_->grab(p.x + 8, p.bottom() + 4, 400, 20).deviation(), 0.03);
  EXPECT_GE(p.width * p.height, 1280 * 720 / 2) << "the picture's share of the window at first";

  // What settles() waits for is stated once: an idle window does no work, no picture and no processor time.
  goAside();
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
  act("keydown w sleep 0.4 keyup w");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return lit(p) && p.difference(first) > 0.2; }))
      << "W changed nothing";

  // A right drag looks around.
  const ScreenPart nearer = viewport();
  mouse().dragThrough({aside(), fmt::format("{} {}", p.x + 88, p.bottom() - 17)}, /*button=*/3);
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
  goAside();
  const ScreenPart first = viewport();
  const auto column = [this, wide = picture().x - 20] { return screen_->grab(5, 40, wide, 600); };
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

TEST_F(WindowTest, PanelsFoldToTheEdgeAndThePictureFillsTheWindow) {
  start();
  away();
  const Control::Area first = picture();
  EXPECT_GE(first.width * first.height, 1280 * 720 / 2) << "the picture has less than half of the window at first";
  EXPECT_LE(control("History").area.bottom(), 720) << "with settings and effects open the column has to be scrolled";
  EXPECT_FALSE(has("frame time"));
  key("Tab");
  rests();
  EXPECT_EQ(picture().width, 1280) << "Tab does not fill the window";
  EXPECT_TRUE(has("Menu/File"));
  EXPECT_TRUE(has("frame time"));
  EXPECT_FALSE(has("Settings"));
  key("F2");
  rests();
  EXPECT_EQ(picture().height, 720);
  EXPECT_FALSE(has("Menu/File"));
  EXPECT_TRUE(has("frame time")) << "it is not told what a picture takes";
  key("F2");
  key("Tab");
  rests();
  EXPECT_EQ(picture().width, first.width);

  // Each column by its handle, the strip by its header; what is folded is remembered.
  click("fold-left");
  EXPECT_FALSE(has("Settings"));
  EXPECT_EQ(picture().x, 0);
  click("fold-right");
  EXPECT_EQ(picture().width, 1280);
  click("Timings");
  EXPECT_LT(picture().height, first.height - 100);
  EXPECT_TRUE(has("Timings/record"));
  quit();
  start();
  away();
  EXPECT_EQ(picture().width, 1280) << "forgotten";
  // The menu brings them back: the strip is among the panels.
  for (const char* part : {"Left column", "Right column", "Timings"}) {
    click("Menu/View");
    click("Menu/View/Panels");
    click(std::string("Menu/View/Panels/") + part);
  }
  away();
  EXPECT_EQ(picture().width, first.width);
  EXPECT_EQ(picture().height, first.height);
  quit();
}

TEST_F(WindowTest, NotesEndByThemselvesAndErrorsAreCleared) {
  start({"--shaders", copyShaders({"gi/gather.comp"}).string()});
  away();
  ASSERT_TRUE(viewportSettles(lit));
  key("F5");
  ASSERT_TRUE(appears("messages/0/dismiss")) << "nothing is said";
  EXPECT_TRUE(appears("messages/0/dismiss", false, 30)) << "the note stays";
  for (const char* name : {"a.glb", "b.glb"}) ASSERT_TRUE(drop({folder_.path / name}));
  ASSERT_TRUE(drop({folder_.path / "c.glb"}));
  ASSERT_TRUE(appears("messages/1/dismiss")) << "errors";
  pause(12);
  EXPECT_TRUE(has("messages/1/dismiss")) << "errors do not stay";
  click("messages/Clear all");
  EXPECT_TRUE(appears("messages/0/dismiss", false)) << "not cleared";
  quit();
}

TEST_F(WindowTest, TextIsScaledWhileItRuns) {
  start();
  away();
  const int before = control("View").area.height;
  key("ctrl+plus");
  key("ctrl+plus");
  rests();
  EXPECT_NEAR(control("View").area.height, 1.5 * before, 2);
  // What is higher than the window now is in it, and scrolls.
  key("F1");
  EXPECT_LE(control("help/end").region.bottom(), 720);
  EXPECT_GT(control("help/end").area.bottom(), 720) << "nothing has to scroll";
  shown("help/end");
  quit();
  start();
  away();
  EXPECT_NEAR(control("View").area.height, 1.5 * before, 2) << "forgotten";
  choose("Menu/View", "Reset the layout");
  away();
  EXPECT_EQ(control("View").area.height, before);
  quit();
}

TEST_F(WindowTest, SettingsSayWhatTheyCostAndWaitForApply) {
  start();
  away();
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart before = viewport();
  EXPECT_FALSE(isOn("Settings/cost"));
  click("Settings/apply by hand");
  EXPECT_TRUE(control("Settings/Apply").disabled);
  click("Settings/voxel");
  click("Settings/matrix");
  enterNumber("Settings/voxel.resolution", "24");
  enterNumber("Settings/matrix.rays", "16");
  away();
  EXPECT_TRUE(isOn("Settings/cost")) << "no prediction";
  EXPECT_FALSE(control("Settings/Apply").disabled);
  EXPECT_EQ(viewport(), before) << "it has not waited";
  EXPECT_FALSE(contains(window_->log(), "irad: predicted "));
  // What is only seen is taken at once.
  key("2");
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(before) > 0.05; }));
  key("1");
  click("Settings/Apply");
  away();
  EXPECT_TRUE(says("irad: predicted ")) << "its error is not printed";
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p != before; })) << "not applied";
  EXPECT_FALSE(isOn("Settings/cost"));
  const std::string log = window_->log();
  EXPECT_EQ(log.find("irad: predicted "), log.rfind("irad: predicted ")) << "built more than once";
  EXPECT_TRUE(contains(log, " MiB; took ")) << log;
  // What only scatters the light anew is not foretold as a relight; nor that as a build.
  const auto predicted = [this] {
    const std::string help = helpOf("Settings/cost"), word = "predicted ";
    EXPECT_TRUE(help.starts_with(word)) << help;
    double value = 0;
    std::string unit;
    std::istringstream(help.substr(std::min(word.size(), help.size()))) >> value >> unit;
    return unit.starts_with("ms") ? value : 1000 * value;
  };
  click("Settings/voxel");
  click("Settings/matrix");
  click("Settings/scatter");
  click("Settings/solver");
  click("Settings/scatter.edge_removal");
  const double scatter = predicted();
  enterNumber("Settings/solver.omega", "0.5");
  const double relight = predicted();
  click("Settings/field");
  choose("Settings/field.method", "jfa");
  const double build = predicted();
  EXPECT_LT(scatter, relight);
  EXPECT_LT(relight, build);
  quitDiscarding();  // the settings
}

TEST_F(WindowTest, SaysWhyAPictureIsBlack) {
  start({}, "check:lights-off");
  goAside();
  const Control::Area p = picture();
  const auto middle = [&] { return screen_->grab(p.x + p.width / 2 - 135, p.y + p.height / 2 - 75, 270, 150); };
  const auto around = [&] { return screen_->grab(p.x + 20, p.y + 30, p.width / 2 - 175, p.height - 60); };
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
  const auto corner = [this] {
    const Control::Area p = picture();
    return screen_->grab(p.x + 18, p.bottom() - 93, 200, 60);
  };
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

TEST_F(WindowTest, EffectsCanBeForced) {
  fold(R"(["Lights", "Materials", "Objects", "Cameras", "History", "Settings"])");
  start();
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = viewport();
  // In the list behind the arrow of emissive facets: "off", and "auto" again.
  ASSERT_TRUE(control("Effects/emission").area.bottom() <= 720) << "the effects are out of view";
  choose("Effects/emission", "off");
  away();
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(first) > 0.1; }))
      << "the lamp still shines";
  // It stays in the list, and is counted apart from what the scene does not call for.
  EXPECT_TRUE(contains(helpOf("Effects/off"), "; 1 forced off, ")) << helpOf("Effects/off");
  EXPECT_TRUE(has("Effects/emission"));
  choose("Effects/emission", "auto");
  away();
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(first) < 0.01; })) << "not auto again";
  EXPECT_FALSE(contains(helpOf("Effects/off"), " forced off, ")) << helpOf("Effects/off");
  // Those that are off fold under one line.
  EXPECT_TRUE(has("Effects/sun"));
  click("Effects/off");
  EXPECT_TRUE(appears("Effects/sun", /*wanted=*/false));
  EXPECT_TRUE(has("Effects/emission"));
  quit();
}

TEST_F(WindowTest, RemembersItsLayoutUntilItIsReset) {
  start();
  ASSERT_TRUE(viewportSettles(lit));
  goAside();
  const int edge = picture().x;
  const auto left = [&] { return screen_->grab(edge - 46, 60, 40, 200); };  // of the left column; then of the viewport
  const auto background = [this] { return screen_->grab(10, 500, 200, 200).deviation() < 0.01; };
  ASSERT_FALSE(background());
  // The edge of the left column, and the headers of the settings and, below it then, of the effects.
  drag("edge-left", -52);
  const auto black = [](const ScreenPart& p) { return p.count(0x000000) > 0.9 * 40 * 200; };
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
  goAside();
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
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart before = viewport();
  key("o");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(before) > 0.5; })) << "no dialog";
  // A wrong file leaves it open, with the reason in it.
  std::ofstream(folder_.path / "wrong.glb") << "not a scene";
  enter("Open a scene/path", folder_.path.string());
  enter("Open a scene/filter", "RONG");
  EXPECT_TRUE(appears("Open a scene/a.glb", false)) << "not filtered";
  click("Open a scene/wrong.glb");
  click("Open a scene/Open");
  EXPECT_TRUE(says("wrong.glb"));
  EXPECT_TRUE(appears("Open a scene/error")) << "the error is not in the dialog";
  EXPECT_FALSE(has("messages/1/dismiss")) << "only the lost layout is said elsewhere";
  // By kind and by size, and by a place.
  click("Open a scene/filter");
  hold("ctrl", "a");
  hold("BackSpace");
  choose("Open a scene/kind", "skies, references: .exr .hdr .pfm");
  EXPECT_TRUE(appears("Open a scene/a.glb", false)) << "not of that kind";
  choose("Open a scene/kind", "all that can be opened");
  click("Open a scene/size");
  rests();
  EXPECT_LT(control("Open a scene/wrong.glb").area.y, control("Open a scene/a.glb").area.y) << "not by size";
  click("Open a scene/size");
  rests();
  EXPECT_GT(control("Open a scene/wrong.glb").area.y, control("Open a scene/a.glb").area.y) << "not turned around";
  // Esc closes the list, not the dialog under it.
  click("Open a scene/kind");
  ASSERT_TRUE(appears("Open a scene/kind/all that can be opened"));
  hold("Escape");
  EXPECT_FALSE(has("Open a scene/kind/all that can be opened")) << "the list stays";
  EXPECT_TRUE(has("Open a scene/Cancel")) << "the dialog goes with its list";
  click("Open a scene/places/Built-in scenes");
  EXPECT_TRUE(appears("Open a scene/park.glb"));
  enter("Open a scene/path", (folder_.path / "a.glb").string());
  ASSERT_TRUE(viewportSettles([&](const ScreenPart&) {
    return slurp(config / "irad/window.json").find("a.glb") != std::string::npos;
  })) << "the scene is not loaded, or not remembered";
  quit();
}

TEST_F(WindowTest, FollowsItsSize) {
  start();
  ASSERT_TRUE(viewportSettles(lit));
  const auto resize = [&](int width, int height) { act(fmt::format("windowsize {} {}", width, height)); };
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

  goAside();
  quit();
}

TEST_F(WindowTest, SurvivesBeingUnmappedAndResizedInAHurry) {
  start();
  ASSERT_TRUE(viewportSettles(lit));
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = viewport();
  act("windowunmap");
  pause(0.5);
  act("windowmap");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == first; })) << "not drawn again when mapped";

  // Sizes that come faster than frames.
  std::string sizes;
  for (const char* size : {"900 500", "1500 800", "700 700", "1100 400", "1280 720"})
    sizes += fmt::format(" windowsize {} sleep 0.03", size);
  act(sizes);
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == first; })) << "the picture did not come back";
  quit();
}

TEST_F(WindowTest, ScreenshotOfTheWholeWindow) {
  start({"--screenshot", "window.png"});
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
  detail_ = "32";
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
