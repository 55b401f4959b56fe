// The scene's lights: list, add, remove, and the fields of the one chosen. The picture follows at once; the scene's
// file is never touched.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/scene/light_units.h"
#include "ui/imgui.h"
#include "ui/light_color.h"
#include "ui/new_light.h"
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

/// What the intensity is shown in. A point's or spot's file holds candela, a sun's lux; this program takes 1 cd for 1
/// W/sr and 1 lx for 1 W/m^2 (docs/conventions.md).
struct IntensityUnit {
  const char* name;
  const char* format;
  double (*perCandela)(const Light&);  ///< shown = intensity x this
  const char* help;
};
constexpr IntensityUnit kIntensityUnits[] = {
    {"cd", "%.4g cd", [](const Light&) { return 1.0; },
     "Candela, as the file holds it: here 1 cd = 1 W/sr. At a distance d a surface that faces the light receives "
     "intensity / d\u00B2."},
    {"lx", "%.4g lx at 1 m", [](const Light&) { return 1.0; },
     "Lux on a surface that faces the light from 1 scene unit (metre): here 1 lx = 1 W/m\u00B2. As many as candela; "
     "at a distance d it is this / d\u00B2."},
    {"W", "%.4g W", solidAngle,
     "All the light that it gives, candela times its solid angle: 4\u03C0 sr of a point; of a spot 2\u03C0 ((1 - cos "
     "inner) + (cos inner - cos outer) / 3), with the falloff between the two. Light as such, as lumens are: here 1 "
     "lm = 1 W, and not 683 lm. A cone that is changed keeps the candela."},
};

class LightsPanel : public Panel {
 public:
  const char* title() const override { return "Lights"; }
  const char* help() const override {
    return "Suns, points and spots: add, change and remove them. Edits are kept beside the scene's file, never in it.";
  }
  Region region() const override { return Region::Left; }

  void draw(Session& session) override {
    if (!session.pipeline) return ImGui::TextColored(theme::dim, "no scene");
    SceneEdits& edits = session.edits;
    drawAdd(session);
    drawList(session);
    drawListButtons(edits);
    if (Light* light = edits.light()) {
      ImGui::PushID(edits.selected);
      drawFields(*light, session);
      ImGui::PopID();
    }
    ImGui::Checkbox("handles in the picture", &edits.showHandles);
    helpTooltip(
        "Drag a light to move it in the plane of the view, with Shift along the line of sight, with Ctrl onto the "
        "surface under the mouse. The chosen one has axes: drag an arrow to move it along x (red), y (green) or z "
        "(blue), a square between two of them to move it in their plane. Drag the square at the end of its own arrow "
        "to aim it, with Ctrl at the surface under the mouse. Captures show none of this.");
    sidecarRow(session);
  }

