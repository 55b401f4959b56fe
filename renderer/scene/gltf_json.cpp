// The document's JSON in one pass: nodes, of which there may be very many, straight into Document::nodes, all else into
// a tree of values. (As values 300,000 nodes are four million, and loading them takes twice as long.)
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include "renderer/base/json_extent.h"
#include "renderer/scene/gltf_document.h"

namespace irad::gltf {
namespace {

constexpr double kMostNumber = 1e30, kMostIndex = 2147483647.0;

enum class NodeKind { Text, Index, Indices, Numbers };
struct NodeRule {
  std::string_view name;
  NodeKind kind;
  size_t least = 0, most = 0;  ///< Numbers: how many
};

/// What the JSON library's parser calls, event by event.
class DocumentReader {
 public:
  explicit DocumentReader(Document& doc) : doc_(doc), root_(*doc.root) {}

  bool null() { return take(Json()); }
  bool boolean(bool value) { return take(Json(value)); }
  bool number_integer(int64_t value) { return takeNumber(value); }
  bool number_unsigned(uint64_t value) { return takeNumber(value); }
  bool number_float(double value, const std::string&) { return takeNumber(value); }
  bool string(std::string& value) {
    if (at_ != At::Node || kNodeRules[member_].kind != NodeKind::Text) return take(Json(std::move(value)));
    node().name = std::move(value);
    return true;
  }
  bool binary(Json::binary_t&) { return false; }  // there is none in a text

  bool start_object(size_t) {
    if (at_ == At::Tree) return open(Json::object());
    if (at_ != At::Nodes) return take(Json::object());
    beginNode();
    return true;
  }
  bool end_object() {
    if (at_ == At::Tree) return close();
    endNode();
    return true;
  }
  bool start_array(size_t) {
    if (at_ == At::Tree && open_.size() == 1 && slot_ != nullptr && slot_ == nodes_) {
      *slot_ = Json::array();  // that there are nodes
      at_ = At::Nodes;
      return true;
    }
    if (at_ == At::Tree) return open(Json::array());
    const NodeKind kind = kNodeRules[member_].kind;
    if (at_ != At::Node || (kind != NodeKind::Numbers && kind != NodeKind::Indices)) return take(Json::array());
    at_ = At::List;
    list_.clear();
    return true;
  }
  bool end_array() {
    if (at_ == At::Tree) return close();
    if (at_ == At::List)
      endList();
    else
      at_ = At::Tree;
    return true;
  }
  bool key(std::string& name) {
    if (at_ == At::Node) {
      const auto known = std::ranges::find(kNodeRules, name, &NodeRule::name);
      if (known != kNodeRules.end()) {
        member_ = static_cast<Member>(known - kNodeRules.begin());
        if ((seen_ & (1u << member_)) != 0) duplicate(name);
        seen_ |= 1u << member_;
        return true;
      }
      open_.push_back(&others_);
      at_ = At::Tree;
    }
    const auto [entry, isNew] = open_.back()->get_ref<Json::object_t&>().try_emplace(std::move(name));
    if (!isNew) duplicate(entry->first);
    slot_ = &entry->second;
    if (open_.size() == 1 && entry->first == "nodes") nodes_ = slot_;
    return true;
  }
  bool parse_error(size_t, const std::string&, const std::exception& error) { doc_.fail("JSON", jsonProblem(error)); }

 private:
  /// What of a node is read here; the rest are values.
  enum Member { Name, Mesh, Skin, Camera, Children, Weights, Matrix, Translation, Rotation, Scale, MemberCount };
  static constexpr std::array<NodeRule, MemberCount> kNodeRules = {{{"name", NodeKind::Text},
                                                                    {"mesh", NodeKind::Index},
                                                                    {"skin", NodeKind::Index},
                                                                    {"camera", NodeKind::Index},
                                                                    {"children", NodeKind::Indices},
                                                                    {"weights", NodeKind::Numbers, 1, 1'000'000},
                                                                    {"matrix", NodeKind::Numbers, 16, 16},
                                                                    {"translation", NodeKind::Numbers, 3, 3},
                                                                    {"rotation", NodeKind::Numbers, 4, 4},
                                                                    {"scale", NodeKind::Numbers, 3, 3}}};

  /// Tree: among values. Nodes: between the nodes. Node: in one. List: in a list of numbers that a node has.
  enum class At { Tree, Nodes, Node, List };

