// Events of the window that ImGui does not take: key presses, flying keys with the time they were held, dropped files.
#pragma once

#include <array>
#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

struct GLFWwindow;

namespace irad {

class Input {
 public:
  /// Installs GLFW callbacks and takes the window's user pointer; ImGuiLayer chains to them, so this comes first.
  explicit Input(GLFWwindow* window);
  Input(const Input&) = delete;

  bool takeEvent();    ///< anything happened since the last call
  bool takeRefresh();  ///< what the window shows was lost since the last call
  struct Press {
    int key;              ///< GLFW's; with Ctrl that of the letter that is printed on it, whatever the layout
    bool shift, control;  ///< was held
  };
  std::vector<Press> takePresses();  ///< since the last call
  std::vector<std::filesystem::path> takeDrops();
  /// Seconds for which each direction (right, up, forward) was held since the last call, so that a short tap between
  /// two slow frames counts for as long as it lasted (1/30 s at least).
  glm::vec3 takeMovement();
  bool flying() const;  ///< a flying key is down
  bool shift() const;
  bool control() const;

 private:
  void key(int key, int scancode, int action, int modifiers);
  struct Held {
    int key;
    glm::vec3 direction;
    double since = -1;  ///< seconds; < 0: up
    double held = 0;
  };
  GLFWwindow* window_;
  std::array<Held, 6> held_;
  bool event_ = true, refresh_ = false;
  std::vector<Press> presses_;
  std::vector<std::filesystem::path> drops_;
};

}  // namespace irad
