// Where lights, materials, objects, bookmarks and region are kept, whether they are saved, and the buttons for it: a
// row of the panels that edit them.
#pragma once

#include "ui/session.h"

namespace irad {

void sidecarRow(Session& session);

}  // namespace irad
