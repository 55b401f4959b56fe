// The scene's materials: list with search, and the fields of the one chosen, here or by a click on a surface. The
// picture follows an edit at once, with no ray traced again; the scene's file is never touched.
#include "renderer/scene/material_edits.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/base/near_match.h"
#include "renderer/base/number_text.h"
#include "ui/imgui.h"
#include "ui/light_color.h"
#include "ui/panel.h"
#include "ui/sidecar_row.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

/// In the order of kMaterialTextures.
constexpr const char* kTextureLabels[] = {"base color", "metalness, roughness", "normals", "occlusion",
                                          "emission",   "transmission"};

class MaterialsPanel : public Panel {
 public:
  const char* title() const override { return "Materials"; }
  const char* help() const override {
    return "Colours, reflection and emission of the scene's surfaces. Edits are kept beside the scene's file.";
  }
  Region region() const override { return Region::Left; }

  void draw(Session& session) override {
    if (!session.pipeline) return ImGui::TextColored(theme::dim, "no scene");
    const Scene& scene = session.pipeline->scene();
    learn(scene);
    drawList(session, scene);
    if (session.material && *session.material < names_.size())
      drawFields(session, scene, *session.material);
    else
      ImGui::TextColored(theme::dim, "Click a surface or a name.");
    drawTimes(session);
    sidecarRow(session);
  }

 private:
  std::string search_;
  std::filesystem::path scene_;
  const Material* first_ = nullptr;  ///< of the scene whose names these are
  std::vector<std::string> names_;
  std::optional<uint32_t> shown_;  ///< that the list was scrolled to

  void learn(const Scene& scene) {
    const Material* first = fileMaterials(scene).data();
    if (scene_ == scene.path && first_ == first && names_.size() == scene.materials.size()) return;
    scene_ = scene.path;
    first_ = first;
    names_ = materialNames(scene);
  }

