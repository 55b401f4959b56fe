// What goes wrong in the window, and what becomes of it: bad files, shaders with mistakes, wrong numbers, a lost
// device, work given up.
#include <chrono>

#include "tests/scene_files.h"
#include "tests/window_fixture.h"

namespace irad::test::window_faults_suite {
namespace {

class WindowFaultsTest : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    if (!IsSkipped()) foldPanels();
  }
};

TEST_F(WindowFaultsTest, TakesDroppedScenesAndRefusesOthersInWords) {
  start();
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = part();

  // What is not a scene leaves a message, and the picture: a file that is not glTF, a folder, a file that disappears
  // before it is read.
  std::ofstream(folder_.path / "bad.glb") << "not a scene";
  for (const char* name : {"bad.glb", ".", "gone.glb"}) {
    ASSERT_TRUE(drop({folder_.path / name}));
    EXPECT_TRUE(says(name)) << window_->log();
    ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; })) << name;
  }
  EXPECT_TRUE(has("messages/2/dismiss")) << "errors do not stay";

  // A scene replaces the one shown, whatever its name; of several the last is taken.
  const std::filesystem::path triangle = triangleFile().write(folder_.path, "100% drei\u00E9ck #1.gltf");
  ASSERT_TRUE(drop({assets() / "box.glb", triangle}));
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p.difference(first) > 0.2; }))
      << "the dropped scene is not shown";
  ASSERT_TRUE(drop({assets() / "box.glb"}));
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }))
      << "the first scene did not come back with the same bits";
  quit();
}

TEST_F(WindowFaultsTest, AFileReadAgainRebuildsOnlyWhatHasChanged) {
  // A triangle before a lamp, x wide.
  const auto write = [&](float x, float candela) {
    GltfFile file;
    file.attributes()["POSITION"] = file.vec3({0, 0, 0, x, 0, 0, 0, 1, 0});
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", candela}}};
    file.json["nodes"].push_back({{"translation", {0.3, 0.3, 0.8}}});
    file.json["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    file.json["scenes"][0]["nodes"] = {0, 1};
    return file.write(folder_.path, "lamp.gltf");
  };
  const auto kept = [this] {
    size_t n = 0;
    for (size_t at = 0; (at = window_->log().find("its surfaces are as they were", at)) != std::string::npos; ++at) ++n;
    return n;
  };
  const auto shows = [&](const std::function<bool(const ScreenPart&)>& wanted) {
    return settles([this] { return part(); }, wanted);
  };
  start();
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart box = part();
  ASSERT_TRUE(drop({write(1, 1)}));
  ASSERT_TRUE(shows([&](const ScreenPart& p) { return p.difference(box) > 0.2; }));
  const ScreenPart dim = part();
  EXPECT_EQ(kept(), 0u);

  // A brighter lamp: voxels and matrix are kept.
  ASSERT_TRUE(drop({write(1, 8)}));
  EXPECT_TRUE(says("its surfaces are as they were"));
  ASSERT_TRUE(shows([&](const ScreenPart& p) { return p.meanLuminance() > dim.meanLuminance() + 0.02; }));
  const ScreenPart bright = part();
  EXPECT_EQ(kept(), 1u);

  // A wider triangle: everything anew.
  ASSERT_TRUE(drop({write(2, 8)}));
  ASSERT_TRUE(shows([&](const ScreenPart& p) { return p.difference(bright) > 0.02; }));
  EXPECT_EQ(kept(), 1u);
  quit();
}

TEST_F(WindowFaultsTest, ADroppedPictureIsTheReference) {
  start({"--view", "reference-picture"});
  goAside();
  // Above the words that say why it is black; but for a light's handle.
  const auto top = [this] { return around(-400, -400, 800, 250); };
  const auto black = [](const ScreenPart& p) { return p.meanLuminance() < 0.01; };
  EXPECT_TRUE(appears("missing/mend", true, 120)) << "nothing says that there is no reference";
  ASSERT_TRUE(settles(top, black)) << "a reference that nobody gave";
  // A file that is no picture, a file that is gone, then a picture that is not black.
  std::ofstream(folder_.path / "bad.exr") << "no picture";
  for (const char* name : {"bad.exr", "gone.hdr"}) {
    ASSERT_TRUE(drop({folder_.path / name}));
    EXPECT_TRUE(says(name)) << window_->log();
  }
  ASSERT_TRUE(settles(top, black));
  ASSERT_TRUE(drop({sourceFolder() / "tests/golden/box.main.lit.exr"}));
  ASSERT_TRUE(settles(top, lit)) << "the picture is not taken";
  EXPECT_FALSE(has("missing/mend"));
  quit();
}

TEST_F(WindowFaultsTest, ADroppedPictureOfTheSphereIsTheSky) {
  start({});
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart before = part();
  // What is none is said, and nothing is lost.
  ASSERT_TRUE(drop({sourceFolder() / "docs/images/box-lit.png"}));
  EXPECT_TRUE(says("box-lit.png")) << window_->log();
  ASSERT_TRUE(drop({assets() / "evening.pfm"}));
  EXPECT_TRUE(says("evening.pfm is the sky")) << window_->log();
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p.difference(before) > 0.02; }));
  quitDiscarding();  // sky.source has changed
}

