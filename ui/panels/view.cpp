// What the viewport shows: the view, what it has to choose, and how its values become a picture.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gi/thesis/jump_flood.h"
#include "ui/histogram.h"
#include "ui/imgui.h"
#include "ui/panel.h"
#include "ui/setting_rows.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

constexpr View kNumberKeys = 9;  ///< views with a key of their own, the registry's first

/// The groups of the registry, in the order in which they first occur.
std::vector<const char*> groups() {
  std::vector<const char*> out;
  for (const ViewInfo& info : views())
    if (std::none_of(out.begin(), out.end(), [&](const char* g) { return std::string_view(g) == info.group; }))
      out.push_back(info.group);
  return out;
}

std::string lightLabel(const Scene& scene, uint32_t index) {
  if (index >= scene.lights.size()) return "none";
  const Light& light = scene.lights[index];
  return fmt::format("{}: {}", index, light.name.empty() ? lightKind(light.type).name : light.name.c_str());
}

class ViewPanel : public Panel {
 public:
  const char* title() const override { return "View"; }
  const char* help() const override {
    return "What the picture shows, how its values become colours, and how often they occur";
  }
  Region region() const override { return Region::Right; }

  void draw(Session& session) override {
    const ViewInfo* info = viewInfo(session.view);
    drawCombo(session, info);
    if (info != nullptr) {
      const std::string unit = shownQuantity(*info, session.edited).unit;
      valueRow("unit", unit.empty() ? "none" : prettyUnit(unit));
      helpTooltip("In which the view's values are given, in the legend and in the status line");
      drawShape(session, *info);
      if (info->isFrom(FROM_JUMP_FLOOD)) drawPass(session);
      if (info->isFrom(FROM_SHADOW_MAPS)) drawLight(session);
      drawNotes(session, *info);
      if (info->hasRange()) drawRange(session, *info);
      if (info->toneMapped()) {
        row(session, "camera.exposure");
        row(session, "camera.auto_exposure");
        if (session.edited.camera.autoExposure) {
          valueRow("exposed", fmt::format("{:+.2f} EV", std::log2(session.exposure())));
          helpTooltip("What the picture is exposed by, the automatic part included: 2^EV times as bright as it is");
        }
        row(session, "camera.tone_curve");
      }
      const bool histogram = ImGui::TreeNodeEx("Histogram", ImGuiTreeNodeFlags_SpanAvailWidth);
      helpTooltip("How often the view's values occur in the picture; the range's ends are dragged on it");
      if (histogram) {
        drawHistogram(session, *info);
        ImGui::TreePop();
      }
    }
    ImGui::Separator();
    const glm::dvec3 p = session.camera.camera().position;
    valueRow("position", fmt::format("{:.2f}, {:.2f}, {:.2f}", p.x, p.y, p.z));
    helpTooltip("The camera's x, y and z in the world, metres");
    valueRow("speed", fmt::format("{:.3g} m/s", session.camera.unitsPerSecond()));
    helpTooltip("At which keys fly, metres a second; the wheel over the picture changes it");
    const glm::uvec2 size = session.targets.size;
    valueRow("picture", size.x > 0 ? fmt::format("{} \u00D7 {}", size.x, size.y) : "\u2014");
    helpTooltip("Width and height in pixels, which Save (F12) takes, too");
    if (ImGui::Button("Save (F12)", {-1, 0})) session.capture = true;
    helpTooltip(
        "This view at this size as PNG (as shown) and EXR (linear, before exposure and tone curve), and the manifest "
        "that `irad render --config` draws it from again. Shift + F12: all views.");
  }

 private:
  static void row(Session& session, const char* setting) { settingRow(session.edited, session.defaults, setting); }

