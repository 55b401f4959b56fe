// A panel: one file in ui/panels/ with a class of its own for its state, one line in the list below. Panels read the
// session and write requests into it; they never touch the device.
#pragma once

#include <memory>
#include <vector>

#include "ui/layout.h"
#include "ui/session.h"

namespace irad {

enum class Region { Left, Right, Bottom };

class Panel {
 public:
  virtual ~Panel() = default;
  virtual const char* title() const = 0;
  virtual const char* help() const = 0;  ///< what it is for: the tooltip of its header
  virtual Region region() const = 0;
  virtual void draw(Session& session) = 0;
};

// The list, top to bottom within each region. X(Name) stands for makeNamePanel() in ui/panels/.
#define IRAD_PANELS(X) \
  X(Scene)             \
  X(Lights)            \
  X(Settings)          \
  X(Effects)           \
  X(Materials)         \
  X(Objects)           \
  X(Cameras)           \
  X(History)           \
  X(View)              \
  X(Compare)           \
  X(Accuracy)          \
  X(Inspector)         \
  X(Solver)            \
  X(Memory)            \
  X(Timings)

#define IRAD_DECLARE_PANEL(name) std::unique_ptr<Panel> make##name##Panel();
IRAD_PANELS(IRAD_DECLARE_PANEL)
#undef IRAD_DECLARE_PANEL

using Panels = std::vector<std::unique_ptr<Panel>>;
Panels makePanels();

/// The menu bar, the columns and the strip, each panel in its region under a header that folds it.
void drawPanels(Session& session, const Panels& panels, const Layout& layout);

}  // namespace irad
