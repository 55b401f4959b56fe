#include "ui/sidecar_row.h"

#include <fmt/format.h>

#include "renderer/base/error.h"
#include "ui/imgui.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {

void sidecarRow(Session& session) {
  SceneEdits& edits = session.edits;
  const bool modified = edits.modified();
  ImGui::BeginDisabled(!modified);
  if (ImGui::Button("Save")) session.saveEdits();
  helpTooltip(edits.file().empty() ? edits.whyNowhere()
                                   : fmt::format("Lights, materials and bookmarks, to {}", edits.file().string()));
  ImGui::SameLine();
  if (ImGui::Button("Revert")) edits.revert();
  helpTooltip("Back to lights, materials and bookmarks as they were saved");
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  ImGui::PushStyleColor(ImGuiCol_Text, modified ? theme::warning : theme::dim);
  clippedText(modified       ? "unsaved changes"
              : edits.kept() ? edits.file().filename().string()
                             : "no edits",
              ImGui::GetContentRegionAvail().x);
  ImGui::PopStyleColor();
}

}  // namespace irad
