// The scene's lights: list, add, remove, and the fields of the one chosen. The picture follows at once; the scene's
// file is never touched.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ui/imgui.h"
#include "ui/light_color.h"
#include "ui/panel.h"
#include "ui/sidecar_row.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

constexpr float kDegree = std::numbers::pi_v<float> / 180.0f;

const char* typeName(const Light& light) {
  return lightKind(light.type).name;
}

/// A light at the camera that shines where it looks: a white surface facing it at a quarter of the scene's diagonal has
/// radiance 1. Lamps are put a little ahead, where they can be seen and grabbed.
Light lightAtCamera(const LightKind& kind, const Camera& camera, float diagonal) {
  const glm::vec3 forward = glm::normalize(camera.orientation * glm::vec3(0, 0, -1));
  const float distance = 0.25f * diagonal;
  Light light;
  light.type = kind.type;
  light.name = typeName(light);
  light.direction = forward;
  light.position = camera.position + glm::dvec3(forward) * (0.4 * distance);
  light.intensity = std::numbers::pi_v<float> * (kind.has(LIGHT_DISTANT) ? 1.0f : distance * distance);
  light.intensity = std::clamp(light.intensity, 1e-6f, 1e12f);
  light.outerCos = std::cos(30 * kDegree);
  return light;
}

class LightsPanel : public Panel {
 public:
  const char* title() const override { return "Lights"; }
  Region region() const override { return Region::Left; }

  void draw(Session& session) override {
    if (!session.pipeline) return ImGui::TextColored(theme::dim, "no scene");
    SceneEdits& edits = session.edits;
    drawAdd(session);
    drawList(edits);
    drawListButtons(edits);
    if (Light* light = edits.light()) {
      ImGui::PushID(edits.selected);
      drawFields(*light, session);
      ImGui::PopID();
    }
    ImGui::Checkbox("handles in the picture", &edits.showHandles);
    helpTooltip(
        "Drag a light to move it in the plane of the view, with Shift along the view; drag the square at the "
        "end of its arrow to aim it.");
    sidecarRow(session);
  }

 private:
  static void drawAdd(Session& session) {
    const glm::vec3 size = session.pipeline->scene().boundsMax - session.pipeline->scene().boundsMin;
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(theme::dim, "add");
    for (const LightKind& kind : lightKinds()) {
      ImGui::SameLine();
      const Light light = lightAtCamera(kind, session.camera.camera(), std::max(glm::length(size), 1e-6f));
      if (ImGui::Button(kind.name)) session.edits.add(light);
      helpTooltip(kind.has(LIGHT_DIRECTION) ? fmt::format("A {} that shines the way the camera looks", kind.name)
                                            : fmt::format("A {} ahead of the camera", kind.one));
    }
  }

