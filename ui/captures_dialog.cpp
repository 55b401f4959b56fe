#include "ui/captures_dialog.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "ui/imgui.h"
#include "ui/imgui_layer.h"
#include "ui/metric_rows.h"
#include "ui/recording_comparison.h"
#include "ui/setting_rows.h"
#include "ui/theme.h"
#include "ui/unsaved.h"
#include "ui/widgets.h"
#include "ui/words.h"

namespace irad {
namespace {

constexpr const char* kCapturesTitle = "Captures";

std::string captureView(const CaptureEntry& entry) {
  return entry.view ? viewInfo(*entry.view)->label : "no view";
}

constexpr const char* kUndescribed = "A recording of an older version, which does not say what it is of";

/// "box.glb, Lit"
std::string captureOf(const CaptureEntry& entry) {
  if (!entry.described()) return "unknown scene";
  return fmt::format("{}, {}", entry.config.scene->filename().string(), captureView(entry));
}

/// "as now", or the settings that are not.
std::string differenceInWords(const Settings& then, const Settings& now) {
  constexpr size_t most = 3;
  const std::vector<const Setting*> differing = differingSettings(then, now);
  if (differing.empty()) return "settings as now";
  std::vector<std::string> words;
  for (size_t i = 0; i < std::min(most, differing.size()); ++i)
    words.push_back(fmt::format("{} {}", differing[i]->name, differing[i]->text(then)));
  const size_t more = differing.size() - words.size();
  return fmt::format("{}{}", fmt::join(words, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
}

/// In the middle of `size` from the cursor, as large as fits; the cursor is under it, or beside it with SameLine().
void capturePicture(ImGuiLayer& layer, const Captures::Picture* picture, ImVec2 size, const char* without) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg));
  if (picture && picture->image) {
    const auto w = static_cast<float>(picture->image.desc.width), h = static_cast<float>(picture->image.desc.height);
    const float scale = std::min(size.x / w, size.y / h);
    const ImVec2 low{at.x + 0.5f * (size.x - w * scale), at.y + 0.5f * (size.y - h * scale)};
    list.AddImage(layer.texture(picture->image), low, {low.x + w * scale, low.y + h * scale});
  } else {
    const std::string text = clipped(!picture                 ? without
                                     : picture->error.empty() ? "\u2026"
                                                              : "no picture",
                                     size.x - 0.5f * ImGui::GetFontSize());
    const ImVec2 extent = ImGui::CalcTextSize(text.c_str());
    list.AddText({at.x + 0.5f * (size.x - extent.x), at.y + 0.5f * (size.y - extent.y)}, ImGui::GetColorU32(theme::dim),
                 text.c_str());
  }
  ImGui::Dummy(size);
  if (picture && !picture->error.empty()) helpTooltip(picture->error);
}

const Captures::Picture* thumbnailOf(const Session& session, const CaptureEntry& entry) {
  const auto at = session.captures.pictures.find(entry.picture);
  return at != session.captures.pictures.end() ? &at->second : nullptr;
}

void wrappedDim(const char* text) {
  ImGui::PushTextWrapPos(0);
  ImGui::TextColored(theme::dim, "%s", text);
  ImGui::PopTextWrapPos();
}

void captureRow(const char* label, const std::string& value, const std::string& help) {
  valueRow(label, value);
  helpTooltip(help);
}

}  // namespace

const CaptureEntry* CapturesDialog::find(const Session& session, const std::string& name) const {
  const auto& entries = session.captures.list.entries;
  const auto at = std::ranges::find(entries, name, &CaptureEntry::name);
  return at != entries.end() ? &*at : nullptr;
}

std::optional<std::array<CaptureEntry, 2>> CapturesDialog::pair(const Session& session) const {
  if (ticked_.size() != 2) return {};
  const CaptureEntry *a = find(session, ticked_[0]), *b = find(session, ticked_[1]);
  if (!a || !b || a->recording != b->recording) return {};
  if (!a->recording && (a->picture.empty() || b->picture.empty())) return {};
  if (std::pair(a->time, a->name) > std::pair(b->time, b->name)) std::swap(a, b);
  return std::array{*a, *b};
}

void CapturesDialog::begin(Session& session) {
  session.captures.read = true;
  ticked_.clear();
  recordings_.reset();
}

