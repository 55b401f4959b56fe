// The window's loop in this process: what it asks of the device and of the processor while nothing happens and while
// little does, and under a display that says what Xvfb never does: that a window has no area.
#include <gtest/gtest.h>

#if IRAD_UI

#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <functional>
#include <set>
#include <vector>

#include "tests/mouse.h"
#include "ui/window.h"

namespace ImGui {
int GetFrameCount();  // imgui.h: one for each frame of the loop, whether it is presented or not
}

namespace irad::test::window_loop_suite {
namespace {

std::atomic<bool> iconified = false;
PFN_vkAcquireNextImageKHR driversAcquire;
PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR driversCapabilities;
PFN_vkQueuePresentKHR driversPresent;
std::function<void()> eachFrame;  ///< before it is presented
/// Where the chosen light's handle is in a frame, and whether that draws a picture.
struct HandleSeen {
  int x, y;
  bool pictured;
};
std::vector<HandleSeen> handles;

double processSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](timeval t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

bool until(const std::function<bool()>& holds) {
  for (int i = 0; i < 1200; ++i) {
    if (holds()) return true;
    pause(0.05);
  }
  return false;
}

/// The Box, small, in a window of 1280 x 720 with every panel but one unfolded, its loop on the test's own thread; the
/// user is another one. What the user asks of the context must be of the kind that threads may ask.
class WindowLoop : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!installed("Xvfb")) GTEST_SKIP() << "Xvfb is not installed: the window is not tested";
    screen_.emplace(1280, 720);
    setenv("DISPLAY", screen_->display().c_str(), 1);
    device_ = Device::create({.validate = true, .presentable = true});
    context_.emplace(*device_, shaders_, timings_);
    options_.scene = assets() / "box.glb";
    options_.settings = options_.defaults = defaultSettings(/*cpuDevice=*/true);
    options_.settings.voxel.resolution = 16;
    options_.settings.matrix.gpu.rays = 16;
    options_.settings.light.shadowResolution = 256;
    options_.preferences = folder_.path / "window.json";
    options_.controls = folder_.path / "controls";
    std::ofstream(options_.preferences) << R"({"format": 1, "folded": ["Accuracy"]})";
  }
  void TearDown() override {
    unsetenv("DISPLAY");
    if (!device_) return;
    for (const std::string& message : device_->validationMessages()) ADD_FAILURE() << message;
  }

  /// The window from its start until `user` has ended and pressed Ctrl + Q.
  void run(const std::function<void()>& user, bool discards = false) {
    std::thread thread([&] {
      EXPECT_TRUE(until([&] { return picture().width > 0; })) << "no frame";
      screen_->act("mousemove " + aside());  // out of the part looked at: the server draws its pointer
      EXPECT_TRUE(until([&] { return rests() && viewport().deviation() > 0.02; })) << "no picture";
      user();
      screen_->key("ctrl+q");
      if (discards) click("Unsaved changes/Discard");
    });
    EXPECT_NO_THROW(runWindow(*context_, options_));
    thread.join();
  }
  /// Where the picture is; empty before the first frame.
  Control::Area picture() const {
    for (const Control& c : readControls(options_.controls))
      if (c.name == "viewport") return c.area;
    return {};
  }
  /// The part of it where there are neither panels nor messages (window_fixture.h).
  ScreenPart viewport() const {
    const Control::Area p = picture();
    return p.width < 300 ? ScreenPart() : screen_->grab(p.x + 68, p.y + 70, p.width - 167, p.height - 148);
  }
  /// A pixel of it.
  std::string at(int x, int y) const { return fmt::format("{} {}", picture().x + x, picture().y + y); }
  /// In it, but out of that part.
  std::string aside() const { return at(28, picture().height - 22); }
  void click(const std::string& name) {
    const auto find = [&] {
      const std::vector<Control> all = readControls(options_.controls);
      return std::find_if(all.begin(), all.end(), [&](const Control& c) { return c.name == name; }) != all.end();
    };
    EXPECT_TRUE(until(find)) << "no " << name;
    const Control::Area at = findControl(readControls(options_.controls), name).area;
    mouse().tap(fmt::format("{} {}", at.x + at.width / 2, at.y + at.height / 2));
  }
  Mouse mouse() const { return {*screen_, options_.controls}; }
  /// Of the first setting in view, down to which the left column is scrolled.
  std::string placeOfSetting() const {
    for (int turns = 0; turns < 60; ++turns) {
      for (const Control& c : readControls(options_.controls)) {
        const int x = c.area.x + c.area.width / 2, y = c.area.y + c.area.height / 2;
        if (c.name.starts_with("Settings/") && c.name.find('.') != std::string::npos && c.region.holds(x, y))
          return fmt::format("{} {}", x, y);
      }
      screen_->act("mousemove 4 400 click 5 sleep 0.3");  // at the column's edge no list takes the wheel
    }
    ADD_FAILURE() << "no setting is in view";
    return aside();
  }
  /// The display and every thread but the user's slept for a second, and nothing was asked of the device.
  bool rests() const {
    const auto asleep = [this] { return std::pair(screen_->server().asleep(), threadsAsleep(getpid(), gettid())); };
    const Counters counted = context_->counters();
    const auto before = asleep();
    pause(1);
    return before.first && before.second && asleep() == before && context_->counters() == counted;
  }
  /// Once the loop has ended: the stages of frames that began between these times of Timings::now().
  std::set<std::string> stagesBetween(double from, double to) const {
    std::set<std::string> stages;
    for (const FrameSample& frame : timings_.frames())
      if (frame.began >= from && frame.began <= to)
        for (const auto& [stage, ms] : frame.stages) stages.insert(stage);
    return stages;
  }

  TemporaryFolder folder_;
  std::optional<VirtualScreen> screen_;
  std::unique_ptr<Device> device_;
  ShaderLibrary shaders_;
  Timings timings_;
  std::optional<Context> context_;
  WindowOptions options_;
};

