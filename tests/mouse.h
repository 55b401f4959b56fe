// The mouse of a virtual screen, moved and pressed so that a window that was started with --controls FILE sees it: a
// busy device draws seldom, and what comes and goes between two frames is lost.
#pragma once

#include "tests/controls.h"
#include "tests/virtual_screen.h"

namespace irad::test {

class Mouse {
 public:
  Mouse(const VirtualScreen& screen, std::filesystem::path controls)
      : screen_(screen), controls_(std::move(controls)) {}

  /// To "x y" of the screen.
  void moveTo(const std::string& place) const {
    screen_.act("mousemove " + place);
    waitUntilSeen(place, /*down=*/false);
  }
  /// Moves it there and presses a button (1: the left one), which stays down.
  void pressAt(const std::string& place, int button = 1) const {
    moveTo(place);
    screen_.act(fmt::format("mousedown {}", button));
    waitUntilSeen(place, /*down=*/true);
  }
  void tap(const std::string& place) const {
    pressAt(place);
    screen_.act("mouseup 1");
    waitUntilSeen(place, /*down=*/false);  // a button that is let go elsewhere is not clicked
  }
  /// Presses at the first place, moves through the others, and lets go at the last.
  void dragThrough(const std::vector<std::string>& places, int button = 1) const {
    pressAt(places.front(), button);
    for (size_t i = 1; i < places.size(); ++i) {
      screen_.act("mousemove " + places[i]);
      waitUntilSeen(places[i], /*down=*/true);
    }
    screen_.act(fmt::format("mouseup {}", button));
    waitUntilSeen(places.back(), /*down=*/false);
  }

 private:
  /// Until a frame has been drawn with the mouse there, its button up or down. While light is gathered anew none is
  /// drawn: for a second on two idle cores, for more than 20 on busy ones.
  void waitUntilSeen(const std::string& place, bool down) const {
    for (const auto end = Clock::now() + kPatience; Clock::now() < end; pause(0.005))
      for (const Control& c : readControls(controls_))
        if (c.name == "pointer" && c.on == down && fmt::format("{} {}", c.area.x, c.area.y) == place) return;
    ADD_FAILURE() << "the window does not see the mouse at " << place << (down ? ", pressed" : ", not pressed");
  }
  const VirtualScreen& screen_;
  std::filesystem::path controls_;
};

}  // namespace irad::test
