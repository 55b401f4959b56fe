#include "ui/missing_input.h"

#include <fmt/format.h>

#include <algorithm>

#include "ui/imgui.h"
#include "ui/session.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

void openFile(Session& session) {
  session.showOpen = true;
}

MissingInput ofSetting(std::string title, std::string text, const char* value, std::function<void(Settings&)> set) {
  return {std::move(title), std::move(text), fmt::format("Set {}", value),
          [set = std::move(set)](Session& session) { set(session.edited); }};
}

std::optional<MissingInput> ofShadowMaps(const Session& session) {
  const std::vector<Light>& lights = session.pipeline->scene().lights;
  const uint32_t chosen = session.edited.view.light;
  if (lights.empty())
    return MissingInput{"No light", "This view shows one light's shadows, and the scene has no lights.", "", {}};
  if (chosen >= lights.size() || chosen >= session.edits.lights.size()) return std::nullopt;
  if (session.built->lacksShadow(chosen))
    return MissingInput{
        "No shadow map",
        fmt::format(
            "The light \"{}\", which this view is of, casts no shadow: the device has not the layers for so many "
            "lights, and the strongest have them.",
            lights[chosen].name),
        "",
        {}};
  if (lights[chosen].on) return std::nullopt;
  return MissingInput{"No shadow map",
                      fmt::format("The light \"{}\", which this view is of, is off.", lights[chosen].name),
                      "Turn it on", [chosen](Session& s) {
                        if (chosen < s.edits.lights.size()) s.edits.lights[chosen].on = true;
                      }};
}

}  // namespace

std::optional<MissingInput> missingInput(const Session& session) {
  const ViewInfo* info = viewInfo(session.view);
  if (info == nullptr || !session.pipeline || !session.built) return std::nullopt;
  const Settings& obeyed = session.pipeline->obeyed();
  const bool framewise = obeyed.solver.method == SolverMethod::bruteForce;
  const auto useMatrix = [](Settings& s) { s.solver.method = SolverMethod::matrix; };
  if (info->isFrom(FROM_PICTURE) && !session.pipeline->hasReference())
    return MissingInput{
        "No reference picture",
        "Open a picture of linear light (.exr, .hdr, .pfm), or drop one on the window. One that is twice as "
        "wide as high is taken for a sky.",
        "Open a picture\u2026", openFile};
  if (framewise && info->isFrom(FROM_MATRIX | FROM_MATRIX_ROW))
    return ofSetting("No matrix", "solver.method = brute_force traces rays anew in every frame and keeps no matrix.",
                     "solver.method = matrix", useMatrix);
  if (!framewise && info->isFrom(FROM_STANDARD_ERROR))
    return ofSetting("No standard error",
                     "Only the frames of solver.method = brute_force, each with rays of its own, have a spread.",
                     "solver.method = brute_force", [](Settings& s) { s.solver.method = SolverMethod::bruteForce; });
  if (framewise && info->isFrom(FROM_SKY))
    return ofSetting("The sky's share is not known",
                     "With solver.method = brute_force what comes from the sky is in H, and nowhere by itself.",
                     "solver.method = matrix", useMatrix);
  if (info->isFrom(FROM_SKY) && obeyed.sky.source == SkySource::none)
    return MissingInput{
        "No sky",
        "sky.source = none. Open a picture of the whole sphere, twice as wide as high (.hdr, .exr, .pfm), or "
        "choose another sky.source in the panel Settings.",
        "Open a sky\u2026", openFile};
  if (info->isFrom(FROM_ORACLE) && !session.pipeline->knowsIrradiance())
    return MissingInput{"No exact answer", "Only check scenes know it. They are opened by their names, as check:NAME.",
                        "Open a check scene\u2026", openFile};
  if (info->isFrom(FROM_WRITTEN) && session.edited.writeback.mode == WritebackMode::off)
    return ofSetting("Nothing is written back", "writeback.mode = off: reflections are seen, and light nothing.",
                     "writeback.mode = compute", [](Settings& s) { s.writeback.mode = WritebackMode::compute; });
  if (info->isFrom(FROM_SHADOW_MAPS)) return ofShadowMaps(session);
  return std::nullopt;
}

void drawMissingInput(Session& session, const Rect& viewport) {
  if (session.work || session.dialogOpen()) return;
  const std::optional<MissingInput> missing = missingInput(session);
  if (!missing) return;
  const float em = ImGui::GetFontSize();
  const float width = std::max(std::min(26 * em, viewport.size.x - 2 * em), 8 * em);
  ImGui::SetNextWindowPos({viewport.position.x + 0.5f * viewport.size.x, viewport.position.y + 0.5f * viewport.size.y},
                          ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, viewport.size.y});
  ImGui::Begin("##missing", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PushID("missing");
  const ImVec2 low = ImGui::GetWindowPos(), extent = ImGui::GetWindowSize();
  ImGui::tellPlace("box", {low.x, low.y}, {low.x + extent.x, low.y + extent.y});
  pushHeadingFont();
  clippedText(missing->title, ImGui::GetContentRegionAvail().x);
  ImGui::PopFont();
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(missing->text.c_str());
  ImGui::PopTextWrapPos();
  if (!missing->button.empty() && ImGui::Button((missing->button + "###mend").c_str(), {-1, 0})) missing->mend(session);
  ImGui::PopID();
  ImGui::End();
}

}  // namespace irad