  static void drawList(SceneEdits& edits) {
    if (edits.lights.empty()) return ImGui::TextColored(theme::dim, "no lights");
    const float row = ImGui::GetTextLineHeightWithSpacing(), em = ImGui::GetFontSize();
    const float rows = std::min(static_cast<float>(edits.lights.size()), 6.0f);
    ImGui::BeginChild("##list", {0, rows * row});
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(edits.lights.size()), row);
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        const Light& light = edits.lights[static_cast<size_t>(i)];
        ImGui::PushID(i);
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float start = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x;
        if (ImGui::Selectable("##", i == edits.selected)) edits.selected = i;
        ImGui::GetWindowDrawList()->AddCircleFilled({at.x + em * 0.5f, at.y + em * 0.5f}, em * 0.3f,
                                                    displayColor(light.color));
        ImGui::SameLine(start + em * 1.3f);
        const float type = ImGui::CalcTextSize(typeName(light)).x;
        clippedText(light.name.empty() ? "(no name)" : light.name, width - em * 1.8f - type);
        ImGui::SameLine(start + width - type);
        ImGui::TextColored(theme::dim, "%s", typeName(light));
        ImGui::PopID();
      }
    ImGui::EndChild();
  }

  static void drawListButtons(SceneEdits& edits) {
    if (edits.light() == nullptr) return;
    if (ImGui::Button("Duplicate")) edits.add(Light(*edits.light()));
    ImGui::SameLine();
    if (ImGui::Button("Remove")) edits.remove();
    helpTooltip("Ctrl + Z brings it back");
  }

  static void drawFields(Light& light, Session& session) {
    fieldLabel("name");
    ImGui::InputText("##name", &light.name);
    fieldLabel("type");
    std::vector<const char*> names;
    for (const LightKind& other : lightKinds()) names.push_back(other.name);
    int type = static_cast<int>(light.type);
    if (ImGui::Combo("##type", &type, names.data(), static_cast<int>(names.size())))
      light.type = static_cast<LightType>(type);
    const LightKind& kind = lightKind(light.type);
    const bool distant = kind.has(LIGHT_DISTANT);

    fieldLabel("color", "As shown on a display; the file holds it linear");
    glm::vec3 shown = glm::convertLinearToSRGB(light.color);
    if (ImGui::ColorEdit3("##color", &shown.x, ImGuiColorEditFlags_Float))
      light.color = glm::convertSRGBToLinear(shown);
    fieldLabel("intensity", distant ? "Irradiance of a surface that faces the sun, lux (W/m\u00B2)"
                                    : "Candela (W/sr): at a distance d a facing surface receives intensity / d\u00B2");
    ImGui::DragFloat("##intensity", &light.intensity, std::max(light.intensity * 0.01f, 1e-6f), 0,
                     static_cast<float>(kMaxLightOrEmission), distant ? "%.4g lx" : "%.4g cd",
                     ImGuiSliderFlags_AlwaysClamp);
    if (kind.has(LIGHT_RANGE)) {
      fieldLabel("range", "Distance at which the light has faded out; 0: unlimited");
      ImGui::DragFloat("##range", &light.range, std::max(light.range * 0.01f, 0.01f), 0,
                       static_cast<float>(kMaxCoordinate), light.range > 0 ? "%.4g" : "unlimited",
                       ImGuiSliderFlags_AlwaysClamp);
    }
    if (distant) {
      fieldLabel("angle", "How large it is seen, across: the wider, the softer its shadows. Our sun has .53\u00B0");
      ImGui::DragFloat("##angle", &light.angle, 0.02f, 0, static_cast<float>(kMaxLightAngle),
                       light.angle > 0 ? "%.3g\u00B0" : "a point", ImGuiSliderFlags_AlwaysClamp);
    } else {
      fieldLabel("radius", "Of the lamp, scene units: the larger, the softer its shadows");
      ImGui::DragFloat("##radius", &light.radius, std::max(light.radius * 0.01f, 0.001f), 0,
                       static_cast<float>(kMaxCoordinate), light.radius > 0 ? "%.4g" : "a point",
                       ImGuiSliderFlags_AlwaysClamp);
    }
    if (kind.has(LIGHT_CONE)) drawCone(light);

    fieldLabel("position", distant ? "Of its handle in the picture: the light comes from everywhere"
                                   : "World coordinates, scene units");
    const double low = -kMaxCoordinate, high = kMaxCoordinate;
    const float size = glm::distance(session.pipeline->scene().boundsMin, session.pipeline->scene().boundsMax);
    ImGui::DragScalarN("##position", ImGuiDataType_Double, &light.position.x, 3, std::max(size * 1e-3f, 1e-9f), &low,
                       &high, "%.4g", ImGuiSliderFlags_AlwaysClamp);
    if (kind.has(LIGHT_DIRECTION)) {
      fieldLabel("direction", "The way it shines");
      glm::vec3 direction = light.direction;
      if (ImGui::DragFloat3("##direction", &direction.x, 0.005f, -1, 1, "%.3f", ImGuiSliderFlags_AlwaysClamp) &&
          glm::length(direction) > 1e-3f)
        light.direction = glm::normalize(direction);
    }
    if (ImGui::Button("Take to the camera")) {
      const Camera& camera = session.camera.camera();
      light.position = camera.position;
      light.direction = glm::normalize(camera.orientation * glm::vec3(0, 0, -1));
    }
    helpTooltip("Its position, shining the way the camera looks");
  }

  /// Half-angles in degrees; the outer one is never within the inner one.
  static void drawCone(Light& light) {
    float inner = std::acos(light.innerCos) / kDegree, outer = std::acos(light.outerCos) / kDegree;
    fieldLabel("outer angle", "Half of the cone's: no light beyond it");
    if (ImGui::SliderFloat("##outer", &outer, 1, 90, "%.1f\u00B0", ImGuiSliderFlags_AlwaysClamp)) {
      light.outerCos = std::cos(outer * kDegree);
      light.innerCos = std::max(light.innerCos, light.outerCos);
    }
    fieldLabel("inner angle", "Half of the cone's: full light within it");
    if (ImGui::SliderFloat("##inner", &inner, 0, 90, "%.1f\u00B0", ImGuiSliderFlags_AlwaysClamp)) {
      light.innerCos = std::cos(inner * kDegree);
      light.outerCos = std::min(light.innerCos, light.outerCos);
    }
  }
};

}  // namespace

std::unique_ptr<Panel> makeLightsPanel() {
  return std::make_unique<LightsPanel>();
}

}  // namespace irad
