// Tangents in the manner of MikkTSpace (Mikkelsen 2008): the derivative of position along u per triangle, projected
// onto the plane of the vertex normal, averaged by angle over the triangles that share position, normal, uv and
// handedness. glTF's v points down and its normal maps' green up, so the bitangent is -dP/dv = w cross(normal,
// tangent).
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "renderer/scene/gltf_document.h"

namespace irad {
namespace {

struct WeldKey {
  std::array<float, 8> values;
  bool operator==(const WeldKey& other) const {
    return std::memcmp(values.data(), other.values.data(), sizeof values) == 0;
  }
};
struct WeldHash {
  size_t operator()(const WeldKey& key) const {
    uint64_t hash = 1469598103934665603ull;  // FNV-1a over words
    for (const float value : key.values) {
      uint32_t bits;
      std::memcpy(&bits, &value, 4);
      hash = (hash ^ bits) * 1099511628211ull;
      hash ^= hash >> 29;
    }
    return hash;
  }
};

/// Vertices that agree in position, normal and uv share a group, whatever the file's indexing.
std::vector<uint32_t> weld(const gltf::Primitive& p, const std::vector<glm::vec2>& uv, uint32_t& groupCount) {
  std::unordered_map<WeldKey, uint32_t, WeldHash> groups;
  groups.reserve(p.positions.size());
  std::vector<uint32_t> group(p.positions.size());
  for (size_t i = 0; i < group.size(); ++i) {
    const glm::vec3 &a = p.positions[i], &n = p.normals[i];
    const WeldKey key{
        {a.x + 0.0f, a.y + 0.0f, a.z + 0.0f, n.x + 0.0f, n.y + 0.0f, n.z + 0.0f, uv[i].x + 0.0f, uv[i].y + 0.0f}};
    group[i] = groups.try_emplace(key, static_cast<uint32_t>(groups.size())).first->second;
  }
  groupCount = static_cast<uint32_t>(groups.size());
  return group;
}

double cornerAngle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 u = b - a, v = c - a;
  return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

}  // namespace

glm::vec4 anyTangent(const glm::vec3& n) {
  const glm::vec3 axis = std::abs(n.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  return glm::vec4(glm::normalize(axis - n * glm::dot(n, axis)), 1.0f);
}

void generateTangents(gltf::Primitive& p, const std::vector<glm::vec2>& uv) {
  uint32_t groupCount = 0;
  const std::vector<uint32_t> group = weld(p, uv, groupCount);
  // Sums per group and handedness: [2 g] for w = +1, [2 g + 1] for w = -1.
  std::vector<glm::dvec3> sum(size_t{groupCount} * 2, glm::dvec3(0.0));
  const size_t triangles = p.indices.size() / 3;
  std::vector<int8_t> sign(triangles, 0);
  for (size_t t = 0; t < triangles; ++t) {
    const uint32_t* v = &p.indices[t * 3];
    const glm::dvec3 a(p.positions[v[0]]), e1 = glm::dvec3(p.positions[v[1]]) - a,
                                           e2 = glm::dvec3(p.positions[v[2]]) - a;
    const glm::dvec2 d1 = glm::dvec2(uv[v[1]]) - glm::dvec2(uv[v[0]]), d2 = glm::dvec2(uv[v[2]]) - glm::dvec2(uv[v[0]]);
    const double area = d1.x * d2.y - d1.y * d2.x;
    if (area == 0.0 || !std::isfinite(area)) continue;  // takes its neighbours' tangent, or any
    const double facing = area > 0.0 ? 1.0 : -1.0;
    const glm::dvec3 dPdu = facing * (e1 * d2.y - e2 * d1.y);
    // Seen from the front, u x (-v) is counter-clockwise where the uv area (v down) is negative.
    sign[t] = area > 0.0 ? -1 : 1;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t vertex = v[k];
      const glm::dvec3 n(p.normals[vertex]);
      const glm::dvec3 flat = dPdu - n * glm::dot(n, dPdu);
      const double length = glm::length(flat);
      if (!(length > 0.0) || !std::isfinite(length)) continue;
      const double angle = cornerAngle(p.positions[vertex], p.positions[v[(k + 1) % 3]], p.positions[v[(k + 2) % 3]]);
      sum[size_t{group[vertex]} * 2 + (sign[t] < 0)] += flat / length * angle;
    }
  }
  // Give every corner its handedness; a vertex used with both is split.
  constexpr uint32_t kNone = 0xFFFFFFFFu;
  const uint32_t original = static_cast<uint32_t>(p.positions.size());
  std::vector<int8_t> used(original, 0);
  std::vector<uint32_t> twin(original, kNone);
  const auto duplicate = [&](auto& values, uint32_t vertex, uint32_t perVertex) {
    if (values.empty()) return;
    for (uint32_t c = 0; c < perVertex; ++c) {
      const auto copy = values[size_t{vertex} * perVertex + c];
      values.push_back(copy);
    }
  };
  for (size_t t = 0; t < triangles; ++t) {
    for (size_t k = 0; k < 3 && sign[t] != 0; ++k) {
      uint32_t& corner = p.indices[t * 3 + k];
      const uint32_t vertex = corner;
      if (used[vertex] == 0) used[vertex] = sign[t];
      if (used[vertex] == sign[t]) continue;
      if (twin[vertex] == kNone) {
        twin[vertex] = static_cast<uint32_t>(p.positions.size());
        duplicate(p.positions, vertex, 1), duplicate(p.normals, vertex, 1), duplicate(p.uv0, vertex, 1);
        duplicate(p.uv1, vertex, 1), duplicate(p.colors, vertex, 1);
        duplicate(p.joints, vertex, p.influences), duplicate(p.weights, vertex, p.influences);
      }
      corner = twin[vertex];
    }
  }
  p.tangents.assign(p.positions.size(), glm::vec4(0.0f));
  const auto assign = [&](uint32_t to, uint32_t vertex, int8_t handedness) {
    const glm::dvec3 tangent = sum[size_t{group[vertex]} * 2 + (handedness < 0)];
    const double length = glm::length(tangent);
    p.tangents[to] = length > 1e-12 ? glm::vec4(glm::vec3(tangent / length), handedness < 0 ? -1.0f : 1.0f)
                                    : anyTangent(p.normals[to]);
  };
  for (uint32_t i = 0; i < original; ++i) {
    const int8_t own = used[i] != 0                                       ? used[i]
                       : glm::length(sum[size_t{group[i]} * 2 + 1]) > 0.0 ? int8_t{-1}
                                                                          : int8_t{1};
    assign(i, i, own);
    if (twin[i] != kNone) assign(twin[i], i, static_cast<int8_t>(-own));
  }
}

}  // namespace irad