void CapturesDialog::drawRow(Session& session, ImGuiLayer& layer, const CaptureEntry& entry) {
  const float em = ImGui::GetFontSize(), high = 4 * em, gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 at = ImGui::GetCursorPos();
  const float width = ImGui::GetContentRegionAvail().x, box = ImGui::GetFrameHeight();
  ImGui::PushID(entry.name.c_str());
  const std::string differs =
      entry.described() ? differenceInWords(entry.settings, session.edited) : "settings unknown";
  if (ImGui::Selectable("##choose", chosen_ == entry.name,
                        ImGuiSelectableFlags_DontClosePopups | ImGuiSelectableFlags_AllowItemOverlap, {0, high}))
    chosen_ = entry.name;
  helpTooltip([&] {
    return fmt::format("{}\n{}", entry.folder.string(),
                       entry.described() ? fmt::format("{}\n{}", entry.config.scene->string(), differs) : kUndescribed);
  });
  const ImVec2 under = ImGui::GetCursorPos();
  ImGui::SetCursorPos(at);
  capturePicture(layer, thumbnailOf(session, entry), {16 * high / 9, high}, entry.recording ? "timings" : "no picture");
  if (const Captures::Picture* picture = thumbnailOf(session, entry); picture && picture->image)
    ImGui::tellPlace("thumbnail", {ImGui::GetItemRectMin().x, ImGui::GetItemRectMin().y},
                     {ImGui::GetItemRectMax().x, ImGui::GetItemRectMax().y}, true);
  const float left = at.x + 16 * high / 9 + gap, room = width - 16 * high / 9 - box - 3 * gap;
  const float line = ImGui::GetTextLineHeight();
  const auto text = [&](int n, const ImVec4& color, const std::string& words) {
    ImGui::SetCursorPos({left, at.y + static_cast<float>(n) * (line + 0.1f * em)});
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::TextUnformatted(clipped(words, room).c_str());
    ImGui::PopStyleColor();
  };
  text(0, theme::text, fmt::format("{}   {}", entry.name, timeInWords(entry.time)));
  text(1, theme::dim, fmt::format("{}{}", entry.recording ? "recording of " : "", captureOf(entry)));
  text(2, theme::dim, differs);
  ImGui::SetCursorPos({at.x + width - box, at.y + 0.5f * (high - box)});
  const auto ticked = std::ranges::find(ticked_, entry.name);
  bool on = ticked != ticked_.end();
  if (ImGui::Checkbox("##compare", &on)) {
    if (ticked != ticked_.end()) ticked_.erase(ticked);
    if (on) ticked_.push_back(entry.name);
    if (ticked_.size() > 2) ticked_.erase(ticked_.begin());
  }
  helpTooltip("One of the two that are compared");
  ImGui::SetCursorPos(under);
  ImGui::PopID();
}

void CapturesDialog::drawList(Session& session, ImGuiLayer& layer, float width, float height) {
  const Captures& captures = session.captures;
  const float lines = std::min<float>(static_cast<float>(captures.list.problems.size()), 4);
  const float problems = lines > 0 ? (lines + 1) * ImGui::GetTextLineHeightWithSpacing() : 0;
  ImGui::BeginGroup();
  if (ImGui::BeginChild("##list", {width, height - problems}, true)) {
    if (!captures.listed)
      ImGui::TextColored(theme::dim, "being read\u2026");
    else if (captures.list.entries.empty())
      ImGui::TextColored(theme::dim, "none yet: F12 saves the view, Record in the panel Timings its times");
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(captures.list.entries.size()));
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
        drawRow(session, layer, captures.list.entries[static_cast<size_t>(i)]);
  }
  ImGui::EndChild();
  if (lines > 0) {
    ImGui::TextColored(theme::error, "%s",
                       fmt::format("{} cannot be listed", counted(captures.list.problems.size(), "folder")).c_str());
    ImGui::tellControl("problems");
    ImGui::BeginChild("##problems",
                      {width, lines * ImGui::GetTextLineHeightWithSpacing() - ImGui::GetStyle().ItemSpacing.y});
    for (const std::string& problem : captures.list.problems) {
      ImGui::TextUnformatted(clipped(problem, ImGui::GetContentRegionAvail().x).c_str());
      helpTooltip(problem);
    }
    ImGui::EndChild();
  }
  ImGui::EndGroup();
}

