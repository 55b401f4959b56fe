// Against path tracing and closed forms: Cycles renders (diffuse only, same camera and lights) and the analytic scenes
// of ../shared. N = 128, 256 rays (Sponza 128, the analytic scenes less), every material Lambertian.
//
// The Cornell box is compared twice. As glTF has it, with culled backs, with tests/references/cornell_one_sided.exr, in
// which the lamp emits from its front alone. With every material double-sided, as Cycles has them, with
// ../shared/scenes/references/cornell_base_diffuse.exr: there the lamp's back, .01 below the ceiling, emits too. That
// light, a seventh of the mean direct irradiance in a strip of ceiling and a quarter of the indirect, enters through a
// gap of .6 voxel: ceiling and both sides of the lamp are facets of one voxel.
#include <nlohmann/json.hpp>

#include <fstream>

#include "gi/lighting.h"
#include "gi/pipeline.h"
#include "renderer/scene/scene.h"
#include "renderer/targets.h"
#include "tests/exr.h"
#include "tests/support.h"

namespace irad::test::reference_suite {
namespace {

class Reference : public GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    scenes_ = sharedScenes();
    if (!scenes_) GTEST_SKIP() << "the folder of real scenes is absent: nothing to compare with";
  }

  struct Quality {
    uint32_t resolution = 128, rays = 256;
    bool doubleSided = false;                        ///< every material
    uint32_t samples = 1;                            ///< of a pixel, along each axis
    EmitterLookup emitters = EmitterLookup::facets;  ///< sample.emitters
  };
  /// The views' linear pixels for a scene, lit by its own lights, at the reference settings.
  std::vector<ExrPicture> render(const std::filesystem::path& scenePath, const Camera* camera, glm::uvec2 size,
                                 const std::vector<const char*>& viewNames, const Quality& quality) {
    Settings settings = defaultSettings(/*cpuDevice=*/true);
    settings.scene = {.lambertian = true, .doubleSided = quality.doubleSided};
    settings.voxel.resolution = quality.resolution;
    settings.matrix.gpu.rays = quality.rays;
    settings.specular.mode = SpecularMode::off;
    settings.sample.emitters = quality.emitters;
    Scene scene = loadScene(scenePath, {.lambertian = true, .doubleSided = quality.doubleSided, .progress = {}});
    const Camera from = camera ? *camera : scene.cameras.at(0);
    Pipeline pipeline(context(), std::move(scene), settings);
    pipeline.prepare();
    EXPECT_TRUE(pipeline.asleep()) << "the solver did not reach its tolerance";
    EXPECT_EQ(pipeline.lighting().report.nonFinite, 0u);
    const uint32_t samples = quality.samples;
    Targets targets(context(), samples * size);
    std::vector<ExrPicture> out;
    for (const char* name : viewNames) {
      Frame frame = context().begin();
      pipeline.render(frame, from, findView(name).value(), targets, {.shareSurfaces = true});
      frame.submitAndWait();
      const std::vector<std::byte> bytes = download(context(), targets.linear);
      const auto* texels = reinterpret_cast<const glm::vec4*>(bytes.data());
      ExrPicture picture{size.x, size.y, std::vector<glm::vec3>(size_t(size.x) * size.y, glm::vec3(0))};
      for (uint32_t y = 0; y < samples * size.y; ++y)
        for (uint32_t x = 0; x < samples * size.x; ++x)
          picture.pixels[size_t(y / samples) * size.x + x / samples] +=
              glm::vec3(texels[size_t(y) * samples * size.x + x]) / static_cast<float>(samples * samples);
      out.push_back(std::move(picture));
    }
    return out;
  }

  struct Ratios {
    glm::dvec3 direct, indirect;
  };
  /// Image means per channel of direct and indirect diffuse irradiance, ours over Cycles' (DiffDir and DiffInd are
  /// irradiance / pi; ours are W/m^2).
  Ratios compare(const std::filesystem::path& reference, const std::filesystem::path& scene, const Camera* camera,
                 const Quality& quality) {
    const ExrPicture direct = readExr(reference, "ViewLayer.DiffDir"),
                     bounced = readExr(reference, "ViewLayer.DiffInd");
    // H holds the emitters' first gather, which Cycles counts as direct: that view's D + F M is compared.
    // (F M comes next to it: those two share their surfaces.)
    const std::vector<ExrPicture> ours = render(scene, camera, {direct.width, direct.height},
                                                {"direct-irradiance", "emitter-irradiance", "irradiance"}, quality);
    ExrPicture oursDirect = ours[0], oursBounced = ours[2];
    for (size_t i = 0; i < oursDirect.pixels.size(); ++i) {
      oursBounced.pixels[i] = (ours[2].pixels[i] - ours[1].pixels[i]) / 3.14159265f;
      oursDirect.pixels[i] = ours[0].pixels[i] / 3.14159265f;
    }
    const Ratios r{oursDirect.mean() / direct.mean(), oursBounced.mean() / bounced.mean()};
    printf("%s: direct %.4f %.4f %.4f, indirect %.4f %.4f %.4f of Cycles; relMSE (eps .01) %.4f, %.4f\n",
           reference.stem().c_str(), r.direct.x, r.direct.y, r.direct.z, r.indirect.x, r.indirect.y, r.indirect.z,
           metrics(oursDirect, direct).relMse, metrics(oursBounced, bounced).relMse);
    return r;
  }
  static void expectMarks(const Ratios& r) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(r.direct[c], 1.0, 0.03) << "direct, channel " << c;
      EXPECT_NEAR(r.indirect[c], 1.0, 0.10) << "indirect, channel " << c;
    }
  }

  std::optional<std::filesystem::path> scenes_;
};

