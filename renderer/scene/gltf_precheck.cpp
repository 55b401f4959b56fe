// What must hold before tinygltf reads the JSON: it takes wrong types, indices and counts silently. A table says what
// each property is (glTF 2.0 schema, as far as the loader reads it); the rest are relations between properties.
#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "renderer/scene/gltf_document.h"

namespace irad::gltf {
namespace {

enum class Kind { Object, Array, String, Bool, UInt, Number, Numbers, Index, Indices, IndexMap };
struct Rule {
  std::string path;  ///< segments by '/', "[]": every element
  Kind kind;
  double lo = 0, hi = 0;  ///< UInt, Number: range; Numbers: permitted lengths
  std::string target;     ///< Index kinds: the array pointed into
  bool required = false;
};

constexpr double kHuge = 1e30, kMaxOffset = 1099511627776.0 /* 2^40 */, kMaxCount = 4294967295.0;

/// Where in the file a value is, put into words only where something is wrong: a file has a million values.
struct Where {
  const Where* parent = nullptr;
  const std::string* member = nullptr;  ///< null: element `index` of an array
  size_t index = 0;

  std::string text() const {
    const std::string before = parent != nullptr ? parent->text() : "";
    if (member == nullptr) return parent == nullptr ? "" : fmt::format("{}[{}]", before, index);
    return before.empty() ? *member : before + "." + *member;
  }
};

/// Elements of the array of this path ("meshes"); 0 where there is none.
size_t countOf(const Document& doc, const std::string& path) {
  if (path == "nodes") return doc.nodes.size();
  const auto pointer = Json::json_pointer("/" + path);
  return !path.empty() && doc.root->contains(pointer) && doc.root->at(pointer).is_array() ? doc.root->at(pointer).size()
                                                                                          : 0;
}

class Checker {
 public:
  explicit Checker(Document& doc) : doc_(doc), root_(*doc.root) {}
  void apply(const Rule& rule) {
    segments_.clear();
    for (size_t at = 0; at <= rule.path.size();) {
      const size_t end = std::min(rule.path.find('/', at), rule.path.size());
      segments_.push_back(rule.path.substr(at, end - at));
      at = end + 1;
    }
    targets_ = countOf(doc_, rule.target);
    walk(root_, rule, 0, {});
  }

 private:
  Document& doc_;
  Json& root_;
  std::vector<std::string> segments_;                     ///< of the rule's path
  size_t targets_ = 0;                                    ///< elements of the array that the rule's indices point into
  std::map<std::string, std::set<std::string>> members_;  ///< of the root's arrays: what their elements have

  /// Whether any element of the root's array `name` has this member: a rule about what none of 300,000 meshes has need
  /// not look at each.
  bool anyHas(const Json& array, const std::string& name, const std::string& member) {
    const auto [of, isNew] = members_.try_emplace(name);
    if (isNew)
      for (const Json& element : array)
        if (element.is_object())
          for (const auto& [key, value] : element.get_ref<const Json::object_t&>())
            if (!of->second.contains(key)) of->second.insert(key);
    return of->second.contains(member);
  }

  void walk(Json& value, const Rule& rule, size_t depth, const Where& where) {
    if (depth == segments_.size()) return leaf(value, rule, where);
    const std::string& segment = segments_[depth];
    if (segment == "[]") {
      if (!value.is_array()) doc_.fail(where.text(), "is not an array");
      const bool inner = depth == 1 && segments_.size() > 2, required = rule.required && segments_.size() == 3;
      if (inner && !required && !anyHas(value, segments_[0], segments_[2])) return;
      for (size_t i = 0; i < value.size(); ++i) walk(value[i], rule, depth + 1, {&where, nullptr, i});
      return;
    }
    if (!value.is_object()) doc_.fail(depth == 0 ? "root" : where.text(), "is not an object");
    const auto found = value.find(segment);
    const Where name{depth == 0 ? nullptr : &where, &segment};
    if (found != value.end()) return walk(*found, rule, depth + 1, name);
    if (rule.required && depth + 1 == segments_.size()) doc_.fail(name.text(), "is missing");
  }

