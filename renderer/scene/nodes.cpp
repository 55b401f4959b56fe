#include "renderer/scene/nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "renderer/base/error.h"
#include "renderer/base/near_match.h"

namespace irad {
namespace {

constexpr size_t kMostSuggested = 5000;  ///< nodes whose names are compared with a misspelt one

uint64_t nameKey(uint32_t parent, std::string_view name) {
  return std::hash<std::string_view>()(name) * 0x9e3779b97f4a7c15ull + parent;
}

/// The names in a path; none where a \ stands before anything else than / or \.
std::vector<std::string> namesIn(std::string_view path) {
  std::vector<std::string> names(1);
  for (size_t i = 0; i < path.size(); ++i) {
    if (path[i] == '/') {
      names.emplace_back();
      continue;
    }
    if (path[i] == '\\' && (++i == path.size() || (path[i] != '/' && path[i] != '\\'))) return {};
    names.back() += path[i];
  }
  return names;
}

struct DoubleBounds {
  glm::dvec3 lo{std::numeric_limits<double>::infinity()}, hi{-std::numeric_limits<double>::infinity()};
  void add(const glm::dvec3& p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
};

DoubleBounds boundsOf(const Geometry& geometry, const Piece& piece) {
  DoubleBounds bounds;
  for (uint32_t i = piece.firstIndex; i < piece.firstIndex + piece.indexCount; ++i)
    bounds.add(geometry.world[geometry.indices[i]]);
  return bounds;
}

template <class T>
void appendRange(std::vector<T>& to, const std::vector<T>& from, const Piece& piece) {
  const auto first = from.begin() + piece.firstVertex;
  to.insert(to.end(), first, first + piece.vertexCount);
}

/// The pieces of shown nodes, as gltf_assemble would have put them together.
Geometry shownPart(const Geometry& whole, const std::vector<bool>& shown) {
  Geometry part;
  DoubleBounds bounds;
  size_t vertices = 0, indices = 0;
  for (const Piece& piece : whole.pieces) {
    if (!shown[piece.node]) continue;
    const DoubleBounds its = boundsOf(whole, piece);
    bounds.add(its.lo), bounds.add(its.hi);
    vertices += piece.vertexCount, indices += piece.indexCount;
  }
  if (indices == 0) return part;
  part.origin = 0.5 * (bounds.lo + bounds.hi);
  part.boundsMin = glm::vec3(bounds.lo - part.origin);
  part.boundsMax = glm::vec3(bounds.hi - part.origin);
  part.positions.reserve(vertices), part.normals.reserve(vertices), part.tangents.reserve(vertices);
  part.uv0.reserve(vertices), part.uv1.reserve(vertices), part.colors.reserve(vertices);
  part.world.reserve(vertices), part.indices.reserve(indices);
  size_t draw = 0;
  for (const Piece& piece : whole.pieces) {
    while (piece.firstIndex >= whole.draws[draw].firstIndex + whole.draws[draw].indexCount) ++draw;
    if (!shown[piece.node]) continue;
    const Piece now{piece.node, static_cast<uint32_t>(part.positions.size()), piece.vertexCount,
                    static_cast<uint32_t>(part.indices.size()), piece.indexCount};
    appendRange(part.normals, whole.normals, piece);
    appendRange(part.tangents, whole.tangents, piece);
    appendRange(part.uv0, whole.uv0, piece);
    appendRange(part.uv1, whole.uv1, piece);
    appendRange(part.colors, whole.colors, piece);
    appendRange(part.world, whole.world, piece);
    for (uint32_t i = 0; i < piece.vertexCount; ++i)
      part.positions.push_back(localPosition(whole.world[piece.firstVertex + i], part.origin));
    for (uint32_t i = 0; i < piece.indexCount; ++i)
      part.indices.push_back(whole.indices[piece.firstIndex + i] - piece.firstVertex + now.firstVertex);
    const uint32_t material = whole.draws[draw].material;
    if (part.draws.empty() || part.draws.back().material != material)
      part.draws.push_back({material, now.firstIndex, piece.indexCount});
    else
      part.draws.back().indexCount += piece.indexCount;
    part.pieces.push_back(now);
  }
  return part;
}

}  // namespace

glm::vec3 localPosition(const glm::dvec3& world, const glm::dvec3& origin) {
  const bool usable =
      std::abs(world.x) < kMaxCoordinate && std::abs(world.y) < kMaxCoordinate && std::abs(world.z) < kMaxCoordinate;
  return usable ? glm::vec3(world - origin) : glm::vec3(0.0f);
}

std::string nodePath(std::span<const SceneNode> nodes, uint32_t node) {
  std::vector<uint32_t> way;
  for (uint32_t at = node; at != SceneNode::kNoParent; at = nodes[at].parent) way.push_back(at);
  std::string path;
  for (auto at = way.rbegin(); at != way.rend(); ++at) {
    if (at != way.rbegin()) path += '/';
    for (const char c : nodes[*at].name) {
      if (c == '/' || c == '\\') path += '\\';
      path += c;
    }
  }
  return path;
}

NodeNames::NodeNames(std::span<const SceneNode> nodes) : nodes_(nodes) {
  sorted_.reserve(nodes.size());
  for (uint32_t i = 0; i < nodes.size(); ++i) sorted_.emplace_back(nameKey(nodes[i].parent, nodes[i].name), i);
  std::ranges::sort(sorted_);
}

std::optional<uint32_t> NodeNames::find(std::string_view path) const {
  uint32_t at = SceneNode::kNoParent;
  for (const std::string& name : namesIn(path)) {
    const uint64_t key = nameKey(at, name);
    auto entry = std::ranges::lower_bound(sorted_, std::pair(key, 0u));
    const auto is = [&](uint32_t node) { return nodes_[node].parent == at && nodes_[node].name == name; };
    while (entry != sorted_.end() && entry->first == key && !is(entry->second)) ++entry;
    if (entry == sorted_.end() || entry->first != key) return std::nullopt;
    at = entry->second;
  }
  return at != SceneNode::kNoParent ? std::optional(at) : std::nullopt;
}

std::vector<uint32_t> NodeNames::named(std::string_view name) const {
  std::vector<uint32_t> found;
  for (uint32_t i = 0; i < nodes_.size(); ++i)
    if (nodes_[i].name == name) found.push_back(i);
  return found;
}

HiddenNodes hiddenPaths(std::span<const SceneNode> nodes, const HiddenNodes& hidden) {
  if (hidden.empty()) return hidden;
  const NodeNames names(nodes);
  HiddenNodes out;
  const auto add = [&](const std::string& wanted, auto&& take) {
    const std::vector<uint32_t> same = names.find(wanted) ? std::vector<uint32_t>() : names.named(wanted);
    for (const uint32_t node : same) take(nodePath(nodes, node));
    if (same.empty()) take(wanted);
  };
  for (const std::string& wanted : hidden.paths)
    add(wanted, [&](std::string path) { out.paths.push_back(std::move(path)); });
  std::ranges::sort(out.paths);
  out.paths.erase(std::unique(out.paths.begin(), out.paths.end()), out.paths.end());
  // Of several with that name the first.
  if (!hidden.isolated.empty())
    add(hidden.isolated, [&](std::string path) {
      if (out.isolated.empty()) out.isolated = std::move(path);
    });
  return out;
}

std::vector<bool> shownNodes(std::span<const SceneNode> nodes, const HiddenNodes& hidden) {
  if (hidden.empty()) return std::vector<bool>(nodes.size(), true);
  const NodeNames names(nodes);
  // How many hidden nodes each is under: their beginnings less their ends, so that nested ones cost no more.
  std::vector<int64_t> begins(nodes.size() + 1, 0);
  for (const std::string& path : hidden.paths)
    if (const auto node = names.find(path)) ++begins[*node], --begins[nodes[*node].end];
  size_t first = 0, end = nodes.size();
  if (!hidden.isolated.empty())
    if (const auto only = names.find(hidden.isolated)) first = *only, end = nodes[*only].end;
  std::vector<bool> shown(nodes.size());
  int64_t depth = 0;
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    depth += begins[i];
    shown[i] = depth == 0 && i >= first && i < end;
  }
  return shown;
}

std::vector<std::string> unknownNodes(std::span<const SceneNode> nodes, const HiddenNodes& hidden) {
  std::vector<std::string> unknown;
  if (hidden.empty()) return unknown;
  const NodeNames names(nodes);
  std::vector<std::string> known;
  const auto check = [&](const std::string& path) {
    if (names.find(path)) return;
    if (known.empty() && nodes.size() <= kMostSuggested)
      for (uint32_t i = 0; i < nodes.size(); ++i) known.push_back(nodePath(nodes, i));
    unknown.push_back(fmt::format("no node \"{}\" to hide{}", path, known.empty() ? "" : suggestion(path, known)));
  };
  for (const std::string& path : hidden.paths) check(path);
  if (!hidden.isolated.empty()) check(hidden.isolated);
  return unknown;
}

void hideNodes(Scene& scene, HiddenNodes hidden) {
  const std::vector<bool> shown = shownNodes(scene.nodes, hidden);
  scene.hidden = std::move(hidden);
  Geometry& now = scene;
  const bool all = std::ranges::find(shown, false) == shown.end();
  if (all) {
    if (scene.whole) now = *std::exchange(scene.whole, nullptr);
    return;
  }
  if (!scene.whole) scene.whole = std::make_shared<const Geometry>(std::move(now));
  now = shownPart(*scene.whole, shown);
}

std::optional<uint32_t> nodeOf(const Geometry& geometry, uint32_t triangle) {
  const auto after = std::ranges::upper_bound(geometry.pieces, 3 * triangle, {}, &Piece::firstIndex);
  return after != geometry.pieces.begin() ? std::optional(std::prev(after)->node) : std::nullopt;
}

std::vector<Draw> drawsOf(const Geometry& geometry, std::span<const SceneNode> nodes, uint32_t node) {
  std::vector<Draw> draws;
  for (const Draw& draw : geometry.draws) {
    const auto first = std::ranges::lower_bound(geometry.pieces, draw.firstIndex, {}, &Piece::firstIndex);
    const auto last = std::lower_bound(first, geometry.pieces.end(), draw.firstIndex + draw.indexCount,
                                       [](const Piece& piece, uint32_t index) { return piece.firstIndex < index; });
    const auto before = [](const Piece& piece, uint32_t n) { return piece.node < n; };
    const auto begin = std::lower_bound(first, last, node, before);
    const auto end = std::lower_bound(begin, last, nodes[node].end, before);
    if (begin == end) continue;
    const Piece& back = *std::prev(end);
    draws.push_back({draw.material, begin->firstIndex, back.firstIndex + back.indexCount - begin->firstIndex});
  }
  return draws;
}

void measureNodes(Scene& scene) {
  std::vector<DoubleBounds> bounds(scene.nodes.size());
  for (SceneNode& node : scene.nodes) node.triangles = 0;
  for (const Piece& piece : scene.pieces) {
    const DoubleBounds its = boundsOf(scene, piece);
    bounds[piece.node].add(its.lo), bounds[piece.node].add(its.hi);
    scene.nodes[piece.node].triangles += piece.indexCount / 3;
  }
  for (size_t i = scene.nodes.size(); i-- > 0;) {
    SceneNode& node = scene.nodes[i];
    if (node.triangles > 0) node.boundsMin = bounds[i].lo, node.boundsMax = bounds[i].hi;
    if (node.parent == SceneNode::kNoParent || node.triangles == 0) continue;
    bounds[node.parent].add(bounds[i].lo), bounds[node.parent].add(bounds[i].hi);
    scene.nodes[node.parent].triangles += node.triangles;
  }
}

}  // namespace irad
