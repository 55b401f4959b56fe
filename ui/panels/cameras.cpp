// The scene's cameras and the user's bookmarks: go to one, keep where the camera is, rename, remove.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ui/imgui.h"
#include "ui/panel.h"
#include "ui/sidecar_row.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

class CamerasPanel : public Panel {
 public:
  const char* title() const override { return "Cameras"; }
  const char* help() const override {
    return "Places to look from: the scene's own and your bookmarks; the window's camera in numbers";
  }
  Region region() const override { return Region::Left; }

  void draw(Session& session) override {
    if (!session.pipeline) return ImGui::TextColored(theme::dim, "no scene");
    const std::vector<Camera> cameras = session.cameras();
    const int ofFile = static_cast<int>(session.pipeline->scene().cameras.size());
    const float row = ImGui::GetTextLineHeightWithSpacing();
    const float rows = std::min(static_cast<float>(cameras.size()), 6.0f);
    ImGui::BeginChild("##list", {0, rows * row});
    for (int i = 0; i < static_cast<int>(cameras.size()); ++i) {
      ImGui::PushID(i);
      const float start = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x;
      if (ImGui::Selectable("##", i == session.sceneCamera)) session.useSceneCamera(i);
      helpTooltip(i < ofFile ? "A camera of the scene's file. Click: look from there (C: the next one)"
                             : "A bookmark of yours. Click: look from there");
      const char* kind = i < ofFile ? "scene" : "bookmark";
      const float kindWidth = ImGui::CalcTextSize(kind).x;
      ImGui::SameLine(start);
      clippedText(cameraName(cameras[static_cast<size_t>(i)], i), width - kindWidth - ImGui::GetFontSize());
      ImGui::SameLine(start + width - kindWidth);
      ImGui::TextColored(theme::dim, "%s", kind);
      ImGui::PopID();
    }
    ImGui::EndChild();
    drawBookmark(session, ofFile);
    drawNumbers(session);
    sidecarRow(session);
  }

 private:
  /// Where the window's camera is, and how it looks.
  static void drawNumbers(Session& session) {
    FlyCamera& camera = session.camera;
    const Scene& scene = session.pipeline->scene();
    const float size = std::max(glm::distance(scene.boundsMin, scene.boundsMax), 1e-6f);
    fieldLabel("position", "Where the window's camera is: x, y and z in the world, metres");
    glm::dvec3 position = camera.camera().position;
    const double low = -kMaxCoordinate, high = kMaxCoordinate;
    if (ImGui::DragScalarN("##position", ImGuiDataType_Double, &position.x, 3, size * 1e-3f, &low, &high, "%.4g",
                           ImGuiSliderFlags_AlwaysClamp)) {
      camera.setPosition(position);
      session.viewDirty = true;
    }
    fieldLabel("yaw", "The way the camera looks, about the vertical, degrees: 0 along -Z, 90 along -X");
    const auto degrees = [](float value) { return std::abs(value) < 0.05f ? 0 : value; };  // no "-0.0"
    float yaw = degrees(camera.yaw()), pitch = degrees(camera.pitch());
    if (ImGui::DragFloat("##yaw", &yaw, 0.2f, -180, 180, "%.1f\u00B0")) turn(session, yaw, camera.pitch());
    fieldLabel("pitch", "How far up the camera looks, degrees: 0 level, -88 almost straight down");
    if (ImGui::DragFloat("##pitch", &pitch, 0.2f, -88, 88, "%.1f\u00B0", ImGuiSliderFlags_AlwaysClamp))
      turn(session, camera.yaw(), pitch);
    const bool flat = camera.camera().orthographic;
    fieldLabel(flat ? "half height" : "field of view",
               flat ? "From the picture's middle to its upper edge, metres"
                    : "Angle from the picture's lower to its upper edge, degrees; 1 to 170");
    float view = camera.view();
    if (flat ? ImGui::DragFloat("##view", &view, size * 1e-3f, size * 1e-6f, size * 1e3f, "%.4g",
                                ImGuiSliderFlags_AlwaysClamp)
             : ImGui::SliderFloat("##view", &view, 1, 170, "%.1f\u00B0", ImGuiSliderFlags_AlwaysClamp)) {
      camera.setView(view);
      session.viewDirty = true;
    }
  }

  static void turn(Session& session, float yaw, float pitch) {
    session.camera.setAngles(yaw, pitch);
    session.viewDirty = true;
  }

  static void drawBookmark(Session& session, int ofFile) {
    SceneEdits& edits = session.edits;
    if (ImGui::Button("Add bookmark")) {
      session.sceneCamera = ofFile + static_cast<int>(edits.addBookmark(session.camera.camera(), "bookmark"));
      return;
    }
    helpTooltip("Keeps where the camera is, which way it looks and how wide it sees; saved beside the scene");
    const auto index = static_cast<size_t>(session.sceneCamera - ofFile);
    if (session.sceneCamera < ofFile || index >= edits.bookmarks.size()) return;
    Camera& bookmark = edits.bookmarks[index];
    ImGui::SameLine();
    if (ImGui::Button("Set here")) {
      const std::string name = bookmark.name;
      bookmark = session.camera.camera();
      bookmark.name = name;
    }
    helpTooltip("Moves the bookmark to where the camera is");
    ImGui::SameLine();
    const bool remove = ImGui::Button("Remove");
    helpTooltip("Takes the bookmark out of the list (Ctrl + Z brings it back)");
    if (remove) {
      edits.bookmarks.erase(edits.bookmarks.begin() + static_cast<ptrdiff_t>(index));
      session.sceneCamera = 0;
      return;
    }
    fieldLabel("name", "Of the bookmark; --camera NAME takes it, too");
    std::string name = bookmark.name;
    if (ImGui::InputText("##name", &name)) edits.rename(index, name);
  }
};

}  // namespace

std::unique_ptr<Panel> makeCamerasPanel() {
  return std::make_unique<CamerasPanel>();
}

}  // namespace irad