Camera lookFrom(glm::dvec3 eye, float yfovDegrees) {
  Camera camera;
  camera.name = "reference";
  camera.position = eye;  // looks along -Z
  camera.yfov = glm::radians(yfovDegrees);
  return camera;
}

TEST_F(Reference, CornellAgainstCycles) {
  const Camera camera = lookFrom({0, 1, 3.4}, 40.0f);
  expectMarks(compare(sourceFolder() / "tests/references/cornell_one_sided.exr", *scenes_ / "variants/cornell_base.glb",
                      &camera, {}));
}

TEST_F(Reference, CornellWithATwoSidedLamp) {
  const Camera camera = lookFrom({0, 1, 3.4}, 40.0f);
  // The strip of ceiling that is seen is one pixel high: like Cycles, several samples of a pixel. It is .6 voxel from
  // the lamp: pixels look for the lamp themselves. (From the facets the direct light is 1.06; docs/performance.md.)
  expectMarks(compare(*scenes_ / "references/cornell_base_diffuse.exr", *scenes_ / "variants/cornell_base.glb", &camera,
                      {.doubleSided = true, .samples = 2, .emitters = EmitterLookup::pixels}));
}

TEST_F(Reference, SponzaAgainstCycles) {
  expectMarks(compare(*scenes_ / "references/sponza_lit_diffuse.exr", *scenes_ / "sponza/sponza_small_lit_m.glb",
                      nullptr, {.rays = 128}));
}

/// The largest radiance within a centred square of `half` pixels, and at the centre.
glm::vec3 centre(const ExrPicture& p) {
  return p.pixels[(p.height / 2) * p.width + p.width / 2];
}

TEST_F(Reference, DirectLightOnAPlane) {
  struct Case {
    const char* file;
    double radiance;
  };
  for (const Case c : {Case{"plane_sun", 0.79577}, Case{"plane_point", 1.98944}, Case{"plane_spot", 1.98944}}) {
    const ExrPicture direct = render(*scenes_ / "analytic" / (std::string(c.file) + ".glb"), nullptr, {65, 65},
                                     {"direct"}, {.resolution = 32, .rays = 64})[0];
    float brightest = 0;
    for (const glm::vec3& p : direct.pixels) brightest = std::max(brightest, p.x);
    printf("%s: brightest %.5f, expected %.5f\n", c.file, brightest, c.radiance);
    EXPECT_NEAR(brightest, c.radiance, 0.005 * c.radiance) << c.file;
  }
}

TEST_F(Reference, FurnaceCube) {
  // Emission .5 x 4 = 2, rho .6: L = 2 / (1 - .6) = 5 everywhere.
  const ExrPicture lit =
      render(*scenes_ / "analytic/furnace_cube.glb", nullptr, {64, 64}, {"lit"}, {.resolution = 32, .rays = 64})[0];
  const glm::dvec3 mean = lit.mean();
  printf("furnace_cube: mean %.4f, expected 5, centre %.4f\n", mean.x, centre(lit).x);
  EXPECT_NEAR(mean.x, 5.0, 0.05);
  for (const glm::vec3& p : lit.pixels) EXPECT_NEAR(p.x, 5.0, 0.15);
}

TEST_F(Reference, IntegratingSphere) {
  // 10 cd inside a sphere of rho .7: L = 1.8568 everywhere (direct + indirect).
  const ExrPicture lit =
      render(*scenes_ / "analytic/sphere_point.glb", nullptr, {64, 64}, {"lit"}, {.resolution = 64, .rays = 64})[0];
  const glm::dvec3 mean = lit.mean();
  printf("sphere_point: mean %.4f, expected 1.8568\n", mean.x);
  EXPECT_NEAR(mean.x, 1.8568, 0.01 * 1.8568);
}

}  // namespace
}  // namespace irad::test::reference_suite
