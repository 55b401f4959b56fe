// The window's loop in this process, under a display that says what Xvfb never does: that a window has no area.
#include <gtest/gtest.h>

#if IRAD_UI

#include <sys/resource.h>

#include <atomic>

#include "tests/virtual_screen.h"
#include "ui/window.h"

namespace irad::test {
namespace {

std::atomic<bool> iconified = false;
PFN_vkAcquireNextImageKHR driversAcquire;
PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR driversCapabilities;

double processSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](timeval t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

TEST(WindowLoop, SleepsWhileItHasNoArea) {
  for (const char* program : {"Xvfb", "xdotool"})
    if (!installed(program)) GTEST_SKIP() << program << " is not installed: the window is not tested";
  const VirtualScreen screen(1280, 720);
  setenv("DISPLAY", screen.display().c_str(), 1);
  const auto device = Device::create({.validate = true, .presentable = true});
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

  // The user, on a thread of its own: the window's loop belongs to this one.
  std::thread user([&screen] {
    const auto viewport = [&] { return screen.grab(400, 100, 500, 380); };
    const auto until = [](const std::function<bool()>& holds) {
      for (int i = 0; i < 1200; ++i) {
        if (holds()) return true;
        pause(0.05);
      }
      return false;
    };
    const auto still = [&] {
      const ScreenPart before = viewport();
      const double used = processSeconds();
      pause(1);
      return processSeconds() - used <= 0.05 && before.deviation() > 0.02 && viewport() == before;
    };
    screen.xdotool("mousemove 360 510");  // out of this part: the server draws its pointer into the framebuffer
    EXPECT_TRUE(until(still)) << "no picture";
    const ScreenPart first = viewport();

    // Another view is wanted while nothing can be drawn: no frame, and no spinning either.
    iconified = true;
    screen.key("2");
    pause(1);
    const double used = processSeconds();
    pause(2);
    EXPECT_LE(processSeconds() - used, 0.1) << "seconds of processor time in 2 s without area";
    EXPECT_EQ(viewport(), first);

    // It comes with the area, without any further event.
    iconified = false;
    EXPECT_TRUE(until([&] { return viewport().difference(first) > 0.05; })) << "nothing is drawn once there is area";
    screen.key("Escape");
  });
  {
    ShaderLibrary shaders;
    Timings timings;
    Context context(*device, shaders, timings);
    WindowOptions options;
    options.scene = assets() / "box.glb";
    options.settings = options.defaults = defaultSettings(/*cpuDevice=*/true);
    options.settings.voxel.resolution = 24;
    options.settings.matrix.gpu.rays = 16;
    options.settings.specular.mode = SpecularMode::off;
    EXPECT_NO_THROW(runWindow(context, options));
  }
  user.join();
  vkAcquireNextImageKHR = driversAcquire;
  vkGetPhysicalDeviceSurfaceCapabilitiesKHR = driversCapabilities;
  for (const std::string& message : device->validationMessages()) ADD_FAILURE() << message;
  unsetenv("DISPLAY");
}

}  // namespace
}  // namespace irad::test

#else

TEST(WindowLoop, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_UI";
}

#endif
