// The node tree: world transforms in double precision, mesh instances, lights and cameras.
#include <cmath>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "renderer/scene/gltf_document.h"

namespace irad::gltf {
namespace {

glm::dmat4 compose(const glm::dvec3& t, const glm::dquat& r, const glm::dvec3& s) {
  glm::dmat4 m(glm::mat3_cast(r));
  m[0] *= s.x, m[1] *= s.y, m[2] *= s.z;
  m[3] = glm::dvec4(t, 1.0);
  return m;
}

/// Unit, from any length; `where` is said of one that has none.
glm::dquat rotation(Document& doc, const std::function<std::string()>& where, double x, double y, double z, double w) {
  const double length = std::sqrt(x * x + y * y + z * z + w * w);
  if (length > 0.0 && std::isfinite(length)) return glm::dquat(w / length, x / length, y / length, z / length);
  doc.warn(fmt::format("{}: ({:g}, {:g}, {:g}, {:g}) is no rotation; none is taken", where(), x, y, z, w));
  return glm::dquat(1, 0, 0, 0);
}

/// 'nodes[3] "lamp"'
std::string nameOf(const Document& doc, size_t node) {
  const std::string& name = doc.nodes[node].name;
  return name.empty() ? fmt::format("nodes[{}]", node) : fmt::format("nodes[{}] \"{}\"", node, name.substr(0, 40));
}

bool finite(const glm::dmat4& m) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(m[c][r])) return false;
  return true;
}

/// The rotation in a transform that may also scale, shear or mirror: Gram-Schmidt from -Z, then Y.
glm::dmat3 orthonormal(const glm::dmat4& m) {
  const auto unit = [](glm::dvec3 v, glm::dvec3 otherwise) {
    const double length = glm::length(v);
    return length > 1e-300 && std::isfinite(length) ? v / length : otherwise;
  };
  const glm::dvec3 z = unit(glm::dvec3(m[2]), {0, 0, 1});
  const glm::dvec3 fallback =
      unit(glm::cross(z, std::abs(z.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)), {0, 1, 0});
  const glm::dvec3 up = glm::dvec3(m[1]);
  const glm::dvec3 y = unit(up - z * glm::dot(up, z), fallback);
  return {glm::cross(y, z), y, z};
}

/// Where a light or camera stands.
glm::dvec3 place(const Document& doc, const Node& node, const glm::dmat4& world) {
  const glm::dvec3 p(world[3]), size = glm::abs(p);
  if (!(std::max({size.x, size.y, size.z}) <= kMaxCoordinate))
    doc.fail(fmt::format("node \"{}\"", node.name),
             fmt::format("its light or camera lies at ({}, {}, {}), further than {}", p.x, p.y, p.z, kMaxCoordinate));
  return p;
}

void addLight(Document& doc, const Node& node, const glm::dmat4& world, Scene& scene) {
  if (node.light < 0) return;
  const size_t index = static_cast<size_t>(node.light);
  if (index >= doc.model.lights.size())
    doc.fail(fmt::format("node \"{}\"", node.name), fmt::format("light {} is unknown", index));
  const tinygltf::Light& in = doc.model.lights[index];
  const std::string where = fmt::format("lights[{}]", index);
  Light light;
  light.name = !in.name.empty() ? in.name : !node.name.empty() ? node.name : fmt::format("light {}", index);
  const LightKind* kind = findGltfLightKind(in.type);
  if (kind == nullptr) return;  // gltf_precheck has said so
  light.type = kind->type;
  light.position = place(doc, node, world);
  light.direction = glm::vec3(-orthonormal(world)[2]);
  const auto limited = [&](double value, const char* what) {
    if (value >= 0.0 && value <= kMaxLightOrEmission) return static_cast<float>(value);
    const double to = std::clamp(value, 0.0, kMaxLightOrEmission);
    doc.warn(fmt::format("{}.{}: {} is clamped to {}", where, what, value, to));
    return static_cast<float>(to);
  };
  for (size_t c = 0; c < in.color.size() && c < 3; ++c)
    light.color[static_cast<int>(c)] = limited(in.color[c], "color");
  light.intensity = limited(in.intensity, "intensity");
  light.range = kind->has(LIGHT_RANGE) ? static_cast<float>(in.range) : 0.0f;
  if (kind->has(LIGHT_CONE)) {
    light.innerCos = static_cast<float>(std::cos(in.spot.innerConeAngle));
    light.outerCos = static_cast<float>(std::cos(in.spot.outerConeAngle));
  }
  // Which tinygltf leaves out.
  const Json& source = doc.root->at("extensions").at("KHR_lights_punctual").at("lights").at(index);
  const bool distant = kind->has(LIGHT_DISTANT);
  if (source.contains("extras") && source.at("extras").is_object())
    (distant ? light.angle : light.radius) = source.at("extras").value(distant ? "angle" : "radius", 0.0f);
  scene.lights.push_back(light);
}

