#include "ui/overlay.h"

#include <fmt/format.h>

#include <algorithm>

#include "ui/bindings.h"
#include "ui/imgui.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {

namespace {

constexpr ImGuiWindowFlags kFloating = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                       ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                                       ImGuiWindowFlags_NoFocusOnAppearing;

void floatAt(const Rect& around, ImVec2 pivot, float margin) {
  const ImVec2 at{around.position.x + (around.size.x - 2 * margin) * pivot.x + margin,
                  around.position.y + (around.size.y - 2 * margin) * pivot.y + margin};
  ImGui::SetNextWindowPos(at, ImGuiCond_Always, pivot);
}

}  // namespace

void beginTile(const char* name, const Rect& where, bool filled, bool scrolls, bool menus) {
  ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                           ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                           ImGuiWindowFlags_NoBringToFrontOnFocus;
  if (!filled) flags |= ImGuiWindowFlags_NoBackground;
  if (!scrolls) flags |= ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
  if (menus) flags |= ImGuiWindowFlags_MenuBar;
  ImGui::SetNextWindowPos({where.position.x, where.position.y});
  ImGui::SetNextWindowSize({where.size.x, where.size.y});
  ImGui::Begin(name, nullptr, flags);
}

void endTile() {
  ImGui::End();
}

void drawBanner(const Session& session, const Rect& viewport) {
  if (!session.built || !session.built->faulty()) return;
  ImGui::SetNextWindowPos({viewport.position.x, viewport.position.y});
  ImGui::SetNextWindowSizeConstraints({viewport.size.x, 0}, {viewport.size.x, viewport.size.y});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, theme::alarm);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
  ImGui::Begin("##banner", nullptr, kFloating | ImGuiWindowFlags_NoInputs);
  ImGui::PushTextWrapPos(0);
  for (const Finding& finding : session.built->findings)
    if (finding.severity == Finding::Severity::Error) ImGui::TextUnformatted(finding.text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::End();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
}

void drawMessages(Session& session, const Rect& viewport) {
  const auto now = std::chrono::steady_clock::now();
  std::erase_if(session.messages, [&](const Message& m) {
    return m.kind == Message::Kind::Note && m.shown && now >= *m.shown + Message::kNoteStays;
  });
  for (Message& message : session.messages)
    if (!message.shown) message.shown = now;
  if (session.messages.empty()) return;
  const float em = ImGui::GetFontSize(), left = viewport.position.x + em;
  float width = std::max(std::min(36 * em, viewport.size.x - 2 * em), 8 * em);
  float bottom = viewport.position.y + viewport.size.y - em;
  // Beside a legend where there is room enough for lines to be read, else above it.
  for (const Rect& legend : session.legends) {
    if (legend.position.x >= left + 20 * em)
      width = std::min(width, legend.position.x - 0.5f * em - left);
    else
      bottom = std::min(bottom, legend.position.y - 0.5f * em);
  }
  ImGui::SetNextWindowPos({left, bottom}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, std::max(0.6f * (bottom - viewport.position.y), 4 * em)});
  ImGui::Begin("##messages", nullptr, kFloating & ~ImGuiWindowFlags_NoScrollbar);
  if (ImGui::IsWindowHovered(ImGuiHoveredFlags_ChildWindows))
    for (Message& message : session.messages) message.shown = now;
  ImGui::PushID("messages");
  std::optional<size_t> dismissed;
  for (size_t i = 0; i < session.messages.size(); ++i) {
    const Message& message = session.messages[i];
    ImGui::PushID(static_cast<int>(i));
    const float button = ImGui::GetFrameHeight();
    const float start = ImGui::GetCursorPosX(), row = ImGui::GetContentRegionAvail().x;
    if (i > 0) ImGui::Separator();
    ImGui::PushTextWrapPos(start + row - button - em * 0.5f);
    ImGui::PushStyleColor(ImGuiCol_Text, message.kind == Message::Kind::Error ? theme::error : theme::text);
    const float top = ImGui::GetCursorPosY();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(message.text.c_str());
    ImGui::PopStyleColor();
    ImGui::PopTextWrapPos();
    if (!message.folder.empty()) {
      if (ImGui::SmallButton("Copy path")) ImGui::SetClipboardText(message.folder.c_str());
      helpTooltip(fmt::format("Puts {} on the clipboard", message.folder.string()));
      ImGui::SameLine();
      if (ImGui::SmallButton("Open folder")) session.openFolder = message.folder;
      helpTooltip("In the desktop's file manager, by xdg-open");
    }
    const float end = ImGui::GetCursorPosY();
    ImGui::SetCursorPos({start + row - button, top});
    if (ImGui::Button("\u00D7###dismiss", {button, button})) dismissed = i;
    ImGui::SetCursorPosY(std::max(end, ImGui::GetCursorPosY()));
    ImGui::PopID();
  }
  const bool clear = session.messages.size() > 1 && ImGui::Button("Clear all", {-1, 0});
  ImGui::PopID();
  ImGui::End();
  if (clear)
    session.messages.clear();
  else if (dismissed)
    session.messages.erase(session.messages.begin() + static_cast<ptrdiff_t>(*dismissed));
}

