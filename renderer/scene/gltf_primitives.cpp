// One primitive in mesh space: attributes read, made a triangle list, morphed to its default weights, cleaned of what
// cannot be rendered, and completed with normals and tangents.
#include <cmath>

#include "renderer/scene/gltf_document.h"

namespace irad::gltf {
namespace {

/// The vertex attributes of a primitive, wherever they come from (accessor or Draco).
class AttributeReader {
 public:
  AttributeReader(Document& doc, const tinygltf::Primitive& primitive, std::string where)
      : doc_(doc), primitive_(primitive), where_(std::move(where)) {
    if (primitive.extensions.contains("KHR_draco_mesh_compression")) {
      draco_ = decodeDraco(doc, primitive, where_);
      packed_ = true;
    }
  }
  bool has(const std::string& name) const { return primitive_.attributes.contains(name); }
  bool packed() const { return packed_; }
  const std::vector<uint32_t>& packedIndices() const { return draco_.indices; }

  Elements read(const std::string& name, uint32_t components) {
    const std::string what = where_ + ".attributes." + name;
    if (const auto found = draco_.attributes.find(name); found != draco_.attributes.end()) {
      if (components != 0 && found->second.components != components)
        doc_.fail(what, fmt::format("has {} components, not {}", found->second.components, components));
      return found->second;
    }
    return readFloats(doc_, primitive_.attributes.at(name), components, what);
  }

  template <class Vector>
  std::vector<Vector> vectors(const std::string& name, uint32_t vertexCount) {
    if (!has(name)) return {};
    return toVectors<Vector>(read(name, Vector::length()), vertexCount, where_ + ".attributes." + name);
  }

  template <class Vector>
  std::vector<Vector> toVectors(const Elements& e, uint32_t vertexCount, const std::string& what) {
    if (e.count != vertexCount) doc_.fail(what, fmt::format("has {} elements for {} vertices", e.count, vertexCount));
    std::vector<Vector> out(e.count);
    for (size_t i = 0; i < out.size(); ++i)
      for (int c = 0; c < Vector::length(); ++c) out[i][c] = e.values[i * e.components + static_cast<size_t>(c)];
    return out;
  }

