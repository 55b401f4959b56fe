// Of pixels that are shown large enough their values, in them.
#include <string>
#include <vector>

#include "ui/imgui.h"
#include "ui/pointing.h"
#include "ui/viewport.h"

namespace irad {
namespace {

class PixelValuesOverlay : public Overlay {
 public:
  /// Asks for the values of the pixels in view where there is room for numbers in them, and writes those that are
  /// there.
  bool draw(Session& session, const Picture& picture, const PictureMouse&) override {
    Pointing& p = session.pointing;
    const ViewInfo* info = viewInfo(session.view);
    const float em = ImGui::GetFontSize();
    p.large = {};
    if (info == nullptr || p.zoom.scale < 3.6f * em) return false;
    const Rect& window = picture.window();
    const glm::uvec2 first = picture.pixel(window.position), last = picture.pixel(window.position + window.size - 1.0f);
    p.large = {first, last - first + 1u};
    if (p.valuesOf != p.large || p.values.size() != size_t{p.large.size.x} * p.large.size.y) return false;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (uint32_t y = 0; y < p.large.size.y; ++y)
      for (uint32_t x = 0; x < p.large.size.x; ++x) {
        const glm::vec4& value = p.values[size_t{y} * p.large.size.x + x];
        if (!(value.w > 0)) continue;
        const std::vector<std::string> numbers = pixelNumbers(info->kind, value);
        const auto [low, high] = picture.area(first + glm::uvec2(x, y));
        const ImVec4 clip{low.x, low.y, high.x, high.y};
        float top = 0.5f * (low.y + high.y - static_cast<float>(numbers.size()) * em);
        for (const std::string& number : numbers) {
          const float left = 0.5f * (low.x + high.x - ImGui::CalcTextSize(number.c_str()).x);
          list.AddText(nullptr, 0, {left + 1, top + 1}, IM_COL32(0, 0, 0, 255), number.c_str(), nullptr, 0, &clip);
          list.AddText(nullptr, 0, {left, top}, IM_COL32(255, 255, 255, 255), number.c_str(), nullptr, 0, &clip);
          top += em;
        }
      }
    return false;
  }
};

}  // namespace

std::unique_ptr<Overlay> makePixelValuesOverlay() {
  return std::make_unique<PixelValuesOverlay>();
}

}  // namespace irad