TEST_F(WindowLoop, AsksForNothingWhileItIdles) {
  std::ofstream(options_.preferences) << R"({"format": 1, "folded": []})";
  const auto autosave = [this] {
    std::filesystem::path file;
    std::error_code none;
    for (std::filesystem::directory_iterator it(folder_.path / "autosave", none), end; !none && it != end;
         it.increment(none))
      if (it->path().extension() == ".json") file = it->path();
    return file;
  };
  run(
      [&] {
        const auto idles = [&](const std::string& when, double seconds) {
          ASSERT_TRUE(until([&] { return rests(); })) << when;
          const Counters before = context_->counters();
          const double used = processSeconds();
          pause(seconds);
          const Counters asked = context_->counters().since(before);
          EXPECT_EQ(asked, Counters()) << when << ": " << asked.dispatches << " dispatches, " << asked.draws
                                       << " draws, " << asked.submissions << " submissions";
          EXPECT_LT(processSeconds() - used, 0.02 * seconds) << "seconds of processor time, " << when;
        };
        // Wherever the mouse is: over the picture, over a setting with its tooltip, over a plot with its own.
        for (const std::string& place : {aside(), placeOfSetting(), at(470, picture().height + 90)}) {
          screen_->act("mousemove " + place);
          idles("mouse at " + place, 5);
        }
        // With the keyboard in a field.
        screen_->act("key ctrl+f");
        idles("the search has the keyboard", 3);
        screen_->act("key Escape");
        screen_->act("mousemove 4 400 click --repeat 60 --delay 50 4 sleep 0.5");
        // With something unsaved: every edit is soon in the autosave, and then that is left alone.
        EXPECT_EQ(autosave(), "");
        click("Lights/point");
        EXPECT_TRUE(until([&] { return autosave() != "" && rests(); }));
        click("Lights/sun");
        EXPECT_TRUE(until([&] { return contains(slurp(autosave()), "\"sun\""); })) << "no autosave of the last edit";
        screen_->act("mousemove " + aside());
        EXPECT_TRUE(until([&] { return rests(); }));
        const auto written = std::filesystem::last_write_time(autosave());
        idles("with unsaved lights", 3);
        EXPECT_EQ(std::filesystem::last_write_time(autosave()), written);
      },
      /*discards=*/true);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path / "autosave"));
}