void addCamera(Document& doc, const Node& node, const glm::dmat4& world, Scene& scene) {
  if (node.camera < 0) return;
  const tinygltf::Camera& in = doc.model.cameras[static_cast<size_t>(node.camera)];
  Camera camera;
  camera.name = !in.name.empty() ? in.name : !node.name.empty() ? node.name : fmt::format("camera {}", node.camera);
  camera.position = place(doc, node, world);
  camera.orientation = glm::quat(glm::quat_cast(orthonormal(world)));
  camera.orthographic = in.type == "orthographic";
  if (camera.orthographic) {
    camera.ymag = static_cast<float>(std::abs(in.orthographic.ymag));
    camera.aspect = static_cast<float>(std::abs(in.orthographic.xmag / in.orthographic.ymag));
    camera.znear = static_cast<float>(in.orthographic.znear);
    camera.zfar = static_cast<float>(in.orthographic.zfar);
  } else {
    camera.yfov = static_cast<float>(in.perspective.yfov);
    camera.aspect = static_cast<float>(in.perspective.aspectRatio);
    camera.znear = static_cast<float>(in.perspective.znear);
    camera.zfar = static_cast<float>(in.perspective.zfar);
  }
  scene.cameras.push_back(camera);
}

/// EXT_mesh_gpu_instancing: one transform per instance, relative to the node.
std::vector<glm::dmat4> instanceTransforms(Document& doc, const std::map<std::string, int>& attributes, size_t index) {
  const std::string where = fmt::format("nodes[{}].EXT_mesh_gpu_instancing", index);
  Elements t, r, s;
  for (const auto& [name, accessor] : attributes) {
    if (name == "TRANSLATION") t = readFloats(doc, accessor, 3, where);
    if (name == "ROTATION") r = readFloats(doc, accessor, 4, where);
    if (name == "SCALE") s = readFloats(doc, accessor, 3, where);
  }
  const size_t count = std::max({t.count, r.count, s.count});
  for (const Elements* e : {&t, &r, &s})
    if (e->count != 0 && e->count != count)
      doc.fail(where, fmt::format("attributes of {} and {} instances", e->count, count));
  doc.take(count * 4 * sizeof(Instance), where);  // the transforms, and the instances as their array grows
  std::vector<glm::dmat4> out(count);
  for (size_t i = 0; i < count; ++i) {
    const auto vector = [&](const Elements& e, double otherwise) {
      return e.count != 0 ? glm::dvec3(e.values[3 * i], e.values[3 * i + 1], e.values[3 * i + 2])
                          : glm::dvec3(otherwise);
    };
    const glm::dquat q = r.count == 0
                             ? glm::dquat(1, 0, 0, 0)
                             : rotation(
                                   doc, [&] { return fmt::format("{}.ROTATION[{}]", where, i); }, r.values[4 * i],
                                   r.values[4 * i + 1], r.values[4 * i + 2], r.values[4 * i + 3]);
    out[i] = compose(vector(t, 0.0), q, vector(s, 1.0));
  }
  return out;
}

