#include "ui/unsaved.h"

#include <algorithm>

#include "ui/session.h"

namespace irad {

bool sameSettings(Settings a, Settings b) {
  a.view.facet = b.view.facet = 0;
  return a == b;
}

std::vector<const Setting*> differingSettings(Settings a, Settings b) {
  a.view.facet = b.view.facet = 0;
  std::vector<const Setting*> differing;
  for (const Setting& setting : settingTable())
    if (setting.get(a) != setting.get(b)) differing.push_back(&setting);
  return differing;
}

Unsaved unsavedBefore(Session& session, const Leaving& leaving) {
  using What = Leaving::What;
  Unsaved unsaved;
  // A scene that is loaded again keeps its edits, and the window keeps the settings that it edits whatever it opens.
  const bool replay = leaving.what == What::Replay;
  const bool otherScene =
      (leaving.what == What::OpenScene && session.pipeline && session.pipeline->scene().path != leaving.path) ||
      (replay && session.pipeline && lastingPath(session.pipeline->scene().path) != lastingPath(leaving.path));
  if (leaving.what == What::Quit || leaving.what == What::OpenSidecar || otherScene)
    unsaved.edits = session.edits.modified();
  const auto add = [&](Side& side) {
    const std::vector<Side*> sides = session.sides();
    if (std::none_of(sides.begin(), sides.end(), [&](const Side* s) { return sameSettings(side.edited, s->saved); }))
      unsaved.settings.push_back(&side);
  };
  if (leaving.what == What::Quit) add(session);
  // Opening a scene ends the comparison, and the side that is not edited goes with it.
  if (session.comparison && leaving.what != What::OpenSidecar && (!replay || otherScene) &&
      !sameSettings(session.comparison->other.edited, session.edited))
    add(session.comparison->other);
  return unsaved;
}

}  // namespace irad
