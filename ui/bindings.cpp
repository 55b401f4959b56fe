#include "ui/bindings.h"

#include <GLFW/glfw3.h>

namespace irad {

std::span<const Binding> bindings() {
  static constexpr Binding table[] = {
      {0, Action::None, "W A S D", "fly forward, left, back, right"},
      {0, Action::None, "Q  E", "fly down, up"},
      {0, Action::None, "Right or left drag", "look around; with Alt turn about what is chosen"},
      {0, Action::None, "Left drag of a light",
       "move it; with Shift along the line of sight, with Ctrl onto\n"
       "the surface there; its axes move it along themselves"},
      {0, Action::None, "Click", "inspect the facet there, choose its object; on the background: end that"},
      {0, Action::None, "Shift + click", "compare its row with that of the facet there"},
      {0, Action::None, "Shift  Ctrl", "fly 4 times faster, slower"},
      {0, Action::None, "Wheel", "flying speed; with Ctrl zoom into the picture's pixels, about the mouse"},
      {0, Action::None, "Middle drag", "move the picture that is zoomed into"},
      {GLFW_KEY_0, Action::WholePicture, "0", "the whole picture again, a pixel for a pixel"},
      {0, Action::None, "Drag an edge", "size of the panels; double click: as it was"},
      {0, Action::None, "1 \u2026 9", "the first nine views"},
      {GLFW_KEY_Z, Action::Redo, "Ctrl + Shift + Z", nullptr, /*shift=*/true, /*control=*/true},
      {GLFW_KEY_Z, Action::Undo, "Ctrl + Z", "undo; Ctrl + Shift + Z or Ctrl + Y: redo", /*shift=*/false,
       /*control=*/true},
      {GLFW_KEY_Y, Action::Redo, "Ctrl + Y", nullptr, /*shift=*/false, /*control=*/true},
      {GLFW_KEY_O, Action::Open, "O", "open a scene"},
      {GLFW_KEY_C, Action::NextCamera, "C", "the next camera or bookmark"},
      {GLFW_KEY_F, Action::FindSetting, "Ctrl + F", "find a setting", /*shift=*/false, /*control=*/true},
      {GLFW_KEY_F, Action::FrameSelected, "F  Home", "what is chosen, or the scene, fills the picture"},
      {GLFW_KEY_HOME, Action::FrameAll, "Home", nullptr},
      {GLFW_KEY_H, Action::ShowAllObjects, "Ctrl + H", nullptr, /*shift=*/false, /*control=*/true},
      {GLFW_KEY_H, Action::IsolateObject, "Shift + H", nullptr, /*shift=*/true},
      {GLFW_KEY_H, Action::HideObject, "H", "hide or show the chosen object; with Shift: it alone; with Ctrl: all"},
      {GLFW_KEY_X, Action::Flicker, "X", "of two compared sides, show the other"},
      {GLFW_KEY_SPACE, Action::Pause, "Space", "pause or resume the solver"},
      {GLFW_KEY_F1, Action::Help, "F1", "this list"},
      {GLFW_KEY_TAB, Action::FillWindow, "Tab", "the picture fills the window, or the panels are back"},
      {GLFW_KEY_F2, Action::HideUi, "F2", "the same without menus: the picture alone, with its time"},
      {GLFW_KEY_EQUAL, Action::LargerUi, "Ctrl + +", "text and panels larger; Ctrl + -: smaller", /*shift=*/false,
       /*control=*/true},
      {GLFW_KEY_KP_ADD, Action::LargerUi, "Ctrl + +", nullptr, /*shift=*/false, /*control=*/true},
      {GLFW_KEY_MINUS, Action::SmallerUi, "Ctrl + -", nullptr, /*shift=*/false, /*control=*/true},
      {GLFW_KEY_KP_SUBTRACT, Action::SmallerUi, "Ctrl + -", nullptr, /*shift=*/false, /*control=*/true},
      {GLFW_KEY_F5, Action::ReloadShaders, "F5", "compile the shaders again"},
      {GLFW_KEY_F12, Action::CaptureAll, "Shift + F12", "save all views", /*shift=*/true},
      {GLFW_KEY_F12, Action::Capture, "F12", "save this view: PNG, EXR, manifest"},
      {GLFW_KEY_ESCAPE, Action::Close, "Esc",
       "close what is on top: a list or menu, a dialog, the help, work in\n"
       "progress, the inspected facet, the chosen object, the chosen\n"
       "light, the comparison"},
      {GLFW_KEY_Q, Action::Quit, "Ctrl + Q", "quit; what is unsaved is asked for", /*shift=*/false, /*control=*/true},
  };
  return table;
}

}  // namespace irad
