// Keys, mouse and window manager of an X display, for tests: by libxdo, the library of xdotool(1).
#pragma once

#include <memory>
#include <string>

namespace irad::test {

class SyntheticInput {
 public:
  /// std::runtime_error where there is no such display.
  explicit SyntheticInput(const std::string& display);
  ~SyntheticInput();

  /// xdotool's words, one command after another:
  ///   mousemove X Y, mousedown BUTTON, mouseup BUTTON, click [--repeat N] [--delay MS] BUTTON,
  ///   key [--delay MS] KEYS, keydown KEYS, keyup KEYS, sleep SECONDS,
  /// and of the window whose title holds "irad": windowsize WIDTH HEIGHT, windowmap, windowunmap.
  /// The server has passed all of it on when this returns. std::runtime_error names what it cannot do.
  void act(const std::string& commands);
  /// Characters, one in 15 ms.
  void type(const std::string& text);

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace irad::test
