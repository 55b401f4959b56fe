// The pictures that the viewport shows, drawn into their targets.
#pragma once

#include "ui/session.h"

namespace irad {

/// Draws the session's view from the camera `shown`, for every side, and the difference where that is shown. Afterwards
/// nothing of the view is dirty, unless the window's camera has moved on; the range that it was drawn with comes back
/// with the frame.
void drawPictures(Session& session, Frame& frame);

}  // namespace irad
