#include "ui/open_dialog.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "renderer/base/near_match.h"
#include "renderer/base/number_text.h"
#include "ui/imgui.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

constexpr const char* kTitle = "Open a scene";
constexpr const char* kKinds[] = {"all that can be opened", "scenes: .gltf .glb .irscene",
                                  "skies, references: .exr .hdr .pfm", "saved lights \u2026: .irad.json"};
constexpr size_t kMostPlaces = 12;

std::string sizeText(uint64_t bytes) {
  return bytes < 100'000 ? fmt::format("{} kB", (bytes + 999) / 1000) : fmt::format("{:.1f} MB", 1e-6 * bytes);
}

}  // namespace

bool OpenDialog::isOpened(const std::filesystem::path& path, Kind kind) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto is = [&](std::initializer_list<const char*> extensions) {
    return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
  };
  const bool scene = is({".gltf", ".glb", ".irscene"}), picture = is({".exr", ".hdr", ".pfm"}),
             sidecar = path.filename().string().ends_with(kSidecarExtension);
  switch (kind) {
    case Kind::All:
      return scene || picture || sidecar;
    case Kind::Scenes:
      return scene;
    case Kind::Pictures:
      return picture;
    case Kind::Sidecars:
      return sidecar;
  }
  return false;
}

/// Where that cannot be read, the dialog stays where it is and says why.
void OpenDialog::enter(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<Entry> entries;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    Entry entry{.name = it->path().filename().string(), .folder = it->is_directory(ignored)};
    if (entry.name.starts_with('.') || !(entry.folder || isOpened(it->path(), Kind::All))) continue;
    struct stat status {};
    if (stat(it->path().c_str(), &status) == 0) {
      entry.bytes = static_cast<uint64_t>(status.st_size);
      entry.changed = status.st_mtime;
    }
    entries.push_back(std::move(entry));
  }
  error_ = error ? fmt::format("{}: {}", folder.string(), error.message()) : "";
  if (error) return;
  if (folder != folder_) {
    filter_.clear();
    typed_.clear();
  }
  folder_ = folder;
  entries_ = std::move(entries);
  chosen_.reset();
  select();
}

void OpenDialog::select() {
  shown_.clear();
  for (uint32_t i = 0; i < entries_.size(); ++i) {
    const Entry& entry = entries_[i];
    const bool named = filter_.empty() || containsAnyCase(entry.name, filter_);
    if (named && (entry.folder || isOpened(entry.name, kind_))) shown_.push_back(i);
  }
  sorted_ = false;
}

void OpenDialog::sort(const ImGuiTableSortSpecs& specs) {
  const int column = specs.SpecsCount > 0 ? specs.Specs[0].ColumnIndex : 0;
  const bool up = specs.SpecsCount == 0 || specs.Specs[0].SortDirection == ImGuiSortDirection_Ascending;
  std::sort(shown_.begin(), shown_.end(), [&](uint32_t i, uint32_t j) {
    const Entry &a = entries_[i], &b = entries_[j];
    if (a.folder != b.folder) return a.folder;
    if (column == 1 && a.bytes != b.bytes) return up ? a.bytes < b.bytes : a.bytes > b.bytes;
    if (column == 2 && a.changed != b.changed) return up ? a.changed < b.changed : a.changed > b.changed;
    return up || column != 0 ? a.name < b.name : a.name > b.name;
  });
  sorted_ = true;
}

/// A folder is entered, a file opened. What is seen to be wrong at once is said in the dialog, and so is what the
/// reader of the file says (Session::openFailed).
void OpenDialog::choose(Session& session, const std::string& what) {
  const std::filesystem::path path =
      what.starts_with("check:") ? std::filesystem::path(what) : (folder_ / what).lexically_normal();
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return enter(path.has_filename() ? path : path.parent_path());
  error_.clear();
  session.showOpen = false;
  session.open(path, /*fromDialog=*/true);
}

std::vector<OpenDialog::Place> OpenDialog::places(const Session& session) const {
  std::vector<Place> all;
  std::error_code ignored;
  const auto add = [&](std::string name, const std::filesystem::path& folder) {
    const std::filesystem::path normal = folder.lexically_normal();
    const bool known = std::ranges::any_of(all, [&](const Place& p) { return p.folder == normal; });
    if (!folder.empty() && !known && all.size() < kMostPlaces) all.push_back({std::move(name), normal});
  };
  if (const char* home = std::getenv("HOME")) add("Home", home);
  add("Current folder", std::filesystem::current_path(ignored));
  const auto there = std::ranges::find_if(session.builtIn, [&](const std::filesystem::path& folder) {
    return std::filesystem::is_directory(folder, ignored);
  });
  if (there != session.builtIn.end()) add("Built-in scenes", *there);
  add("/", "/");
  for (const std::filesystem::path& scene : session.preferences.recent)
    add(scene.parent_path().filename().string(), scene.parent_path());
  return all;
}

void OpenDialog::drawPlaces(const Session& session, float height) {
  const float width = 10 * ImGui::GetFontSize();
  std::filesystem::path wanted;
  if (ImGui::BeginChild("##places", {width, height}, true)) {
    ImGui::PushID("places");
    for (const Place& place : places(session)) {
      const std::string id = fmt::format("{}###{}", clipped(place.name, width - ImGui::GetFontSize()), place.name);
      ImGui::PushID(place.folder.c_str());
      ImGui::leaveControls();  // the folder is no part of its name
      if (ImGui::Selectable(id.c_str(), place.folder == folder_)) wanted = place.folder;
      helpTooltip(place.folder.string());
      ImGui::enterControls("");
      ImGui::PopID();
    }
    ImGui::PopID();
  }
  ImGui::EndChild();
  if (!wanted.empty()) enter(wanted);
}

