// A view that has nothing to be drawn from says so in the picture, with a button that mends it.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "ui/layout.h"

namespace irad {

struct Session;

struct MissingInput {
  std::string title, text;
  std::string button;                  ///< empty: nothing in the window mends it
  std::function<void(Session&)> mend;  ///< what the button does
};
/// What the view shown lacks; none where it has all, or nothing is built yet.
std::optional<MissingInput> missingInput(const Session& session);
/// In the middle of the picture, where something is missing.
void drawMissingInput(Session& session, const Rect& viewport);

}  // namespace irad
