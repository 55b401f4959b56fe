// The window on a virtual display: what is presented is what the display shows, before and after a resize.
#include <gtest/gtest.h>

#if IRAD_UI

#include "renderer/base/error.h"
#include "renderer/presenter.h"
#include "tests/virtual_screen.h"

namespace irad::test::presenter_suite {
namespace {

constexpr std::chrono::seconds kPatience{60};  ///< on a busy machine the display takes its time

/// Left half red, right half green.
Image halves(Context& context, uint32_t width, uint32_t height) {
  Image image(context.device,
              {.name = "picture", .format = VK_FORMAT_R8G8B8A8_UNORM, .width = width, .height = height});
  std::vector<uint32_t> texels(width * height);
  for (uint32_t i = 0; i < texels.size(); ++i) texels[i] = i % width < width / 2 ? 0xFF0000FFu : 0xFF00FF00u;
  upload(context, image, std::as_bytes(std::span(texels)));
  return image;
}

/// A window of 320 x 200 on a screen of its own, on a validated device.
class PresenterTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!installed("Xvfb")) GTEST_SKIP() << "Xvfb is not installed: the presenter is not tested";
    screen_ = std::make_unique<VirtualScreen>(640, 480);
    setenv("DISPLAY", screen_->display().c_str(), 1);
    device_ = Device::create({.validate = true, .presentable = true});
    context_ = std::make_unique<Context>(*device_, shaders_, timings_);
    presenter_ = std::make_unique<Presenter>("irad test", 320, 200);
    presenter_->attach(*context_);
  }
  void TearDown() override {
    presenter_.reset();
    context_.reset();
    if (device_)
      for (const std::string& message : device_->validationMessages()) ADD_FAILURE() << message;
    device_.reset();
    unsetenv("DISPLAY");
  }
  void show(const Image& image, int frames) {
    for (int i = 0; i < frames; ++i) {
      ASSERT_TRUE(presenter_->poll());
      ASSERT_TRUE(presenter_->acquire());
      Frame frame = context_->begin();
      presenter_->present(frame, image);
    }
  }
  /// Waits until the display shows so many red and as many green pixels: presentation is asynchronous.
  void shown(const Image& image, int red) {
    const auto count = [&](uint32_t color) { return screen_->grab(0, 0, 640, 480).count(color); };
    for (const auto end = Clock::now() + kPatience; count(0xFF0000) != red && Clock::now() < end;) {
      show(image, 1);
      pause(0.01);
    }
    EXPECT_EQ(count(0xFF0000), red);
    EXPECT_EQ(count(0x00FF00), red);
  }

  std::unique_ptr<VirtualScreen> screen_;
  std::unique_ptr<Device> device_;
  ShaderLibrary shaders_;
  Timings timings_;
  std::unique_ptr<Context> context_;
  std::unique_ptr<Presenter> presenter_;
};

TEST_F(PresenterTest, ShowsResizesAndCloses) {
  const Image picture = halves(*context_, 320, 200);
  show(picture, 20);
  EXPECT_EQ(presenter_->framebufferSize(), glm::uvec2(320, 200));
  shown(picture, 160 * 200);
  EXPECT_EQ(presenter_->rebuilds(), 1u);

  // The swapchain follows the window.
  presenter_->resize(400, 300);
  for (const auto end = Clock::now() + kPatience;
       presenter_->framebufferSize() != glm::uvec2(400, 300) && Clock::now() < end;) {
    presenter_->poll();
    pause(0.01);
  }
  ASSERT_EQ(presenter_->framebufferSize(), glm::uvec2(400, 300));
  const Image larger = halves(*context_, 400, 300);
  show(larger, 20);
  shown(larger, 200 * 300);
  EXPECT_GE(presenter_->rebuilds(), 2u);

  // An acquired image that is never presented, and a frame dropped in between.
  ASSERT_TRUE(presenter_->acquire());
  { Frame dropped = context_->begin(); }
  ASSERT_TRUE(presenter_->acquire());
  show(larger, 3);
  ASSERT_TRUE(presenter_->acquire());

  // Attached again, as after a lost device or a device change.
  presenter_->detach();
  presenter_->attach(*context_);
  show(larger, 3);
  shown(larger, 200 * 300);
}