void OpenDialog::drawEntries(Session& session, float width, float height) {
  const float em = ImGui::GetFontSize();
  std::string opened;
  constexpr ImGuiTableFlags kFlags =
      ImGuiTableFlags_RowBg | ImGuiTableFlags_Sortable | ImGuiTableFlags_ScrollY | ImGuiTableFlags_BordersOuter;
  if (!ImGui::BeginTable("entries", 3, kFlags, {width, height})) return;
  ImGui::TableSetupScrollFreeze(0, 1);
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch | ImGuiTableColumnFlags_DefaultSort);
  ImGui::TableSetupColumn("size", ImGuiTableColumnFlags_WidthFixed, 5.5f * em);
  ImGui::TableSetupColumn("changed", ImGuiTableColumnFlags_WidthFixed, 10.5f * em);
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (const char* column : {"name", "size", "changed"}) {
    ImGui::TableNextColumn();
    ImGui::TableHeader(column);
  }
  ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs();
  if (specs && (!sorted_ || specs->SpecsDirty)) {
    sort(*specs);
    specs->SpecsDirty = false;
  }
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(shown_.size()));
  while (clipper.Step())
    for (int row = clipper.DisplayStart; row < clipper.DisplayEnd; ++row) {
      const uint32_t index = shown_[static_cast<size_t>(row)];
      const Entry& entry = entries_[index];
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::PushStyleColor(ImGuiCol_Text, entry.folder ? theme::accent : theme::text);
      const std::string label = fmt::format("{0}{1}###{0}", entry.name, entry.folder ? "/" : "");
      if (ImGui::Selectable(label.c_str(), chosen_ == index,
                            ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowDoubleClick |
                                ImGuiSelectableFlags_DontClosePopups)) {
        chosen_ = index;
        typed_ = entry.name;
        error_.clear();
        if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) opened = entry.name;
      }
      ImGui::PopStyleColor();
      ImGui::PushStyleColor(ImGuiCol_Text, theme::dim);
      ImGui::TableNextColumn();
      if (!entry.folder) rightText(sizeText(entry.bytes));
      ImGui::TableNextColumn();
      rightText(timeInWords(entry.changed));
      ImGui::PopStyleColor();
    }
  ImGui::EndTable();
  if (!opened.empty()) choose(session, opened);
}

void OpenDialog::draw(Session& session) {
  if (session.showOpen && !ImGui::IsPopupOpen(kTitle)) {
    ImGui::OpenPopup(kTitle);
    const std::string was = typed_;
    std::error_code ignored;
    const bool fromFile = session.pipeline && std::filesystem::exists(session.pipeline->scene().path, ignored);
    if (folder_.empty())
      enter(fromFile ? std::filesystem::absolute(session.pipeline->scene().path).lexically_normal().parent_path()
                     : std::filesystem::current_path(ignored));
    else
      enter(folder_);  // what it holds now
    if (!session.openError.empty()) {
      error_ = std::exchange(session.openError, {});
      typed_ = was;
    }
  }
  const ImVec2 middle = ImGui::GetMainViewport()->GetCenter(), window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(middle, ImGuiCond_Always, {0.5f, 0.5f});
  if (!ImGui::BeginPopupModal(kTitle, &session.showOpen,
                              ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings))
    return;
  const float em = ImGui::GetFontSize(), gap = ImGui::GetStyle().ItemSpacing.x;
  const float width = std::max(std::min(48 * em, window.x - 4 * em), 16 * em);
  const float height = std::max(std::min(18 * em, window.y - 16 * em), 4 * em);

  const bool above = folder_.has_parent_path() && folder_ != folder_.root_path();
  ImGui::BeginDisabled(!above);
  if (ImGui::Button("Up")) enter(folder_.parent_path());
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  clippedText(folder_.string(), width - ImGui::GetCursorPosX());
  ImGui::SetNextItemWidth(0.45f * width);
  if (ImGui::InputTextWithHint("##filter", "filter by name", &filter_)) select();
  ImGui::SameLine();
  ImGui::SetNextItemWidth(0.55f * width - gap);
  int kind = static_cast<int>(kind_);
  if (ImGui::Combo("##kind", &kind, kKinds, static_cast<int>(std::size(kKinds)))) {
    kind_ = static_cast<Kind>(kind);
    select();
  }
  drawPlaces(session, height);
  ImGui::SameLine();
  drawEntries(session, width - 10 * em - gap, height);
  if (shown_.empty())
    ImGui::TextColored(theme::dim, entries_.empty() ? "neither folders here nor files that can be opened"
                                                    : "nothing of that name and kind");
  ImGui::SetNextItemWidth(width);
  const bool entered = ImGui::InputTextWithHint("##path", "a name, a path, or check:NAME", &typed_,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  if (!error_.empty()) {
    ImGui::PushTextWrapPos(width);
    ImGui::TextColored(theme::error, "%s", error_.c_str());
    ImGui::tellControl("error");
    ImGui::PopTextWrapPos();
  }
  ImGui::BeginDisabled(typed_.empty());
  const bool open = ImGui::Button("Open", {8 * em, 0});
  ImGui::EndDisabled();
  if ((open || entered) && !typed_.empty()) choose(session, std::string(typed_));
  ImGui::SameLine();
  if (ImGui::Button("Cancel", {8 * em, 0})) session.showOpen = false;
  if (!session.showOpen) ImGui::CloseCurrentPopup();
  ImGui::EndPopupModal();
}

}  // namespace irad
