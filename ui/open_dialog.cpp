#include "ui/open_dialog.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "ui/imgui.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

constexpr const char* kTitle = "Open a scene";

bool isScene(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension == ".gltf" || extension == ".glb" || extension == ".irscene";
}

}  // namespace

void OpenDialog::enter(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<Entry> entries;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    const bool isFolder = it->is_directory(ignored);
    const std::string name = it->path().filename().string();
    if (!name.starts_with('.') && (isFolder || isScene(it->path()))) entries.push_back({name, isFolder});
  }
  error_ = error ? fmt::format("{}: {}", folder.string(), error.message()) : "";
  if (error) return;
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tuple(!a.folder, a.name) < std::tuple(!b.folder, b.name);
  });
  folder_ = folder;
  entries_ = std::move(entries);
}

void OpenDialog::choose(Session& session, const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return enter(path.lexically_normal());
  session.open(path);  // errors of the file are the loader's to tell
  session.showOpen = false;
}

void OpenDialog::drawEntries(Session& session) {
  const float em = ImGui::GetFontSize();
  if (!ImGui::BeginChild("##entries", {30 * em, 18 * em}, true)) return ImGui::EndChild();
  std::filesystem::path chosen;
  if (folder_.has_parent_path() && folder_ != folder_.root_path() && ImGui::Selectable(".."))
    chosen = folder_.parent_path();
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(entries_.size()));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const Entry& entry = entries_[static_cast<size_t>(i)];
      ImGui::PushStyleColor(ImGuiCol_Text, entry.folder ? theme::dim : theme::text);
      if (ImGui::Selectable(entry.folder ? (entry.name + "/").c_str() : entry.name.c_str()))
        chosen = folder_ / entry.name;
      ImGui::PopStyleColor();
    }
  if (entries_.empty()) ImGui::TextColored(theme::dim, "no folders, no .gltf, .glb or .irscene");
  ImGui::EndChild();
  if (!chosen.empty()) choose(session, chosen);
}

void OpenDialog::draw(Session& session) {
  if (session.showOpen && !ImGui::IsPopupOpen(kTitle)) {
    ImGui::OpenPopup(kTitle);
    std::error_code ignored;
    const bool fromFile = session.pipeline && std::filesystem::exists(session.pipeline->scene().path, ignored);
    if (folder_.empty())
      enter(fromFile ? std::filesystem::absolute(session.pipeline->scene().path).lexically_normal().parent_path()
                     : std::filesystem::current_path(ignored));
    else
      enter(folder_);  // what it holds now
  }
  const ImVec2 middle = ImGui::GetMainViewport()->GetCenter();
  ImGui::SetNextWindowPos(middle, ImGuiCond_Appearing, {0.5f, 0.5f});
  if (!ImGui::BeginPopupModal(kTitle, &session.showOpen,
                              ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings))
    return;
  const float width = 30 * ImGui::GetFontSize();
  clippedText(folder_.string(), width);
  helpTooltip(folder_.string());
  drawEntries(session);
  ImGui::SetNextItemWidth(width);
  if (ImGui::InputTextWithHint("##path", "a path, or check:NAME", &typed_, ImGuiInputTextFlags_EnterReturnsTrue) &&
      !typed_.empty())
    choose(session, typed_.starts_with("check:") ? std::filesystem::path(typed_) : folder_ / typed_);
  if (!error_.empty()) {
    ImGui::PushTextWrapPos(width);
    ImGui::TextColored(theme::error, "%s", error_.c_str());
    ImGui::PopTextWrapPos();
  }
  if (ImGui::Button("Cancel")) session.showOpen = false;
  if (!session.showOpen) ImGui::CloseCurrentPopup();
  ImGui::EndPopupModal();
}

}  // namespace irad
