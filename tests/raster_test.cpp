// Rasterization by kernels (renderer/raster.h): against exact arithmetic, and against the graphics pipeline.
#include "renderer/raster.h"

#include <bit>
#include <random>

#include "gi/settings.h"
#include "gi/voxelize.h"
#include "renderer/depth_pass.h"
#include "renderer/instance.h"
#include "renderer/targets.h"
#include "shaders/shared/passes.h"
#include "tests/forward_support.h"

namespace irad::test::raster_suite {
namespace {

class RasterTest : public GpuTest {
 protected:
  struct Seen {
    glm::uvec2 size;
    std::vector<uint32_t> triangle;  ///< ~0u: none
    std::vector<float> depth;        ///< the target's
  };
  /// What a camera sees, by kernels.
  Seen visible(const Scene& scene, const Camera& camera, glm::uvec2 size) {
    const SceneOnDevice device(context(), scene);
    Targets targets(context(), size);
    targets.fitRaster(context(), /*kernels*/ true, scene.triangleCount());
    Frame frame = context().begin();
    rasterVisible(frame, device, cameraBuffer(scene, camera, size), /*alphaTest*/ true, targets);
    frame.submitAndWait();
    Seen seen{size, {}, depths(targets.depth)};
    for (const uint64_t word : downloadAs<uint64_t>(context(), targets.visible)) {
      seen.triangle.push_back(static_cast<uint32_t>(word));
      const float depth = std::bit_cast<float>(~static_cast<uint32_t>(word >> 32));
      const float stored = seen.depth[seen.triangle.size() - 1];
      EXPECT_EQ(stored, seen.triangle.back() == ~0u ? 0.0f : depth);
    }
    return seen;
  }
  /// The same depths by the graphics pipeline.
  std::vector<float> hardware(const Scene& scene, const Camera& camera, glm::uvec2 size) {
    const SceneOnDevice device(context(), scene);
    Targets targets(context(), size);
    const Buffer projection = cameraBuffer(scene, camera, size);
    Frame frame = context().begin();
    drawDepth(frame, device, {.stage = "RE Depth", .target = targets.depth, .projections = projection, .cull = true});
    frame.submitAndWait();
    return depths(targets.depth);
  }
  Buffer cameraBuffer(const Scene& scene, const Camera& camera, glm::uvec2 size) {
    const GpuCamera gpu = makeGpuCamera(scene, camera, size);
    return makeBuffer(context(), "camera", Subsystem::Targets, std::span<const GpuCamera>(&gpu, 1));
  }
  std::vector<float> depths(const Image& image) {
    const std::vector<std::byte> bytes = download(context(), image);
    std::vector<float> out(bytes.size() / sizeof(float));
    std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
  }

