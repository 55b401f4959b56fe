// A window that shows an image: GLFW window, surface, swapchain, and a blit. Built with IRAD_UI only.
//
//   const auto device = Device::create({.presentable = true});
//   Presenter presenter("irad", 1280, 720);
//   presenter.attach(context);
//   while (presenter.poll())
//     if (presenter.acquire()) { Frame frame = context.begin(); ...; presenter.present(frame, image); }
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <string>

#include "renderer/frame/frame.h"

struct GLFWwindow;

namespace irad {

class Presenter {
 public:
  /// Opens the window; throws DeviceError in words where there is no display. Sizes in screen coordinates.
  Presenter(const std::string& title, int width, int height);
  ~Presenter();
  Presenter(const Presenter&) = delete;

  /// Makes surface and swapchain on the context's device, which must have been created `presentable`. Detach (or
  /// destroy) before that device goes.
  void attach(Context& context);
  void detach();

  /// Handles the window's events; waits up to `waitSeconds` for one. False once the window should close.
  bool poll(double waitSeconds = 0);
  /// Gets the next swapchain image, rebuilding what a resize or a lost surface has outdated. False: nothing can be
  /// shown now (the window is iconified): skip the frame.
  bool acquire();
  /// Blits `image` over the whole window as the frame's last pass, submits the frame, and queues the presentation. The
  /// image's values are shown as they are: encoded for the display.
  void present(Frame& frame, const Image& image);

  GLFWwindow* window() const;
  glm::uvec2 framebufferSize() const;  ///< pixels; 0 while iconified
  void resize(int width, int height);  ///< screen coordinates
  uint32_t rebuilds() const;           ///< how often the swapchain was made

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace irad
