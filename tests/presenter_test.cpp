// The window on a virtual display: what is presented is what the display shows, before and after a resize.
#include <gtest/gtest.h>

#if IRAD_UI

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "renderer/error.h"
#include "renderer/presenter.h"
#include "tests/support.h"

extern char** environ;

namespace irad::test {
namespace {

/// An X server without a screen whose framebuffer is a file (XWD format).
class VirtualDisplay {
 public:
  VirtualDisplay() {
    int ends[2];
    if (pipe(ends) != 0) return;
    const std::string number = std::to_string(ends[1]), folder = folder_.path.string();
    const char* argv[] = {"Xvfb",   "-displayfd",   number.c_str(), "-screen", "0",    "640x480x24",
                          "-fbdir", folder.c_str(), "-nolisten",    "tcp",     nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addclose(&actions, ends[0]);
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    if (posix_spawnp(&pid_, "Xvfb", &actions, nullptr, const_cast<char* const*>(argv), environ) != 0) pid_ = 0;
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    // "N\n", written in two pieces: closing early would kill the server with SIGPIPE.
    std::string text;
    for (char c = 0; pid_ && c != '\n' && read(ends[0], &c, 1) == 1;) text += c;
    if (!text.empty()) display_ = fmt::format(":{}", std::atoi(text.c_str()));
    close(ends[0]);
    if (!display_.empty()) setenv("DISPLAY", display_.c_str(), 1);
  }
  ~VirtualDisplay() {
    if (!pid_) return;
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
    unsetenv("DISPLAY");
  }
  bool running() const { return !display_.empty(); }

  /// How many of the screen's pixels have this colour (0xRRGGBB).
  int count(uint32_t rgb) const {
    std::ifstream in(folder_.path / "Xvfb_screen0", std::ios::binary);
    const std::string file((std::istreambuf_iterator<char>(in)), {});
    const auto word = [&](size_t i) {  // the header is big-endian
      uint32_t v = 0;
      for (size_t b = 0; b < 4; ++b) v = v << 8 | static_cast<uint8_t>(file[4 * i + b]);
      return v;
    };
    if (file.size() < 100) return -1;
    const uint32_t header = word(0), width = word(4), height = word(5), stride = word(12), colors = word(19);
    int n = 0;
    for (uint32_t y = 0; y < height; ++y)
      for (uint32_t x = 0; x < width; ++x) {
        uint32_t pixel;
        std::memcpy(&pixel, file.data() + header + 12ull * colors + uint64_t{y} * stride + 4ull * x, 4);
        n += (pixel & 0xFFFFFF) == rgb;
      }
    return n;
  }

 private:
  TemporaryFolder folder_;
  pid_t pid_ = 0;
  std::string display_;
};

/// Left half red, right half green.
Image halves(Context& context, uint32_t width, uint32_t height) {
  Image image(context.device,
              {.name = "picture", .format = VK_FORMAT_R8G8B8A8_UNORM, .width = width, .height = height});
  std::vector<uint32_t> texels(width * height);
  for (uint32_t i = 0; i < texels.size(); ++i) texels[i] = i % width < width / 2 ? 0xFF0000FFu : 0xFF00FF00u;
  upload(context, image, std::as_bytes(std::span(texels)));
  return image;
}

TEST(Presenter, ShowsResizesAndCloses) {
  VirtualDisplay display;
  if (!display.running()) GTEST_SKIP() << "Xvfb is not installed";
  const auto device = Device::create({.validate = true, .presentable = true});
  ShaderLibrary shaders;
  Timings timings;
  {
    Context context(*device, shaders, timings);
    Presenter presenter("irad test", 320, 200);
    presenter.attach(context);
    const auto show = [&](const Image& image, int frames) {
      for (int i = 0; i < frames; ++i) {
        ASSERT_TRUE(presenter.poll());
        ASSERT_TRUE(presenter.acquire());
        Frame frame = context.begin(i);
        presenter.present(frame, image);
      }
    };
    // Waits until the display shows the picture: presentation is asynchronous.
    const auto shown = [&](const Image& image, int red) {
      for (int i = 0; i < 200 && display.count(0xFF0000) != red; ++i) {
        show(image, 1);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
      EXPECT_EQ(display.count(0xFF0000), red);
      EXPECT_EQ(display.count(0x00FF00), red);
    };
    const Image picture = halves(context, 320, 200);
    show(picture, 20);
    EXPECT_EQ(presenter.framebufferSize(), glm::uvec2(320, 200));
    shown(picture, 160 * 200);
    EXPECT_EQ(presenter.rebuilds(), 1u);

    // The swapchain follows the window.
    presenter.resize(400, 300);
    for (int i = 0; i < 200 && presenter.framebufferSize() != glm::uvec2(400, 300); ++i) {
      presenter.poll();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ASSERT_EQ(presenter.framebufferSize(), glm::uvec2(400, 300));
    const Image larger = halves(context, 400, 300);
    show(larger, 20);
    shown(larger, 200 * 300);
    EXPECT_GE(presenter.rebuilds(), 2u);

    // An acquired image that is never presented, and a frame dropped in between.
    ASSERT_TRUE(presenter.acquire());
    { Frame dropped = context.begin(); }
    ASSERT_TRUE(presenter.acquire());
    show(larger, 3);
    ASSERT_TRUE(presenter.acquire());

    // Attached again, as after a lost device or a device change.
    presenter.detach();
    presenter.attach(context);
    show(larger, 3);
    shown(larger, 200 * 300);
  }
  for (const std::string& message : device->validationMessages()) ADD_FAILURE() << message;
}

TEST(Presenter, NoDisplayIsAnErrorInWords) {
  const char* before = std::getenv("DISPLAY");
  const std::string kept = before ? before : "";
  setenv("DISPLAY", ":987", 1);
  try {
    Presenter presenter("irad test", 64, 64);
    ADD_FAILURE() << "a window without a display";
  } catch (const DeviceError& error) {
    EXPECT_EQ(error.exitStatus, 4);
    EXPECT_NE(std::string(error.what()).find("no window"), std::string::npos) << error.what();
  }
  if (before)
    setenv("DISPLAY", kept.c_str(), 1);
  else
    unsetenv("DISPLAY");
}

}  // namespace
}  // namespace irad::test

#else

TEST(Presenter, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_UI";
}

#endif
