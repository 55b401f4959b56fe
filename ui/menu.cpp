#include "ui/menu.h"

#include <fmt/format.h>

#include <algorithm>

#include "ui/history_list.h"
#include "ui/imgui.h"
#include "ui/overlay.h"
#include "ui/theme.h"
#include "ui/widgets.h"
#include "ui/words.h"

namespace irad {
namespace {

struct State {
  ImVec4 color;
  std::string text;
  const char* help = "";
};

State stateOf(const Session& session) {
  if (session.work) return {theme::accent, session.work->what};
  if (!session.pipeline) return {theme::dim, "no scene"};
  if (session.halted)
    return {theme::warning, "not rebuilt", "A rebuild failed or was cancelled: the picture shows the old state"};
  if (session.pending)
    return {theme::warning, "not applied yet", "Settings that rebuild wait for Apply in the panel Settings"};
  if (session.next < Redo::Shade) return {theme::accent, "next: " + stagesFrom(session.next, arrowGlyph())};
  if (session.built && session.built->faulty())
    return {theme::error, "wrong numbers", "The banner over the picture and the panel Solver say which"};
  if (session.paused) return {theme::warning, "paused", "The solver waits: Space, or Resume in the panel Solver"};
  if (session.asleep())
    return {theme::good, "asleep", "The light is solved: nothing is computed until something changes"};
  if (session.built && session.built->solve.frames > 0)
    return {theme::accent, "brute force: " + counted(session.built->solve.frames, "frame")};
  return {theme::accent, "solving: " + counted(session.sweepsSinceWake, "sweep")};
}

/// An item that does what a key does.
void actionItem(Session& session, const char* label, Action action, bool checked = false, bool enabled = true) {
  const auto all = bindings();
  const auto binding = std::find_if(all.begin(), all.end(), [&](const Binding& b) { return b.action == action; });
  if (ImGui::MenuItem(label, binding != all.end() ? binding->keys : nullptr, checked, enabled)) session.act(action);
}

void drawFile(Session& session) {
  actionItem(session, "Open\u2026", Action::Open);
  if (ImGui::BeginMenu("Open recent", !session.preferences.recent.empty())) {
    for (const std::filesystem::path& path : session.preferences.recent)
      if (ImGui::MenuItem(path.string().c_str())) session.open(path);
    ImGui::EndMenu();
  }
  if (ImGui::MenuItem("Load again", nullptr, false, session.pipeline != nullptr))
    session.open(session.pipeline->scene().path);
  ImGui::Separator();
  if (ImGui::MenuItem("Save lights, materials, objects, bookmarks, region", nullptr, false, session.edits.modified()))
    session.saveEdits();
  actionItem(session, "Save this view", Action::Capture, false, session.built.has_value());
  actionItem(session, "Save all views", Action::CaptureAll, false, session.built.has_value());
  if (ImGui::MenuItem("Captures\u2026", nullptr, session.captures.shown)) session.captures.shown = true;
  helpTooltip("Captures and recordings of the output folder: look at them, take one back into the window, compare two");
  if (session.underRenderDoc && ImGui::MenuItem("Capture a frame with RenderDoc")) session.captureFrame = true;
  ImGui::Separator();
  actionItem(session, "Quit", Action::Quit);
}

/// Undo and redo with the names of their steps, and all of them.
void drawEdit(Session& session) {
  const History& history = session.history;
  const float width = 24 * ImGui::GetFontSize();
  const auto item = [&](const char* what, Action action, bool can, size_t step) {
    const std::string label = can ? fmt::format("{}: {}", what, history.steps()[step].name) : what;
    actionItem(session, fmt::format("{}###{}", clipped(label, width), what).c_str(), action, false, can);
  };
  item("Undo", Action::Undo, history.canUndo(), history.at());
  item("Redo", Action::Redo, history.canRedo(), history.at() + 1);
  ImGui::Separator();
  actionItem(session, "Find a setting", Action::FindSetting);
  ImGui::Separator();
  if (ImGui::BeginMenu("History", !history.steps().empty())) {
    const float rows = std::min(static_cast<float>(history.steps().size()), 16.0f);
    ImGui::BeginChild("##list", {width, rows * ImGui::GetTextLineHeightWithSpacing()});
    historyList(session, ImGui::GetContentRegionAvail().x);
    ImGui::EndChild();
    ImGui::EndMenu();
  }
}

void drawView(Session& session, const Panels& panels) {
  if (session.pipeline && ImGui::BeginMenu("Camera")) {
    const std::vector<Camera> cameras = session.cameras();
    for (int i = 0; i < static_cast<int>(cameras.size()); ++i) {
      ImGui::PushID(i);
      if (ImGui::MenuItem(cameraName(cameras[static_cast<size_t>(i)], i).c_str(), nullptr, i == session.sceneCamera))
        session.useSceneCamera(i);
      ImGui::PopID();
    }
    ImGui::EndMenu();
  }
  if (ImGui::BeginMenu("Panels")) {
    std::set<std::string>& folded = session.preferences.folded;
    const auto item = [&](const char* title) {
      const bool open = !folded.contains(title);
      if (ImGui::MenuItem(title, nullptr, open)) keepFolded(folded, title, !open);
    };
    for (const auto& panel : panels) item(panel->title());
    ImGui::Separator();
    item(kLeftColumn);
    item(kRightColumn);
    ImGui::EndMenu();
  }
  actionItem(session, "Fill the window with the picture", Action::FillWindow, session.fillWindow);
  actionItem(session, "Hide panels and menus", Action::HideUi, session.hideUi);
  if (ImGui::BeginMenu("Size of text and panels")) {
    for (const int percent : {75, 100, 125, 150, 175, 200, 250, 300}) {
      const float scale = 0.01f * static_cast<float>(percent);
      if (ImGui::MenuItem(fmt::format("{} %", percent).c_str(), nullptr, session.scale == scale))
        session.preferences.scale = scale;
    }
    ImGui::EndMenu();
  }
  if (ImGui::MenuItem("Reset the layout")) session.preferences.resetLayout();
}

void drawSolver(Session& session) {
  actionItem(session, "Paused", Action::Pause, session.paused);
  if (ImGui::MenuItem("Rebuild", nullptr, false, session.halted)) session.rebuild = true;
  actionItem(session, "Compile shaders again", Action::ReloadShaders);
}

}  // namespace

void drawMenuBar(Session& session, const Panels& panels, const Rect& where) {
  const ImGuiStyle& style = ImGui::GetStyle();
  // As high as the bar; open menus have a padding of their own.
  const ImVec2 high{style.FramePadding.x, std::max((where.size.y - ImGui::GetFontSize()) * 0.5f, 0.0f)};
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, high);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(style.WindowPadding.x, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  beginTile("##bar", where, /*filled=*/true, /*scrolls=*/false, /*menus=*/true);
  ImGui::PopStyleVar(3);
  const bool shown = ImGui::BeginMenuBar();
  ImGui::PopStyleVar();
  if (shown) {
    ImGui::PushID("Menu");
    const auto menu = [&](const char* name, auto&& draw) {
      if (!ImGui::BeginMenu(name)) return;
      draw();
      ImGui::EndMenu();
    };
    menu("File", [&] { drawFile(session); });
    menu("Edit", [&] { drawEdit(session); });
    menu("View", [&] { drawView(session, panels); });
    menu("Solver", [&] { drawSolver(session); });
    menu("Help", [&] {
      actionItem(session, "Keys and mouse", Action::Help, session.showHelp);
      if (ImGui::MenuItem("Glossary", nullptr, session.showGlossary)) session.showGlossary = !session.showGlossary;
    });

    // The scene's file between the menus and the state.
    const State state = stateOf(session);
    const float gap = 2 * ImGui::GetFontSize(), width = ImGui::GetContentRegionAvail().x;
    const float stateWidth = std::min(ImGui::CalcTextSize(state.text.c_str()).x, width * 0.6f);
    const float start = ImGui::GetCursorPosX();
    if (session.pipeline) {
      ImGui::SetCursorPosX(start + gap);
      ImGui::PushStyleColor(ImGuiCol_Text, theme::dim);
      std::string file = session.pipeline->scene().path.filename().string();
      if (session.edits.modified()) file += "   unsaved changes";
      clippedText(file, std::max(width - stateWidth - 2 * gap, 1.0f));
      ImGui::PopStyleColor();
    }
    ImGui::SetCursorPosX(start + width - stateWidth);
    ImGui::PushStyleColor(ImGuiCol_Text, state.color);
    clippedText(state.text, stateWidth + 1);
    ImGui::PopStyleColor();
    if (*state.help != 0) helpTooltip(state.help);
    ImGui::PopID();
    ImGui::EndMenuBar();
  }
  endTile();
}

}  // namespace irad
