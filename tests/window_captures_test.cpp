// Captures and recordings: what they say of themselves, where they are, and the dialog that lists, replays and compares
// them.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "gi/captures.h"
#include "gi/manifest.h"
#include "tests/window_fixture.h"

namespace irad::test::window_captures_suite {
namespace {

/// What another program would paste; empty where there is nothing, or it does not come in 10 s.
std::string clipboard(const std::string& display) {
  const std::unique_ptr<Display, int (*)(Display*)> x(XOpenDisplay(display.c_str()), XCloseDisplay);
  if (!x) return {};
  const Window self = XCreateSimpleWindow(x.get(), DefaultRootWindow(x.get()), 0, 0, 1, 1, 0, 0, 0);
  const Atom text = XInternAtom(x.get(), "UTF8_STRING", False), pasted = XInternAtom(x.get(), "PASTED", False);
  XConvertSelection(x.get(), XInternAtom(x.get(), "CLIPBOARD", False), text, pasted, self, CurrentTime);
  for (const auto end = Clock::now() + std::chrono::seconds(10); Clock::now() < end; pause(0.01))
    while (XPending(x.get())) {
      XEvent event;
      XNextEvent(x.get(), &event);
      if (event.type != SelectionNotify || event.xselection.property != pasted) continue;
      Atom type;
      int format;
      unsigned long length, rest;
      unsigned char* bytes = nullptr;
      XGetWindowProperty(x.get(), self, pasted, 0, 4096, False, text, &type, &format, &length, &rest, &bytes);
      std::string out(reinterpret_cast<char*>(bytes), length);
      XFree(bytes);
      return out;
    }
  return {};
}

class WindowCapturesTest : public WindowTest {
 protected:
  WindowCapturesTest() { windowSize_ = kLow; }
  std::filesystem::path out_ = folder_.path / "out";

