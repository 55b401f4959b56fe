// For suites of the GI stages: a scene voxelized with its field, and the matrix read back row by row.
#pragma once

#include <fmt/format.h>

#include <bit>
#include <memory>

#include "gi/check/scenes.h"
#include "gi/facets.h"
#include "gi/field.h"
#include "gi/host_matrix.h"
#include "gi/settings.h"
#include "renderer/gpu_scene.h"
#include "shaders/shared/normals.h"
#include "tests/support.h"

namespace irad::test {

/// A scene up to its field.
struct World {
  std::unique_ptr<Scene> scene;
  std::unique_ptr<SceneOnDevice> device;
  Settings settings;
  FacetList facets;
  Field field;
};

class GiTest : public GpuTest {
 protected:
  static Settings defaults() { return defaultSettings(/*cpuDevice=*/true); }
  World world(Scene scene, const Settings& settings = defaults()) {
    World w;
    w.settings = settings;
    w.scene = std::make_unique<Scene>(std::move(scene));
    w.device = std::make_unique<SceneOnDevice>(context(), *w.scene);
    w.facets = makeFacets(context(), *w.device, settings);
    w.field = buildField(context(), w.facets, settings);
    return w;
  }
  static Settings at(uint32_t resolution, uint32_t rays) {
    Settings s = defaults();
    s.voxel.resolution = resolution;
    s.matrix.gpu.rays = rays;
    return s;
  }
};

}  // namespace irad::test