std::vector<bool> isChild(const Document& doc) {
  std::vector<bool> child(doc.nodes.size(), false);
  for (const Node& node : doc.nodes)
    for (const int c : node.children) child[static_cast<size_t>(c)] = true;
  return child;
}

std::vector<int> rootNodes(const Document& doc) {
  const tinygltf::Model& model = doc.model;
  if (!model.scenes.empty())
    return model.scenes[model.defaultScene >= 0 ? static_cast<size_t>(model.defaultScene) : 0].nodes;
  // Without scenes every root node is shown.
  std::vector<int> roots;
  const std::vector<bool> child = isChild(doc);
  for (size_t i = 0; i < child.size(); ++i)
    if (!child[i]) roots.push_back(static_cast<int>(i));
  return roots;
}

/// A node of the file's scene.
struct Shown {
  size_t node = 0;  ///< of the file
  uint32_t parent = SceneNode::kNoParent;
  uint32_t instances = 0;  ///< of its mesh
};

struct NameUnder {
  uint32_t parent = 0;
  std::string_view name;
  bool operator==(const NameUnder&) const = default;
  struct Hash {
    size_t operator()(const NameUnder& n) const { return std::hash<std::string_view>()(n.name) * 31 + n.parent; }
  };
};

/// Those that have meshes, and those above them, as Scene::nodes, which the instances name from then on.
void listNodes(Document& doc, const std::vector<Shown>& shown, Scene& scene, std::vector<Instance>& instances) {
  std::vector<bool> wanted(shown.size());
  for (size_t i = shown.size(); i-- > 0;) {
    if (shown[i].instances > 0) wanted[i] = true;
    if (wanted[i] && shown[i].parent != SceneNode::kNoParent) wanted[shown[i].parent] = true;
  }
  const auto count = static_cast<size_t>(std::count(wanted.begin(), wanted.end(), true));
  doc.take(uint64_t{count} * 2 * sizeof(SceneNode), "nodes");
  scene.nodes.reserve(count);
  std::vector<uint32_t> number(shown.size());
  // Of one parent's nodes each gets a name of its own: "leg", "leg 2". The taken ones (their texts are the nodes'),
  // with the next number to try, so that a thousand of one name do not ask a thousand times each.
  std::unordered_map<NameUnder, int, NameUnder::Hash> taken;
  taken.reserve(count);
  for (size_t i = 0; i < shown.size(); ++i) {
    if (!wanted[i]) continue;
    number[i] = static_cast<uint32_t>(scene.nodes.size());
    SceneNode& node = scene.nodes.emplace_back();
    if (shown[i].parent != SceneNode::kNoParent) node.parent = number[shown[i].parent];
    node.instances = shown[i].instances;
    const std::string& own = doc.nodes[shown[i].node].name;
    const std::string name = own.empty() ? fmt::format("node {}", shown[i].node) : own;
    node.name = name;
    const auto [first, isNew] = taken.try_emplace({node.parent, node.name}, 2);
    if (isNew) continue;
    int& n = first->second;
    do {
      node.name = fmt::format("{} {}", name, n++);
    } while (!taken.try_emplace({node.parent, node.name}, 2).second);
  }
  for (size_t i = scene.nodes.size(); i-- > 0;) {
    SceneNode& node = scene.nodes[i];
    node.end = std::max(node.end, static_cast<uint32_t>(i) + 1);
    if (node.parent == SceneNode::kNoParent) continue;
    SceneNode& parent = scene.nodes[node.parent];
    parent.end = std::max(parent.end, node.end);
  }
  for (Instance& instance : instances) instance.sceneNode = number[instance.sceneNode];
}

}  // namespace

glm::dmat4 transformOf(Document& doc, size_t node, const glm::dvec3& translation, const glm::dvec4& turn,
                       const glm::dvec3& scale) {
  const auto where = [&] { return nameOf(doc, node) + ".rotation"; };
  return compose(translation, rotation(doc, where, turn.x, turn.y, turn.z, turn.w), scale);
}

