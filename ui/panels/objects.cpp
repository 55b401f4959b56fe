// The nodes of the scene's file that have meshes: list with search, chosen here or by a click in the picture, hidden
// and shown, one by one or all but one.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "renderer/base/near_match.h"
#include "renderer/scene/nodes.h"
#include "ui/imgui.h"
#include "ui/panel.h"
#include "ui/sidecar_row.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

class ObjectsPanel : public Panel {
 public:
  const char* title() const override { return "Objects"; }
  const char* help() const override { return "The nodes of the scene's file: choose them, hide them, show them alone"; }
  Region region() const override { return Region::Left; }

  void draw(Session& session) override {
    if (!session.pipeline) return ImGui::TextColored(theme::dim, "no scene");
    const Scene& scene = session.pipeline->scene();
    if (scene.nodes.empty()) {
      ImGui::TextColored(theme::dim, "The scene has no named objects.");
      return;
    }
    if (session.object != at_ && session.object) unfoldTo(scene, *session.object);
    learn(scene, session.edits.hidden);
    const bool chosen = session.object && *session.object < scene.nodes.size();
    if (chosen && named_ != session.object) path_ = nodePath(scene.nodes, *(named_ = session.object));
    drawList(session, scene);
    drawButtons(session, chosen);
    if (chosen)
      drawFacts(scene.nodes[*session.object]);
    else
      ImGui::TextColored(theme::dim, "Click a surface or a name.");
    sidecarRow(session);
  }

 private:
  static constexpr uint32_t kMostIndented = 8;  ///< levels

  std::string search_;
  // As of these, from which the rest follows:
  const SceneNode* first_ = nullptr;
  size_t count_ = 0;
  std::filesystem::path scene_;
  HiddenNodes hidden_;
  std::string searched_;
  std::vector<bool> shown_;        ///< per node
  std::optional<uint32_t> only_;   ///< the node that is isolated
  std::vector<uint32_t> level_;    ///< below the roots, per node
  std::vector<bool> holds_;        ///< rows under its own, per node
  std::set<uint32_t> folded_;      ///< nodes whose rows are not listed, but where one searches
  std::vector<uint32_t> found_;    ///< rows
  bool relist_ = false;            ///< they are others, since one was folded or unfolded
  size_t objects_ = 0, away_ = 0;  ///< with meshes; those of them that are hidden
  std::optional<uint32_t> at_;     ///< that the list was scrolled to
  std::optional<uint32_t> named_;  ///< whose path this is:
  std::string path_;