TEST_F(WindowFaultsTest, ReloadsShadersAndWhatTheyMade) {
  const std::filesystem::path shaders = copyShaders({"gi/piece_shade.comp", "gi/gather.comp"});
  start({"--shaders", shaders.string(), "--view", "voxel-albedo"});
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = part();

  key("F5");
  EXPECT_TRUE(says("no shader has changed"));

  // An error: the message names file and line, the old shaders stay.
  const std::filesystem::path shading = shaders / "gi/piece_shade.comp";
  const std::string good = slurp(shading);
  std::ofstream(shading) << good << "\nmistake\n";
  key("F5");
  EXPECT_TRUE(says("The old shaders stay in use"));
  EXPECT_TRUE(says("piece_shade.comp")) << window_->log();
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }));

  // A voxelization shader: the voxels are made anew, and everything after them.
  const std::string written = "push.albedo.at[piece] = albedo";
  std::string changed = good;
  ASSERT_NE(changed.find(written), std::string::npos);
  changed.insert(changed.find(written) + written.size(), " * vec3(0.9, 0.1, 0.5)");
  std::ofstream(shading) << changed;
  key("F5");
  EXPECT_TRUE(says("Compiled again: gi/piece_shade.comp"));
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p.difference(first) > 0.5; }))
      << "the voxels keep what the old shader made of them";
  std::ofstream(shading) << good;
  key("F5");
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }))
      << "the first picture did not come back with its shader";
  quit();
}

TEST_F(WindowFaultsTest, ABannerNamesWrongNumbersUntilTheyAreGone) {
  const std::filesystem::path shaders = copyShaders({"gi/gather.comp"});
  // By the thesis's rule a kernel gathers direct light on CPU devices, too.
  start({"--shaders", shaders.string(), "--set", "matrix.hit_rule=thesis"});
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = part();
  const auto top = [this] {
    const Control::Area p = picture();
    return screen_->grab(p.x + 8, p.y + 2, p.width - 17, 30);
  };
  constexpr uint32_t kAlarm = 0x9E1714;
  EXPECT_EQ(top().count(kAlarm), 0);

  // One facet's direct light becomes NaN.
  const std::filesystem::path gather = shaders / "gi/gather.comp";
  const std::string good = slurp(gather), wanted = "vec4(sum, 0.0f)";
  std::string bad = good;
  const size_t at = bad.find(wanted);
  ASSERT_NE(at, std::string::npos);
  bad.replace(at, wanted.size(), "vec4(facet == 100u ? vec3(uintBitsToFloat(0x7FC00000u | facet)) : sum, 0.0f)");
  std::ofstream(gather) << bad;
  key("F5");
  ASSERT_TRUE(settles(top, [&](const ScreenPart& p) { return p.count(kAlarm) > p.width * 30 / 2; })) << "no banner";
  std::ofstream(gather) << good;
  key("F5");
  ASSERT_TRUE(settles(top, [&](const ScreenPart& p) { return p.count(kAlarm) == 0; })) << "the banner stays";
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }))
      << "the first picture did not come back";
  quit();
}

TEST_F(WindowFaultsTest, ALostDeviceEndsItWithAMessage) {
  startsProgram_ = true;
  // In the load, and once pictures are drawn.
  for (const char* fault : {"lost=30", "lost=400"}) {
    start({"--inject", fault});
    // Something to draw until it happens: on a busy machine several moves make one frame.
    const auto given = std::chrono::steady_clock::now();
    for (int i = 0; window_->running() && std::chrono::steady_clock::now() - given < std::chrono::minutes(2); ++i) {
      screen_->act(fmt::format("mousemove {} 500", 400 + i % 2));
      pause(0.05);  // a move makes some frames
    }
    EXPECT_EQ(window_->wait(60), 1) << fault;
    EXPECT_TRUE(says("irad: error: ")) << fault;
    EXPECT_TRUE(says("the device was lost")) << fault;
  }
}

TEST_F(WindowFaultsTest, LoadsAndRebuildsCanBeCancelled) {
  // Large enough for some seconds of work.
  const std::filesystem::path shaders = copyShaders({"gi/piece_shade.comp"});
  start({"--shaders", shaders.string(), "--set", "voxel.resolution=64", "--set", "matrix.rays=256"});
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = part();

  const std::filesystem::path copy = folder_.path / "copy.glb";
  std::filesystem::copy_file(assets() / "box.glb", copy);
  cancel([&] { ASSERT_TRUE(drop({copy})); });
  EXPECT_TRUE(says("copy.glb: loading was cancelled"));
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }));

  // Darker facets; nothing that a picture by itself is drawn with, which is drawn anew by what was compiled again.
  const std::filesystem::path shade = shaders / "gi/piece_shade.comp";
  std::string text = slurp(shade);
  const std::string whole = "push.albedo.at[piece] = albedo;";
  ASSERT_TRUE(contains(text, whole));
  text.replace(text.find(whole), whole.size(), "push.albedo.at[piece] = 0.25 * albedo;");
  std::ofstream(shade) << text;
  cancel([&] { key("F5"); });
  EXPECT_TRUE(says("The rebuild was cancelled"));
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }));

  // Esc cancels like the button; Ctrl + Q ends the program in the middle of the work.
  ASSERT_TRUE(drop({copy}));
  ASSERT_TRUE(appears("progress/cancel"));
  key("Escape");
  ASSERT_TRUE(appears("progress/cancel", false)) << "Esc does not cancel";
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }));
  ASSERT_TRUE(drop({copy}));
  ASSERT_TRUE(appears("progress/cancel"));
  key("ctrl+q");
  EXPECT_EQ(window_->wait(20), 0);
}

}  // namespace
}  // namespace irad::test::window_faults_suite
