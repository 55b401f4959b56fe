// What is under the mouse, in a line at the picture's lower edge (at the upper one, where the mouse is on that line).
#include "ui/pointing.h"

#include <fmt/format.h>

#include <algorithm>

#include "ui/imgui.h"
#include "ui/viewport.h"
#include "ui/widgets.h"

namespace irad {
namespace {

struct Part {
  const char* name;
  std::string text;
};

class PointingOverlay : public Overlay {
 public:
  bool draw(Session& session, const Picture& picture, const PictureMouse&) override {
    if (!session.hideUi) drawLine(session, picture);
    return false;
  }

 private:
  static std::vector<Part> parts(const Session& session) {
    const Pointing& p = session.pointing;
    std::vector<Part> all;
    if (p.zoom.on()) all.push_back({"zoom", fmt::format("{:g} \u00D7", p.zoom.scale)});
    if (!p.over || !p.reading) return all;
    const Pointing::Reading& r = *p.reading;
    all.push_back({"pixel", fmt::format("x {} y {}", r.pixel.x, r.pixel.y)});
    all.push_back({"value", r.value});
    if (!r.material.empty()) all.push_back({"material", r.material});
    if (r.facet) all.push_back({"facet", fmt::format("facet {}", *r.facet)});
    if (r.voxel) all.push_back({"voxel", fmt::format("voxel {}, {}, {}", r.voxel->x, r.voxel->y, r.voxel->z)});
    return all;
  }

  void drawLine(const Session& session, const Picture& picture) const {
    const std::vector<Part> all = parts(session);
    if (all.empty()) return;
    const Rect& window = picture.window();
    const float em = ImGui::GetFontSize(), line = statusLine(), lines = statusHeight(window.size.x) / line;
    const float height = lines * line, bottom = window.position.y + window.size.y;
    const ImVec2 mouse = ImGui::GetMousePos();
    const bool above = session.pointing.over && mouse.y >= bottom - height;
    const glm::vec2 corner{window.position.x, above ? window.position.y : bottom - height};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({corner.x, corner.y}, {corner.x + window.size.x, corner.y + height}, IM_COL32(20, 20, 22, 225));
    ImGui::enterControls("Pointing");
    const float end = corner.x + window.size.x - 0.5f * em;
    glm::vec2 at = corner + glm::vec2(0.5f * em, 0.5f * (line - ImGui::GetTextLineHeight()));
    for (const Part& part : all) {
      const float width = ImGui::CalcTextSize(part.text.c_str()).x;
      if (at.x + width > end && at.x > corner.x + em && at.y + line < corner.y + height)
        at = {corner.x + 0.5f * em, at.y + line};
      ImGui::SetCursorScreenPos({at.x, at.y});
      ImGui::TextUnformatted(clipped(part.text, std::max(end - at.x, 1.0f)).c_str());
      ImGui::tellControl(fmt::format("{}={}", part.name, part.text).c_str());
      at.x += width + 1.2f * em;
    }
    ImGui::leaveControls();
  }
};

}  // namespace

std::unique_ptr<Overlay> makePointingOverlay() {
  return std::make_unique<PointingOverlay>();
}

}  // namespace irad
