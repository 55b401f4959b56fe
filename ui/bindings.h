// Every key of the window, once: what it does, and how the help overlay names it.
#pragma once

#include <span>

namespace irad {

enum class Action {
  None,
  Help,
  HideUi,
  FillWindow,
  LargerUi,
  SmallerUi,
  ReloadShaders,
  Capture,
  CaptureAll,
  Pause,
  Close,
  Quit,
  NextCamera,
  Open,
  FindSetting,
  Flicker,
  Undo,
  Redo,
  FrameSelected,
  FrameAll,
  HideObject,
  IsolateObject,
  ShowAllObjects,
  WholePicture
};

struct Binding {
  int key;  ///< GLFW key; 0: listed in the help only
  Action action;
  const char* keys;
  const char* does;                     ///< null: another row of the help says so
  bool shift = false, control = false;  ///< only with it; listed before the row of the same key without
};
std::span<const Binding> bindings();

}  // namespace irad
