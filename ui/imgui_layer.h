// Dear ImGui on our device: its GLFW half feeds events, this draws its triangles as one pass of the frame ("UI").
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "renderer/frame.h"

struct GLFWwindow;

namespace irad {

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
  /// Registers an image for this frame and returns what ImGui::Image takes; UI_TEXTURES - 1 of them at most. The image
  /// must live until the frame has been submitted.
  void* texture(const Image& image);
  /// Ends ImGui's frame and records the pass onto `target`, cleared to the theme's background first.
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
