// Against path tracing and closed forms: the Cycles renders of ../shared/scenes/references (diffuse only, same camera
// and lights) and the analytic scenes. N = 128, 256 rays, every material Lambertian.
//
// The tests named DISABLED_ do not hold yet: indirect light comes out too dark (Cornell: direct .91, indirect .72 to
// .79 of Cycles; the sphere: 1.66 instead of 1.857). Their marks stay as they are; --gtest_also_run_disabled_tests runs
// them.
#include <nlohmann/json.hpp>

#include <fstream>

#include "exr.h"
#include "gi/pipeline.h"
#include "support.h"

namespace irad::test {
namespace {

class Reference : public GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    scenes_ = sharedScenes();
    if (!scenes_) GTEST_SKIP() << "the folder of real scenes is absent: nothing to compare with";
  }

  /// The views' linear pixels for a scene, lit by its own lights, at the reference settings.
  std::vector<Picture> render(const std::filesystem::path& scenePath, const Camera* camera, glm::uvec2 size,
                              const std::vector<const char*>& viewNames, uint32_t resolution = 128,
                              uint32_t rays = 256) {
    Settings settings = defaultSettings(/*cpuDevice=*/true);
    settings.lambertian = true;
    settings.voxel.resolution = resolution;
    settings.matrix.gpu.rays = rays;
    settings.specular.mode = SpecularMode::off;
    Scene scene = loadScene(scenePath, {.lambertian = true, .progress = {}});
    const Camera from = camera ? *camera : scene.cameras.at(0);
    Pipeline pipeline(context(), std::move(scene), settings);
    pipeline.prepare();
    EXPECT_TRUE(pipeline.asleep()) << "the solver did not reach its tolerance";
    EXPECT_EQ(pipeline.lighting().report.nonFinite, 0u);
    Targets targets(context(), size);
    std::vector<Picture> out;
    for (const char* name : viewNames) {
      Frame frame = context().begin();
      pipeline.render(frame, from, findView(name).value(), targets);
      frame.submitAndWait();
      const std::vector<std::byte> bytes = download(context(), targets.linear);
      Picture picture{size.x, size.y, {}};
      picture.pixels.resize(size_t(size.x) * size.y);
      for (size_t i = 0; i < picture.pixels.size(); ++i)
        std::memcpy(&picture.pixels[i], bytes.data() + i * sizeof(glm::vec4), sizeof(glm::vec3));
      out.push_back(std::move(picture));
    }
    return out;
  }

  /// Image means per channel of direct and indirect diffuse irradiance, ours over Cycles' (DiffDir and DiffInd are
  /// irradiance / pi; ours are W/m^2).
  void compare(const char* name, const std::filesystem::path& scene, const Camera* camera, glm::uvec2 size) {
    const std::filesystem::path file = *scenes_ / "references" / (std::string(name) + ".exr");
    const Picture direct = readExr(file, "ViewLayer.DiffDir"), bounced = readExr(file, "ViewLayer.DiffInd");
    ASSERT_EQ(direct.width, size.x);
    const std::vector<Picture> ours = render(scene, camera, size, {"direct-irradiance", "irradiance"});
    // H holds the emitters' first gather too, which Cycles counts as direct: both views' sum is D + H + F M.
    Picture oursDirect = ours[0], oursBounced = ours[1];
    Picture emitted = render(scene, camera, size, {"emitter-irradiance"})[0];
    for (size_t i = 0; i < oursDirect.pixels.size(); ++i) {
      oursBounced.pixels[i] = (ours[1].pixels[i] - emitted.pixels[i]) / 3.14159265f;
      oursDirect.pixels[i] = ours[0].pixels[i] / 3.14159265f;
    }
    const glm::dvec3 d = oursDirect.mean() / direct.mean(), b = oursBounced.mean() / bounced.mean();
    printf("%s: direct %.4f %.4f %.4f, indirect %.4f %.4f %.4f of Cycles; relMSE (eps .01) %.4f, %.4f\n", name, d.x,
           d.y, d.z, b.x, b.y, b.z, relMse(oursDirect, direct, 0.01), relMse(oursBounced, bounced, 0.01));
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(d[c], 1.0, 0.03) << "direct, channel " << c;
      EXPECT_NEAR(b[c], 1.0, 0.10) << "indirect, channel " << c;
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

TEST_F(Reference, DISABLED_CornellAgainstCycles) {
  const Camera camera = lookFrom({0, 1, 3.4}, 40.0f);
  compare("cornell_base_diffuse", *scenes_ / "variants/cornell_base.glb", &camera, {256, 256});
}

TEST_F(Reference, DISABLED_SponzaAgainstCycles) {
  compare("sponza_lit_diffuse", *scenes_ / "sponza/sponza_small_lit_m.glb", nullptr, {320, 320});
}

/// The largest radiance within a centred square of `half` pixels, and at the centre.
glm::vec3 centre(const Picture& p) {
  return p.pixels[(p.height / 2) * p.width + p.width / 2];
}

TEST_F(Reference, DirectLightOnAPlane) {
  struct Case {
    const char* file;
    double radiance;
  };
  for (const Case c : {Case{"plane_sun", 0.79577}, Case{"plane_point", 1.98944}, Case{"plane_spot", 1.98944}}) {
    const Picture direct =
        render(*scenes_ / "analytic" / (std::string(c.file) + ".glb"), nullptr, {65, 65}, {"direct"}, 32, 64)[0];
    float brightest = 0;
    for (const glm::vec3& p : direct.pixels) brightest = std::max(brightest, p.x);
    printf("%s: brightest %.5f, expected %.5f\n", c.file, brightest, c.radiance);
    EXPECT_NEAR(brightest, c.radiance, 0.005 * c.radiance) << c.file;
  }
}

TEST_F(Reference, FurnaceCube) {
  // Emission .5 x 4 = 2, rho .6: L = 2 / (1 - .6) = 5 everywhere.
  const Picture lit = render(*scenes_ / "analytic/furnace_cube.glb", nullptr, {64, 64}, {"lit"}, 64, 256)[0];
  const glm::dvec3 mean = lit.mean();
  printf("furnace_cube: mean %.4f, expected 5, centre %.4f\n", mean.x, centre(lit).x);
  EXPECT_NEAR(mean.x, 5.0, 0.05);
  for (const glm::vec3& p : lit.pixels) EXPECT_NEAR(p.x, 5.0, 0.15);
}

TEST_F(Reference, DISABLED_IntegratingSphere) {
  // 10 cd inside a sphere of rho .7: L = 1.8568 everywhere (direct + indirect).
  const Picture lit = render(*scenes_ / "analytic/sphere_point.glb", nullptr, {64, 64}, {"lit"}, 64, 256)[0];
  const glm::dvec3 mean = lit.mean();
  printf("sphere_point: mean %.4f, expected 1.8568\n", mean.x);
  EXPECT_NEAR(mean.x, 1.8568, 0.01 * 1.8568);
}

}  // namespace
}  // namespace irad::test
