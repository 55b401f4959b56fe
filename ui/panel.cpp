#include "ui/panel.h"

namespace irad {

std::vector<std::unique_ptr<Panel>> makePanels() {
  std::vector<std::unique_ptr<Panel>> panels;
#define IRAD_MAKE_PANEL(name) panels.push_back(make##name##Panel());
  IRAD_PANELS(IRAD_MAKE_PANEL)
#undef IRAD_MAKE_PANEL
  return panels;
}

}  // namespace irad