 private:
  Document& doc_;
  const tinygltf::Primitive& primitive_;
  std::string where_;
  DracoMesh draco_;
  bool packed_ = false;
};

/// glTF 3.7.2.1: triangle lists, strips and fans as lists, with their winding.
std::vector<uint32_t> triangulate(const Document& doc, const std::vector<uint32_t>& in, int mode,
                                  const std::string& where) {
  const uint64_t triangles = mode == TINYGLTF_MODE_TRIANGLES ? in.size() / 3 : in.size() < 3 ? 0 : in.size() - 2;
  if (triangles > kMaxTriangles)
    doc.fail(where, fmt::format("{} triangles, at most {} are accepted", triangles, kMaxTriangles));
  if (mode == TINYGLTF_MODE_TRIANGLES) return {in.begin(), in.begin() + static_cast<int64_t>(in.size() / 3 * 3)};
  std::vector<uint32_t> out;
  for (size_t i = 0; i + 2 < in.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
      out.insert(out.end(), {in[i + 1], in[i + 2], in[0]});
    } else {
      out.insert(out.end(), {in[i], in[i + 1 + i % 2], in[i + 2 - i % 2]});
    }
  }
  return out;
}

std::vector<uint32_t> readIndexList(Document& doc, const tinygltf::Primitive& primitive, uint32_t vertexCount,
                                    const std::string& where) {
  std::vector<uint32_t> list;
  if (primitive.indices < 0) {
    doc.take(uint64_t{vertexCount} * 4, where);
    doc.release(uint64_t{vertexCount} * 4);
    list.resize(vertexCount);
    for (uint32_t i = 0; i < vertexCount; ++i) list[i] = i;
    return list;
  }
  list = readIntegers(doc, primitive.indices, 1, where + ".indices");
  const int type = doc.model.accessors[static_cast<size_t>(primitive.indices)].componentType;
  const uint32_t restart = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? 0xFFu
                           : type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 0xFFFFu
                                                                            : 0xFFFFFFFFu;
  for (const uint32_t index : list)
    if (index == restart) doc.fail(where + ".indices", fmt::format("holds {}, the primitive restart value", index));
  return list;
}

bool finite(const glm::vec2& v) {
  return std::isfinite(v.x) && std::isfinite(v.y);
}
bool finite(const glm::vec3& v) {
  return finite(glm::vec2(v)) && std::isfinite(v.z);
}
bool finite(const glm::vec4& v) {
  return finite(glm::vec3(v)) && std::isfinite(v.w);
}

template <class Vector>
bool finiteAt(const std::vector<Vector>& values, uint32_t i) {
  return values.empty() || finite(values[i]);
}

bool usable(const Primitive& p, uint32_t i) {
  const glm::vec3 a = glm::abs(p.positions[i]);
  return finite(p.positions[i]) && std::max({a.x, a.y, a.z}) < kMaxCoordinate && finiteAt(p.normals, i) &&
         finiteAt(p.tangents, i) && finiteAt(p.uv0, i) && finiteAt(p.uv1, i) && finiteAt(p.colors, i);
}

/// Twice the area is nothing beside the squared longest edge: corners repeat or lie on a line.
bool zeroArea(const Primitive& p, const uint32_t* t) {
  const glm::dvec3 a(p.positions[t[0]]), e1 = glm::dvec3(p.positions[t[1]]) - a, e2 = glm::dvec3(p.positions[t[2]]) - a,
                                         e3 = e2 - e1;
  const double longest = std::max({glm::dot(e1, e1), glm::dot(e2, e2), glm::dot(e3, e3)});
  return !(glm::length(glm::cross(e1, e2)) > 1e-12 * longest);
}

void dropUnusableTriangles(Primitive& p) {
  std::vector<uint32_t> kept;
  kept.reserve(p.indices.size());
  for (size_t t = 0; t < p.indices.size(); t += 3) {
    const uint32_t* corner = &p.indices[t];
    if (!usable(p, corner[0]) || !usable(p, corner[1]) || !usable(p, corner[2])) {
      ++p.nonFinite;
    } else if (zeroArea(p, corner)) {
      ++p.degenerate;
    } else {
      kept.insert(kept.end(), corner, corner + 3);
    }
  }
  p.indices = std::move(kept);
}

template <class T>
void gather(std::vector<T>& values, const std::vector<uint32_t>& from, uint32_t perVertex = 1) {
  if (values.empty()) return;
  std::vector<T> out(from.size() * perVertex);
  for (size_t i = 0; i < from.size(); ++i)
    for (uint32_t c = 0; c < perVertex; ++c) out[i * perVertex + c] = values[uint64_t{from[i]} * perVertex + c];
  values = std::move(out);
}

/// Makes vertex i of the primitive what vertex from[i] was.
void gatherVertices(Primitive& p, const std::vector<uint32_t>& from) {
  gather(p.positions, from), gather(p.normals, from), gather(p.tangents, from);
  gather(p.uv0, from), gather(p.uv1, from), gather(p.colors, from);
  gather(p.joints, from, p.influences), gather(p.weights, from, p.influences);
}

/// Drops vertices that no triangle uses, so that a dropped triangle leaves nothing behind.
void compact(Primitive& p) {
  constexpr uint32_t kUnused = 0xFFFFFFFFu;
  std::vector<uint32_t> to(p.positions.size(), kUnused), from;
  for (const uint32_t index : p.indices) to[index] = 0;
  for (uint32_t i = 0; i < to.size(); ++i)
    if (to[i] != kUnused) to[i] = static_cast<uint32_t>(from.size()), from.push_back(i);
  if (from.size() == to.size()) return;
  gatherVertices(p, from);
  for (uint32_t& index : p.indices) index = to[index];
}

/// glTF 3.7.2.1: without normals every face is flat; vertices are no longer shared.
void flatNormals(Primitive& p) {
  gatherVertices(p, std::vector<uint32_t>(p.indices));
  p.tangents.clear();  // the specification ignores tangents without normals
  p.normals.resize(p.positions.size());
  for (uint32_t i = 0; i < p.indices.size(); ++i) p.indices[i] = i;
  for (size_t t = 0; t < p.positions.size(); t += 3) {
    const glm::dvec3 a(p.positions[t]);
    const glm::dvec3 normal = glm::cross(glm::dvec3(p.positions[t + 1]) - a, glm::dvec3(p.positions[t + 2]) - a);
    for (size_t k = 0; k < 3; ++k) p.normals[t + k] = glm::vec3(glm::normalize(normal));
  }
}

/// Unit normals; a zero one becomes the area-weighted mean of the faces around its vertex.
void normalizeNormals(Primitive& p) {
  std::vector<bool> zero(p.normals.size(), false);
  for (size_t i = 0; i < p.normals.size(); ++i) {
    const glm::dvec3 n(p.normals[i]);
    const double length = glm::length(n);
    zero[i] = !(length > 1e-20);
    if (zero[i]) ++p.zeroNormals;
    p.normals[i] = zero[i] ? glm::vec3(0.0f) : glm::vec3(n / length);
  }
  if (p.zeroNormals == 0) return;
  std::vector<glm::dvec3> sum(p.normals.size(), glm::dvec3(0.0));
  std::vector<glm::dvec3> first(p.normals.size(), glm::dvec3(0.0));
  for (size_t t = 0; t < p.indices.size(); t += 3) {
    const glm::dvec3 a(p.positions[p.indices[t]]);
    const glm::dvec3 face =
        glm::cross(glm::dvec3(p.positions[p.indices[t + 1]]) - a, glm::dvec3(p.positions[p.indices[t + 2]]) - a);
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t vertex = p.indices[t + k];
      if (!zero[vertex]) continue;
      sum[vertex] += face;
      if (first[vertex] == glm::dvec3(0.0)) first[vertex] = face;
    }
  }
  for (size_t i = 0; i < zero.size(); ++i) {
    if (!zero[i]) continue;
    const bool cancelled = !(glm::length(sum[i]) > 1e-9 * glm::length(first[i]));
    p.normals[i] = glm::vec3(glm::normalize(cancelled ? first[i] : sum[i]));
  }
}

