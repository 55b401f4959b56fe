#include "ui/bindings.h"

#include <GLFW/glfw3.h>

namespace irad {

std::span<const Binding> bindings() {
  static constexpr Binding table[] = {
      {0, Action::None, "W A S D", "fly forward, left, back, right"},
      {0, Action::None, "Q  E", "fly down, up"},
      {0, Action::None, "Right or left drag", "look around; with Alt turn about what is chosen"},
      {0, Action::None, "Left drag of a light", "move it, with Shift along the view; its square aims it"},
      {0, Action::None, "Click", "inspect the facet there; beside everything: done"},
      {0, Action::None, "Shift + click", "compare its row with that of the facet there"},
      {0, Action::None, "Shift  Ctrl", "fly 4 times faster, slower"},
      {0, Action::None, "Wheel", "flying speed"},
      {0, Action::None, "Drag an edge", "size of the panels; double click: as it was"},
      {0, Action::None, "1 \u2026 9", "the first nine views"},
      {GLFW_KEY_O, Action::Open, "O", "open a scene"},
      {GLFW_KEY_C, Action::NextCamera, "C", "the next camera or bookmark"},
      {GLFW_KEY_F, Action::FrameSelected, "F  Home", "what is chosen, or the scene, fills the picture"},
      {GLFW_KEY_HOME, Action::FrameAll, "Home", nullptr},
      {GLFW_KEY_X, Action::Flicker, "X", "of two compared sides, show the other"},
      {GLFW_KEY_SPACE, Action::Pause, "Space", "pause or resume the solver"},
      {GLFW_KEY_F1, Action::Help, "F1", "this list"},
      {GLFW_KEY_F2, Action::HideUi, "F2", "hide or show the panels"},
      {GLFW_KEY_F5, Action::ReloadShaders, "F5", "compile the shaders again"},
      {GLFW_KEY_F12, Action::CaptureAll, "Shift + F12", "save all views", /*shift=*/true},
      {GLFW_KEY_F12, Action::Capture, "F12", "save this view: PNG, EXR, manifest"},
      {GLFW_KEY_ESCAPE, Action::Close, "Esc",
       "close what is on top: a list or menu, a dialog, the help, work in\n"
       "progress, the inspected facet, the chosen light, the comparison"},
      {GLFW_KEY_Q, Action::Quit, "Ctrl + Q", "quit; what is unsaved is asked for", /*shift=*/false, /*control=*/true},
  };
  return table;
}

}  // namespace irad
