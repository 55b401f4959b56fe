// Emission textures: the power of facets, of the triangles that pixels look for, and of the picture is that of the
// texture itself, which is summed up here texel by texel.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <random>

#include "gi/host_facets.h"
#include "gi/pixel_emitters.h"
#include "gi/subsystems.h"
#include "gi/traits.h"
#include "renderer/scene/srgb.h"
#include "shaders/shared/pixel_emitters.h"
#include "tests/lit_stage.h"

namespace irad::test::emission_textures_suite {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr float kRadiance = 3;

class EmissionTextures : public GpuTest {};

struct Pattern {
  const char* name;
  uint32_t size;
  /// Code of a texel: 0..255.
  std::function<uint8_t(uint32_t x, uint32_t y)> code;
};
const std::vector<Pattern>& patterns() {
  static std::mt19937 random(7);
  static const std::vector<Pattern> all{
      {"checker of 4 x 4, half black", 64, [](uint32_t x, uint32_t y) { return (x / 16 + y / 16) % 2 ? 255 : 0; }},
      {"checker of 4 texels", 2, [](uint32_t x, uint32_t y) { return (x + y) % 2 ? 255 : 0; }},
      {"checker of single texels, all mip levels", 512, [](uint32_t x, uint32_t y) { return (x + y) % 2 ? 255 : 0; }},
      {"noise", 256, [](uint32_t, uint32_t) { return static_cast<uint8_t>(random() % 256); }},
      {"a line of light", 128, [](uint32_t x, uint32_t) { return x / 2 == 31 ? 255 : 0; }},
      {"even", 4, [](uint32_t, uint32_t) { return 188; }}};
  return all;
}

SceneImage image(const Pattern& pattern) {
  SceneImage out{.name = pattern.name, .width = pattern.size, .height = pattern.size, .srgb = true};
  for (uint32_t y = 0; y < pattern.size; ++y)
    for (uint32_t x = 0; x < pattern.size; ++x) {
      const uint8_t code = pattern.code(x, y);
      out.rgba.insert(out.rgba.end(), {code, code, code, 255});
    }
  return out;
}

/// A lamp with the texture, in a room that is larger and black; `slanted`: across the grid's axes.
Scene lamp(const Pattern& pattern, bool slanted) {
  SceneBuilder b;
  b.scene.materials[0].baseColor = {0, 0, 0, 1};
  b.addQuad({-1, -0.6f, 1}, {2, 0, 0}, {0, 0, -2});
  Material& m = b.newMaterial();
  m.emission = glm::vec3(kRadiance);
  m.emissiveTexture.image = 0;
  const glm::vec3 u = slanted ? glm::vec3(1.1f, 0.3f, 0.2f) : glm::vec3(1.07f, 0, 0);
  const glm::vec3 v = slanted ? glm::vec3(0.1f, 0.2f, -1) : glm::vec3(0, 0, -1.07f);
  b.addQuad(-0.5f * (u + v), u, v);
  b.scene.images.push_back(image(pattern));
  Camera& camera = b.addCamera({0, 1, 0}, {0, 0, 0}, 1, {0, 0, -1});
  camera.orthographic = true;
  camera.ymag = 0.5f * 1.07f;
  return b.finish();
}

/// Of the texture over the lamp, W: the mean of bilinear lookups that repeat is that of the texels.
double power(const Scene& scene) {
  double sum = 0;
  const SceneImage& texture = scene.images[0];
  for (size_t i = 0; i < texture.rgba.size(); i += 4) sum += double{linearFromSrgb(texture.rgba[i])};
  const Draw& draw = scene.draws.back();
  const auto at = [&](uint32_t corner) { return glm::dvec3(scene.positions[scene.indices[draw.firstIndex + corner]]); };
  const double area = glm::length(glm::cross(at(1) - at(0), at(2) - at(0)));  // of both triangles
  return kPi * double{kRadiance} * area * sum / (static_cast<double>(texture.rgba.size()) / 4);
}

TEST_F(EmissionTextures, FacetsTrianglesAndPixelsHaveTheTexturesPower) {
  for (const Pattern& pattern : patterns())
    for (const bool slanted : {false, true}) {
      const Scene scene = lamp(pattern, slanted);
      const double whole = power(scene);
      Settings settings = defaultSettings(/*cpuDevice=*/true);
      settings.voxel.resolution = 24;
      const SceneOnDevice device(context(), scene);
      const FacetList list = makeFacets(context(), device, settings);
      const HostFacets host = hostFacets(context(), list);
      double byFacets = 0;
      for (size_t i = 0; i < host.count(); ++i) byFacets += double{host.emission[i].x} * host.area[i];

      const Buffer grid = makeBuffer(context(), "grid", Subsystem::Voxels, std::span<const Grid>(&list.grid, 1));
      const EmissiveTriangles found =
          listEmissiveTriangles(context(), device, measure(scene, 24).materials, list, grid);
      double byTriangles = 0;
      for (const EmissiveTriangle& t : downloadAs<EmissiveTriangle>(context(), found.triangles))
        byTriangles += double{t.exitance.x} * 0.5 * double{glm::length(glm::cross(t.edge1, t.edge2))} *
                       std::pow(double{list.grid.edge}, 2);
      fmt::print("{}{}: facets {:.4f}, triangles {:.4f} of the power", pattern.name, slanted ? ", slanted" : "",
                 byFacets / whole, byTriangles / whole);
      EXPECT_NEAR(byFacets / whole, 1, 0.01) << pattern.name << slanted;
      EXPECT_NEAR(byTriangles / whole, 1, 0.01) << pattern.name << slanted;
      if (!slanted) {
        Stage stage(context(), scene, settings);
        double sum = 0;
        const std::vector<glm::vec4> lit = stage.draw(VIEW_LIT, {96, 96}).linear;
        for (const glm::vec4& c : lit) sum += double{c.x};
        const double byPixels = kPi * sum / static_cast<double>(lit.size()) * 1.07 * 1.07;
        fmt::print(", pixels {:.4f}", byPixels / whole);
        EXPECT_NEAR(byPixels / whole, 1, 0.01) << pattern.name;
      }
      fmt::print("\n");
    }
}

}  // namespace
}  // namespace irad::test::emission_textures_suite