  static void drawCombo(Session& session, const ViewInfo* shown) {
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::BeginCombo("##view", shown ? shown->label : "?", ImGuiComboFlags_HeightLarge))
      return helpTooltip("The quantity that the picture shows; the keys 1 to 9 choose the first ones (docs/views.md)");
    for (const char* group : groups()) {
      ImGui::TextColored(theme::dim, "%s", group);
      for (const ViewInfo& info : views()) {
        if (std::string_view(group) != info.group) continue;
        const std::string text = (info.view < kNumberKeys ? fmt::format("{}  {}", info.view + 1, info.label)
                                                          : fmt::format("    {}", info.label)) +
                                 "###" + info.name;
        const bool chosen = info.view == session.view;
        if (ImGui::Selectable(text.c_str(), chosen)) {
          session.view = info.view;
          session.viewDirty = true;
        }
        if (chosen && ImGui::IsWindowAppearing()) ImGui::SetScrollHereY();
      }
    }
    ImGui::EndCombo();
  }

  static void drawShape(Session& session, const ViewInfo& info) {
    const auto shape = resolveShape(info.view, session.edited.view.shape);
    if (!shape) return;
    row(session, "view.shape");
    if (*shape == ViewShape::slice) {
      row(session, "view.axis");
      row(session, "view.slice");
    }
    if (info.ofField() && (*shape == ViewShape::cubes || *shape == ViewShape::isosurface))
      row(session, "view.isovalue");
    const ViewShape wanted = session.edited.view.shape;
    if (wanted != ViewShape::automatic && *shape != wanted)
      note(fmt::format("This view has no {}: shown as {}.", nameOf(wanted), nameOf(*shape)));
  }

  /// From the seeds alone to the last pass, with the arrows or the slider.
  static void drawPass(Session& session) {
    if (!session.built) return;
    const int last = static_cast<int>(jumpFloodPasses(Grid{.dims = session.built->dims}));
    uint32_t& setting = session.edited.view.jfaPass;
    int pass = std::min(static_cast<int>(setting), last);
    ImGui::PushID("pass");
    const float button = ImGui::GetFrameHeight(), gap = ImGui::GetStyle().ItemInnerSpacing.x;
    bool changed = ImGui::ArrowButton("back", ImGuiDir_Left);
    helpTooltip("The pass before");
    if (changed) --pass;
    ImGui::SameLine(0, gap);
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button - gap);
    const std::string label = pass == 0 ? "seeds" : fmt::format("pass %d of {}, step {}", last, 1 << (last - pass));
    changed |= ImGui::SliderInt("##slider", &pass, 0, last, label.c_str(), ImGuiSliderFlags_AlwaysClamp);
    helpTooltip(
        "view.jfa_pass\nThe view shows what jump flooding knows after so many of its passes: of every voxel the "
        "nearest "
        "solid one. seeds: before the first.");
    ImGui::SameLine(0, gap);
    if (ImGui::ArrowButton("on", ImGuiDir_Right)) {
      ++pass;
      changed = true;
    }
    helpTooltip("The pass after");
    ImGui::PopID();
    if (changed) setting = static_cast<uint32_t>(std::clamp(pass, 0, last));
  }

  static void drawLight(Session& session) {
    if (!session.pipeline) return;
    const Scene& scene = session.pipeline->scene();
    uint32_t& light = session.edited.view.light;
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::BeginCombo("##light", lightLabel(scene, light).c_str()))
      return helpTooltip("view.light\nThe light whose shadow map the view shows");
    for (uint32_t i = 0; i < scene.lights.size(); ++i)
      if (ImGui::Selectable(lightLabel(scene, i).c_str(), i == light)) light = i;
    ImGui::EndCombo();
  }

  static void drawNotes(const Session& session, const ViewInfo& info) {
    if (!session.pipeline) return;
    const Pipeline& pipeline = *session.pipeline;
    if (info.isFrom(FROM_PICTURE) && !pipeline.hasReference())
      note("There is no picture to compare with: open an .exr, .hdr or .pfm, or drop one on the window.");
    else if (info.isFrom(FROM_PICTURE) && info.isFrom(FROM_TARGETS))
      note(fmt::format(
          "(L - R) / sqrt(R\u00B2 + {}), L and R the luminances of picture and reference, from the reference's "
          "camera: 0.1 is a tenth too bright, -0.1 a tenth too dark.",
          VIEW_ERROR_EPSILON));
    else if (const std::string missing = whatIsMissing(info, pipeline.obeyed()); !missing.empty())
      note(missing);
    else if (info.isFrom(FROM_MATRIX_ROW))
      note(fmt::format("F from facet {} to each facet: click the picture to take another's row.",
                       session.edited.view.facet));
    else if (info.isFrom(FROM_ORACLE) && !pipeline.knowsIrradiance())
      note("Only check scenes know the exact answer.");
  }

  static void drawRange(Session& session, const ViewInfo& info) {
    row(session, "view.range");
    const RangeMode mode = session.edited.view.range;
    if (mode == RangeMode::percentile) row(session, "view.percentile");
    if (mode == RangeMode::manual) {
      row(session, "view.low");
      row(session, "view.high");
    }
    if (session.range && session.rangeView == info.view) {
      valueRow("shown", fmt::format("{:.4g} to {:.4g}", session.range->low, session.range->high));
      helpTooltip("The values that the two ends of the colours stand for, in the view's unit");
      if (mode != RangeMode::manual) {
        if (ImGui::Button("Keep this range", {-1, 0})) {
          session.edited.view.low = std::max(session.range->low, -1e6f);
          session.edited.view.high = std::min(session.range->high, 1e6f);
          session.edited.view.range = RangeMode::manual;
        }
        helpTooltip("The colours stand for these values in pictures to come, too (view.range = manual)");
      }
    }
    if (info.kind == VIEW_KIND_SIGNED) {
      valueRow("color map", colorMapName(COLOR_MAP_BLUE_RED));
      helpTooltip("Of values with a sign always this: blue below 0, red above");
    } else
      row(session, "view.color_map");
  }

  static void note(const std::string& text) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextColored(theme::dim, "%s", text.c_str());
    ImGui::PopTextWrapPos();
  }
};

}  // namespace

std::unique_ptr<Panel> makeViewPanel() {
  return std::make_unique<ViewPanel>();
}

}  // namespace irad
