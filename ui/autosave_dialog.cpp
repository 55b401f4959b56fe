#include "ui/autosave_dialog.h"

#include <fmt/format.h>

#include "ui/imgui.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

constexpr const char* kFoundTitle = "Unsaved work was found";

}  // namespace

void drawAutosaveDialog(Session& session) {
  // Another question comes first: of two at once the second would close the first.
  if (session.found && !session.asking && !session.showOpen && !ImGui::IsPopupOpen(kFoundTitle))
    ImGui::OpenPopup(kFoundTitle);
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowSizeConstraints({36 * em, 0}, {36 * em, 40 * em});
  if (!ImGui::BeginPopupModal(
          kFoundTitle, nullptr,
          ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove))
    return;
  if (session.found) {
    const Autosave& found = *session.found;
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted("irad ended without saving this:");
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
    valueRow("scene", found.scene.filename().string());
    helpTooltip(found.scene.string());
    valueRow("kept", timeInWords(found.time));
    helpTooltip("When this was last written, local time");
    ImGui::TextColored(theme::dim, "it holds");
    ImGui::Indent();
    ImGui::PushTextWrapPos(0);
    for (const std::string& line : contentInWords(found, session.edited)) ImGui::TextUnformatted(line.c_str());
    ImGui::PopTextWrapPos();
    ImGui::Unindent();
    ImGui::Spacing();
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const ImVec2 button{(ImGui::GetContentRegionAvail().x - 2 * gap) / 3, 0};
    if (ImGui::Button("Take", button)) session.answer = Session::Offer::Take;
    helpTooltip(
        fmt::format("Opens {} with these lights, bookmarks and settings, as one step that can be undone. They are "
                    "unsaved until they are saved.",
                    found.scene.filename().string()));
    ImGui::SameLine();
    if (ImGui::Button("Discard", button)) session.answer = Session::Offer::Discard;
    helpTooltip("Removes the file that holds them");
    ImGui::SameLine();
    if (ImGui::Button("Later", button)) session.answer = Session::Offer::Later;
    helpTooltip("The next start asks again");
  }
  if (!session.found || session.answer) ImGui::CloseCurrentPopup();
  ImGui::EndPopupModal();
}

}  // namespace irad
