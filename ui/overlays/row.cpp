// The picked facet in the picture: its voxel, lines to the facets that it exchanges light with, the traced ray. A click
// picks.
#include <fmt/format.h>

#include <algorithm>

#include "shaders/shared/emitters.h"
#include "ui/color_bar.h"
#include "ui/imgui.h"
#include "ui/link_filter.h"
#include "ui/theme.h"
#include "ui/viewport.h"
#include "ui/widgets.h"
#include "ui/words.h"

namespace irad {
namespace {

constexpr size_t kLines = 500;  ///< of the strongest links

class RowOverlay : public Overlay {
 public:
  bool draw(Session& session, const Picture& picture, const PictureMouse& mouse) override {
    Inspection& in = session.inspection;
    if (mouse.clicked && mouse.hovered) {
      const float share = (mouse.position.x - picture.rect().position.x) / picture.rect().size.x;
      in.pick = Inspection::Pick{picture.pixel(mouse.position), mouse.shift,
                                 session.comparison && session.comparison->showsOther(share)};
    }
    if (!in.voxel) return false;
    const glm::vec2 low = picture.window().position, high = low + picture.window().size;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.PushClipRect({low.x, low.y}, {high.x, high.y}, true);
    if (in.facet() && in.shown != Inspection::Show::Comparison) select(in);
    const Drawing d{list, picture, in, session.edited.view.colorMap, drawn_, passing_, session.legends};
    d.box(in.voxel->world, theme::accent, 2);
    if (in.facet()) {
      if (in.shown == Inspection::Show::Comparison && in.comparison)
        d.drawComparison();
      else
        d.drawLinks(in.shown == Inspection::Show::Row);
      d.normal();
    }
    if (in.ray) d.drawRay(*in.ray);
    list.PopClipRect();
    return false;
  }

 private:
  std::vector<uint32_t> drawn_;  ///< indices of links: the strongest that the table's filter passes
  size_t passing_ = 0;           ///< how many pass
  struct Selected {
    uint64_t serial, filter;
    bool row;
    bool operator==(const Selected&) const = default;
  };
  std::optional<Selected> selected_;  ///< what they were selected from

  void select(const Inspection& in) {
    const bool row = in.shown == Inspection::Show::Row;
    const Selected now{in.serial, in.linkFilterEdits, row};
    if (selected_ == now) return;
    selected_ = now;
    const std::vector<Link>& links = (row ? in.facet()->row : in.facet()->column).links;
    drawn_.clear();
    passing_ = 0;
    for (uint32_t i = 0; i < links.size(); ++i) {
      if (!in.linkFilter.passes(links[i])) continue;
      if (drawn_.size() < kLines) drawn_.push_back(i);
      ++passing_;
    }
  }

  struct Drawing {
    ImDrawList& list;
    const Picture& picture;
    const Inspection& in;
    ColorMap map;
    const std::vector<uint32_t>& drawn;
    size_t passing;
    std::vector<Rect>& legends;

    glm::dvec3 centre(const glm::ivec3& voxel) const {
      return in.voxel->world + in.edge() * (glm::dvec3(voxel) - glm::dvec3(in.voxel->voxel));
    }
    void line(const glm::dvec3& a, const glm::dvec3& b, ImU32 color, float width) const {
      if (const auto ends = picture.project(a, b))
        list.AddLine({ends->first.x, ends->first.y}, {ends->second.x, ends->second.y}, color, width);
    }
    /// The edges of a voxel.
    void box(const glm::dvec3& middle, const ImVec4& color, float width) const {
      for (int axis = 0; axis < 3; ++axis)
        for (const int corner : {0, 1, 2, 3}) {
          glm::dvec3 from(-0.5);
          from[(axis + 1) % 3] += corner & 1;
          from[(axis + 2) % 3] += corner >> 1;
          glm::dvec3 to = from;
          to[axis] += 1;
          line(middle + in.edge() * from, middle + in.edge() * to, ImGui::GetColorU32(color), width);
        }
    }
    void normal() const {
      const InspectedFacet& f = *in.facet();
      line(f.position, f.position + 1.5 * in.edge() * f.normal, ImGui::GetColorU32(theme::accent), 2);
    }

