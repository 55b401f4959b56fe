#include "tests/synthetic_input.h"

#include <gtest/gtest.h>  // before X11's macros

#include <sstream>
#include <stdexcept>

#include "tests/file_drop.h"

extern "C" {
#include <xdo.h>
}

namespace irad::test {
namespace {

constexpr useconds_t kMillisecond = 1000, kKeyDelay = 12 * kMillisecond;  // as xdotool's own

}  // namespace

struct SyntheticInput::Connection {
  explicit Connection(const std::string& display) : xdo(xdo_new(display.c_str()), xdo_free) {
    if (!xdo) throw std::runtime_error("no X display " + display);
  }
  const std::unique_ptr<xdo_t, void (*)(xdo_t*)> xdo;
};

SyntheticInput::SyntheticInput(const std::string& display) : connection_(std::make_unique<Connection>(display)) {}
SyntheticInput::~SyntheticInput() = default;

void SyntheticInput::act(const std::string& commands) {
  const xdo_t* xdo = connection_->xdo.get();
  std::istringstream in(commands);
  const auto next = [&]<class T>(T value) {
    if (!(in >> value)) throw std::runtime_error(commands + ": not enough words");
    return value;
  };
  /// Its value where the next word is this option.
  const auto option = [&](const std::string& name, int otherwise) {
    const auto before = in.tellg();
    if (std::string word; in >> word && word == name) return next(0);
    in.clear();
    in.seekg(before);
    return otherwise;
  };
  const auto window = [&] {
    const Window found = windowTitled(xdo->xdpy, "irad");
    if (!found) throw std::runtime_error(commands + ": there is no such window");
    return found;
  };
  for (std::string command; in >> command;) {
    int failed = 0;
    if (command == "mousemove") {
      const int x = next(0), y = next(0);
      failed = xdo_move_mouse(xdo, x, y, /*screen=*/0);
    } else if (command == "mousedown") {
      failed = xdo_mouse_down(xdo, CURRENTWINDOW, next(0));
    } else if (command == "mouseup") {
      failed = xdo_mouse_up(xdo, CURRENTWINDOW, next(0));
    } else if (command == "click") {
      const int repeat = option("--repeat", 1), delay = option("--delay", 12);
      failed =
          xdo_click_window_multiple(xdo, CURRENTWINDOW, next(0), repeat, static_cast<useconds_t>(delay) * kMillisecond);
    } else if (command == "key") {
      const int delay = option("--delay", 12);
      failed = xdo_send_keysequence_window(xdo, CURRENTWINDOW, next(std::string()).c_str(),
                                           static_cast<useconds_t>(delay) * kMillisecond);
    } else if (command == "keydown") {
      failed = xdo_send_keysequence_window_down(xdo, CURRENTWINDOW, next(std::string()).c_str(), kKeyDelay);
    } else if (command == "keyup") {
      failed = xdo_send_keysequence_window_up(xdo, CURRENTWINDOW, next(std::string()).c_str(), kKeyDelay);
    } else if (command == "sleep") {
      XFlush(xdo->xdpy);
      pause(next(0.0));
    } else if (command == "windowsize") {
      const int width = next(0), height = next(0);
      failed = xdo_set_window_size(xdo, window(), width, height, /*flags=*/0);
    } else if (command == "windowmap") {
      failed = xdo_map_window(xdo, window());
    } else if (command == "windowunmap") {
      failed = xdo_unmap_window(xdo, window());
    } else {
      throw std::runtime_error(commands + ": what is '" + command + "'?");
    }
    if (failed != 0) throw std::runtime_error(commands + ": '" + command + "' failed");
  }
  XSync(xdo->xdpy, /*discard=*/False);
}

void SyntheticInput::type(const std::string& text) {
  if (xdo_enter_text_window(connection_->xdo.get(), CURRENTWINDOW, text.c_str(), 15 * kMillisecond) != 0)
    throw std::runtime_error("'" + text + "' cannot be typed");
  XSync(connection_->xdo->xdpy, /*discard=*/False);
}

}  // namespace irad::test