  struct Difference {
    size_t coverage = 0;  ///< pixels that are empty in one of the two
    size_t depth = 0;     ///< pixels further apart than 1e-5 of them and 1/64 of the largest step to a neighbour
    size_t drawn = 0;
  };
  /// `b`: pictures of `width` pixels, one below the other. Either interpolates depth from corners that it has snapped,
  /// or not, to 1/256 pixel: what a steep triangle makes of that is allowed for.
  static Difference difference(const std::vector<float>& a, const std::vector<float>& b, float empty, size_t width) {
    EXPECT_EQ(a.size(), b.size());
    Difference d;
    for (size_t i = 0; i < a.size(); ++i) {
      if (a[i] != empty) ++d.drawn;
      float step = 0;
      for (const size_t j : {i - 1, i + 1, i - width, i + width})
        if (j < b.size() && b[j] != empty) step = std::max(step, std::abs(b[i] - b[j]));
      if ((a[i] == empty) != (b[i] == empty))
        ++d.coverage;
      else if (!(std::abs(a[i] - b[i]) <= 1e-5f * a[i] + step / 64))
        ++d.depth;
    }
    return d;
  }
  /// Some pixels at edges and rims of cut-outs change hands.
  static void expectAlike(const Difference& d, const std::string& what) {
    printf("%s: %zu drawn, %zu differ in coverage, %zu in depth\n", what.c_str(), d.drawn, d.coverage, d.depth);
    EXPECT_GT(d.drawn, 1000u) << what;
    EXPECT_LE(d.coverage, d.drawn / 2000) << what;
    EXPECT_LE(d.depth, d.drawn / 500) << what;
  }
};

Scene triangles(const std::vector<std::array<glm::vec3, 3>>& corners) {
  SceneBuilder b;
  b.scene.materials[0].doubleSided = true;
  for (const auto& t : corners) b.addTriangle(t, {glm::vec4(1), glm::vec4(1), glm::vec4(1)});
  b.scene.draws.push_back({0, 0, static_cast<uint32_t>(b.scene.indices.size())});
  return b.finish();
}

/// Looks down -Z at x, y in [-1, 1] about the scene's middle, 1/8 .. 8 away.
Camera flatCamera(const Scene& scene) {
  Camera camera;
  camera.orthographic = true;
  camera.ymag = 1;
  camera.position = scene.origin + glm::dvec3(0, 0, 4);
  camera.znear = 0.125f;
  camera.zfar = 8;
  return camera;
}

struct Exact {
  std::vector<uint32_t> triangle;  ///< nearest; ~0u: none
  std::vector<uint32_t> count;     ///< that cover the pixel
};
/// By the rules of shaders/raster/raster.glsl, pixel by pixel, in integers; the nearest by the first corner's z.
Exact exact(const Scene& scene, const Camera& camera, glm::uvec2 size) {
  const GpuCamera gpu = makeGpuCamera(scene, camera, size);
  const auto snap = [&](const glm::vec3& p) {
    const glm::mat4& m = gpu.viewProjection;
    const glm::vec4 clip = ((m[0] * p.x + m[1] * p.y) + m[2] * p.z) + m[3];
    return glm::i64vec2(std::floor((clip.x * 0.5f + 0.5f) * static_cast<float>(size.x) * 256.0f + 0.5f),
                        std::floor((clip.y * -0.5f + 0.5f) * static_cast<float>(size.y) * 256.0f + 0.5f));
  };
  const auto turn = [](glm::i64vec2 p, glm::i64vec2 q, glm::i64vec2 r) {
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
  };
  Exact out{std::vector<uint32_t>(size.x * size.y, ~0u), std::vector<uint32_t>(size.x * size.y, 0)};
  for (uint32_t t = 0; t < scene.triangleCount(); ++t) {
    std::array<glm::i64vec2, 3> c;
    for (uint32_t i = 0; i < 3; ++i) c[i] = snap(scene.positions[scene.indices[3 * t + i]]);
    if (turn(c[0], c[1], c[2]) < 0) std::swap(c[1], c[2]);
    if (turn(c[0], c[1], c[2]) == 0) continue;
    const float z = scene.positions[scene.indices[3 * t]].z;
    for (uint32_t y = 0; y < size.y; ++y)
      for (uint32_t x = 0; x < size.x; ++x) {
        const glm::i64vec2 at(256 * x + 128, 256 * y + 128);
        bool inside = true;
        for (int i = 0; i < 3; ++i) {
          const glm::i64vec2 p = c[i], q = c[(i + 1) % 3];
          const bool topOrLeft = q.y < p.y || (q.y == p.y && q.x > p.x);
          inside &= turn(p, q, at) >= (topOrLeft ? 0 : 1);
        }
        if (!inside) continue;
        uint32_t& best = out.triangle[y * size.x + x];
        if (best == ~0u || z > scene.positions[scene.indices[3 * best]].z) best = t;
        ++out.count[y * size.x + x];
      }
  }
  return out;
}

TEST_F(RasterTest, RandomTrianglesAsIntegersHaveThem) {
  // From less than a pixel to far beyond the picture, each at a depth of its own.
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (const glm::uvec2 size : {glm::uvec2(97, 61), glm::uvec2(256, 256)}) {
    std::vector<std::array<glm::vec3, 3>> corners;
    for (int i = 0; i < 400; ++i) {
      const float extent = std::pow(10.0f, unit(random) * 1.5f - 1.0f);  // .003 to 3
      const float z = -1.0f + 2.0f * static_cast<float>((i * 37) % 400) / 400.0f;
      const glm::vec3 middle(1.4f * unit(random), 1.4f * unit(random), z);
      std::array<glm::vec3, 3> t;
      for (glm::vec3& p : t) p = middle + extent * glm::vec3(unit(random), unit(random), 0);
      corners.push_back(t);
    }
    const Scene scene = triangles(corners);
    const Camera camera = flatCamera(scene);
    const Seen seen = visible(scene, camera, size);
    EXPECT_EQ(seen.triangle, exact(scene, camera, size).triangle);
  }
}

TEST_F(RasterTest, SharedEdgesAreDrawnOnce) {
  // A mesh of jittered corners over the whole picture, whose edges meet pixel centres too: nothing between, nothing
  // twice.
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1, 1);
  constexpr int kCells = 24;
  const auto corner = [](int x, int y) { return glm::vec3(2.2f * x / kCells - 1.1f, 2.2f * y / kCells - 1.1f, 0); };
  std::vector<glm::vec3> grid;
  for (int y = 0; y <= kCells; ++y)
    for (int x = 0; x <= kCells; ++x) {
      glm::vec3 p = corner(x, y);
      if ((x + y) % 3 != 0) p += 0.03f * glm::vec3(unit(random), unit(random), 0);
      grid.push_back(p);
    }
  std::vector<std::array<glm::vec3, 3>> corners;
  for (int y = 0; y < kCells; ++y)
    for (int x = 0; x < kCells; ++x) {
      const auto at = [&](int i, int j) { return grid[(y + j) * (kCells + 1) + x + i]; };
      corners.push_back({at(0, 0), at(1, 0), at(1, 1)});
      corners.push_back({at(0, 0), at(1, 1), at(0, 1)});
    }
  const Scene scene = triangles(corners);
  const Camera camera = flatCamera(scene);
  const glm::uvec2 size(160, 160);
  const Exact expected = exact(scene, camera, size);
  for (const uint32_t count : expected.count) ASSERT_EQ(count, 1u);
  EXPECT_EQ(visible(scene, camera, size).triangle, expected.triangle);
}

TEST_F(RasterTest, DepthsAreTheGraphicsPipelines) {
  const Scene box = loadScene(assets() / "box.glb");
  const glm::uvec2 size(320, 240);
  for (size_t i = 0; i < box.cameras.size(); ++i)
    expectAlike(difference(visible(box, box.cameras[i], size).depth, hardware(box, box.cameras[i], size), 0.0f, size.x),
                "Box, camera " + std::to_string(i));
}

TEST_F(RasterTest, CloseSurfacesFarAwayAreToldApart) {
  // A tenth of a metre apart at 300 m, seen from a near plane at .01 m: 1 part in 3,000. Whichever is drawn first.
  for (const bool farFirst : {true, false}) {
    SceneBuilder b;
    const auto plane = [&](float z) { b.addQuad({-100, -80, z}, {200, 0, 0}, {0, 160, 0}); };
    plane(farFirst ? -300.1f : -300.0f);
    plane(farFirst ? -300.0f : -300.1f);
    const uint32_t nearer = farFirst ? 2 : 0;  // its first triangle
    Camera camera = b.addCamera({0.3, 0.2, 0}, {0.3, 0.2, -1}, 0.4f);
    const Scene scene = b.finish();
    camera.znear = 0.01f;
    const glm::uvec2 size(160, 120);
    const Seen seen = visible(scene, camera, size);
    const std::vector<float> drawn = hardware(scene, camera, size);
    const auto distance = [&](float depth) {
      const GpuCamera gpu = makeGpuCamera(scene, camera, size);
      return double{gpu.znear} * gpu.zfar / (gpu.znear + double{depth} * (double{gpu.zfar} - gpu.znear));
    };
    size_t wrong = 0, off = 0;
    for (size_t i = 0; i < drawn.size(); ++i) {
      wrong += seen.triangle[i] < nearer || seen.triangle[i] > nearer + 1;
      off += std::abs(distance(seen.depth[i]) - 300) > 0.02 || std::abs(distance(drawn[i]) - 300) > 0.02;
    }
    EXPECT_EQ(wrong, 0u) << "by kernels";
    EXPECT_EQ(off, 0u) << "pixels whose depth is not the nearer plane's";
  }
}

TEST_F(RasterTest, TrianglesThroughTheNearPlaneAreClipped) {
  // A floor and a wall that reach far behind the camera, seen from a centimetre above and beside them.
  SceneBuilder b;
  b.addQuad({-30, 0, 30}, {60, 0, 0}, {0, 0, -60});
  b.addQuad({0.01f, -5, 20}, {0, 0, -40}, {0, 10, 0});
  b.addBox({-2, 0, -6}, {-1, 1, -5});
  const Scene scene = b.finish();
  for (const glm::dvec3 eye : {glm::dvec3(-1, 0.01, 0), glm::dvec3(0, 3, 1)})
    for (const float znear : {1e-3f, 0.1f}) {
      SceneBuilder looking;
      Camera camera = looking.addCamera(eye, eye + glm::dvec3(-0.1, -0.05, -1), 1.2f);
      camera.znear = znear;
      const Seen seen = visible(scene, camera, {200, 150});
      expectAlike(difference(seen.depth, hardware(scene, camera, {200, 150}), 0.0f, 200), "near plane");
    }
}

TEST_F(RasterTest, MaskedAndDoubleSidedMaterials) {
  const auto scenes = sharedScenes();
  if (!scenes) GTEST_SKIP() << "the folder of real scenes is absent: nothing masked to draw";
  Scene scene = loadScene(*scenes / "sponza/sponza_small_lit_m.glb");
  // Without mips: a driver that takes the derivatives itself chooses levels by rules of its own.
  for (Material& m : scene.materials) m.baseColorTexture.sampler.mips = false;
  const glm::uvec2 size(400, 300);
  expectAlike(difference(visible(scene, scene.cameras.at(0), size).depth, hardware(scene, scene.cameras.at(0), size), 0,
                         size.x),
              "Sponza");
}

TEST_F(RasterTest, ShadowMapsAreTheGraphicsPipelines) {
  Scene scene = loadScene(assets() / "box.glb");
  scene.lights.clear();
  for (const LightType type : {LightType::Sun, LightType::Spot, LightType::Point}) {
    Light light;
    light.type = type;
    light.intensity = 1;
    light.direction = glm::normalize(glm::vec3(0.3f, -1, 0.2f));
    light.position = scene.origin + glm::dvec3(0.5, 1.5, 0.3);
    light.outerCos = 0.8f;
    scene.lights.push_back(light);
  }
  const auto maps = [&](bool kernels) {
    SceneOnDevice device(context(), scene);
    const ShadowMaps drawn = drawShadows(context(), device, 256, {.kernels = kernels});
    return std::pair(depths(drawn.flat), depths(drawn.cubes));
  };
  const auto ours = maps(true), pipelines = maps(false);
  expectAlike(difference(ours.first, pipelines.first, 0, 256), "flat maps");
  expectAlike(difference(ours.second, pipelines.second, 0, 128), "cubes");
  EXPECT_EQ(ours, maps(true)) << "the same bits again";
}

TEST_F(RasterTest, IsChosenForDevicesWithNarrowGraphics) {
  for (const char* narrow : {"NVIDIA H100 80GB HBM3", "NVIDIA H200", "NVIDIA GH200 480GB"})
    EXPECT_TRUE(hasNarrowGraphics(narrow)) << narrow;
  for (const char* wide : {"NVIDIA GeForce RTX 4090", "AMD Radeon RX 7700 XT", "llvmpipe (LLVM 15.0.6, 256 bits)"})
    EXPECT_FALSE(hasNarrowGraphics(wide)) << wide;
  Settings settings;
  EXPECT_EQ(rasterizesByKernels(context().device, settings), context().device.narrowGraphics);
  settings.rasterizer = Rasterizer::kernels;
  EXPECT_TRUE(rasterizesByKernels(context().device, settings));
}

TEST_F(RasterTest, VoxelsAreTheGraphicsPipelines) {
  std::vector<Scene> scenes;
  scenes.push_back(loadScene(assets() / "box.glb"));
  if (const auto shared = sharedScenes()) scenes.push_back(loadScene(*shared / "sponza/sponza_small_lit_m.glb"));
  for (const Scene& scene : scenes) {
    const SceneOnDevice device(context(), scene);
    Settings settings = defaultSettings(/*cpuDevice*/ true);
    settings.voxel.method = VoxelMethod::raster;
    const auto keys = [&](Rasterizer rasterizer) {
      settings.rasterizer = rasterizer;
      return downloadAs<uint32_t>(context(), voxelize(context(), device, settings).keys);
    };
    const std::vector<uint32_t> ours = keys(Rasterizer::kernels), pipelines = keys(Rasterizer::hardware);
    size_t solid = 0, differ = 0;
    for (size_t i = 0; i < ours.size(); ++i) {
      solid += pipelines[i] != 0;
      differ += ours[i] != pipelines[i];
    }
    printf("%s: %zu keys, %zu differ\n", scene.path.filename().c_str(), solid, differ);
    EXPECT_GT(solid, 10000u);
    EXPECT_LE(differ, solid / 1000);
    EXPECT_EQ(ours, keys(Rasterizer::kernels));
  }
}

}  // namespace
}  // namespace irad::test::raster_suite