  Document& doc_;
  Json& root_;
  At at_ = At::Tree;
  std::vector<Json*> open_;  ///< objects and arrays that have begun and not ended
  Json* slot_ = nullptr;     ///< where the value of the latest key goes
  Json* nodes_ = nullptr;    ///< that of the root's "nodes"
  // Of the node that is being read:
  Member member_ = Name;
  uint32_t seen_ = 0;  ///< a bit per member
  std::vector<double> list_;
  glm::dvec3 translation_{0.0}, scale_{1.0};
  glm::dvec4 rotation_{0, 0, 0, 1};
  Json others_ = Json::object();  ///< its extras and extensions, and what is not known

  Node& node() { return doc_.nodes.back(); }
  std::string where() const {
    const std::string text = fmt::format("nodes[{}]", doc_.nodes.size() - (at_ == At::Nodes ? 0 : 1));
    if (at_ == At::Nodes) return text;
    const std::string member = fmt::format("{}.{}", text, kNodeRules[member_].name);
    return at_ == At::List ? fmt::format("{}[{}]", member, list_.size()) : member;
  }
  /// The specification forbids them: two readers would see two scenes.
  [[noreturn]] void duplicate(const std::string& name) const {
    doc_.fail("JSON", fmt::format("duplicate key \"{}\"", name));
  }

  Json& put(Json&& value) {
    if (open_.empty()) return root_ = std::move(value);
    Json& parent = *open_.back();
    if (parent.is_array()) return parent.get_ref<Json::array_t&>().emplace_back(std::move(value));
    return *slot_ = std::move(value);
  }
  bool open(Json&& value) {
    open_.push_back(&put(std::move(value)));
    return true;
  }
  bool close() {
    open_.pop_back();
    return done();
  }
  /// A value of the tree is whole: behind one that a node has, the node goes on.
  bool done() {
    if (open_.empty() || open_.back() != &others_) return true;
    open_.pop_back();
    at_ = At::Node;
    return true;
  }
  /// A value that is no number which a node has.
  bool take(Json&& value) {
    if (at_ != At::Tree) refuse(value);
    put(std::move(value));
    return done();
  }
  template <class Number>
  bool takeNumber(Number value) {
    if (at_ == At::Tree) return take(Json(value));
    if (at_ == At::Nodes) refuse(Json(value));
    const NodeKind kind = kNodeRules[member_].kind;
    const double number = static_cast<double>(value);
    if (at_ == At::Node && kind == NodeKind::Index) {
      const int index = indexOf(number, [this] { return where(); });
      (member_ == Mesh ? node().mesh : member_ == Skin ? node().skin : node().camera) = index;
    } else if (at_ == At::List) {
      if (kind == NodeKind::Indices)
        indexOf(number, [this] { return where(); });
      else if (!(std::abs(number) <= kMostNumber))
        doc_.fail(where(), fmt::format("{} is out of range ({} to {})", number, -kMostNumber, kMostNumber));
      list_.push_back(number);
    } else {
      refuse(Json(value));
    }
    return true;
  }
  /// Integers may be written as 1.0 (the specification says so).
  int indexOf(double number, const auto& whose) const {
    if (number != std::floor(number) || number < 0 || number > kMostIndex)
      doc_.fail(whose(), fmt::format("{} is not an integer from 0 to {}", number, kMostIndex));
    return static_cast<int>(number);
  }
  int indexOf(const Json& value, const std::string& whose) const {
    if (!value.is_number()) doc_.fail(whose, fmt::format("is not an integer ({})", value.dump().substr(0, 40)));
    return indexOf(value.get<double>(), [&] { return whose; });
  }
  [[noreturn]] void refuse(const Json& value) const {
    const NodeRule& rule = kNodeRules[member_];
    const std::string text = value.dump().substr(0, 40);
    if (at_ == At::Nodes) doc_.fail(where(), "is not an object");
    if (rule.kind == NodeKind::Text) doc_.fail(where(), "is not a string");
    if (rule.kind == NodeKind::Index || (at_ == At::List && rule.kind == NodeKind::Indices))
      doc_.fail(where(), fmt::format("is not an integer ({})", text));
    if (at_ == At::List) doc_.fail(where(), fmt::format("is not a number ({})", text));
    refuseLength(rule);
  }
  [[noreturn]] void refuseLength(const NodeRule& rule) const {
    doc_.fail(where(), rule.kind == NodeKind::Indices ? "is not an array"
                       : rule.least == rule.most      ? fmt::format("is not an array of {} numbers", rule.least)
                                                      : "is not an array of numbers");
  }