  /// Integers may be written as 1.0 (the specification says so); tinygltf then wants them rewritten.
  void integer(Json& value, double lo, double hi, const Where& where) const {
    if (!value.is_number()) doc_.fail(where.text(), fmt::format("is not an integer ({})", value.dump().substr(0, 40)));
    const double number = value.get<double>();
    if (number != std::floor(number) || number < lo || number > hi)
      doc_.fail(where.text(), fmt::format("{} is not an integer from {} to {}", value.dump(), lo, hi));
    value = static_cast<uint64_t>(number);
  }

  void index(Json& value, const std::string& target, const Where& where) const {
    integer(value, 0, kMaxCount, where);
    if (value.get<uint64_t>() >= targets_)
      doc_.fail(where.text(), fmt::format("{} points past \"{}\", which has {}", value.dump(), target, targets_));
  }

  void number(const Json& value, double lo, double hi, const Where& where) const {
    if (!value.is_number()) doc_.fail(where.text(), fmt::format("is not a number ({})", value.dump().substr(0, 40)));
    const double n = value.get<double>();
    if (!(n >= lo && n <= hi))
      doc_.fail(where.text(), fmt::format("{} is out of range ({} to {})", value.dump(), lo, hi));
  }

  void leaf(Json& value, const Rule& rule, const Where& where) {
    switch (rule.kind) {
      case Kind::Object:
        if (!value.is_object()) doc_.fail(where.text(), "is not an object");
        break;
      case Kind::Array:
        if (!value.is_array()) doc_.fail(where.text(), "is not an array");
        break;
      case Kind::String:
        if (!value.is_string()) doc_.fail(where.text(), "is not a string");
        break;
      case Kind::Bool:
        if (!value.is_boolean()) doc_.fail(where.text(), "is neither true nor false");
        break;
      case Kind::UInt:
        integer(value, rule.lo, rule.hi, where);
        break;
      case Kind::Number:
        number(value, rule.lo, rule.hi, where);
        break;
      case Kind::Numbers:
        if (!value.is_array() || value.size() < rule.lo || value.size() > rule.hi)
          doc_.fail(where.text(), rule.lo == rule.hi ? fmt::format("is not an array of {} numbers", rule.lo)
                                                     : "is not an array of numbers");
        for (size_t i = 0; i < value.size(); ++i) number(value[i], -kHuge, kHuge, {&where, nullptr, i});
        break;
      case Kind::Index:
        index(value, rule.target, where);
        break;
      case Kind::Indices:
        if (!value.is_array()) doc_.fail(where.text(), "is not an array");
        for (size_t i = 0; i < value.size(); ++i) index(value[i], rule.target, {&where, nullptr, i});
        break;
      case Kind::IndexMap:
        if (!value.is_object()) doc_.fail(where.text(), "is not an object");
        for (auto& [key, element] : value.items()) index(element, rule.target, {&where, &key});
        break;
    }
  }
};

std::vector<Rule> rules() {
  using enum Kind;
  std::vector<Rule> r;
  const auto add = [&](const char* path, Kind kind, double lo = 0, double hi = 0, bool required = false) {
    r.push_back({path, kind, lo, hi, "", required});
  };
  const auto ref = [&](const char* path, const char* target, Kind kind = Index, bool required = false) {
    r.push_back({path, kind, 0, 0, target, required});
  };
  add("asset", Object, 0, 0, true), add("asset/version", String, 0, 0, true), add("asset/minVersion", String);
  add("extensionsUsed/[]", String), add("extensionsRequired/[]", String), add("extensions", Object);
  ref("scene", "scenes"), add("scenes/[]", Object), ref("scenes/[]/nodes", "nodes", Indices);

  add("meshes/[]", Object), add("meshes/[]/name", String), add("meshes/[]/primitives", Array, 0, 0, true);
  add("meshes/[]/weights", Numbers, 1, 1e6), add("meshes/[]/primitives/[]", Object);
  ref("meshes/[]/primitives/[]/attributes", "accessors", IndexMap, true);
  ref("meshes/[]/primitives/[]/indices", "accessors"), ref("meshes/[]/primitives/[]/material", "materials");
  add("meshes/[]/primitives/[]/mode", UInt, 0, 6), ref("meshes/[]/primitives/[]/targets/[]", "accessors", IndexMap);
  const char* draco = "meshes/[]/primitives/[]/extensions/KHR_draco_mesh_compression";
  r.push_back({std::string(draco) + "/bufferView", Index, 0, 0, "bufferViews", true});
  r.push_back({std::string(draco) + "/attributes", Object, 0, 0, "", true});

  add("accessors/[]", Object), ref("accessors/[]/bufferView", "bufferViews");
  add("accessors/[]/byteOffset", UInt, 0, kMaxOffset), add("accessors/[]/componentType", UInt, 5120, 5126, true);
  add("accessors/[]/normalized", Bool), add("accessors/[]/count", UInt, 1, kMaxCount, true);
  add("accessors/[]/type", String, 0, 0, true), add("accessors/[]/sparse", Object);
  // tinygltf keeps these offsets and counts as int.
  add("accessors/[]/sparse/count", UInt, 1, 2147483647, true), add("accessors/[]/sparse/indices", Object, 0, 0, true);
  ref("accessors/[]/sparse/indices/bufferView", "bufferViews", Index, true);
  add("accessors/[]/sparse/indices/byteOffset", UInt, 0, 2147483647);
  add("accessors/[]/sparse/indices/componentType", UInt, 5121, 5125, true);
  add("accessors/[]/sparse/values", Object, 0, 0, true);
  ref("accessors/[]/sparse/values/bufferView", "bufferViews", Index, true);
  add("accessors/[]/sparse/values/byteOffset", UInt, 0, 2147483647);

  add("bufferViews/[]", Object), ref("bufferViews/[]/buffer", "buffers", Index, true);
  add("bufferViews/[]/byteOffset", UInt, 0, kMaxOffset), add("bufferViews/[]/byteLength", UInt, 1, kMaxOffset, true);
  add("bufferViews/[]/byteStride", UInt, 4, 252), add("bufferViews/[]/target", UInt, 34962, 34963);
  for (const std::string name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    const std::string base = "bufferViews/[]/extensions/" + name;
    r.push_back({base + "/buffer", Index, 0, 0, "buffers", true});
    r.push_back({base + "/byteOffset", UInt, 0, kMaxOffset, "", false});
    r.push_back({base + "/byteLength", UInt, 1, kMaxOffset, "", true});
    r.push_back({base + "/byteStride", UInt, 1, 256, "", true});
    r.push_back({base + "/count", UInt, 1, kMaxCount, "", true});
    r.push_back({base + "/mode", String, 0, 0, "", true});
    r.push_back({base + "/filter", String, 0, 0, "", false});
  }
  add("buffers/[]", Object), add("buffers/[]/uri", String), add("buffers/[]/byteLength", UInt, 1, kMaxOffset, true);
  add("buffers/[]/extensions", Object);

  add("images/[]", Object), add("images/[]/uri", String), add("images/[]/mimeType", String),
      add("images/[]/name", String);
  ref("images/[]/bufferView", "bufferViews");
  add("textures/[]", Object), ref("textures/[]/source", "images"), ref("textures/[]/sampler", "samplers");
  ref("textures/[]/extensions/EXT_texture_webp/source", "images");
  add("samplers/[]", Object), add("samplers/[]/magFilter", UInt, 9728, 9729),
      add("samplers/[]/minFilter", UInt, 9728, 9987);
  add("samplers/[]/wrapS", UInt, 10497, 33648), add("samplers/[]/wrapT", UInt, 10497, 33648);

  add("materials/[]", Object), add("materials/[]/name", String), add("materials/[]/extensions", Object);
  add("materials/[]/doubleSided", Bool), add("materials/[]/alphaMode", String);
  add("materials/[]/alphaCutoff", Number, -kHuge, kHuge), add("materials/[]/emissiveFactor", Numbers, 3, 3);
  add("materials/[]/pbrMetallicRoughness/baseColorFactor", Numbers, 4, 4);
  add("materials/[]/pbrMetallicRoughness/metallicFactor", Number, -kHuge, kHuge);
  add("materials/[]/pbrMetallicRoughness/roughnessFactor", Number, -kHuge, kHuge);
  add("materials/[]/extensions/KHR_materials_emissive_strength/emissiveStrength", Number, 0, 1e38);
  add("materials/[]/extensions/KHR_materials_transmission/transmissionFactor", Number, -kHuge, kHuge);
  add("materials/[]/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor", Numbers, 4, 4);
  add("materials/[]/extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor", Number, -kHuge, kHuge);
  for (const std::string texture :
       {"pbrMetallicRoughness/baseColorTexture", "pbrMetallicRoughness/metallicRoughnessTexture", "normalTexture",
        "occlusionTexture", "emissiveTexture", "extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture",
        "extensions/KHR_materials_pbrSpecularGlossiness/specularGlossinessTexture",
        "extensions/KHR_materials_transmission/transmissionTexture"}) {
    const std::string base = "materials/[]/" + texture;
    r.push_back({base + "/index", Index, 0, 0, "textures", true});
    r.push_back({base + "/texCoord", UInt, 0, 255, "", false});
    r.push_back({base + "/scale", Number, -kHuge, kHuge, "", false});
    r.push_back({base + "/strength", Number, -kHuge, kHuge, "", false});
    const std::string transform = base + "/extensions/KHR_texture_transform";
    r.push_back({transform + "/offset", Numbers, 2, 2, "", false});
    r.push_back({transform + "/scale", Numbers, 2, 2, "", false});
    r.push_back({transform + "/rotation", Number, -kHuge, kHuge, "", false});
    r.push_back({transform + "/texCoord", UInt, 0, 255, "", false});
  }

  add("skins/[]", Object), ref("skins/[]/joints", "nodes", Indices, true), ref("skins/[]/skeleton", "nodes");
  ref("skins/[]/inverseBindMatrices", "accessors");
  add("cameras/[]", Object), add("cameras/[]/name", String), add("cameras/[]/type", String, 0, 0, true);
  add("cameras/[]/perspective/yfov", Number, -kHuge, kHuge, true),
      add("cameras/[]/perspective/aspectRatio", Number, -kHuge, kHuge);
  add("cameras/[]/perspective/znear", Number, -kHuge, kHuge, true),
      add("cameras/[]/perspective/zfar", Number, -kHuge, kHuge);
  add("cameras/[]/orthographic/xmag", Number, -kHuge, kHuge, true),
      add("cameras/[]/orthographic/ymag", Number, -kHuge, kHuge, true);
  add("cameras/[]/orthographic/znear", Number, -kHuge, kHuge, true),
      add("cameras/[]/orthographic/zfar", Number, -kHuge, kHuge, true);
  const std::string light = "extensions/KHR_lights_punctual/lights/[]";
  r.push_back({"extensions/KHR_lights_punctual/lights", Array, 0, 0, "", true});
  r.push_back({light, Object, 0, 0, "", false});
  r.push_back({light + "/type", String, 0, 0, "", true});
  r.push_back({light + "/name", String, 0, 0, "", false});
  r.push_back({light + "/color", Numbers, 3, 3, "", false});
  r.push_back({light + "/intensity", Number, -kHuge, 1e39, "", false});
  r.push_back({light + "/range", Number, -kHuge, kHuge, "", false});
  r.push_back({light + "/spot", Object, 0, 0, "", false});
  r.push_back({light + "/spot/innerConeAngle", Number, 0, 1.5707964, "", false});
  r.push_back({light + "/spot/outerConeAngle", Number, 0, 1.5707964, "", false});
  return r;
}

/// glTF 1.0 names its objects, in place of counting them, and may say nothing of its version.
bool isOldFormat(const Json& root) {
  if (root.contains("asset") && root.at("asset").is_object() && root.at("asset").contains("version")) {
    const Json& version = root.at("asset").at("version");
    if (version.is_string()) return version.get<std::string>().starts_with("1.");
    return version.is_number() && version.get<double>() < 2.0;
  }
  return std::ranges::any_of(std::array{"scenes", "nodes", "meshes", "accessors"},
                             [&](const char* name) { return root.contains(name) && root.at(name).is_object(); });
}

/// "2.0" or "2.5"; a file that needs more than 2.0 says so in minVersion.
void checkVersion(const Document& doc) {
  const Json& asset = doc.root->at("asset");
  const auto parse = [&](const char* key) {
    int major = -1, minor = -1, read = 0;
    const std::string text = asset.at(key).get<std::string>();
    if (text.size() > 10 || std::sscanf(text.c_str(), "%3d.%3d%n", &major, &minor, &read) != 2 ||
        read != static_cast<int>(text.size()) || major < 0 || minor < 0)
      doc.fail(fmt::format("asset.{}", key), fmt::format("\"{}\" is not a version", text.substr(0, 40)));
    return std::pair(major, minor);
  };
  if (const auto v = parse("version"); v.first != 2)
    doc.fail("asset.version", fmt::format("{}.{} is not 2.x", v.first, v.second));
  if (asset.contains("minVersion"))
    if (const auto v = parse("minVersion"); v > std::pair(2, 0))
      doc.fail("asset.minVersion", fmt::format("{}.{} is newer than 2.0", v.first, v.second));
}

void checkExtensions(Document& doc) {
  static const std::set<std::string> kSupported = {
      "KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_texture_transform", "KHR_mesh_quantization",
      "EXT_texture_webp", "EXT_mesh_gpu_instancing", "KHR_draco_mesh_compression", "EXT_meshopt_compression",
      "KHR_meshopt_compression", "KHR_materials_transmission", "KHR_node_visibility",
      // Which gltf_materials.cpp warns of.
      "KHR_materials_pbrSpecularGlossiness"};
  // Effects the renderer has no term for: without them, the material stands in, and a warning says so.
  static const std::set<std::string> kApproximated = {
      "KHR_materials_unlit",     "KHR_materials_variants", "KHR_materials_ior",         "KHR_materials_specular",
      "KHR_materials_clearcoat", "KHR_materials_sheen",    "KHR_materials_iridescence", "KHR_materials_anisotropy",
      "KHR_techniques_webgl",    "KHR_technique_webgl"};
  // What light does on its way through a body: there are thin panes alone.
  static const std::set<std::string> kOfBodies = {"KHR_materials_volume", "KHR_materials_dispersion",
                                                  "KHR_materials_diffuse_transmission"};
  constexpr const char *kKtx = "KHR_texture_basisu",
                       *kNoKtx = ": KTX2 images are not decoded here; PNG, JPEG and WebP are";
  for (const char* list : {"extensionsRequired", "extensionsUsed"}) {
    if (!doc.root->contains(list)) continue;
    for (const Json& entry : doc.root->at(list)) {
      const std::string name = entry.get<std::string>();
      if (kSupported.contains(name)) continue;
      if (kOfBodies.contains(name)) {
        doc.warn(fmt::format("{} is not rendered: what transmits light is a thin pane, which does not bend it", name));
      } else if (kApproximated.contains(name)) {
        doc.warn(fmt::format("{} is not rendered: the plain material stands in for it", name));
      } else if (name == "CESIUM_RTC") {
        doc.warn(name + " is left aside: it says where on the globe the scene lies, which no picture shows");
      } else if (std::string_view(list) == "extensionsRequired") {
        doc.fail(list, fmt::format("\"{}\" is not supported{}", name, name == kKtx ? kNoKtx : ""));
      } else if (name == kKtx) {
        doc.warn(fmt::format("{} is ignored{}", name, kNoKtx));
      } else {
        doc.warn(fmt::format("extension {} is not known and ignored", name));
      }
    }
  }
}

/// Takes a node that the scene shown lists twice, or beside one of those that it lies under, out of the list: it is
/// shown once, where the tree has it. `parent`: of each node, or -1.
void takeOnce(Document& doc, const std::vector<int64_t>& parent) {
  if (!doc.root->contains("scenes") || doc.root->at("scenes").empty()) return;
  const size_t s = doc.root->value("scene", size_t{0});
  Json& scene = doc.root->at("scenes")[s];
  if (!scene.contains("nodes")) return;
  Json& nodes = scene.at("nodes");
  enum class State : uint8_t { Unknown, Shown, NotShown };
  std::vector<bool> listed(parent.size(), false), taken(parent.size(), false);
  for (const Json& node : nodes) listed[node.get<size_t>()] = true;
  // Whether a node or one that it lies under is listed: found once for each.
  std::vector<State> state(parent.size(), State::Unknown);
  std::vector<size_t> path;
  const auto shown = [&](int64_t from) {
    State found = State::NotShown;
    path.clear();
    for (int64_t n = from; n >= 0 && found != State::Shown; n = parent[static_cast<size_t>(n)]) {
      const size_t node = static_cast<size_t>(n);
      found = state[node];
      if (found != State::Unknown) break;
      path.push_back(node);
      found = listed[node] ? State::Shown : State::NotShown;
    }
    for (const size_t n : path) state[n] = found;
    return found == State::Shown;
  };
  Json kept = Json::array();
  std::string first;
  size_t more = 0;
  for (const Json& node : nodes) {
    const size_t n = node.get<size_t>();
    const bool child = shown(parent[n]);
    if (!child && !taken[n]) {
      kept.push_back(node);
      taken[n] = true;
    } else if (first.empty()) {
      first = child ? fmt::format("lists node {}, which is a child of node {}", n, parent[n])
                    : fmt::format("lists node {} twice", n);
    } else {
      ++more;
    }
  }
  if (first.empty()) return;
  nodes = std::move(kept);
  doc.warn(fmt::format("scenes[{}]: {}{}; it is taken once", s, first,
                       more > 0 ? fmt::format(", and {} more like it", more) : ""));
}

constexpr const char* kLightsPath = "extensions/KHR_lights_punctual/lights";

/// What nodes name is there.
void checkNodeIndices(const Document& doc) {
  const auto check = [&](size_t node, const char* member, const char* target, size_t count, int64_t index) {
    if (index >= static_cast<int64_t>(count))
      doc.fail(fmt::format("nodes[{}].{}", node, member),
               fmt::format("{} points past \"{}\", which has {}", index, target, count));
  };
  const size_t meshes = countOf(doc, "meshes"), skins = countOf(doc, "skins"), cameras = countOf(doc, "cameras"),
               lights = countOf(doc, kLightsPath), accessors = countOf(doc, "accessors");
  for (size_t i = 0; i < doc.nodes.size(); ++i) {
    const Node& node = doc.nodes[i];
    check(i, "mesh", "meshes", meshes, node.mesh), check(i, "skin", "skins", skins, node.skin);
    check(i, "camera", "cameras", cameras, node.camera);
    check(i, "extensions.KHR_lights_punctual.light", kLightsPath, lights, node.light);
    for (const int child : node.children) check(i, "children", "nodes", doc.nodes.size(), child);
  }
  for (const auto& [node, attributes] : doc.instancing)
    for (const auto& [name, accessor] : attributes)
      check(node, ("extensions.EXT_mesh_gpu_instancing.attributes." + name).c_str(), "accessors", accessors, accessor);
}

/// Every node has one parent and no node is its own ancestor: then the nodes are trees and can be walked.
void checkNodeTree(Document& doc) {
  const std::vector<Node>& nodes = doc.nodes;
  std::vector<int64_t> parent(nodes.size(), -1);
  for (size_t i = 0; i < nodes.size(); ++i)
    for (const int child : nodes[i].children) {
      const auto c = static_cast<size_t>(child);
      if (parent[c] >= 0 || c == i)
        doc.fail(fmt::format("nodes[{}]", c),
                 c == i ? "is its own child" : fmt::format("is a child of nodes {} and {}", parent[c], i));
      parent[c] = static_cast<int64_t>(i);
    }
  // Mark the path to the root: a node met again on the path being walked closes a cycle.
  std::vector<uint32_t> visited(nodes.size(), 0);
  for (size_t i = 0; i < nodes.size(); ++i) {
    const uint32_t mark = static_cast<uint32_t>(i + 1);
    for (int64_t n = static_cast<int64_t>(i); n >= 0 && visited[n] != mark; n = parent[n]) {
      if (visited[n] != 0) break;
      visited[n] = mark;
      if (parent[n] >= 0 && visited[parent[n]] == mark) doc.fail(fmt::format("nodes[{}]", n), "is part of a cycle");
    }
  }
  takeOnce(doc, parent);
}

/// ' "lamp"', or nothing.
std::string quoted(const std::string& name) {
  return name.empty() ? "" : fmt::format(" \"{}\"", name.substr(0, 40));
}

/// "directional, point or spot"
std::string knownLightTypes() {
  std::string out;
  const std::span<const LightKind> kinds = lightKinds();
  for (size_t i = 0; i < kinds.size(); ++i)
    out += fmt::format("{}{}", i == 0 ? "" : i + 1 < kinds.size() ? ", " : " or ", kinds[i].gltf);
  return out;
}

/// What others write and readers take: an aspect ratio of 0, planes at 0 or in the wrong order.
void mendPlanes(Document& doc, const std::string& where, Json& lens, bool perspective) {
  const auto value = [&](const char* name) { return lens.at(name).get<double>(); };
  if (lens.contains("aspectRatio") && !(value("aspectRatio") >= 1e-4 && value("aspectRatio") <= 1e4)) {
    doc.warn(fmt::format("{}.aspectRatio: {} is not from 0.0001 to 10000; the picture's is taken", where,
                         lens.at("aspectRatio").dump()));
    lens.erase("aspectRatio");
  }
  const double least = perspective ? 1e-30 : 0.0, otherwise = double{Camera{}.znear};
  if (!(value("znear") >= least)) {
    doc.warn(fmt::format("{}.znear: {} is not {}; {:.6g} is taken", where, lens.at("znear").dump(),
                         perspective ? "above 0" : "0 or more", perspective ? otherwise : 0.0));
    lens["znear"] = perspective ? otherwise : 0.0;
  }
  if (!lens.contains("zfar") || value("zfar") > value("znear")) return;
  const double far = perspective ? 0.0 : value("znear") + double{kMaxCoordinate};
  doc.warn(fmt::format("{}.zfar: {} is not beyond znear, {}; there is no limit then", where, lens.at("zfar").dump(),
                       lens.at("znear").dump()));
  if (perspective)
    lens.erase("zfar");
  else
    lens["zfar"] = far;
}

/// Equal angles, which the specification forbids, are what three.js writes of a spot by default, and Blender of one
/// with a blend of 0: a hard edge.
void checkCone(Document& doc, const std::string& where, Json& light) {
  if (!light.contains("spot")) {
    doc.warn(fmt::format("{}: a spot light without \"spot\"; its cone is the default one", where));
    light["spot"] = Json::object();
  }
  const Json& spot = light.at("spot");
  const double inner = spot.value("innerConeAngle", 0.0), outer = spot.value("outerConeAngle", 0.7853981633974483);
  if (!(inner <= outer && outer > 0.0))
    doc.fail(where + ".spot", fmt::format("innerConeAngle {} is not below outerConeAngle {}", inner, outer));
}

/// What others write and readers take: yfov in degrees, and worse.
void mendLens(Document& doc, const std::string& where, Json& lens) {
  if (!lens.contains("yfov")) return;
  constexpr double kLeast = 1e-4, kMost = 3.1415;
  const double yfov = lens.at("yfov").get<double>();
  if (yfov >= kLeast && yfov <= kMost) return;
  const bool degrees = yfov > std::numbers::pi && yfov < 180.0;
  const double taken = degrees ? yfov * std::numbers::pi / 180.0 : double{Camera{}.yfov};
  lens["yfov"] = taken;
  doc.warn(fmt::format("{}.perspective.yfov: {} is not from {} to {} radians; {:.6g} is taken{}", where, yfov, kLeast,
                       kMost, taken, degrees ? ", as if it were degrees" : ""));
}

void checkLightsAndCameras(Document& doc) {
  const Json::json_pointer lightsPath("/extensions/KHR_lights_punctual/lights");
  if (doc.root->contains(lightsPath)) {
    Json& lights = doc.root->at(lightsPath);
    for (size_t i = 0; i < lights.size(); ++i) {
      const std::string where = fmt::format("lights[{}]", i), type = lights[i].at("type").get<std::string>();
      const LightKind* kind = findGltfLightKind(type);
      if (kind == nullptr) {
        doc.warn(fmt::format("{}.type: \"{}\" is not {}; the light{} is left out", where, type.substr(0, 40),
                             knownLightTypes(), quoted(lights[i].value("name", ""))));
        continue;
      }
      if (const auto range = lights[i].find("range"); range != lights[i].end() && !(range->get<double>() > 0.0)) {
        doc.warn(fmt::format("{}.range: {} is not above 0; the light{} reaches without limit", where, range->dump(),
                             quoted(lights[i].value("name", ""))));
        lights[i].erase(range);
      }
      // Extras may be anything; a size is a number.
      const Json extras = lights[i].value("extras", Json::object());
      for (const auto& [member, most] : {std::pair("angle", kMaxLightAngle), std::pair("radius", kMaxCoordinate)})
        if (const auto size = extras.is_object() ? extras.find(member) : extras.end(); size != extras.end())
          if (!size->is_number() || !(*size >= 0.0 && *size <= most))
            doc.fail(fmt::format("{}.extras.{}", where, member),
                     fmt::format("{} is not a number from 0 to {}", size->dump().substr(0, 40), most));
      if (kind->has(LIGHT_CONE)) checkCone(doc, where, lights[i]);
    }
  }
  if (!doc.root->contains("cameras")) return;
  Json& cameras = doc.root->at("cameras");
  for (size_t i = 0; i < cameras.size(); ++i) {
    const std::string where = fmt::format("cameras[{}]", i), type = cameras[i].at("type").get<std::string>();
    if (type != "perspective" && type != "orthographic")
      doc.fail(where + ".type", fmt::format("\"{}\" is neither perspective nor orthographic", type.substr(0, 40)));
    if (!cameras[i].contains(type)) doc.fail(where, fmt::format("has no \"{}\"", type));
    Json& lens = cameras[i].at(type);
    const std::string named = where + quoted(cameras[i].value("name", ""));
    if (type == "perspective") mendLens(doc, named, lens);
    mendPlanes(doc, named + "." + type, lens, type == "perspective");
    for (const char* mag : {"xmag", "ymag"})
      if (const double size = std::abs(lens.value(mag, 1.0)); size < 1e-15 || size > kMaxCoordinate)
        doc.fail(where + "." + mag, fmt::format("{} is not from 1e-15 to {}", size, kMaxCoordinate));
  }
}

}  // namespace

void precheck(Document& doc) {
  if (isOldFormat(*doc.root)) doc.fail("asset.version", kOldFormat);
  for (const char* name : {"scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers", "images", "textures",
                           "samplers", "materials", "skins", "cameras", "extensionsUsed", "extensionsRequired"})
    if (doc.root->contains(name) && !doc.root->at(name).is_array()) doc.fail(name, "is not an array");
  Checker checker(doc);
  for (const Rule& rule : rules()) checker.apply(rule);
  checkVersion(doc);
  checkExtensions(doc);
  checkNodeIndices(doc);
  checkNodeTree(doc);
  checkLightsAndCameras(doc);
}

}  // namespace irad::gltf
