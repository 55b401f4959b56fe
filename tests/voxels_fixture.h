// For suites of the thesis's voxels: a scene voxelized and compacted to plane facets, read back one by one.
#pragma once

#include <algorithm>
#include <cmath>
#include <tuple>

#include "gi/facets.h"
#include "gi/settings.h"
#include "gi/voxelize.h"
#include "renderer/gpu_scene.h"
#include "shaders/shared/normals.h"
#include "tests/soup.h"
#include "tests/support.h"

namespace irad::test {

struct Facet {
  glm::uvec3 voxel;
  uint32_t shape;
  glm::uvec2 albedo;
  glm::vec3 emission{0};
  glm::vec3 normal() const { return decodeNormal(shape & 0xFFFFu, NORMALS_OCT16); }
  auto key() const {
    return std::make_tuple(voxel.z, voxel.y, voxel.x, shape, albedo.x, albedo.y, emission.x, emission.y, emission.z);
  }
  bool operator==(const Facet& o) const { return key() == o.key(); }
};

class VoxelsTest : public GpuTest {
 protected:
  struct Result {
    Grid grid;
    std::vector<uint32_t> keys;
    std::vector<bool> solid;
    std::vector<Facet> facets;
    uint32_t clamped = 0;
    uint32_t count(glm::uvec3 voxel) const {
      return static_cast<uint32_t>(
          std::count_if(facets.begin(), facets.end(), [&](const Facet& f) { return f.voxel == voxel; }));
    }
    uint32_t solidCount() const { return static_cast<uint32_t>(std::count(solid.begin(), solid.end(), true)); }
  };
  Settings with(uint32_t resolution, VoxelMethod method = VoxelMethod::conservative) {
    Settings settings;
    settings.voxel.resolution = resolution;
    settings.voxel.method = method;
    return settings;
  }
  Result run(const Scene& scene, const Settings& settings) {
    const SceneOnDevice device(context(), scene);
    Voxels voxels = voxelize(context(), device, settings);
    Result result;
    result.grid = voxels.grid;
    result.keys = downloadAs<uint32_t>(context(), voxels.keys);
    result.solid.resize(result.grid.voxels);
    for (uint32_t i = 0; i < result.grid.voxels; ++i) result.solid[i] = result.keys[i] != 0;
    const FacetList list = compactFacets(context(), voxels, settings);
    result.clamped = list.clampedAlbedo;
    const auto voxel = downloadAs<uint32_t>(context(), list.voxel), shape = downloadAs<uint32_t>(context(), list.shape);
    const auto albedo = downloadAs<glm::uvec2>(context(), list.albedo);
    const auto emission = list.hasEmission ? downloadAs<glm::vec3>(context(), list.emission)
                                           : std::vector<glm::vec3>(list.count, glm::vec3(0));
    for (uint32_t i = 0; i < list.count; ++i)
      result.facets.push_back({unpackVoxel(voxel[i]), shape[i], albedo[i], emission[i]});
    return result;
  }
};

/// A rotation by 31 degrees about (1, 2, 3).
inline glm::vec3 tilted(glm::vec3 p) {
  const glm::vec3 axis = glm::normalize(glm::vec3(1, 2, 3));
  const float angle = glm::radians(31.0f);
  return p * std::cos(angle) + glm::cross(axis, p) * std::sin(angle) + axis * glm::dot(axis, p) * (1 - std::cos(angle));
}
inline Scene tiltedBox(bool inwards) {
  Soup soup;
  soup.box(soup.diffuse(glm::vec3(0.5f)), tilted({-1, -0.8f, -0.6f}), tilted({2, 0, 0}), tilted({0, 1.6f, 0}),
           tilted({0, 0, 1.2f}), inwards);
  return soup.build();
}

}  // namespace irad::test