std::string frameTime(const Session& session) {
  const std::deque<FrameSample>& frames = session.context.timings.frames();
  for (auto frame = frames.rbegin(); frame != frames.rend(); ++frame)
    if (frame->kind != WorkKind::Setup) return fmt::format("last frame {} ms", milliseconds(frame->gpuMs()));
  return {};
}

void drawFrameTime(const Session& session, const Rect& viewport) {
  const std::string text = frameTime(session);
  if (text.empty()) return;
  const float em = ImGui::GetFontSize();
  floatAt(viewport, {1, 0}, 0.5f * em);
  ImGui::SetNextWindowBgAlpha(0.7f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0.5f * em, 0.2f * em));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  ImGui::Begin("##frame-time", nullptr, kFloating | ImGuiWindowFlags_NoInputs);
  ImGui::PopStyleVar(2);
  ImGui::TextUnformatted(text.c_str());
  ImGui::tellControl("frame time");
  ImGui::End();
}

void drawProgress(Session& session, const Rect& viewport) {
  if (!session.work) return;
  const float em = ImGui::GetFontSize();
  const float width = std::max(std::min(28 * em, viewport.size.x - 2 * em), 8 * em);
  floatAt(viewport, {0.5f, 0.5f}, em);
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, viewport.size.y});
  ImGui::Begin("##progress", nullptr, kFloating);
  ImGui::PushID("progress");
  pushHeadingFont();
  clippedText(session.work->what, ImGui::GetContentRegionAvail().x);
  ImGui::PopFont();
  ImGui::TextColored(theme::dim, "%s", session.work->stage.c_str());
  const std::string percent = fmt::format("{:.0f} %", 100 * session.work->fraction);
  const float button = ImGui::CalcTextSize("Cancel").x + 2 * ImGui::GetStyle().FramePadding.x;
  ImGui::ProgressBar(session.work->fraction,
                     {ImGui::GetContentRegionAvail().x - button - ImGui::GetStyle().ItemSpacing.x, 0}, percent.c_str());
  ImGui::SameLine();
  if (ImGui::Button(session.work->cancel ? "\u2026###cancel" : "Cancel###cancel", {button, 0}))
    session.work->cancel = true;
  ImGui::PopID();
  ImGui::End();
}

void drawHelp(Session& session, const Rect& window) {
  if (!session.showHelp) return;
  const float em = ImGui::GetFontSize();
  floatAt(window, {0.5f, 0.5f}, em);
  ImGui::SetNextWindowSizeConstraints({0, 0}, {window.size.x, std::max(window.size.y - em, 8 * em)});
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, ImVec2(0.3f * em, 0));  // all rows in a low window, too
  ImGui::Begin("##help", nullptr, kFloating & ~ImGuiWindowFlags_NoScrollbar);
  pushHeadingFont();
  ImGui::TextUnformatted("Keys and mouse");
  ImGui::PopFont();
  if (ImGui::BeginTable("bindings", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const Binding& binding : bindings()) {
      if (!binding.does) continue;
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextColored(theme::accent, "%s", binding.keys);
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(binding.does);
    }
    ImGui::EndTable();
  }
  ImGui::TextColored(theme::dim, "Keys are ignored while a text field has the keyboard.");
  ImGui::PushID("help");
  ImGui::tellControl("end");
  ImGui::PopID();
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace irad
