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
  helpTooltip(edits.file().empty()
                  ? edits.whyNowhere()
                  : fmt::format("Lights, materials, objects, bookmarks and region, to {}", edits.file().string()));
  ImGui::EndDisabled();
  ImGui::SameLine();
  const bool toFile = !modified && edits.canRevert();
  ImGui::BeginDisabled(!edits.canRevert());
  if (ImGui::Button(toFile ? "File's lights###Revert" : "Revert###Revert")) {
    session.history.call(toFile ? "the file's own lights" : "revert to what was saved");
    edits.revert();
  }
  helpTooltip(toFile ? "Back to the lights of the scene's own file; materials, objects, bookmarks and region stay"
                     : "Back to lights, materials, objects, bookmarks and region as they were saved");
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
