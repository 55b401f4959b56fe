// Dear ImGui on our device: its GLFW half feeds events, this draws its triangles ("UI" in the timings).
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "renderer/frame/frame.h"

struct GLFWwindow;

namespace irad {

namespace Subsystem {
inline constexpr SubsystemName Ui{"ui"};
}

class ImGuiLayer {
 public:
  /// Chains to the GLFW callbacks that are installed already.
  ImGuiLayer(Context& context, GLFWwindow* window);
  ~ImGuiLayer();
  ImGuiLayer(const ImGuiLayer&) = delete;

  /// Fonts and sizes for `scale` pixels per unit (the monitor's content scale times the user's). Cheap when unchanged.
  void setScale(float scale);
  float scale() const { return scale_; }

  void beginFrame();
  /// Registers an image for this frame and returns what ImGui::Image takes. It must live until the frame is submitted.
  void* texture(const Image& image);
  /// Ends ImGui's frame and records it onto `target`, cleared to the theme's background first: one pass for each run of
  /// draws with the same image, two or three in all.
  void draw(Frame& frame, const Image& target);

 private:
  void buildFonts();

  Context& context_;
  float scale_ = 0;
  Image atlas_;
  std::vector<const Image*> textures_;
  Buffer vertices_, indices_;  ///< of the last frame; freed when the device has finished with it
};

}  // namespace irad