  void drawList(Session& session, const Scene& scene) {
    std::vector<uint32_t> found;
    for (const Draw& draw : scene.draws)
      if (containsAnyCase(names_[draw.material], search_))
        if (found.empty() || found.back() != draw.material) found.push_back(draw.material);
    ImGui::SetNextItemWidth(-1);
    ImGui::InputTextWithHint("##search", "search", &search_);
    helpTooltip("Materials whose name holds this are listed");
    const float row = ImGui::GetTextLineHeightWithSpacing(), em = ImGui::GetFontSize();
    if (found.empty()) return ImGui::TextColored(theme::dim, "none of that name");
    ImGui::BeginChild("##list", {0, std::min(static_cast<float>(found.size()), 6.0f) * row});
    // A material that was picked in the picture is brought into view.
    if (session.material != shown_) {
      shown_ = session.material;
      if (const auto at = std::ranges::find(found, session.material.value_or(~0u)); at != found.end())
        ImGui::SetScrollY(std::max(0.0f, static_cast<float>(at - found.begin() - 2) * row));
    }
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(found.size()), row);
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        const uint32_t material = found[static_cast<size_t>(i)];
        ImGui::PushID(names_[material].c_str());
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float start = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x;
        if (ImGui::Selectable("##", material == session.material)) session.material = shown_ = material;
        helpTooltip("Click: choose it, to change it below. A click on a surface in the picture chooses its material.");
        const Material& m = scene.materials[material];
        const glm::vec3 shown = glm::convertLinearToSRGB(glm::vec3(m.baseColor));
        ImGui::GetWindowDrawList()->AddCircleFilled(
            {at.x + em * 0.5f, at.y + em * 0.5f}, em * 0.3f,
            m.emission != glm::vec3(0) ? displayColor(m.emission)
                                       : ImGui::ColorConvertFloat4ToU32({shown.x, shown.y, shown.z, 1}));
        const bool changed = !isEmpty(session.edits.material(names_[material]));
        const float mark = changed ? ImGui::CalcTextSize("edited").x : 0;
        ImGui::SameLine(start + em * 1.3f);
        clippedText(names_[material], width - em * 1.8f - mark);
        if (changed) {
          ImGui::SameLine(start + width - mark);
          ImGui::TextColored(theme::accent, "edited");
        }
        ImGui::PopID();
      }
    ImGui::EndChild();
  }

  void drawFields(Session& session, const Scene& scene, uint32_t index) {
    const Material& file = fileMaterials(scene)[index];
    const MaterialEdit before = session.edits.material(names_[index]);
    MaterialEdit edit = before;
    const Material now = edited(file, edit);  // as edited, which the pipeline may yet have to take
    ImGui::PushID(names_[index].c_str());

    fieldLabel(
        "base color",
        "Share of the light that it reflects, red, green and blue from 0 to 1, as shown on a display; files hold it "
        "linear. A texture is multiplied with it.");
    if (glm::vec3 color(now.baseColor); colorField("##base", color)) edit.baseColor = color;
    ImGui::BeginDisabled(file.lambertian);
    drawShare("metalness", "##metalness",
              "0: scatters light in its base color, as paint does; 1: reflects it in its base color, as metal does; "
              "between: a mixture",
              now.metallic, edit.metallic);
    drawShare("roughness", "##roughness", "How much it blurs what it reflects: 0 a mirror, 1 not at all like one",
              now.roughness, edit.roughness);
    ImGui::EndDisabled();
    if (file.lambertian) ImGui::TextColored(theme::dim, "Lambertian (scene.lambertian): no reflections");

    const Emission own = emissionOf(file);
    fieldLabel("emission", "Color of the light that it gives, red, green and blue from 0 to 1, as shown on a display");
    if (glm::vec3 color = edit.emissionColor.value_or(own.color); colorField("##emission", color))
      edit.emissionColor = color;
    fieldLabel("strength", "Emitted radiance where the color is white, W/(m\u00B2 sr); 0: it gives no light");
    float strength = edit.emissionStrength.value_or(own.strength);
    if (ImGui::DragFloat("##strength", &strength, std::max(strength * 0.01f, 0.01f), 0,
                         static_cast<float>(kMaxLightOrEmission), "%.4g", ImGuiSliderFlags_AlwaysClamp))
      edit.emissionStrength = std::clamp(strength, 0.0f, static_cast<float>(kMaxLightOrEmission));
    if (now.alpha == AlphaMode::Mask) {
      fieldLabel("alpha cutoff",
                 "Where base color and texture have less alpha there is no surface. This moves surfaces: voxels and "
                 "matrix are built again, once you let go.");
      float cutoff = now.alphaCutoff;
      if (ImGui::SliderFloat("##cutoff", &cutoff, 0, 1, "%.3f", ImGuiSliderFlags_AlwaysClamp))
        edit.alphaCutoff = std::clamp(cutoff, 0.0f, 1.0f);
      ImGui::TextColored(theme::dim, "a cutoff rebuilds voxels and matrix");
    }
    fieldLabel("transmission",
               "The share of what it would scatter that passes straight through, in its base color: a thin pane. This "
               "moves surfaces: voxels and matrix are built again.");
    float passed = now.transmission;
    if (ImGui::SliderFloat("##transmission", &passed, 0, 1, "%.3f", ImGuiSliderFlags_AlwaysClamp))
      edit.transmission = std::clamp(passed, 0.0f, 1.0f);
    drawTextures(file, edit);
    settle(file, edit);
    if (edit != before) session.edits.setMaterial(edit);

    ImGui::BeginDisabled(isEmpty(edit));
    if (ImGui::Button("File's own")) session.edits.setMaterial({.material = names_[index]});
    helpTooltip(
        [&] { return fmt::format("Takes all edits of \"{}\" back: it is as the scene's file has it", names_[index]); });
    ImGui::EndDisabled();
    ImGui::PopID();
  }

  static void drawShare(const char* label, const char* id, const char* help, float now, std::optional<float>& edit) {
    fieldLabel(label, help);
    if (ImGui::SliderFloat(id, &now, 0, 1, "%.3f", ImGuiSliderFlags_AlwaysClamp)) edit = std::clamp(now, 0.0f, 1.0f);
  }

  /// A box for each that the file has.
  static void drawTextures(const Material& file, MaterialEdit& edit) {
    for (size_t i = 0; i < kMaterialTextures.size(); ++i) {
      if ((file.*kMaterialTextures[i].use).image < 0) continue;
      bool on = (edit.texturesOff >> i & 1) == 0;
      const bool moves = cutByAlpha(file) && kMaterialTextures[i].use == &Material::baseColorTexture;
      if (ImGui::Checkbox(fmt::format("texture: {}", kTextureLabels[i]).c_str(), &on)) edit.texturesOff ^= 1u << i;
      helpTooltip(moves
                      ? "Off: the surface has the base color above alone. The texture's alpha cuts the surface out, so "
                        "that voxels and matrix are built again."
                      : "Off: the surface has the values above alone, everywhere the same");
    }
  }

  /// What is as in the file is no edit.
  static void settle(const Material& file, MaterialEdit& edit) {
    const Emission own = emissionOf(file);
    if (edit.baseColor == glm::vec3(file.baseColor)) edit.baseColor.reset();
    if (edit.metallic == file.metallic) edit.metallic.reset();
    if (edit.roughness == file.roughness) edit.roughness.reset();
    if (edit.emissionColor == own.color) edit.emissionColor.reset();
    if (edit.emissionStrength == own.strength) edit.emissionStrength.reset();
    if (edit.alphaCutoff == file.alphaCutoff) edit.alphaCutoff.reset();
    if (edit.transmission == file.transmission) edit.transmission.reset();
  }

  static void drawTimes(const Session& session) {
    if (!session.materialEdit) return;
    const MaterialTimes& times = *session.materialEdit;
    const bool rebuilt = times.from <= Redo::Matrix;
    valueRow("last edit", times.settled > 0
                              ? fmt::format("{} ms{}", milliseconds(times.settled), rebuilt ? ", rebuilt" : "")
                          : times.shown > 0 ? fmt::format("{} ms, light goes on", milliseconds(times.shown))
                                            : std::string("waits"));
    helpTooltip([&] {
      return fmt::format(
          "Time from the last edit of a material until the light was at rest; the first picture with it came after {} "
          "ms. {}",
          milliseconds(times.shown),
          rebuilt ? "It moved surfaces or brought the first light: voxels or rays were redone."
                  : "Facets were shaded anew and the light solved; no ray was traced.");
    });
  }
};

}  // namespace

std::unique_ptr<Panel> makeMaterialsPanel() {
  return std::make_unique<MaterialsPanel>();
}

}  // namespace irad
