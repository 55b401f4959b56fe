// The offer of what an earlier run has left: take it, discard it, or be asked again at the next start.
#pragma once

#include "ui/session.h"

namespace irad {

/// Shown while session.found; the answer is a request of the session.
void drawAutosaveDialog(Session& session);

}  // namespace irad