void applyMorphTargets(Document& doc, AttributeReader& reader, const tinygltf::Primitive& in,
                       const std::vector<double>& weights, const std::string& where, Primitive& out) {
  for (size_t target = 0; target < in.targets.size() && target < weights.size(); ++target) {
    const float weight = static_cast<float>(weights[target]);
    if (weight == 0.0f) continue;
    for (const auto& [name, accessor] : in.targets[target]) {
      const std::string what = fmt::format("{}.targets[{}].{}", where, target, name);
      if (name != "POSITION" && name != "NORMAL" && name != "TANGENT") continue;
      const auto deltas = reader.toVectors<glm::vec3>(readFloats(doc, accessor, 3, what),
                                                      static_cast<uint32_t>(out.positions.size()), what);
      for (size_t i = 0; i < deltas.size(); ++i) {
        if (name == "POSITION") out.positions[i] += weight * deltas[i];
        if (name == "NORMAL" && !out.normals.empty()) out.normals[i] += weight * deltas[i];
        if (name == "TANGENT" && !out.tangents.empty()) out.tangents[i] += glm::vec4(weight * deltas[i], 0.0f);
      }
    }
  }
}

void readSkin(Document& doc, AttributeReader& reader, const std::string& where, Primitive& out) {
  std::vector<std::vector<uint32_t>> joints;
  std::vector<Elements> weights;
  for (int set = 0; set < 4; ++set) {
    const std::string jointName = fmt::format("JOINTS_{}", set), weightName = fmt::format("WEIGHTS_{}", set);
    if (!reader.has(jointName) || !reader.has(weightName)) break;
    const Elements j = reader.read(jointName, 4);
    weights.push_back(reader.read(weightName, 4));
    for (const Elements* e : {&j, static_cast<const Elements*>(&weights.back())})
      if (e->count != out.positions.size())
        doc.fail(where + "." + jointName, fmt::format("{} elements for {} vertices", e->count, out.positions.size()));
    auto& list = joints.emplace_back();
    for (const float value : j.values) {
      if (!(value >= 0.0f && value < 65536.0f))
        doc.fail(where + "." + jointName, fmt::format("{} is not a joint", value));
      list.push_back(static_cast<uint32_t>(value));
    }
  }
  out.influences = static_cast<uint32_t>(4 * joints.size());
  doc.take(uint64_t{out.influences} * out.positions.size() * 8, where);
  for (size_t v = 0; v < out.positions.size() && out.influences > 0; ++v)
    for (size_t set = 0; set < joints.size(); ++set)
      for (size_t c = 0; c < 4; ++c) {
        const float weight = weights[set].values[v * 4 + c];
        out.joints.push_back(joints[set][v * 4 + c]);
        out.weights.push_back(std::isfinite(weight) ? std::max(weight, 0.0f) : 0.0f);
      }
}