  /// A list of hundreds of thousands is looked through only when it is another, or asked for otherwise.
  void learn(const Scene& scene, const HiddenNodes& hidden) {
    const std::vector<SceneNode>& nodes = scene.nodes;
    const bool same = first_ == nodes.data() && count_ == nodes.size() && scene_ == scene.path;
    if (!same) {
      level_.assign(nodes.size(), 0);
      holds_.assign(nodes.size(), false);
      for (size_t i = 0; i < nodes.size(); ++i)
        if (const uint32_t parent = nodes[i].parent; parent != SceneNode::kNoParent) {
          level_[i] = level_[parent] + 1;
          if (nodes[i].triangles > 0) holds_[parent] = true;
        }
      folded_.clear();
    }
    if (!same || hidden_ != hidden) {
      shown_ = shownNodes(nodes, hidden);
      only_ = hidden.isolated.empty() ? std::nullopt : NodeNames(nodes).find(hidden.isolated);
      objects_ = away_ = 0;
      for (size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i].instances == 0 || nodes[i].triangles == 0) continue;
        ++objects_;
        away_ += !shown_[i];
      }
    }
    if (!same || searched_ != search_ || std::exchange(relist_, false)) {
      found_.clear();
      for (uint32_t i = 0; i < nodes.size();) {
        if (nodes[i].triangles > 0 && containsAnyCase(nodes[i].name, search_)) found_.push_back(i);
        i = search_.empty() && folded_.contains(i) ? nodes[i].end : i + 1;
      }
    }
    if (!same) named_.reset();
    first_ = nodes.data();
    count_ = nodes.size();
    scene_ = scene.path;
    hidden_ = hidden;
    searched_ = search_;
  }

  /// One that was chosen in the picture is listed.
  void unfoldTo(const Scene& scene, uint32_t index) {
    while (index < scene.nodes.size() && (index = scene.nodes[index].parent) != SceneNode::kNoParent)
      relist_ |= folded_.erase(index) > 0;
  }

  void drawList(Session& session, const Scene& scene) {
    ImGui::SetNextItemWidth(-1);
    ImGui::InputTextWithHint("##search", "search", &search_);
    helpTooltip("Objects whose name holds this are listed");
    if (found_.empty()) return ImGui::TextColored(theme::dim, "none of that name");
    const float row = ImGui::GetTextLineHeightWithSpacing();
    ImGui::BeginChild("##list", {0, std::min(static_cast<float>(found_.size()), 8.0f) * row});
    // One that was chosen in the picture is brought into view.
    if (session.object != at_) {
      at_ = session.object;
      const auto found = std::ranges::lower_bound(found_, session.object.value_or(~0u));
      if (found != found_.end() && *found == session.object)
        ImGui::SetScrollY(std::max(0.0f, static_cast<float>(found - found_.begin() - 2) * row));
    }
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(found_.size()), row);
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
        drawRow(session, scene, found_[static_cast<size_t>(i)]);
    ImGui::EndChild();
  }

  void drawRow(Session& session, const Scene& scene, uint32_t index) {
    const SceneNode& node = scene.nodes[index];
    const float em = ImGui::GetFontSize();
    const float start = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x;
    ImGui::PushID(static_cast<int>(index));

    // Shown or not; what hides it may be above it.
    bool shown = shown_[index];
    const std::string reason = whyDisabled(scene, index);
    ImGui::BeginDisabled(!reason.empty());
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(0, 0));
    if (ImGui::Checkbox("##shown", &shown)) session.edits.hide(scene.nodes, index, !shown);
    ImGui::PopStyleVar();
    helpTooltip(reason.empty() ? "Shown, with all under it: in the picture, in voxels, shadows and rays" : reason);
    ImGui::EndDisabled();

    float indent = 1.6f * em;
    if (searched_.empty()) {
      indent += 0.8f * em * static_cast<float>(std::min(level_[index], kMostIndented));
      if (holds_[index]) {
        ImGui::SameLine(start + indent);
        drawArrow(index);
      }
      indent += 1.4f * em;  // the arrow, and by how much a row reaches over its text
    }
    ImGui::SameLine(start + indent);
    if (ImGui::Selectable("##", index == session.object, ImGuiSelectableFlags_AllowDoubleClick)) {
      session.object = at_ = index;
      if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) session.act(Action::FrameSelected);
    }
    helpTooltip("Click: choose it, as a click in the picture does. Double click: it fills the picture.");
    const std::string count =
        node.instances > 1 ? fmt::format("\u00D7{}", withThousands(node.instances)) : std::string();
    const float countWidth = ImGui::CalcTextSize(count.c_str()).x;
    ImGui::SameLine(start + indent);
    ImGui::PushStyleColor(ImGuiCol_Text, shown_[index] ? theme::text : theme::dim);
    clippedText(node.name, width - indent - countWidth - (count.empty() ? 0 : em * 0.5f));
    ImGui::PopStyleColor();
    if (!count.empty()) {
      ImGui::SameLine(start + width - countWidth);
      ImGui::TextColored(theme::dim, "%s", count.c_str());
    }
    ImGui::PopID();
  }

  /// Folds what is under a row, and unfolds it.
  void drawArrow(uint32_t index) {
    const bool folded = folded_.contains(index);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(0, 0));
    ImGui::PushStyleColor(ImGuiCol_Button, IM_COL32_BLACK_TRANS);
    if (ImGui::ArrowButton("fold", folded ? ImGuiDir_Right : ImGuiDir_Down)) {
      relist_ = true;
      if (folded)
        folded_.erase(index);
      else
        folded_.insert(index);
    }
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();
    helpTooltip(folded ? "List the objects under it" : "Leave the objects under it out of the list");
  }

  /// Why its own box can change nothing; empty: it can.
  std::string whyDisabled(const Scene& scene, uint32_t index) const {
    if (shown_[index]) return "";
    const uint32_t parent = scene.nodes[index].parent;
    if (only_ && (index < *only_ || index >= scene.nodes[*only_].end))
      return fmt::format("{} alone is shown: Show all ends that", scene.nodes[*only_].name);
    return parent != SceneNode::kNoParent && !shown_[parent]
               ? fmt::format("{}, which it is under, is hidden", scene.nodes[parent].name)
               : "";
  }

  void drawButtons(Session& session, bool chosen) const {
    const SceneEdits& edits = session.edits;
    ImGui::BeginDisabled(!chosen);
    const bool hidden = chosen && std::ranges::binary_search(edits.hidden.paths, path_);
    if (ImGui::Button(hidden ? "Show###Hide" : "Hide###Hide")) session.act(Action::HideObject);
    helpTooltip(
        "The chosen object and all under it (H). Voxels and matrix are built anew; the picture stays meanwhile.");
    ImGui::SameLine();
    if (ImGui::Button("Isolate")) session.act(Action::IsolateObject);
    helpTooltip("Show the chosen object and what is under it alone (Shift + H)");
    ImGui::SameLine();
    if (ImGui::Button("Frame")) session.act(Action::FrameSelected);
    helpTooltip("It fills the picture (F, or a double click)");
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::BeginDisabled(edits.hidden.empty());
    if (ImGui::Button("Show all")) session.act(Action::ShowAllObjects);
    helpTooltip("Nothing is hidden (Ctrl + H)");
    ImGui::EndDisabled();
    ImGui::TextColored(theme::dim, "%s",
                       fmt::format("{} {}{}", withThousands(objects_), objects_ == 1 ? "object" : "objects",
                                   away_ > 0 ? fmt::format(", {} hidden", withThousands(away_)) : "")
                           .c_str());
  }

  void drawFacts(const SceneNode& node) const {
    valueRow("path", path_);
    helpTooltip("Its name behind those of the nodes that it is under: --hide and --isolate take it");
    valueRow("triangles", withThousands(node.triangles));
    helpTooltip("Of its meshes and of those under it, once per node that shows them");
    if (node.instances > 1) {
      valueRow("instances", withThousands(node.instances));
      helpTooltip("Meshes that it and the nodes under it show");
    }
    const glm::dvec3 size = node.boundsMax - node.boundsMin;
    valueRow("size", fmt::format("{:.4g} \u00D7 {:.4g} \u00D7 {:.4g} m", size.x, size.y, size.z));
    helpTooltip("Of the box around it, along x, y and z, metres");
  }
};

}  // namespace

std::unique_ptr<Panel> makeObjectsPanel() {
  return std::make_unique<ObjectsPanel>();
}

}  // namespace irad
