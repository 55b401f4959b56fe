#include "ui/input.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

namespace irad {

namespace {
constexpr double kShortestTap = 1.0 / 30.0;  ///< seconds
Input& of(GLFWwindow* window);

/// GLFW names keys by their place on a US keyboard, where others have Z and Y, or A and Q, the other way round.
int printedKey(int key, int scancode) {
  const char* name = glfwGetKeyName(key, scancode);
  return name && name[1] == 0 && name[0] >= 'a' && name[0] <= 'z' ? GLFW_KEY_A + (name[0] - 'a') : key;
}
}  // namespace

Input::Input(GLFWwindow* window)
    : window_(window), held_{Held{GLFW_KEY_D, {1, 0, 0}},  Held{GLFW_KEY_A, {-1, 0, 0}}, Held{GLFW_KEY_E, {0, 1, 0}},
                             Held{GLFW_KEY_Q, {0, -1, 0}}, Held{GLFW_KEY_W, {0, 0, 1}},  Held{GLFW_KEY_S, {0, 0, -1}}} {
  glfwSetWindowUserPointer(window, this);
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int modifiers) {
    of(w).key(key, scancode, action, modifiers);
  });
  glfwSetCharCallback(window, [](GLFWwindow* w, unsigned) { of(w).event_ = true; });
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double, double) { of(w).event_ = true; });
  glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int) { of(w).event_ = true; });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int, int, int) { of(w).event_ = true; });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double, double) { of(w).event_ = true; });
  glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { of(w).event_ = of(w).refresh_ = true; });
  glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
    of(w).event_ = true;
    if (!focused)  // releases are not delivered to a window without focus
      for (Held& held : of(w).held_) of(w).key(held.key, 0, GLFW_RELEASE, 0);
  });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    of(w).event_ = true;
    for (int i = 0; i < count; ++i) of(w).drops_.emplace_back(paths[i]);
  });
}

namespace {
Input& of(GLFWwindow* window) {
  return *static_cast<Input*>(glfwGetWindowUserPointer(window));
}
}  // namespace

void Input::key(int key, int scancode, int action, int modifiers) {
  event_ = true;
  const bool control = (modifiers & GLFW_MOD_CONTROL) != 0;
  if (action == GLFW_PRESS)
    presses_.push_back({control ? printedKey(key, scancode) : key, (modifiers & GLFW_MOD_SHIFT) != 0, control});
  const double now = glfwGetTime();
  for (Held& held : held_) {
    if (held.key != key) continue;
    const bool quits = control && printedKey(key, scancode) == GLFW_KEY_Q;
    if (action == GLFW_PRESS && !quits) held.since = now;
    if (action == GLFW_RELEASE && held.since >= 0) {
      held.held += std::max(now - held.since, held.held > 0 ? 0.0 : kShortestTap);
      held.since = -1;
    }
  }
}

bool Input::takeEvent() {
  return std::exchange(event_, false);
}
bool Input::takeRefresh() {
  return std::exchange(refresh_, false);
}
std::vector<Input::Press> Input::takePresses() {
  return std::exchange(presses_, {});
}
std::vector<std::filesystem::path> Input::takeDrops() {
  return std::exchange(drops_, {});
}

glm::vec3 Input::takeMovement() {
  const double now = glfwGetTime();
  glm::vec3 movement(0.0f);
  for (Held& held : held_) {
    if (held.since >= 0) {
      held.held += now - held.since;
      held.since = now;
    }
    movement += held.direction * static_cast<float>(held.held);
    held.held = 0;
  }
  return movement;
}

bool Input::flying() const {
  return std::any_of(held_.begin(), held_.end(), [](const Held& held) { return held.since >= 0; });
}

bool Input::shift() const {
  return glfwGetKey(window_, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ||
         glfwGetKey(window_, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
}
bool Input::control() const {
  return glfwGetKey(window_, GLFW_KEY_LEFT_CONTROL) == GLFW_PRESS ||
         glfwGetKey(window_, GLFW_KEY_RIGHT_CONTROL) == GLFW_PRESS;
}

}  // namespace irad