/// Nothing of the light is redone, and what is drawn over the picture moves with it: only in frames that draw one.
TEST_F(WindowLoop, ACameraThatMovesAloneRedoesNoLightAndTakesTheHandlesAlong) {
  std::ofstream(options_.preferences) << R"({"format": 1, "folded": ["Accuracy", "Scene", "Settings", "Effects",
                                             "Materials", "Objects", "History"]})";
  double from = 0, to = 0, toDepth = 0;
  Counters before, after;
  run([&] {
    click("Lights/0");
    EXPECT_TRUE(until([&] { return rests(); }));
    eachFrame = [this, dispatches = context_->counters().dispatches]() mutable {
      Control::Area handle;  // none where it is not seen
      for (const Control& c : readControls(options_.controls))
        if (c.name == "picture/light") handle = c.area;
      handles.push_back({handle.x, handle.y, context_->counters().dispatches != dispatches});
      dispatches = context_->counters().dispatches;
    };
    driversPresent = std::exchange(vkQueuePresentKHR, [](VkQueue queue, const VkPresentInfoKHR* info) {
      eachFrame();
      return driversPresent(queue, info);
    });
    before = context_->counters();
    from = timings_.now();
    // By a key, by the mouse, and by a panel, which is drawn after the handles.
    screen_->act("keydown w sleep 0.5 keyup w");
    mouse().dragThrough({at(168, 270), at(188, 275), at(208, 280)}, /*button=*/3);
    click("Cameras/0");
    screen_->act("mousemove " + aside());
    EXPECT_TRUE(until([&] { return rests(); }));
    to = timings_.now();
    after = context_->counters();
    vkQueuePresentKHR = driversPresent;
    screen_->key("9");
    EXPECT_TRUE(until([&] { return rests(); }));
    toDepth = timings_.now();
  });
  int moves = 0;
  for (size_t i = 1; i < handles.size(); ++i) {
    if (handles[i].x == handles[i - 1].x && handles[i].y == handles[i - 1].y) continue;
    ++moves;
    EXPECT_TRUE(handles[i].pictured) << "frame " << i << ": to " << handles[i].x << ' ' << handles[i].y;
  }
  EXPECT_GE(moves, 3);
  const std::set<std::string> stages = stagesBetween(from, to);
  EXPECT_TRUE(stages.contains("RE Forward")) << "the camera has not moved";
  for (const std::string& stage : stages)
    EXPECT_FALSE(stage.starts_with("GI ") || stage == "RE Shadow") << stage << " for a camera";
  // A view runs no stage whose result it does not show.
  const std::set<std::string> depth = stagesBetween(to, toDepth);
  EXPECT_TRUE(depth.contains("RE Depth"));
  for (const char* stage : {"RE Forward", "RE Specular"}) EXPECT_FALSE(depth.contains(stage)) << stage << " for depth";
  const Counters asked = after.since(before);
  EXPECT_GT(asked.draws, 0u);
  EXPECT_EQ(asked.images, 0u);
  EXPECT_EQ(asked.allocations, 0u) << "device memory for a camera";
}

/// With something to measure and nobody to look at it: no thread, nothing read back, nothing drawn beside the frames.
TEST_F(WindowLoop, AFoldedAccuracyPanelCostsNothing) {
  const glm::uvec2 size(64, 48);
  options_.reference = ReferencePicture{.path = "/a.exr", .picture = {.size = size}};
  options_.reference->picture.pixels.assign(size_t{size.x} * size.y, glm::vec4(0.3f, 0.3f, 0.3f, 1));
  struct Cost {
    int64_t beside;  ///< submissions that are no frames of the window; the last frame is counted with the next
    uint64_t images;
    ptrdiff_t threads;
  };
  constexpr int kPictures = 4;
  const auto threads = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/task"), std::filesystem::directory_iterator());
  };
  run([&] {
    // Of views in turn, each of which is a picture anew.
    const auto ofPictures = [&] {
      EXPECT_TRUE(until([&] { return rests(); }));
      const Counters before = context_->counters();
      const int64_t frames = ImGui::GetFrameCount();
      const ptrdiff_t had = threads();
      for (int i = 0; i < kPictures; ++i) {
        const uint64_t draws = context_->counters().dispatches;
        screen_->key(i % 2 == 0 ? "2" : "1");
        EXPECT_TRUE(until([&] { return context_->counters().dispatches > draws; })) << "no picture";
        EXPECT_TRUE(until([&] { return rests(); }));
      }
      const Counters asked = context_->counters().since(before);
      return Cost{static_cast<int64_t>(asked.submissions) - (ImGui::GetFrameCount() - frames), asked.images,
                  threads() - had};
    };
    const auto free = [&](const char* when) {
      const Cost folded = ofPictures();
      EXPECT_LE(std::abs(folded.beside), 1) << when;
      EXPECT_EQ(folded.images, 0u) << when;
      EXPECT_EQ(folded.threads, 0) << when;
    };
    ofPictures();  // views that were not there before take memory once
    free("at first");
    click("Accuracy");
    screen_->act("mousemove " + aside());
    EXPECT_GE(ofPictures().beside, kPictures - 1) << "an open one measures each";
    click("Accuracy");
    screen_->act("mousemove " + aside());
    free("folded again");
  });
}

