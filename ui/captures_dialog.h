// The dialog "Captures": what the output folder holds, with thumbnails; taken back into the window, or two compared.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "ui/session.h"

namespace irad {

class ImGuiLayer;

class CapturesDialog {
 public:
  /// Shown while session.captures.shown.
  void draw(Session& session, ImGuiLayer& layer);

 private:
  void begin(Session& session);
  void drawList(Session& session, ImGuiLayer& layer, float width, float height);
  void drawRow(Session& session, ImGuiLayer& layer, const CaptureEntry& entry);
  void drawChosen(Session& session, ImGuiLayer& layer, float height);
  void drawButtons(Session& session);
  void drawPair(Session& session, ImGuiLayer& layer, float height);
  const CaptureEntry* find(const Session& session, const std::string& name) const;
  /// The ticked ones, the older first; none where two of one sort are not ticked.
  std::optional<std::array<CaptureEntry, 2>> pair(const Session& session) const;

  std::string chosen_;               ///< name of an entry
  std::vector<std::string> ticked_;  ///< names, two at most
  /// Two recordings that are shown beside each other.
  std::optional<std::array<CaptureEntry, 2>> recordings_;
};

}  // namespace irad