 private:
  static void drawAdd(Session& session) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(theme::dim, "add");
    for (const LightKind& kind : lightKinds()) {
      ImGui::SameLine();
      if (ImGui::Button(kind.name))
        session.edits.add(newLight(kind, session.pipeline->scene(), session.camera.camera()));
      helpTooltip([&] {
        return fmt::format("A {} {}", kind.one,
                           kind.has(LIGHT_DISTANT)     ? "that shines the way the camera looks"
                           : kind.has(LIGHT_DIRECTION) ? "half-way to what is in the picture's middle, shining there"
                                                       : "half-way to what is in the picture's middle");
      });
    }
  }

  static void drawList(Session& session) {
    SceneEdits& edits = session.edits;
    if (edits.lights.empty()) return ImGui::TextColored(theme::dim, "no lights");
    const float row = ImGui::GetTextLineHeightWithSpacing(), em = ImGui::GetFontSize();
    const float rows = std::min(static_cast<float>(edits.lights.size()), 6.0f);
    ImGui::BeginChild("##list", {0, rows * row});
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(edits.lights.size()), row);
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        Light& light = edits.lights[static_cast<size_t>(i)];
        ImGui::PushID(i);
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float start = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x;
        const bool pressed = ImGui::Selectable("##", i == edits.selected);
        const bool dot = ImGui::GetIO().MousePos.x < at.x + 1.2f * em;  // the lamp before the name
        const bool noShadow = session.built && session.built->lacksShadow(static_cast<uint32_t>(i));
        helpTooltip([&] {
          if (dot) return std::string(light.on ? "On; a click turns it off" : "Off; a click turns it on");
          return std::string("Click: choose it, to change it below. Its dot, in its colour, turns it off and on.") +
                 (noShadow
                      ? "\nIt casts no shadow: the device has not the layers for so many maps, and stronger lights "
                        "have them."
                      : "");
        });
        if (pressed && dot)
          light.on = !light.on;
        else if (pressed)
          edits.selected = i;
        ImDrawList& drawing = *ImGui::GetWindowDrawList();
        const ImVec2 middle{at.x + em * 0.5f, at.y + em * 0.5f};
        if (light.on)
          drawing.AddCircleFilled(middle, em * 0.3f, displayColor(light.color));
        else
          drawing.AddCircle(middle, em * 0.3f, ImGui::GetColorU32(theme::dim));
        ImGui::SameLine(start + em * 1.3f);
        const std::string kind = std::string(typeName(light)) + (noShadow ? ", no shadow" : "");
        const float type = ImGui::CalcTextSize(kind.c_str()).x;
        if (!light.on) ImGui::PushStyleColor(ImGuiCol_Text, theme::dim);
        clippedText(light.name.empty() ? "(no name)" : light.name, width - em * 1.8f - type);
        if (!light.on) ImGui::PopStyleColor();
        ImGui::SameLine(start + width - type);
        ImGui::TextColored(theme::dim, "%s", kind.c_str());
        ImGui::PopID();
      }
    ImGui::EndChild();
  }

  static void drawListButtons(SceneEdits& edits) {
    if (edits.light() == nullptr) return;
    if (ImGui::Button("Duplicate")) edits.add(Light(*edits.light()));
    helpTooltip("Another light like the chosen one, in the same place");
    ImGui::SameLine();
    if (ImGui::Button("Remove")) edits.remove();
    helpTooltip("Takes the chosen light out of the scene (Ctrl + Z brings it back)");
  }

  void drawFields(Light& light, Session& session) {
    fieldLabel("on",
               "Off it gives no light and costs nothing: no shadow map is drawn, no pixel and no facet asks for it");
    ImGui::Checkbox("##on", &light.on);
    fieldLabel("name", "Of the light, in lists and files");
    ImGui::InputText("##name", &light.name);
    fieldLabel("type",
               "sun: parallel light from far away; point: from a place, every way; spot: from a place, within a cone");
    std::vector<const char*> names;
    for (const LightKind& other : lightKinds()) names.push_back(other.name);
    int type = static_cast<int>(light.type);
    if (ImGui::Combo("##type", &type, names.data(), static_cast<int>(names.size())))
      light.type = static_cast<LightType>(type);
    const LightKind& kind = lightKind(light.type);
    const bool distant = kind.has(LIGHT_DISTANT);

    fieldLabel("color",
               "Of its light, red, green and blue from 0 to 1, as shown on a display; the file holds it linear");
    colorField("##color", light.color);
    drawTemperature(light);
    drawIntensity(light, distant);
    if (kind.has(LIGHT_RANGE)) {
      fieldLabel("range", "Distance at which the light has faded out, metres; 0: unlimited");
      ImGui::DragFloat("##range", &light.range, std::max(light.range * 0.01f, 0.01f), 0,
                       static_cast<float>(kMaxCoordinate), light.range > 0 ? "%.4g" : "unlimited",
                       ImGuiSliderFlags_AlwaysClamp);
    }
    if (distant) {
      fieldLabel("angle",
                 "How large it is seen, across, degrees: the wider, the softer its shadows. Our sun has 0.53\u00B0.");
      ImGui::DragFloat("##angle", &light.angle, 0.02f, 0, static_cast<float>(kMaxLightAngle),
                       light.angle > 0 ? "%.3g\u00B0" : "a point", ImGuiSliderFlags_AlwaysClamp);
    } else {
      fieldLabel("radius", "Of the lamp, metres: the larger, the softer its shadows");
      ImGui::DragFloat("##radius", &light.radius, std::max(light.radius * 0.01f, 0.001f), 0,
                       static_cast<float>(kMaxCoordinate), light.radius > 0 ? "%.4g" : "a point",
                       ImGuiSliderFlags_AlwaysClamp);
    }
    if (kind.has(LIGHT_CONE)) drawCone(light);

    fieldLabel("position", distant ? "Of its handle in the picture: the light comes from everywhere"
                                   : "Where it is: x, y and z in the world, metres");
    const double low = -kMaxCoordinate, high = kMaxCoordinate;
    const float size = glm::distance(session.pipeline->scene().boundsMin, session.pipeline->scene().boundsMax);
    ImGui::DragScalarN("##position", ImGuiDataType_Double, &light.position.x, 3, std::max(size * 1e-3f, 1e-9f), &low,
                       &high, "%.4g", ImGuiSliderFlags_AlwaysClamp);
    if (kind.has(LIGHT_DIRECTION)) {
      fieldLabel("direction", "The way it shines: x, y and z of an arrow of length 1");
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
    helpTooltip("Puts the light where the camera is; it shines the way the camera looks");
  }

  /// A temperature is a way to choose a colour: lights keep the colour alone.
  static void drawTemperature(Light& light) {
    fieldLabel(
        "temperature",
        "Of a glowing body of this colour, kelvin (1,000 to 15,000): candle 1,900, bulb 2,700, noon 5,500, overcast "
        "6,500. Setting it sets the colour, with 1 as its largest component. A dash: no glowing body has a colour "
        "near this one. (The nearest point of the Planckian locus, Krystek 1985, none beyond 0.05 in CIE 1960 u, "
        "v; below 1,900 K the display's colours end, and blue is 0.)");
    const std::optional<double> found = colorTemperature(light.color);
    auto kelvin = static_cast<float>(found.value_or(6500));
    if (ImGui::SliderFloat("##temperature", &kelvin, kLeastTemperature, kMostTemperature, found ? "%.0f K" : "\u2014",
                           ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic))
      light.color = temperatureColor(kelvin);
  }

  void drawIntensity(Light& light, bool distant) {
    if (distant) {
      fieldLabel("intensity",
                 "Lux on a surface that faces the sun, as the file holds it: here 1 lx = 1 W/m\u00B2. A sun comes from "
                 "infinity, and has neither candela nor a power of its own.");
      ImGui::DragFloat("##intensity", &light.intensity, std::max(light.intensity * 0.01f, 1e-6f), 0,
                       static_cast<float>(kMaxLightOrEmission), "%.4g lx", ImGuiSliderFlags_AlwaysClamp);
      return;
    }
    const IntensityUnit& unit = kIntensityUnits[unit_];
    fieldLabel("intensity", unit.help);
    const float width = ImGui::CalcItemWidth(), list = 3.4f * ImGui::GetFontSize();
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const auto per = static_cast<float>(unit.perCandela(light));
    float shown = light.intensity * per;
    ImGui::SetNextItemWidth(width - list - gap);
    if (ImGui::DragFloat("##intensity", &shown, std::max(shown * 0.01f, 1e-6f), 0,
                         static_cast<float>(kMaxLightOrEmission) * std::min(per, 1.0f), unit.format,
                         ImGuiSliderFlags_AlwaysClamp) &&
        per > 0)
      light.intensity = std::min(shown / per, static_cast<float>(kMaxLightOrEmission));
    ImGui::SameLine(0, gap);
    ImGui::SetNextItemWidth(list);
    const char* names[std::size(kIntensityUnits)];
    for (size_t i = 0; i < std::size(kIntensityUnits); ++i) names[i] = kIntensityUnits[i].name;
    ImGui::Combo("##unit", &unit_, names, static_cast<int>(std::size(kIntensityUnits)));
  }

  int unit_ = 0;  ///< of kIntensityUnits

  /// Half-angles in degrees; the outer one is never within the inner one.
  static void drawCone(Light& light) {
    float inner = std::acos(light.innerCos) / kDegree, outer = std::acos(light.outerCos) / kDegree;
    fieldLabel("outer angle", "From the spot's axis to where its light ends, degrees (half of the cone)");
    if (ImGui::SliderFloat("##outer", &outer, 1, 90, "%.1f\u00B0", ImGuiSliderFlags_AlwaysClamp)) {
      light.outerCos = std::cos(outer * kDegree);
      light.innerCos = std::max(light.innerCos, light.outerCos);
    }
    fieldLabel("inner angle",
               "From the spot's axis to where its full light ends, degrees; it fades from there to the outer angle");
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