TEST_F(WindowLoop, PointingAndZoomingRenderNothing) {
  const auto reading = [this](const std::string& name) {
    for (const Control& c : readControls(options_.controls))
      if (c.name.starts_with("Pointing/" + name + "=")) return c.name.substr(c.name.find('=') + 1);
    return std::string();
  };
  run([&] {
    EXPECT_TRUE(until([&] { return rests(); }));
    const ScreenPart whole = viewport();
    const Counters before = context_->counters();
    const uint64_t frames = timings_.recorded();
    // Of the list beside the plot.
    const auto lastForward = [this] {
      for (const Control& c : readControls(options_.controls))
        if (c.name.starts_with("Timings/RE Forward=")) return c.name;
      return std::string();
    };
    const std::string forward = lastForward();
    EXPECT_NE(forward, "");
    const auto rendersNothing = [&](const char* when) {
      EXPECT_EQ(context_->counters().since(before).dispatches, 0u) << when;
    };
    std::set<std::string> pixels, values;
    for (const std::string& place : {at(88, 220), at(308, 270), at(468, 420)}) {
      screen_->act("mousemove " + place);
      EXPECT_TRUE(until([&] { return rests(); }));
      pixels.insert(reading("pixel"));
      values.insert(reading("value"));
    }
    EXPECT_EQ(pixels, (std::set<std::string>{"x 88 y 220", "x 308 y 270", "x 468 y 420"}));
    EXPECT_EQ(values.size(), 3u);
    EXPECT_FALSE(values.contains(""));
    rendersNothing("pointed at");
    mouse().moveTo(at(308, 270));
    screen_->act("keydown ctrl click --repeat 3 --delay 1 4");
    EXPECT_TRUE(until([&] { return reading("zoom") != ""; })) << "the wheel does not zoom";
    EXPECT_TRUE(until([&] { return rests(); }));
    screen_->act("keyup ctrl");
    rendersNothing("zoomed");
    mouse().dragThrough({at(308, 270), at(328, 290)}, /*button=*/2);
    screen_->act("mousemove " + aside());
    EXPECT_TRUE(until([&] { return rests(); }));
    EXPECT_GT(viewport().difference(whole), 0.2);
    rendersNothing("moved");
    screen_->key("0");
    EXPECT_TRUE(until([&] { return rests() && viewport() == whole; })) << "not the whole picture again";
    const Counters asked = context_->counters().since(before);
    EXPECT_EQ(asked.dispatches, 0u);
    EXPECT_GT(asked.draws, 0u) << "panels";
    EXPECT_EQ(timings_.recorded(), frames) << "frames that only draw panels are in the timings";
    EXPECT_EQ(lastForward(), forward) << "a row does not keep its time";
    // Nor does a view without it take it away.
    screen_->key("9");
    EXPECT_TRUE(until([&] { return rests() && timings_.recorded() > frames; }));
    EXPECT_EQ(lastForward(), forward) << "a row does not keep its time";
    // A frame of an hour among others, which leaves no room for them: it is cut, and the plot says so.
    const auto cut = [this] {
      const std::vector<Control> all = readControls(options_.controls);
      return std::ranges::any_of(all,
                                 [](const Control& c) { return c.name == "Timings/one peak of 3600000 ms is cut"; });
    };
    eachFrame = [this, told = false]() mutable {
      for (int frame = 0; !told && frame < 9; ++frame) {
        timings_.add("RE Forward", frame == 4 ? 3.6e6 : 5);
        timings_.endFrame(0, /*setup=*/false, 1);
      }
      told = true;
    };
    EXPECT_FALSE(cut());
    driversPresent = std::exchange(vkQueuePresentKHR, [](VkQueue queue, const VkPresentInfoKHR* info) {
      eachFrame();
      return driversPresent(queue, info);
    });
    screen_->act("mousemove 10 400");  // so that a frame is drawn, and another one
    EXPECT_TRUE(until([&] { return rests(); }));
    vkQueuePresentKHR = driversPresent;
    screen_->act("mousemove " + aside());
    EXPECT_TRUE(until(cut)) << "the plot is scaled to one peak, or does not say so";
  });
}