    /// The strongest of those that the table shows, weakest of them first, coloured by their contribution.
    void drawLinks(bool row) const {
      const InspectedFacet& facet = *in.facet();
      const std::vector<Link>& links = (row ? facet.row : facet.column).links;
      const auto strength = [](const Link& l) { return luminance(glm::vec3(l.contribution)); };
      const float largest = drawn.empty() ? 0 : strength(links[drawn.front()]);
      float least = largest;
      for (const uint32_t i : drawn)
        if (const float s = strength(links[i]); s > 0) least = std::min(least, s);
      const LinkScale scale = linkScale(least, largest);
      const Link* pointedAt = nullptr;
      for (const Link& l : links)
        if (in.highlighted == l.facet) pointedAt = &l;
      for (auto i = drawn.rbegin(); i != drawn.rend(); ++i)
        line(facet.position, links[*i].position, mapColor(map, scale.at(strength(links[*i])), pointedAt ? 0.25f : 0.9f),
             1.5f);
      if (pointedAt) {
        line(facet.position, pointedAt->position, ImGui::GetColorU32(theme::text), 3);
        box(centre(glm::ivec3(pointedAt->voxel)), theme::text, 2);
      }
      const std::string most = drawn.size() < passing ? fmt::format("{} of ", drawn.size()) : "";
      drawKey(
          fmt::format("Light by {}{}{}", most, counted(passing, "link"), passing < links.size() ? ", filtered" : "") +
              (scale.logarithmic ? " (log)" : ""),
          scale);
    }
    /// What the colours stand for, in the lower left corner.
    void drawKey(const std::string& title, const LinkScale& scale) const {
      const float em = ImGui::GetFontSize(), width = std::max(12 * em, ImGui::CalcTextSize(title.c_str()).x);
      const Rect where = picture.clear();
      const glm::vec2 at = where.position + glm::vec2(0, where.size.y) + glm::vec2(em, -5 * em);
      legends.push_back({at, {width + em, 4 * em}});
      list.AddRectFilled({at.x, at.y}, {at.x + width + em, at.y + 4 * em}, IM_COL32(20, 20, 22, 215), 0.3f * em);
      if (Controls::current())
        ImGui::tellPlace(fmt::format("links={}", title).c_str(), at, at + glm::vec2(width + em, 4 * em));
      const glm::vec2 inside = at + glm::vec2(0.5f * em, 0.3f * em);
      list.AddText({inside.x, inside.y}, ImGui::GetColorU32(theme::text), title.c_str());
      drawColorBar(list, inside + glm::vec2(0, 1.4f * em), {width, 0.7f * em}, map);
      const std::string high = withDigits(scale.high) + " W/m\u00B2";
      const std::string least = scale.logarithmic ? withDigits(scale.low) : "0";
      const float below = inside.y + 2.3f * em;
      list.AddText({inside.x, below}, ImGui::GetColorU32(theme::text), least.c_str());
      list.AddText({inside.x + width - ImGui::CalcTextSize(high.c_str()).x, below}, ImGui::GetColorU32(theme::text),
                   high.c_str());
    }
    /// Both voxels of a comparison, and lines from the one the mouse is on in the table to those that gather from it.
    void drawComparison() const {
      box(centre(glm::ivec3(in.other->voxel)), theme::good, 2);
      for (const RowComparison::Entry& entry : in.comparison->entries) {
        if (in.highlighted != entry.facet) continue;
        const glm::dvec3 sender = centre(glm::ivec3(entry.voxel));
        if (entry.a > 0) line(in.facet()->position, sender, ImGui::GetColorU32(theme::accent), 2);
        if (entry.b > 0) line(in.other->position, sender, ImGui::GetColorU32(theme::good), 2);
        box(sender, theme::text, 2);
      }
    }
    /// Where it went, and the cells that the field left of it.
    void drawRay(const InspectedRay& ray) const {
      const auto world = [&](double t) {
        return in.voxel->world + in.edge() * (ray.origin + t * ray.direction - (glm::dvec3(in.voxel->voxel) + 0.5));
      };
      for (const RayStep& step : ray.sdf.steps) box(centre(step.cell), theme::dim, 1);
      line(world(0), world(ray.dda.t), ImGui::GetColorU32(theme::good), 2);
      if (ray.sdf.t > ray.dda.t) line(world(ray.dda.t), world(ray.sdf.t), ImGui::GetColorU32(theme::warning), 2);
    }
  };
};

}  // namespace

std::unique_ptr<Overlay> makeRowOverlay() {
  return std::make_unique<RowOverlay>();
}

}  // namespace irad
