// What lies over the panels and the viewport: messages, progress, help; and the tiles themselves.
#pragma once

#include "ui/layout.h"
#include "ui/session.h"

namespace irad {

/// What the numerical watch found wrong, in red across the top of the viewport for as long as it is.
void drawBanner(const Session& session, const Rect& viewport);
/// Notes until their time is over, errors until they are dismissed; beside or above the picture's legends.
void drawMessages(Session& session, const Rect& viewport);
/// What the last frame that did more than draw panels took on the device, "last frame 12.3 ms"; empty: there was none.
std::string frameTime(const Session& session);
/// The same in the upper right corner, where the panels that tell it are hidden.
void drawFrameTime(const Session& session, const Rect& viewport);
void drawProgress(Session& session, const Rect& viewport);
void drawHelp(Session& session, const Rect& window);

/// Begins one of the fixed windows that tile the main window. It has the cleared window's colour already; `filled`
/// draws its own, `scrolls` lets its contents be longer than it is, `menus` begins it with a menu bar.
void beginTile(const char* name, const Rect& where, bool filled = false, bool scrolls = true, bool menus = false);
void endTile();

}  // namespace irad