TEST_F(WindowLoop, FramesOfBruteForceEndInRestAndBeginAnewFromTheDark) {
  options_.settings.solver.method = SolverMethod::bruteForce;
  options_.settings.solver.frames = 5;
  double from = 0, to = 0;
  run([&] {  // once it rests
    from = timings_.now();
    const uint64_t before = context_->counters().dispatches;
    click("Solver/H = 0");
    screen_->act("mousemove " + aside());
    // It rests until the click arrives, too; panels are drawn without a dispatch.
    EXPECT_TRUE(until([&] { return context_->counters().dispatches > before; })) << "the click does nothing";
    EXPECT_TRUE(until([&] { return rests(); }));
    to = timings_.now();
  });
  size_t samples = 0;
  for (const FrameSample& frame : timings_.frames())
    if (frame.began >= from && frame.began <= to)
      samples += std::ranges::any_of(frame.stages, [](const auto& s) { return s.first == "GI BruteForce"; });
  EXPECT_GE(samples, 5u) << "more than one in a frame of the window";
  const std::set<std::string> stages = stagesBetween(0, to);
  EXPECT_TRUE(stages.contains("GI BruteForce"));
  EXPECT_FALSE(stages.contains("GI BuildMatrix") || stages.contains("GI Solve"));
}

TEST_F(WindowLoop, ALightThatMovesLeavesVoxelsAndMatrix) {
  double from = 0, to = 0;
  ScreenPart first, moved;
  const auto user = [&] {
    first = viewport();
    from = timings_.now();
    // The handle of the Box's spot light, in the upper right of the picture.
    const Control::Area p = picture();
    const auto lamp = [&](int right, int down) {
      return at(p.width / 2 + 325 * p.height / 1000 + right, p.height / 2 - 416 * p.height / 1000 + down);
    };
    mouse().dragThrough({lamp(0, 0), lamp(-69, 18), lamp(-129, 48)});
    screen_->act("mousemove " + aside());
    EXPECT_TRUE(until([&] { return rests(); }));
    moved = viewport();
    to = timings_.now();
  };
  run(user, /*discards=*/true);
  EXPECT_GT(moved.difference(first), 0.1) << "the light is not dragged";
  const std::set<std::string> stages = stagesBetween(from, to);
  for (const char* stage : {"RE Shadow", "GI Gather", "GI Solve", "GI Scatter"})
    EXPECT_TRUE(stages.contains(stage)) << stage;
  for (const std::string& stage : stages) {
    const bool ofLight =
        stage.starts_with("GI Gather") || stage.starts_with("GI Solve") || stage.starts_with("GI Scatter");
    EXPECT_TRUE(ofLight || !stage.starts_with("GI ")) << stage << " for a light";
  }
}

TEST_F(WindowLoop, SleepsWhileItHasNoArea) {
  driversAcquire = std::exchange(vkAcquireNextImageKHR, [](VkDevice handle, VkSwapchainKHR swapchain, uint64_t timeout,
                                                           VkSemaphore semaphore, VkFence fence, uint32_t* image) {
    return iconified ? VK_ERROR_OUT_OF_DATE_KHR : driversAcquire(handle, swapchain, timeout, semaphore, fence, image);
  });
  driversCapabilities =
      std::exchange(vkGetPhysicalDeviceSurfaceCapabilitiesKHR,
                    [](VkPhysicalDevice physical, VkSurfaceKHR surface, VkSurfaceCapabilitiesKHR* capabilities) {
                      const VkResult result = driversCapabilities(physical, surface, capabilities);
                      if (iconified) capabilities->currentExtent = {0, 0};
                      return result;
                    });
  run([&] {
    const ScreenPart first = viewport();

    // Another view is asked for while nothing can be drawn: no frame follows, and no busy waiting.
    iconified = true;
    screen_->key("2");
    pause(1);
    const double used = processSeconds();
    pause(2);
    EXPECT_LE(processSeconds() - used, 0.1) << "seconds of processor time in 2 s without area";
    EXPECT_EQ(viewport(), first);

    // The frame comes when there is an area again, without any further event.
    iconified = false;
    EXPECT_TRUE(until([&] { return viewport().difference(first) > 0.05; })) << "nothing is drawn once there is area";
  });
  vkAcquireNextImageKHR = driversAcquire;
  vkGetPhysicalDeviceSurfaceCapabilitiesKHR = driversCapabilities;
}

}  // namespace
}  // namespace irad::test::window_loop_suite

#else

TEST(WindowLoop, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_UI";
}

#endif