  void begin(std::vector<std::string> more = {}) {
    fold(R"(["Scene", "Lights", "Effects", "Materials", "Objects", "Cameras", "View", "Compare", "Solver", "Memory"])");
    more.insert(more.end(), {"--out", out_.string()});
    start(more);
    goAside();
    ASSERT_TRUE(viewportSettles(lit));
  }
  void openCaptures() {
    choose("Menu/File", "Captures\u2026");
    ASSERT_TRUE(appears("Captures/Close"));
    rests();
  }
  void recordAgain() {
    while (has("messages/0/dismiss")) click("messages/0/dismiss");
    record(2);
  }
  nlohmann::json json(const std::string& file) const { return nlohmann::json::parse(slurp(out_ / file)); }
};

TEST_F(WindowCapturesTest, SayWhatTheyAreAndAreListedReplayedAndCompared) {
  // A file manager that notes what it is asked to show.
  const std::filesystem::path bin = folder_.path / "bin", opened = folder_.path / "opened";
  std::filesystem::create_directories(bin);
  std::ofstream(bin / "xdg-open") << "#!/bin/sh\nprintf %s \"$1\" > " << opened.string() << "\n";
  std::filesystem::permissions(bin / "xdg-open", std::filesystem::perms::owner_all);
  environment_["PATH"] = bin.string() + ":" + std::getenv("PATH");
  begin();

  // The message of a capture has its path, for the clipboard and for the file manager.
  const ScreenPart first = part();
  key("F12");
  const std::string one = (out_ / "box.001").string();
  ASSERT_TRUE(says("Saved Lit to " + one)) << window_->log();
  click("messages/0/Copy path");
  EXPECT_EQ(clipboard(screen_->display()), one);
  click("messages/0/Open folder");
  for (int i = 0; i < 200 && slurp(opened) != one; ++i) pause(0.05);
  EXPECT_EQ(slurp(opened), one);

  // Another one, with other settings and from elsewhere; two recordings.
  choose("Settings/sample.filter", "nearest");
  away();
  act("keydown w sleep 0.4 keyup w");
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p.difference(first) > 0.05; }));
  const ScreenPart second = part();
  key("F12");
  ASSERT_TRUE(says("Saved Lit to " + (out_ / "box.002").string()));
  for (const char* name : {"recording.001", "recording.002"}) {
    recordAgain();
    ASSERT_TRUE(says((out_ / name).string())) << window_->log();
  }
  const nlohmann::json manifest = json("recording.001/manifest.json");
  EXPECT_EQ(json("recording.001/trace.json")["otherData"]["manifest"], manifest);
  EXPECT_EQ(manifest["settings"], json("box.002/manifest.json")["settings"]);
  EXPECT_EQ(manifest["cameras"], json("box.002/manifest.json")["cameras"]);
  EXPECT_EQ(manifest["scene"], json("box.002/manifest.json")["scene"]);
  EXPECT_EQ(manifest["cameras"][0]["name"], "") << "it stands at no camera of the scene";
  EXPECT_EQ(json("box.001/manifest.json")["cameras"][0]["name"], "main");
  EXPECT_EQ(manifest["views"], nlohmann::json{"lit"});
  EXPECT_GE(manifest["recording"]["frames"], 3);
  EXPECT_FALSE(manifest["recording"].contains("changed_meanwhile")) << manifest["recording"];
  EXPECT_TRUE(contains(manifest["command"], "--set sample.filter=nearest")) << manifest["command"];

  // What is no manifest is named, the rest is listed, with its pictures; a recording of an older version has none.
  std::filesystem::create_directories(out_ / "recording.000");
  std::filesystem::copy(out_ / "recording.001/frames.csv", out_ / "recording.000/frames.csv");
  std::filesystem::create_directories(out_ / "foreign");
  std::ofstream(out_ / "foreign/manifest.json") << "{}";
  while (has("messages/0/dismiss")) click("messages/0/dismiss");
  openCaptures();
  ASSERT_TRUE(appears("Captures/problems"));
  for (const char* name : {"box.001", "box.002", "recording.000", "recording.001", "recording.002"})
    EXPECT_TRUE(has(fmt::format("Captures/{}/choose", name))) << name;
  EXPECT_TRUE(appears("Captures/box.001/thumbnail"));
  // With the dialog open nothing is drawn but the dialog: pictures are read once.
  rests();
  const auto asleep = window_->asleep();
  pause(0.5);
  EXPECT_EQ(window_->asleep(), asleep) << "it does not sleep";

  // Two pictures with their numbers, two recordings stage by stage; a picture and a recording are not compared.
  click("Captures/box.001/compare");
  click("Captures/recording.001/compare");
  EXPECT_TRUE(control("Captures/Compare the two").disabled);
  click("Captures/recording.002/compare");  // the oldest tick goes
  EXPECT_FALSE(isOn("Captures/box.001/compare"));
  click("Captures/Compare the two");
  EXPECT_TRUE(appears("Captures/times")) << "no times are compared";
  click("Captures/Back");
  click("Captures/recording.000/compare");
  click("Captures/Compare the two");
  EXPECT_TRUE(appears("Captures/times")) << "nor those of an older version";
  click("Captures/Back");
  click("Captures/recording.000/choose");
  EXPECT_TRUE(control("Captures/Replay").disabled) << "of what?";
  click("Captures/box.001/compare");
  click("Captures/box.002/compare");
  click("Captures/Compare the two");
  ASSERT_TRUE(appears("Captures/numbers"));
  EXPECT_TRUE(isOn("Captures/first picture") && isOn("Captures/second picture"));
  // Esc closes it here, too, and the next time the list is there.
  hold("Escape");
  EXPECT_TRUE(appears("Captures/Back", /*wanted=*/false)) << "Esc does not close it";
  openCaptures();

  // The first one's settings and camera come back, as one step.
  click("Captures/box.001/choose");
  click("Captures/Replay");
  ASSERT_TRUE(says("The window is as it was for box.001")) << window_->log();
  while (has("messages/0/dismiss")) click("messages/0/dismiss");
  away();
  EXPECT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }, 30));
  key("ctrl+z");
  away();
  EXPECT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == second; }, 30));
  key("ctrl+y");
  away();
  EXPECT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }, 30));

  // So do a sky and a reference, and go where the step is undone.
  const auto dismiss = [this] {
    while (has("messages/0/dismiss")) click("messages/0/dismiss");
    away();
  };
  ASSERT_TRUE(drop({assets() / "evening.pfm"}));
  ASSERT_TRUE(says("evening.pfm is the sky"));
  openCaptures();
  click("Captures/box.001/choose");
  click("Captures/As reference");
  ASSERT_TRUE(appears("Accuracy/of")) << "no reference";
  dismiss();
  // Of light that began from other light, less than a grey level is left.
  const auto shows = [&](const ScreenPart& wanted) {
    return settles([this] { return part(); }, [&](const ScreenPart& p) { return p.levels(wanted) < 1; }, 30);
  };
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p.levels(first) > 2; }, 30));
  const ScreenPart third = part();
  key("F12");
  ASSERT_TRUE(says("Saved Lit to " + (out_ / "box.003").string()));
  const auto isFirst = [&] {
    dismiss();
    return shows(first) && !has("Accuracy/of");
  };
  key("ctrl+z");
  EXPECT_TRUE(appears("Accuracy/of", false)) << "the reference stays";
  key("ctrl+z");
  EXPECT_TRUE(isFirst()) << "the sky stays";
  openCaptures();
  click("Captures/box.003/choose");
  click("Captures/Replay");
  ASSERT_TRUE(says("The window is as it was for box.003")) << window_->log();
  dismiss();
  EXPECT_TRUE(shows(third));
  EXPECT_TRUE(has("Accuracy/of"));
  key("ctrl+z");
  EXPECT_TRUE(isFirst()) << "sky or reference stay";
  quit();  // settings that a manifest holds are saved
}

TEST_F(WindowCapturesTest, AReplayOfAnotherSceneAsksFirstAndAMissingFileManagerIsNamed) {
  environment_["PATH"] = (folder_.path / "none").string();
  const std::filesystem::path other = folder_.path / "other.glb";
  std::filesystem::copy(assets() / "box.glb", other);
  const std::vector<std::string> small{"--size", "64x48", "--set", "voxel.resolution=12", "--set", "matrix.rays=12"};
  std::vector<std::string> render{"render", other.string(), "--out", (out_ / "made").string()};
  render.insert(render.end(), small.begin(), small.end());
  const RunResult made = runIrad(render);
  ASSERT_EQ(made.status, 0) << made.err;
  begin();
  click("Lights");
  click("Lights/point");  // unsaved
  rests();

  const auto replay = [&] {
    openCaptures();
    click("Captures/made/choose");
    click("Captures/Replay");
    ASSERT_TRUE(appears("Unsaved changes/Cancel")) << "the light is lost without being asked for";
  };
  openCaptures();
  click("Captures/made/choose");
  click("Captures/Open folder");
  ASSERT_TRUE(appears("Captures/said")) << "nothing is said";
  click("Captures/Close");
  replay();
  click("Unsaved changes/Cancel");
  EXPECT_TRUE(appears("Lights/Remove")) << "the light is gone";
  replay();
  click("Unsaved changes/Discard");
  ASSERT_TRUE(says("The window is as it was for made", 60)) << window_->log();
  away();
  ASSERT_TRUE(viewportSettles(lit));
  quit();  // settings that a manifest holds are saved
}

}  // namespace
}  // namespace irad::test::window_captures_suite
