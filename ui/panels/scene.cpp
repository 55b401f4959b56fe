// The scene as loaded: file, counts, lights, warnings; opening another.
#include <fmt/format.h>

#include <algorithm>

#include "ui/imgui.h"
#include "ui/panel.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

class ScenePanel : public Panel {
 public:
  const char* title() const override { return "Scene"; }
  Region region() const override { return Region::Left; }

  void draw(Session& session) override {
    if (session.pipeline) {
      drawCounts(session);
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
    helpTooltip(scene.path.string());
    valueRow("triangles", withThousands(scene.triangleCount()));
    valueRow("materials", fmt::format("{}, {} images", scene.materials.size(), scene.images.size()));
    valueRow("lights", lights(session.edits.lights));
    const glm::vec3 size = scene.boundsMax - scene.boundsMin;
    valueRow("size", fmt::format("{:.4g} \u00D7 {:.4g} \u00D7 {:.4g}", size.x, size.y, size.z));
    if (!session.built) return;
    const Built& built = *session.built;
    valueRow("grid", fmt::format("{} \u00D7 {} \u00D7 {}", built.dims.x, built.dims.y, built.dims.z));
    valueRow("facets", fmt::format("{} in {}", withThousands(built.facets), withThousands(built.solidVoxels)));
    helpTooltip("Facets in the solid voxels that hold them");
    if (built.clampedAlbedo == 0) return;
    valueRow("clamped", fmt::format("albedo of {}", withThousands(built.clampedAlbedo)));
    helpTooltip("Facets whose albedo was outside 0 to .98, or no number");
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
    const std::string title = fmt::format("{} warning{}", scene.warnings.size(), scene.warnings.size() == 1 ? "" : "s");
    ImGui::PushStyleColor(ImGuiCol_Text, theme::warning);
    const bool open = ImGui::TreeNodeEx("##warnings", ImGuiTreeNodeFlags_NoTreePushOnOpen, "%s", title.c_str());
    ImGui::PopStyleColor();
    if (!open) return;
    ImGui::PushTextWrapPos(0);
    for (const std::string& warning : scene.warnings) ImGui::TextUnformatted(warning.c_str());
    ImGui::PopTextWrapPos();
  }

  void drawOpen(Session& session) {
    ImGui::SetNextItemWidth(-1);
    if (ImGui::InputTextWithHint("##open", "drop a .glb, .gltf or .exr, or type a path", &path_,
                                 ImGuiInputTextFlags_EnterReturnsTrue) &&
        !path_.empty())
      session.open(path_);
  }
};

}  // namespace

std::unique_ptr<Panel> makeScenePanel() {
  return std::make_unique<ScenePanel>();
}

}  // namespace irad
