// Primitives and instances into one world-space vertex and index array, grouped by material. Everything is counted
// before it is allocated; the origin is the centre of the bounds in double precision.
#include <cmath>
#include <limits>
#include <map>

#include "renderer/scene/gltf_document.h"
#include "renderer/scene/nodes.h"

namespace irad::gltf {
namespace {

/// A primitive somewhere in the world, its positions still to be transformed.
struct Placed {
  const Primitive* primitive = nullptr;
  const Instance* instance = nullptr;
  const std::vector<glm::dmat4>* joints = nullptr;  ///< skinned: these instead of the instance's transform
  std::vector<bool> keep;                           ///< per triangle; empty: all
  uint64_t kept = 0;
};

/// The transform of a vertex: the instance's, or the weighted mean of its joints' (glTF 3.7.3.3).
glm::dmat4 vertexTransform(const Document& doc, const Placed& placed, size_t vertex) {
  if (placed.joints == nullptr) return placed.instance->world;
  const Primitive& p = *placed.primitive;
  glm::dmat4 sum(0.0);
  double total = 0.0;
  for (uint32_t k = 0; k < p.influences; ++k) {
    const double weight = p.weights[vertex * p.influences + k];
    if (weight == 0.0) continue;
    const uint32_t joint = p.joints[vertex * p.influences + k];
    if (joint >= placed.joints->size())
      doc.fail("skin", fmt::format("joint {} of {} joints", joint, placed.joints->size()));
    sum += weight * (*placed.joints)[joint];
    total += weight;
  }
  return total > 0.0 ? sum / total : placed.joints->empty() ? glm::dmat4(1.0) : placed.joints->front();
}

void worldPositions(const Document& doc, const Placed& placed, std::vector<glm::dvec3>& out) {
  const Primitive& p = *placed.primitive;
  out.resize(p.positions.size());
  for (size_t i = 0; i < out.size(); ++i)
    out[i] = glm::dvec3(vertexTransform(doc, placed, i) * glm::dvec4(glm::dvec3(p.positions[i]), 1.0));
}

bool usable(const glm::dvec3& v) {
  return std::abs(v.x) < kMaxCoordinate && std::abs(v.y) < kMaxCoordinate && std::abs(v.z) < kMaxCoordinate;
}

bool zeroArea(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 e1 = b - a, e2 = c - a, e3 = c - b;
  const double longest = std::max({glm::dot(e1, e1), glm::dot(e2, e2), glm::dot(e3, e3)});
  return !(glm::length(glm::cross(e1, e2)) > 1e-12 * longest);
}

/// What is the matter where nothing is drawn: ": …", as far as the file's structure says it.
std::string whyNone(const Document& doc, const std::vector<Instance>& instances, uint64_t triangles) {
  const tinygltf::Model& model = doc.model;
  const size_t meshes = model.meshes.size(), scene = static_cast<size_t>(std::max(model.defaultScene, 0));
  if (meshes == 0) return ": the file has no meshes";
  if (!instances.empty()) return triangles == 0 ? ": its meshes have none" : "";
  const std::string none = fmt::format(": none of the file's {} meshes is shown: ", meshes);
  if (doc.nodes.empty()) return none + "it has no nodes";
  if (std::ranges::any_of(doc.nodes, [](const Node& n) { return n.mesh >= 0 && !n.visible; }))
    return none + "its nodes are invisible";
  if (!model.scenes.empty() && model.scenes[scene].nodes.empty())
    return none + fmt::format("scenes[{}] lists no nodes", scene);
  return none + (model.scenes.empty() ? "no node names one" : fmt::format("no node of scenes[{}] names one", scene));
}

struct Counts {
  uint64_t nonFinite = 0, degenerate = 0, zeroNormals = 0;
};

/// Which triangles survive their transform, and the bounds of those.
void measure(const Document& doc, Placed& placed, std::vector<glm::dvec3>& world, glm::dvec3& lo, glm::dvec3& hi,
             Counts& counts) {
  worldPositions(doc, placed, world);
  const auto& indices = placed.primitive->indices;
  const size_t triangles = indices.size() / 3;
  const auto leaveOut = [&](size_t t) {
    if (placed.keep.empty()) placed.keep.assign(triangles, true);
    placed.keep[t] = false;
  };
  for (size_t t = 0; t < triangles; ++t) {
    const glm::dvec3 &a = world[indices[3 * t]], &b = world[indices[3 * t + 1]], &c = world[indices[3 * t + 2]];
    if (!usable(a) || !usable(b) || !usable(c)) {
      ++counts.nonFinite;
      leaveOut(t);
    } else if (zeroArea(a, b, c)) {
      ++counts.degenerate;
      leaveOut(t);
    } else {
      lo = glm::min(lo, glm::min(a, glm::min(b, c)));
      hi = glm::max(hi, glm::max(a, glm::max(b, c)));
      ++placed.kept;
    }
  }
}

/// det(M) M^-T, which exists for singular M too.
glm::dmat3 cofactor(const glm::dmat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

void append(const Document& doc, const Placed& placed, Scene& scene) {
  const Primitive& p = *placed.primitive;
  const uint32_t base = static_cast<uint32_t>(scene.positions.size());
  bool mirrored = false;
  for (size_t i = 0; i < p.positions.size(); ++i) {
    const glm::dmat4 m = vertexTransform(doc, placed, i);
    const glm::dmat3 linear(m), normalMatrix = cofactor(linear);
    const double side = glm::determinant(linear) < 0.0 ? -1.0 : 1.0;
    if (i == 0) mirrored = side < 0.0;
    const glm::dvec3 normal = normalMatrix * glm::dvec3(p.normals[i]) * side;
    const double normalLength = glm::length(normal);
    const glm::vec3 n =
        normalLength > 0.0 && std::isfinite(normalLength) ? glm::vec3(normal / normalLength) : p.normals[i];
    const glm::dvec3 t = linear * glm::dvec3(p.tangents[i]), flat = t - glm::dvec3(n) * glm::dot(glm::dvec3(n), t);
    const double length = glm::length(flat);
    const glm::vec4 tangent = length > 0.0 && std::isfinite(length)
                                  ? glm::vec4(glm::vec3(flat / length), p.tangents[i].w * static_cast<float>(side))
                                  : anyTangent(n);
    // A vertex of dropped triangles only may be anywhere: it still has to be finite.
    const glm::dvec3 world(m * glm::dvec4(glm::dvec3(p.positions[i]), 1.0));
    scene.positions.push_back(localPosition(world, scene.origin));
    scene.world.push_back(usable(world) ? world : glm::dvec3(std::numeric_limits<double>::quiet_NaN()));
    scene.normals.push_back(n);
    scene.tangents.push_back(tangent);
    scene.uv0.push_back(p.uv0[i]);
    scene.uv1.push_back(p.uv1[i]);
    scene.colors.push_back(p.colors[i]);
  }
  for (size_t t = 0; t < p.indices.size() / 3; ++t) {
    if (!placed.keep.empty() && !placed.keep[t]) continue;
    scene.indices.push_back(base + p.indices[3 * t]);
    scene.indices.push_back(base + p.indices[3 * t + (mirrored ? 2 : 1)]);
    scene.indices.push_back(base + p.indices[3 * t + (mirrored ? 1 : 2)]);
  }
}

}  // namespace

void assemble(Document& doc, const std::vector<Instance>& instances, Scene& scene) {
  // Each mesh is read once per set of morph weights.
  using Key = std::pair<int, std::vector<double>>;
  std::map<Key, std::vector<std::unique_ptr<Primitive>>> meshes;
  std::map<int, std::vector<glm::dmat4>> joints;
  std::vector<Placed> placed;
  placed.reserve(instances.size());
  Counts counts;
  uint64_t triangles = 0;
  for (const Instance& instance : instances) {
    const tinygltf::Mesh& mesh = doc.model.meshes[static_cast<size_t>(instance.mesh)];
    const Node& node = doc.nodes[static_cast<size_t>(instance.node)];
    const std::vector<double>& weights = node.weights.empty() ? mesh.weights : node.weights;
    auto [entry, isNew] = meshes.try_emplace(Key(instance.mesh, weights));
    if (isNew) {
      for (uint32_t p = 0; p < mesh.primitives.size(); ++p) {
        auto primitive = std::make_unique<Primitive>();
        if (!mesh.primitives[p].targets.empty())
          doc.warn("morph targets are applied with the file's default weights; they are not animated");
        if (loadPrimitive(doc, mesh, static_cast<uint32_t>(instance.mesh), p, weights, scene, *primitive))
          entry->second.push_back(std::move(primitive));
      }
    }
    for (const auto& primitive : entry->second) {
      Placed place{primitive.get(), &instance, nullptr, {}, 0};
      if (instance.skin >= 0 && primitive->influences > 0) {
        doc.warn("skins are shown in their rest pose; they are not animated");
        if (!joints.contains(instance.skin)) joints[instance.skin] = jointMatrices(doc, instance.skin);
        place.joints = &joints[instance.skin];
      }
      counts.nonFinite += primitive->nonFinite, counts.degenerate += primitive->degenerate,
          counts.zeroNormals += primitive->zeroNormals;
      triangles += primitive->indices.size() / 3;
      if (triangles > kMaxTriangles)
        doc.fail("meshes", fmt::format("more than {} triangles with all instances", kMaxTriangles));
      doc.take(3 * sizeof(Placed) + primitive->indices.size() / 24, "meshes");
      placed.push_back(std::move(place));
    }
  }

  glm::dvec3 lo(std::numeric_limits<double>::infinity()), hi(-lo);
  std::vector<glm::dvec3> world;
  for (Placed& place : placed) measure(doc, place, world, lo, hi, counts);
  if (counts.nonFinite > 0)
    doc.warn(fmt::format("{} triangles with non-finite or unusably large vertex data are left out", counts.nonFinite));
  if (counts.degenerate > 0) doc.warn(fmt::format("{} triangles without area are left out", counts.degenerate));
  if (counts.zeroNormals > 0)
    doc.warn(fmt::format("{} normals of length 0 are replaced by those of the faces", counts.zeroNormals));
  std::erase_if(placed, [](const Placed& p) { return p.kept == 0; });
  if (placed.empty()) {
    doc.warn("the scene has no triangles" + whyNone(doc, instances, triangles));
    return;
  }
  scene.origin = 0.5 * (lo + hi);

  // Count, allocate once, then fill in material order (stable: file order within a material).
  std::ranges::stable_sort(placed, {}, [](const Placed& p) { return p.primitive->material; });
  uint64_t vertexCount = 0, indexCount = 0;
  for (const Placed& place : placed) vertexCount += place.primitive->positions.size(), indexCount += place.kept * 3;
  doc.take(vertexCount * 96 + indexCount * 4, "meshes");
  scene.positions.reserve(vertexCount), scene.normals.reserve(vertexCount), scene.tangents.reserve(vertexCount);
  scene.uv0.reserve(vertexCount), scene.uv1.reserve(vertexCount), scene.colors.reserve(vertexCount);
  scene.world.reserve(vertexCount), scene.indices.reserve(indexCount);
  for (const Placed& place : placed) {
    const uint32_t first = static_cast<uint32_t>(scene.indices.size());
    const uint32_t firstVertex = static_cast<uint32_t>(scene.positions.size());
    append(doc, place, scene);
    const uint32_t added = static_cast<uint32_t>(scene.indices.size()) - first;
    const uint32_t vertices = static_cast<uint32_t>(scene.positions.size()) - firstVertex;
    const bool newDraw = scene.draws.empty() || scene.draws.back().material != place.primitive->material;
    const uint32_t node = place.instance->sceneNode;
    if (newDraw || scene.pieces.back().node != node)
      scene.pieces.push_back({node, firstVertex, vertices, first, added});
    else
      scene.pieces.back().vertexCount += vertices, scene.pieces.back().indexCount += added;
    if (newDraw) {
      scene.draws.push_back({place.primitive->material, first, added});
    } else {
      scene.draws.back().indexCount += added;
    }
  }
  scene.boundsMin = glm::vec3(lo - scene.origin);
  scene.boundsMax = glm::vec3(hi - scene.origin);
  measureNodes(scene);
}

}  // namespace irad::gltf
