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
    const float em = ImGui::GetFontSize(), line = statusLine(), most = statusHeight(window.size.x);
    const float bottom = window.position.y + window.size.y, end = window.size.x - 0.5f * em;
    // In a second line what the first has no room for, where there may be two.
    std::vector<glm::vec2> places;
    glm::vec2 next{0.5f * em, 0.5f * (line - ImGui::GetTextLineHeight())};
    float height = line;
    for (const Part& part : all) {
      const float width = ImGui::CalcTextSize(part.text.c_str()).x;
      if (next.x + width > end && next.x > em && height + line <= most) {
        next = {0.5f * em, next.y + line};
        height += line;
      }
      places.push_back(next);
      next.x += width + 1.2f * em;
    }
    const bool above = session.pointing.over && statusAbove(window, ImGui::GetMousePos().y);
    const glm::vec2 corner{window.position.x, above ? window.position.y : bottom - height};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({corner.x, corner.y}, {corner.x + window.size.x, corner.y + height}, IM_COL32(20, 20, 22, 225));
    ImGui::enterControls("Pointing");
    for (size_t i = 0; i < all.size(); ++i) {
      ImGui::SetCursorScreenPos({corner.x + places[i].x, corner.y + places[i].y});
      ImGui::TextUnformatted(clipped(all[i].text, std::max(end - places[i].x, 1.0f)).c_str());
      ImGui::tellControl(fmt::format("{}={}", all[i].name, all[i].text).c_str());
    }
    ImGui::leaveControls();
  }
};

}  // namespace

std::unique_ptr<Overlay> makePointingOverlay() {
  return std::make_unique<PointingOverlay>();
}

}  // namespace irad