void CapturesDialog::drawChosen(Session& session, ImGuiLayer& layer, float height) {
  const CaptureEntry* entry = find(session, chosen_);
  if (!entry) return ImGui::TextColored(theme::dim, "Choose one on the left; tick two to compare them.");
  const float em = ImGui::GetFontSize(), width = ImGui::GetContentRegionAvail().x;
  if (!entry->recording)
    capturePicture(layer, thumbnailOf(session, *entry), {width, std::min(0.4f * height, 9 * width / 16)}, "no picture");
  const Config& config = entry->config;
  captureRow("made", timeInWords(entry->time), "Local time, as the manifest says or, where it does not, the file's");
  captureRow("scene", entry->described() ? config.scene->filename().string() : "\u2014",
             entry->described() ? config.scene->string() : kUndescribed);
  captureRow("view", entry->described() ? captureView(*entry) : "\u2014", "The first view of the manifest");
  if (config.size) captureRow("size", fmt::format("{} x {}", config.size->x, config.size->y), "Of the picture, pixels");
  captureRow("device", config.device.empty() ? "\u2014" : config.device,
             "The Vulkan device that made it, and its driver: " + config.driver);
  captureRow("program", config.program.empty() ? "\u2014" : config.program,
             "Version and commit of the irad that made it");
  const float buttons = 3 * ImGui::GetFrameHeightWithSpacing();
  if (ImGui::BeginChild("##settings", {0, std::max(ImGui::GetContentRegionAvail().y - buttons, 3 * em)})) {
    const Settings& now = entry->other ? session.sideA().edited : session.edited;
    if (!entry->described())
      wrappedDim(kUndescribed);
    else if (!differenceTable("##differing", entry->settings, now, "then", "now"))
      ImGui::TextColored(theme::dim, "settings as now");
    if (entry->other && session.comparison)
      differenceTable("##differing of B", *entry->other, session.sideB().edited, "B then", "now");
  }
  ImGui::EndChild();
  const float half = (width - ImGui::GetStyle().ItemSpacing.x) / 2;
  ImGui::BeginDisabled(!entry->described());
  if (ImGui::Button("Replay", {half, 0}))
    session.leave({Leaving::What::Replay, *config.scene, entry->folder / "manifest.json"});
  ImGui::EndDisabled();
  helpTooltip(
      "Takes its settings, lights, materials, hidden objects, view and camera into the window, as one step that can be "
      "undone; another scene is opened for it, after what is unsaved has been asked for");
  ImGui::SameLine();
  ImGui::BeginDisabled(entry->linear.empty());
  if (ImGui::Button("As reference", {half, 0})) {
    session.open(entry->linear);
    session.captures.shown = false;
  }
  ImGui::EndDisabled();
  helpTooltip("Its linear picture becomes what the views reference-picture and error compare with");
  if (ImGui::Button("Copy path", {half, 0})) ImGui::SetClipboardText(entry->folder.c_str());
  helpTooltip([&] { return fmt::format("Puts {} on the clipboard", entry->folder.string()); });
  ImGui::SameLine();
  if (ImGui::Button("Open folder", {half, 0})) session.openFolder = entry->folder;
  helpTooltip("In the desktop's file manager, by xdg-open");
}