// Answers that a display may give but Xvfb never does, injected into the driver. Each is given once.
PFN_vkAcquireNextImageKHR driversAcquire;
PFN_vkQueuePresentKHR driversPresent;
PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR driversCapabilities;
VkResult acquireAnswer, presentAnswer, capabilitiesAnswer;
bool noArea;

VkResult answer(VkResult& once) {
  return std::exchange(once, VK_SUCCESS);
}

class MoodyDisplay : public PresenterTest {
 protected:
  void SetUp() override {
    PresenterTest::SetUp();
    if (IsSkipped()) return;
    driversAcquire =
        std::exchange(vkAcquireNextImageKHR, [](VkDevice device, VkSwapchainKHR swapchain, uint64_t timeout,
                                                VkSemaphore semaphore, VkFence fence, uint32_t* image) {
          const VkResult result = answer(acquireAnswer);
          return result ? result : driversAcquire(device, swapchain, timeout, semaphore, fence, image);
        });
    driversPresent = std::exchange(vkQueuePresentKHR, [](VkQueue queue, const VkPresentInfoKHR* info) {
      const VkResult result = driversPresent(queue, info);  // the semaphore is waited for in any case
      return result ? result : answer(presentAnswer);
    });
    driversCapabilities =
        std::exchange(vkGetPhysicalDeviceSurfaceCapabilitiesKHR,
                      [](VkPhysicalDevice device, VkSurfaceKHR surface, VkSurfaceCapabilitiesKHR* capabilities) {
                        if (const VkResult result = answer(capabilitiesAnswer)) return result;
                        const VkResult result = driversCapabilities(device, surface, capabilities);
                        if (noArea) capabilities->currentExtent = {0, 0};
                        return result;
                      });
  }
  void TearDown() override {
    if (driversAcquire) {
      vkAcquireNextImageKHR = driversAcquire;
      vkQueuePresentKHR = driversPresent;
      vkGetPhysicalDeviceSurfaceCapabilitiesKHR = driversCapabilities;
    }
    PresenterTest::TearDown();
  }
};

TEST_F(MoodyDisplay, OutdatedAndLostSurfacesAreMadeAnew) {
  const Image picture = halves(*context_, 320, 200);
  shown(picture, 160 * 200);
  ASSERT_EQ(presenter_->rebuilds(), 1u);
  uint32_t rebuilds = 1;
  for (VkResult* where : {&acquireAnswer, &presentAnswer})
    for (const VkResult result : {VK_ERROR_OUT_OF_DATE_KHR, VK_ERROR_SURFACE_LOST_KHR}) {
      *where = result;
      show(picture, 3);
      EXPECT_EQ(presenter_->rebuilds(), ++rebuilds);
      shown(picture, 160 * 200);
    }
  // The surface is lost again while it is being made: this frame is skipped, the next one shown.
  acquireAnswer = capabilitiesAnswer = VK_ERROR_SURFACE_LOST_KHR;
  EXPECT_FALSE(presenter_->acquire());
  show(picture, 3);
  EXPECT_EQ(presenter_->rebuilds(), ++rebuilds);
  // Anything else is an error in words.
  acquireAnswer = VK_ERROR_OUT_OF_HOST_MEMORY;
  EXPECT_THROW(presenter_->acquire(), Error);
  shown(picture, 160 * 200);
}

TEST_F(MoodyDisplay, WithoutAreaFramesAreSkipped) {
  const Image picture = halves(*context_, 320, 200);
  shown(picture, 160 * 200);
  noArea = true;
  acquireAnswer = VK_ERROR_OUT_OF_DATE_KHR;
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(presenter_->acquire());
  noArea = false;
  shown(picture, 160 * 200);
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
}  // namespace irad::test::presenter_suite

#else

TEST(Presenter, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_UI";
}

#endif
