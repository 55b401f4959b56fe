#include "ui/unsaved_dialog.h"

#include <fmt/format.h>

#include <cctype>

#include "renderer/base/error.h"
#include "ui/imgui.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

constexpr const char* kUnsavedTitle = "Unsaved changes";

std::string questionFor(const Leaving& leaving) {
  const std::string file = leaving.path.filename().string();
  switch (leaving.what) {
    case Leaving::What::Quit:
      return "irad is about to quit. Not saved yet:";
    case Leaving::What::OpenScene:
      return fmt::format("{} is about to be opened. Not saved yet:", file);
    case Leaving::What::OpenSidecar:
      return fmt::format("{} is about to replace what is not saved yet:", file);
    case Leaving::What::Replay:
      return fmt::format("{} is about to be opened, for a replay. Not saved yet:", file);
    case Leaving::What::EndComparison:
      return "The comparison is about to end. Not saved yet:";
  }
  return {};
}

/// The scene's name in letters that a preset's may have.
std::string freePresetName(const Session& session, const char* more) {
  std::string name = session.pipeline ? session.pipeline->scene().path.stem().string() : "settings";
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_') c = '-';
  return freeName(name + more, session.presets.names());
}

std::string& typedName(const Session& session, const Side& side, std::string& a, std::string& b) {
  const bool isOther = session.comparison && &side == &session.comparison->other;
  return session.comparison && isOther != session.comparison->editsB ? b : a;
}

}  // namespace

void UnsavedDialog::begin(const Session& session) {
  error_.clear();
  presetA_ = freePresetName(session, session.comparison ? " A" : "");
  presetB_ = freePresetName(session, " B");
  const std::string stem = session.pipeline ? session.pipeline->scene().path.stem().string() : "scene";
  std::error_code ignored;
  std::filesystem::path file = folder_ / (stem + kSidecarExtension);
  for (int n = 2; std::filesystem::exists(file, ignored); ++n)
    file = folder_ / fmt::format("{} {}{}", stem, n, kSidecarExtension);
  file_ = file.string();
}

/// True when Return was pressed in a field.
bool UnsavedDialog::drawRows(Session& session, const Unsaved& unsaved) {
  bool entered = false;
  const auto field = [&](const char* label, const std::string& help, const char* id, std::string& text) {
    fieldLabel(label, help);
    entered |= ImGui::InputText(id, &text, ImGuiInputTextFlags_EnterReturnsTrue);
  };
  if (unsaved.edits && session.edits.file().empty())
    field("Scene edits, as", session.edits.whyNowhere() + "\nDrop the file into the window to have them again.",
          "##file", file_);
  else if (unsaved.edits)
    valueRow("Scene edits, as", session.edits.file().string());
  for (const Side* side : unsaved.settings) {
    std::string& name = typedName(session, *side, presetA_, presetB_);
    const bool isB = &name == &presetB_;
    field(!session.comparison ? "Settings, as the preset"
          : isB               ? "Settings of B, as the preset"
                              : "Settings of A, as the preset",
          "A name of letters, digits, spaces, - and _; the list in Settings has it then",
          isB ? "##presetB" : "##preset", name);
  }
  return entered;
}

void UnsavedDialog::save(Session& session, const Unsaved& unsaved) {
  try {
    if (unsaved.edits) {
      if (!file_.ends_with(kSidecarExtension)) file_ += kSidecarExtension;  // by which it is recognized
      if (session.edits.file().empty())
        session.edits.saveAs(file_);
      else
        session.edits.save();
      session.note(
          fmt::format("Saved lights, materials, objects, bookmarks and region to {}", session.edits.file().string()));
    }
    for (Side* side : unsaved.settings) {
      const std::filesystem::path preset =
          session.presets.save(typedName(session, *side, presetA_, presetB_), side->edited);
      side->saved = side->edited;
      session.note(fmt::format("Saved {}", preset.string()));
    }
    session.leaveNow(*session.asking);
  } catch (const Error& error) {
    error_ = error.what();
  }
}

void UnsavedDialog::draw(Session& session) {
  if (session.asking && !ImGui::IsPopupOpen(kUnsavedTitle)) {
    ImGui::OpenPopup(kUnsavedTitle);
    begin(session);
  }
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowSizeConstraints({36 * em, 0}, {36 * em, 40 * em});
  if (!ImGui::BeginPopupModal(
          kUnsavedTitle, nullptr,
          ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove))
    return;
  if (session.asking) {
    const Unsaved unsaved = unsavedBefore(session, *session.asking);
    clippedText(questionFor(*session.asking), ImGui::GetContentRegionAvail().x);
    ImGui::Spacing();
    const bool entered = drawRows(session, unsaved);
    if (!error_.empty()) {
      ImGui::PushTextWrapPos(0);
      ImGui::TextColored(theme::error, "%s", error_.c_str());
      ImGui::PopTextWrapPos();
    }
    ImGui::Spacing();
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const ImVec2 button{(ImGui::GetContentRegionAvail().x - 2 * gap) / 3, 0};
    const bool wanted = ImGui::Button("Save", button);
    ImGui::SameLine();
    const bool discarded = ImGui::Button("Discard", button);
    ImGui::SameLine();
    const bool cancelled = ImGui::Button("Cancel", button);
    if (wanted || entered)
      save(session, unsaved);
    else if (discarded)
      session.leaveNow(*session.asking);
    else if (cancelled)
      session.stay();
  }
  if (!session.asking) ImGui::CloseCurrentPopup();
  ImGui::EndPopupModal();
}

}  // namespace irad
