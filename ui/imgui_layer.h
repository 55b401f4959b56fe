// Dear ImGui on our device: its GLFW half feeds events, this draws its triangles ("UI" in the timings).
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "renderer/frame/frame.h"

struct GLFWwindow;

namespace irad {

namespace Subsystem {
inline constexpr SubsystemName Ui{"ui"};
}

/// How a window shows an image.
struct ImageUse {
  bool blends = false;   ///< by its alpha, which pictures have for other ends
  bool nearest = false;  ///< its texels are told apart, however large they are shown
  bool operator==(const ImageUse&) const = default;
};

/// A picture for texture(), of bytes as screens show them, top row first. Between frames.
Image imageOf(Context& context, const char* name, glm::uvec2 size, std::span<const glm::u8vec4> pixels);

class ImGuiLayer {
 public:
  /// Chains to the GLFW callbacks that are installed already.
  ImGuiLayer(Context& context, GLFWwindow* window);
  ~ImGuiLayer();
  ImGuiLayer(const ImGuiLayer&) = delete;

  /// Fonts and sizes for `scale` pixels per unit (the monitor's content scale times the user's). Cheap when unchanged.
  void setScale(float scale);
  float scale() const { return scale_; }

  /// Asks the window system for the window's size, its focus and the mouse (under X11 four round trips to the server),
  /// before each beginFrame().
  void takeInput();
  void beginFrame();
  /// Registers an image for this frame and returns what ImGui::Image takes. It must live until the frame is submitted.
  void* texture(const Image& image, ImageUse use = {});
  /// Ends ImGui's frame. False: its triangles, and the images on them, are those that were drawn last (what is in these
  /// images may be other).
  bool endFrame();
  /// Records the frame that has ended onto `target`, cleared to the theme's background first: one pass for each run of
  /// draws with the same image, two or three in all.
  void draw(Frame& frame, const Image& target);

 private:
  struct Triangles;
  void buildFonts();
  /// The wheel over a list that has come to its end turns the list or column around it, in which ImGui would trap it.
  void passWheelOn();

  Context& context_;
  float scale_ = 0;
  Image atlas_;
  struct Texture {
    const Image* image;
    ImageUse use;
  };
  std::vector<Texture> textures_;
  std::unique_ptr<Triangles> ended_, drawn_;
};

}  // namespace irad
