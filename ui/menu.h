// The menu bar: what the window can do, with the keys that do it too, and the state at its right end.
#pragma once

#include "ui/layout.h"
#include "ui/panel.h"
#include "ui/session.h"

namespace irad {

void drawMenuBar(Session& session, const Panels& panels, const Rect& where);

}  // namespace irad
