// The nodes of a scene's file that have meshes: their names, whose triangle is whose, and hiding them. A path is the
// names from a root on, with / between them; a / or \ that belongs to a name has a \ before it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "renderer/scene/scene.h"

namespace irad {

/// "house/table/leg 2".
std::string nodePath(std::span<const SceneNode> nodes, uint32_t node);

/// Finds nodes. The nodes must outlive it.
class NodeNames {
 public:
  explicit NodeNames(std::span<const SceneNode> nodes);
  std::optional<uint32_t> find(std::string_view path) const;
  /// All that have this name, wherever they are.
  std::vector<uint32_t> named(std::string_view name) const;

 private:
  std::span<const SceneNode> nodes_;
  std::vector<std::pair<uint64_t, uint32_t>> sorted_;  ///< by a hash of parent and name: nodes
};

/// With paths in the place of what is no path, but a name: of all nodes that have it.
HiddenNodes hiddenPaths(std::span<const SceneNode> nodes, const HiddenNodes& hidden);
/// Of each node whether it is shown. Names that no node has hide nothing.
std::vector<bool> shownNodes(std::span<const SceneNode> nodes, const HiddenNodes& hidden);
/// In words, each of `hidden` that no node has.
std::vector<std::string> unknownNodes(std::span<const SceneNode> nodes, const HiddenNodes& hidden);

/// Hides these in place of those that are hidden: the geometry is that of a file without them, bit for bit. Lights and
/// cameras under them stay, and so do the camera and the sun that the file as a whole has called for.
void hideNodes(Scene& scene, HiddenNodes hidden);

/// The node of a triangle of the geometry; none where the scene has no nodes.
std::optional<uint32_t> nodeOf(const Geometry& geometry, uint32_t triangle);
/// The triangles of a node and all under it: a range of indices in each draw that has some.
std::vector<Draw> drawsOf(const Geometry& geometry, std::span<const SceneNode> nodes, uint32_t node);

// ---- For readers of scenes ----

/// fp32 relative to the origin; 0 where a vertex is of no use.
glm::vec3 localPosition(const glm::dvec3& world, const glm::dvec3& origin);
/// Fills in what nodes say of their triangles. Nothing is hidden yet.
void measureNodes(Scene& scene);

}  // namespace irad
