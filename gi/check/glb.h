// Check scenes through the loader: written as .glb, loaded, removed.
#pragma once

#include <filesystem>
#include <vector>

#include "renderer/scene/scene.h"

namespace irad {

/// A node that draws the scene's mesh, as glTF places it: scaled, then moved.
struct MeshNode {
  glm::dvec3 translation{0}, scale{1};
};

/// Writes a .glb: positions and normals as they are (they may be anything), untextured materials, lights and cameras.
/// The mesh is drawn by every one of `nodes`; those, lights and cameras hang from a root that lies at `offset`.
/// WorkError where the file cannot be written.
void writeGlb(const std::filesystem::path& file, const Scene& scene, glm::dvec3 offset = glm::dvec3(0),
              const std::vector<MeshNode>& nodes = {{}});
/// What loadScene makes of such a file. Throws as both do.
Scene throughLoader(const Scene& scene, glm::dvec3 offset = glm::dvec3(0), const std::vector<MeshNode>& nodes = {{}});

}  // namespace irad
