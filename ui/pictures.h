// The pictures that the viewport shows, drawn into their targets.
#pragma once

#include "ui/session.h"

namespace irad {

/// Draws the session's view from its camera, for every side, and the difference where that is shown. Afterwards nothing
/// of the view is dirty; the range that it was drawn with comes back with the frame.
void drawPictures(Session& session, Frame& frame);

}  // namespace irad