void CapturesDialog::drawPair(Session& session, ImGuiLayer& layer, float height) {
  const std::array<CaptureEntry, 2>& of = recordings_ ? *recordings_ : session.captures.pair->of;
  const float width = ImGui::GetContentRegionAvail().x, half = (width - ImGui::GetStyle().ItemSpacing.x) / 2;
  const char* const names[] = {"first", "second"};
  const float top = ImGui::GetCursorPosY(), left = ImGui::GetCursorPosX();
  for (const size_t i : {0u, 1u}) {
    if (i > 0) ImGui::SameLine(left + half + ImGui::GetStyle().ItemSpacing.x);
    ImGui::BeginGroup();
    ImGui::TextUnformatted(
        clipped(fmt::format("{}: {}   {}   {}", names[i], of[i].name, timeInWords(of[i].time), captureOf(of[i])), half)
            .c_str());
    helpTooltip(of[i].folder.string());
    if (!recordings_) {
      capturePicture(layer, &session.captures.pair->pictures[i], {half, std::min(0.55f * height, 9 * half / 16)}, "");
      ImGui::tellPlace(i == 0 ? "first picture" : "second picture",
                       {ImGui::GetItemRectMin().x, ImGui::GetItemRectMin().y},
                       {ImGui::GetItemRectMax().x, ImGui::GetItemRectMax().y},
                       static_cast<bool>(session.captures.pair->pictures[i].image));
    }
    ImGui::EndGroup();
  }
  const float rest = std::max(height - (ImGui::GetCursorPosY() - top), 5 * ImGui::GetFontSize());
  if (ImGui::BeginChild("##numbers", {recordings_ ? 0.7f * width : half, rest})) {
    if (recordings_) {
      drawRecordingChanges(session.recorder);
      if (!session.recorder.changes.empty()) ImGui::tellControl("times");
    } else if (const auto& metrics = session.captures.pair->metrics) {
      const ViewInfo* view = of[0].view ? viewInfo(*of[0].view) : nullptr;
      for (const MetricRow& metric : metricRows(*metrics, "second", "first", view ? prettyUnit(view->unit) : ""))
        if (std::string_view(metric.name) != "FLIP") captureRow(metric.name, metric.text, metric.help);
      ImGui::tellControl("numbers");
    } else {
      const std::string& why = session.captures.pair->noMetrics;
      wrappedDim(why.empty() ? "being measured\u2026" : why.c_str());
    }
  }
  ImGui::EndChild();
  ImGui::SameLine();
  if (ImGui::BeginChild("##differences", {0, rest})) {
    if (!of[0].described() || !of[1].described())
      wrappedDim(fmt::format("{}: its settings are unknown", of[of[0].described() ? 1 : 0].name).c_str());
    else if (!differenceTable("##between", of[0].settings, of[1].settings, "first", "second"))
      ImGui::TextColored(theme::dim, "the same settings");
  }
  ImGui::EndChild();
}

void CapturesDialog::drawButtons(Session& session) {
  const float em = ImGui::GetFontSize();
  Captures& captures = session.captures;
  if (captures.pair || recordings_) {
    if (ImGui::Button("Back", {8 * em, 0})) {
      captures.endPair = true;
      recordings_.reset();
    }
    helpTooltip("To the list");
  } else {
    auto two = pair(session);
    const bool can = two.has_value();
    ImGui::BeginDisabled(!can);
    if (ImGui::Button("Compare the two", {10 * em, 0})) {
      if ((*two)[0].recording) {
        session.recorder.compare = {(*two)[0].folder, (*two)[1].folder};
        recordings_ = std::move(two);
      } else {
        captures.compare = std::move(two);
      }
    }
    ImGui::EndDisabled();
    helpTooltip(can ? "The older one is the first" : "Two with pictures, or two recordings: tick them in the list");
    ImGui::SameLine();
    if (ImGui::Button("Read again", {8 * em, 0})) {
      captures.read = true;
      captures.said.clear();
    }
    helpTooltip("Lists what the folder holds now");
  }
  ImGui::SameLine();
  if (ImGui::Button("Close", {8 * em, 0})) captures.shown = false;
  if (captures.said.empty()) return;
  ImGui::SameLine();
  ImGui::PushStyleColor(ImGuiCol_Text, theme::error);
  clippedText(captures.said, ImGui::GetContentRegionAvail().x);
  ImGui::PopStyleColor();
  ImGui::tellControl("said");
}

void CapturesDialog::draw(Session& session, ImGuiLayer& layer) {
  const bool other = session.asking || session.found || session.showOpen;
  if (session.captures.shown && !other && !ImGui::IsPopupOpen(kCapturesTitle)) {
    ImGui::OpenPopup(kCapturesTitle);
    begin(session);
  }
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::max(std::min(78 * em, window.x - 3 * em), 20 * em),
                            std::max(std::min(50 * em, window.y - 4 * em), 16 * em)});
  if (!ImGui::BeginPopupModal(kCapturesTitle, &session.captures.shown,
                              ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                  ImGuiWindowFlags_NoScrollbar))
    return;
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float height = room.y - ImGui::GetFrameHeightWithSpacing();
  if (session.captures.pair || recordings_) {
    ImGui::BeginChild("##pair", {0, height});
    drawPair(session, layer, height);
    ImGui::EndChild();
  } else {
    const float list = 0.58f * room.x;
    drawList(session, layer, list, height);
    ImGui::SameLine();
    ImGui::BeginChild("##chosen", {0, height});
    drawChosen(session, layer, height);
    ImGui::EndChild();
  }
  drawButtons(session);
  if (!session.captures.shown || other) ImGui::CloseCurrentPopup();
  ImGui::EndPopupModal();
}

}  // namespace irad
