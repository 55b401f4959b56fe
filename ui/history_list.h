// The steps of the history as a list, in the panel and in the menu.
#pragma once

#include "ui/session.h"

namespace irad {

/// All steps, the last one on top; a click goes to one. Those that are undone are dim.
void historyList(Session& session, float width);

}  // namespace irad