  void beginNode() {
    std::vector<Node>& nodes = doc_.nodes;
    if (nodes.size() == nodes.capacity()) {
      const size_t held = nodes.capacity(), wanted = std::max<size_t>(64, 2 * held);
      doc_.take(wanted * sizeof(Node), "nodes");
      nodes.reserve(wanted);
      doc_.release(held * sizeof(Node));
    }
    nodes.emplace_back();
    seen_ = 0;
    translation_ = glm::dvec3(0.0), scale_ = glm::dvec3(1.0), rotation_ = {0, 0, 0, 1};
    others_.clear();
    at_ = At::Node;
  }
  void endList() {
    at_ = At::Node;
    const NodeRule& rule = kNodeRules[member_];
    if (rule.kind == NodeKind::Numbers && (list_.size() < rule.least || list_.size() > rule.most)) refuseLength(rule);
    const std::vector<double>& v = list_;
    if (member_ == Children) node().children.assign(v.begin(), v.end());
    if (member_ == Weights) node().weights = v;
    if (member_ == Translation) translation_ = {v[0], v[1], v[2]};
    if (member_ == Rotation) rotation_ = {v[0], v[1], v[2], v[3]};
    if (member_ == Scale) scale_ = {v[0], v[1], v[2]};
    if (member_ == Matrix)
      for (int i = 0; i < 16; ++i) node().transform[i / 4][i % 4] = v[static_cast<size_t>(i)];
  }
  void endNode() {
    const size_t index = doc_.nodes.size() - 1;
    const uint32_t parts = (1u << Translation) | (1u << Rotation) | (1u << Scale);
    if ((seen_ & (1u << Matrix)) == 0)
      node().transform = transformOf(doc_, index, translation_, rotation_, scale_);
    else if ((seen_ & parts) != 0)
      doc_.fail(fmt::format("nodes[{}]", index), "has both a matrix and translation, rotation or scale");
    if (const auto extensions = others_.find("extensions"); extensions != others_.end())
      takeExtensions(*extensions, fmt::format("nodes[{}].extensions", index));
    at_ = At::Nodes;
  }
  void takeExtensions(const Json& extensions, const std::string& whose) {
    const auto find = [&](const char* name) -> const Json* {
      const auto found = extensions.find(name);
      if (found == extensions.end()) return nullptr;
      if (!found->is_object()) doc_.fail(fmt::format("{}.{}", whose, name), "is not an object");
      return &*found;
    };
    const auto required = [&](const Json& of, const char* name, const char* member) -> const Json& {
      if (!of.contains(member)) doc_.fail(fmt::format("{}.{}.{}", whose, name, member), "is missing");
      return of.at(member);
    };
    if (!extensions.is_object()) doc_.fail(whose, "is not an object");
    const char *lights = "KHR_lights_punctual", *many = "EXT_mesh_gpu_instancing", *shows = "KHR_node_visibility";
    if (const Json* light = find(lights))
      node().light = indexOf(required(*light, lights, "light"), fmt::format("{}.{}.light", whose, lights));
    if (const Json* instances = find(many)) {
      const Json& attributes = required(*instances, many, "attributes");
      const std::string all = fmt::format("{}.{}.attributes", whose, many);
      if (!attributes.is_object()) doc_.fail(all, "is not an object");
      auto& accessors = doc_.instancing[doc_.nodes.size() - 1];
      for (const auto& [name, accessor] : attributes.items())
        accessors[name] = indexOf(accessor, fmt::format("{}.{}", all, name));
    }
    if (const Json* visibility = find(shows); visibility != nullptr && visibility->contains("visible")) {
      const Json& visible = visibility->at("visible");
      if (!visible.is_boolean()) doc_.fail(fmt::format("{}.{}.visible", whose, shows), "is neither true nor false");
      node().visible = visible.get<bool>();
    }
  }
};

}  // namespace

void readJson(Document& doc) {
  doc.root = std::make_unique<Json>();
  DocumentReader reader(doc);
  Json::sax_parse(doc.json.begin(), doc.json.end(), &reader);
}

}  // namespace irad::gltf
