// The scene as loaded: file, counts, lights, warnings; opening another.
#include <fmt/format.h>

#include <algorithm>

#include "ui/imgui.h"
#include "ui/panel.h"
#include "ui/theme.h"
#include "ui/widgets.h"
#include "ui/words.h"

namespace irad {
namespace {

class ScenePanel : public Panel {
 public:
  const char* title() const override { return "Scene"; }
  const char* help() const override {
    return "The file as it was loaded, the grid of voxels that was made of it, and what loading had to warn of";
  }
  Region region() const override { return Region::Left; }

  void draw(Session& session) override {
    if (session.pipeline) {
      drawCounts(session);
      drawRegion(session);
      drawWarnings(session.pipeline->scene());
    } else {
      ImGui::TextColored(theme::dim, "no scene");
    }
    drawOpen(session);
  }

 private:
  std::string path_;  ///< being typed

  static void drawCounts(const Session& session) {
    const Scene& scene = session.pipeline->scene();
    valueRow("file", scene.path.filename().string());
    helpTooltip("The scene's file: " + scene.path.string());
    valueRow("triangles", withThousands(scene.triangleCount()));
    helpTooltip("Of all meshes, once per node that shows them");
    valueRow("materials", fmt::format("{}, {}", scene.materials.size(), counted(scene.images.size(), "image")));
    helpTooltip(
        "Materials of the file, whether a surface has them or not, and the images that their textures are made of");
    valueRow("lights", lights(session.edits.lights));
    helpTooltip("How many there are of each kind, with those that are off");
    const glm::vec3 size = scene.boundsMax - scene.boundsMin;
    valueRow("size", fmt::format("{:.4g} \u00D7 {:.4g} \u00D7 {:.4g} m", size.x, size.y, size.z));
    helpTooltip("Of the box around all surfaces along x, y and z, metres");
    if (!session.built) return;
    const Built& built = *session.built;
    valueRow("grid", fmt::format("{} \u00D7 {} \u00D7 {}", built.dims.x, built.dims.y, built.dims.z));
    helpTooltip([&] { return fmt::format("Voxels along x, y and z, of edge {:.4g} m", built.edge); });
    valueRow("facets in voxels",
             fmt::format("{} in {}", withThousands(built.facets), withThousands(built.solidVoxels)));
    helpTooltip("Pieces of surface that light is kept for, and the solid voxels that hold them");
    if (built.clampedAlbedo > 0) {
      valueRow("clamped", fmt::format("albedo of {}", withThousands(built.clampedAlbedo)));
      helpTooltip("Facets whose albedo was outside 0 to .98, or no number");
    }
    const glm::vec3 part = built.region.hi - built.region.lo;
    valueRow("region", built.region.whole
                           ? "whole"
                           : fmt::format("{:.4g} \u00D7 {:.4g} \u00D7 {:.4g} m", part.x, part.y, part.z));
    helpTooltip(
        "The part of the scene that has voxels (scene.region), m along x, y and z. What lies outside of it is lit "
        "directly and gives light, but passes none on.");
  }

  /// A box to drag in the picture, or the whole scene again.
  static void drawRegion(Session& session) {
    if (!session.built) return;
    RegionSettings& wanted = session.edited.scene.region;
    const SceneRegion& region = session.built->region;
    const bool box = wanted.mode == RegionMode::box || (wanted.mode == RegionMode::automatic && session.edits.region);
    ImGui::BeginDisabled(session.edited.matrix.gpu.hitRule == HitRule::thesis);
    if (ImGui::Button(box ? "Voxels of the whole scene###region" : "Voxels of a box\u2026###region", {-1, 0})) {
      wanted = {.mode = box ? RegionMode::whole : RegionMode::automatic};
      session.edits.region.reset();
      const glm::dvec3& origin = session.pipeline->scene().origin;
      if (!box)
        session.edits.region =
            RegionBox{glm::vec3(origin + glm::dvec3(region.lo)), glm::vec3(origin + glm::dvec3(region.hi))};
    }
    helpTooltip(
        box ? "Removes the box: all of the scene has voxels (scene.region=whole)"
            : "Makes voxels within a box alone, which are finer by as much as it is smaller than the scene. It "
              "begins as the part that has voxels now; its faces are dragged in the picture. It is saved beside "
              "the scene's file, and taken with scene.region = auto.");
    ImGui::EndDisabled();
  }

  static std::string lights(const std::vector<Light>& all) {
    std::string text;
    for (const LightKind& kind : lightKinds()) {
      const auto count = std::ranges::count(all, kind.type, &Light::type);
      if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, kind.name);
    }
    return text.empty() ? "none" : text;
  }

  static void drawWarnings(const Scene& scene) {
    if (scene.warnings.empty()) return;
    const std::string title = counted(scene.warnings.size(), "warning");
    ImGui::PushStyleColor(ImGuiCol_Text, theme::warning);
    const bool open = ImGui::TreeNodeEx("##warnings", ImGuiTreeNodeFlags_NoTreePushOnOpen, "%s", title.c_str());
    ImGui::PopStyleColor();
    helpTooltip("What is odd about the file, and what was made of it");
    if (!open) return;
    ImGui::PushTextWrapPos(0);
    for (const std::string& warning : scene.warnings) ImGui::TextUnformatted(warning.c_str());
    ImGui::PopTextWrapPos();
  }

  void drawOpen(Session& session) {
    ImGui::SetNextItemWidth(-1);
    if (ImGui::InputTextWithHint("##open", "path of a scene or picture, or drop it", &path_,
                                 ImGuiInputTextFlags_EnterReturnsTrue) &&
        !path_.empty())
      session.open(path_);
    helpTooltip(
        "A scene (.glb, .gltf), a picture to compare with or a sky (.exr, .hdr), or edits (.irad.json); Return opens "
        "it. "
        "File > Open shows folders.");
  }
};

}  // namespace

std::unique_ptr<Panel> makeScenePanel() {
  return std::make_unique<ScenePanel>();
}

}  // namespace irad