std::vector<glm::vec4> readColors(Document& doc, AttributeReader& reader, uint32_t vertexCount,
                                  const std::string& where) {
  if (!reader.has("COLOR_0")) return {};
  const Elements e = reader.read("COLOR_0", 0);
  const std::string what = where + ".attributes.COLOR_0";
  if (e.components != 3 && e.components != 4) doc.fail(what, fmt::format("has {} components", e.components));
  std::vector<glm::vec4> out;
  if (e.components == 4) {
    out = reader.toVectors<glm::vec4>(e, vertexCount, what);
  } else {
    for (const glm::vec3& rgb : reader.toVectors<glm::vec3>(e, vertexCount, what)) out.emplace_back(rgb, 1.0f);
  }
  uint64_t clamped = 0;
  for (glm::vec4& color : out) {
    if (!finite(color)) continue;  // its triangles are dropped
    const glm::vec4 to = glm::clamp(color, 0.0f, 1.0f);
    clamped += to != color;
    color = to;
  }
  if (clamped > 0) doc.warn(fmt::format("{}: {} vertex colours outside 0 to 1 are clamped", where, clamped));
  return out;
}

}  // namespace

bool loadPrimitive(Document& doc, const tinygltf::Mesh& mesh, uint32_t meshIndex, uint32_t primitiveIndex,
                   const std::vector<double>& morphWeights, const Scene& scene, Primitive& out) {
  const tinygltf::Primitive& in = mesh.primitives[primitiveIndex];
  const std::string where = fmt::format("meshes[{}].primitives[{}]", meshIndex, primitiveIndex);
  const int mode = in.mode < 0 ? TINYGLTF_MODE_TRIANGLES : in.mode;
  if (mode < TINYGLTF_MODE_TRIANGLES) {
    doc.warn(where + ": points or lines have no surface and are left out");
    return false;
  }
  if (!in.attributes.contains("POSITION")) {
    doc.warn(where + ": has no positions and is left out");
    return false;
  }
  AttributeReader reader(doc, in, where);
  const Elements positions = reader.read("POSITION", 3);
  if (positions.count > 3 * kMaxTriangles)
    doc.fail(where, fmt::format("{} vertices, at most {} are accepted", positions.count, 3 * kMaxTriangles));
  doc.take(uint64_t{positions.count} * 72, where);
  out.positions = reader.toVectors<glm::vec3>(positions, positions.count, where);
  out.normals = reader.vectors<glm::vec3>("NORMAL", positions.count);
  out.tangents = reader.vectors<glm::vec4>("TANGENT", positions.count);
  out.uv0 = reader.vectors<glm::vec2>("TEXCOORD_0", positions.count);
  out.uv1 = reader.vectors<glm::vec2>("TEXCOORD_1", positions.count);
  out.colors = readColors(doc, reader, positions.count, where);
  out.material =
      in.material >= 0 ? static_cast<uint32_t>(in.material) : static_cast<uint32_t>(scene.materials.size() - 1);
  applyMorphTargets(doc, reader, in, morphWeights, where, out);
  readSkin(doc, reader, where, out);

  out.indices = triangulate(
      doc, reader.packed() ? reader.packedIndices() : readIndexList(doc, in, positions.count, where), mode, where);
  for (const uint32_t index : out.indices)
    if (index >= positions.count)
      doc.fail(where + ".indices", fmt::format("{} is past the {} vertices", index, positions.count));
  dropUnusableTriangles(out);
  compact(out);
  if (out.normals.empty()) {
    doc.take(out.indices.size() * 72, where);
    flatNormals(out);
  } else {
    normalizeNormals(out);
  }

  const TextureUse& normalMap = scene.materials[out.material].normalTexture;
  const auto& uv = normalMap.uvSet == 0 ? out.uv0 : out.uv1;
  if (out.tangents.empty() && normalMap.image >= 0) {
    if (uv.empty()) {
      doc.warn(fmt::format("{}: its normal map has no TEXCOORD_{} and is seen without detail", where, normalMap.uvSet));
    } else {
      generateTangents(out, std::vector<glm::vec2>(uv));
    }
  }
  if (out.tangents.empty())
    for (const glm::vec3& normal : out.normals) out.tangents.push_back(anyTangent(normal));
  // Unit, orthogonal to the normal, handedness +-1: what the file gives may be none of these.
  for (size_t i = 0; i < out.tangents.size(); ++i) {
    const glm::vec3 t(out.tangents[i]), flat = t - out.normals[i] * glm::dot(out.normals[i], t);
    const float length = glm::length(flat);
    out.tangents[i] =
        length > 1e-6f ? glm::vec4(flat / length, out.tangents[i].w < 0.0f ? -1.0f : 1.0f) : anyTangent(out.normals[i]);
  }
  const size_t count = out.positions.size();
  out.uv0.resize(count, glm::vec2(0.0f));
  out.uv1.resize(count, glm::vec2(0.0f));
  out.colors.resize(count, glm::vec4(1.0f));
  return !out.indices.empty() || out.nonFinite + out.degenerate > 0;
}

}  // namespace irad::gltf
