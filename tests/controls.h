// The controls of a window that was started with --controls FILE, by their names (ui/controls.h).
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "renderer/base/near_match.h"
#include "tests/support.h"

namespace irad::test {

struct Control {
  struct Area {
    int x = 0, y = 0, width = 0, height = 0;
    int right() const { return x + width; }
    int bottom() const { return y + height; }
    bool holds(int px, int py) const { return px >= x && px < right() && py >= y && py < bottom(); }
  };
  std::string name;
  Area area;    ///< in the window, pixels; also where it is scrolled out of view
  Area region;  ///< the visible part of the region that it is in
  bool on = false, disabled = false;
};

/// Those of the last frame. Read hundreds of times per click: no streams.
inline std::vector<Control> readControls(const std::filesystem::path& file) {
  std::vector<Control> controls;
  const std::string text = slurp(file);
  const char *at = text.data(), *const end = at + text.size();
  const auto next = [&] {
    int value = 0;
    while (at != end && *at == ' ') ++at;
    at = std::from_chars(at, end, value).ptr;
    return value;
  };
  while (at != end) {
    Control c;
    for (Control::Area* a : {&c.area, &c.region}) *a = {next(), next(), next(), next()};
    c.on = next() != 0, c.disabled = next() != 0;
    const char *const name = std::find(at, end, '\t'), *const line = std::find(at, end, '\n');
    c.name.assign(name < line ? name + 1 : line, line);
    controls.push_back(std::move(c));
    at = line == end ? end : line + 1;
  }
  return controls;
}

/// Names that begin as this one does, up to its last part.
inline std::vector<std::string> inPlaceOf(const std::string& name, const std::vector<std::string>& names) {
  std::vector<std::string> found;
  for (const std::string& other : names)
    if (other.starts_with(name.substr(0, name.rfind('/') + 1))) found.push_back(other);
  return found;
}

/// Among the controls that are drawn, the one of this name, or else those whose names come near.
inline Control findControl(const std::vector<Control>& controls, const std::string& name) {
  std::vector<std::string> names;
  const Control* found = nullptr;
  for (const Control& c : controls) {
    names.push_back(c.name);
    if (c.name != name) continue;
    if (found) throw std::runtime_error(fmt::format("two controls are called '{}'", name));
    found = &c;
  }
  if (found) return *found;
  throw std::runtime_error(fmt::format("no control is called '{}'; near: {}; in its place: {}", name,
                                       fmt::join(nearMatches(name, names), ", "),
                                       fmt::join(inPlaceOf(name, names), ", ")));
}

}  // namespace irad::test