std::vector<Instance> flattenNodes(Document& doc, Scene& scene) {
  std::vector<Instance> out;
  // World transforms of all nodes (skins may use joints outside the scene); the tree was checked, the stack is ours.
  std::vector<int> stack;
  const std::vector<bool> child = isChild(doc);
  for (size_t i = child.size(); i-- > 0;)
    if (!child[i]) stack.push_back(static_cast<int>(i));
  while (!stack.empty()) {
    const size_t n = static_cast<size_t>(stack.back());
    stack.pop_back();
    for (const int c : doc.nodes[n].children) {
      Node& under = doc.nodes[static_cast<size_t>(c)];
      under.transform = doc.nodes[n].transform * under.transform;
      under.visible = under.visible && doc.nodes[n].visible;
      stack.push_back(c);
    }
  }
  std::vector<Shown> shown;  // in the order in which they are met: what lies under a node comes right behind it
  shown.reserve(doc.nodes.size());
  out.reserve(static_cast<size_t>(std::ranges::count_if(doc.nodes, [](const Node& n) { return n.mesh >= 0; })));
  size_t invisible = 0;
  std::vector<std::pair<int, uint32_t>> open;  // nodes, and their parents in that order
  const std::vector<int> roots = rootNodes(doc);
  for (auto it = roots.rbegin(); it != roots.rend(); ++it) open.emplace_back(*it, SceneNode::kNoParent);
  while (!open.empty()) {
    const size_t n = static_cast<size_t>(open.back().first);
    const auto own = static_cast<uint32_t>(shown.size());
    shown.push_back({.node = n, .parent = open.back().second});
    open.pop_back();
    const Node& node = doc.nodes[n];
    const glm::dmat4& world = node.transform;
    if (!finite(world)) doc.fail(fmt::format("nodes[{}]", n), "its world transform is not finite");
    const auto addInstance = [&](const glm::dmat4& transform) {
      out.push_back({node.mesh, static_cast<int>(n), node.skin, own, transform});
      ++shown[own].instances;
    };
    if (node.mesh >= 0 && !node.visible) {
      ++invisible;
    } else if (node.mesh >= 0) {
      const auto instancing = doc.instancing.find(n);
      if (instancing == doc.instancing.end())
        addInstance(world);
      else
        for (const glm::dmat4& instance : instanceTransforms(doc, instancing->second, n)) addInstance(world * instance);
    }
    addLight(doc, node, world, scene);
    addCamera(doc, node, world, scene);
    for (auto it = node.children.rbegin(); it != node.children.rend(); ++it) open.emplace_back(*it, own);
  }
  if (invisible > 0)
    doc.warn(fmt::format("KHR_node_visibility: {} nodes with meshes are invisible and left out", invisible));
  listNodes(doc, shown, scene, out);
  return out;
}

std::vector<glm::dmat4> jointMatrices(Document& doc, int index) {
  const tinygltf::Skin& skin = doc.model.skins[static_cast<size_t>(index)];
  const std::string where = fmt::format("skins[{}].inverseBindMatrices", index);
  Elements inverse;
  if (skin.inverseBindMatrices >= 0) {
    inverse = readFloats(doc, skin.inverseBindMatrices, 16, where);
    if (inverse.count < skin.joints.size())
      doc.fail(where, fmt::format("{} matrices for {} joints", inverse.count, skin.joints.size()));
  }
  std::vector<glm::dmat4> out;
  for (size_t j = 0; j < skin.joints.size(); ++j) {
    glm::dmat4 bind(1.0);
    if (inverse.count != 0)
      for (int c = 0; c < 16; ++c) bind[c / 4][c % 4] = inverse.values[j * 16 + static_cast<size_t>(c)];
    out.push_back(doc.nodes[static_cast<size_t>(skin.joints[j])].transform * bind);
    if (!finite(out.back())) doc.fail(where, fmt::format("joint {} has no finite transform", j));
  }
  return out;
}

}  // namespace irad::gltf
