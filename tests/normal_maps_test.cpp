// Normal maps (shaders/shared/normal_maps.h, docs/method.md 9): what bumps leave of light, in closed form against its
// integral, and pixels and facets against the path tracer, which shares no code with them.
#include "shaders/shared/normal_maps.h"

#include <cmath>
#include <numbers>

#include "gi/check/path_tracer.h"
#include "gi/host_facets.h"
#include "tests/lit_stage.h"

namespace irad::test::normal_maps_suite {
namespace {

constexpr double kPi = std::numbers::pi;

double shadowing(double smoothMapped, double smoothLight, double mappedLight) {
  const double g = smoothLight / (smoothMapped * mappedLight);
  return g >= 1 ? 1 : g > 0 ? g + g * g - g * g * g : 0;
}

/// The share of an even sky, by the midpoint rule over the hemisphere.
double keptByQuadrature(double c) {
  constexpr int kUp = 4000, kAround = 1000;
  const double s = std::sqrt(1 - c * c);
  std::vector<double> along;
  for (int j = 0; j < kAround; ++j) along.push_back(std::cos(kPi * (j + 0.5) / kAround));  // one half, by symmetry
  double sum = 0;
  for (int i = 0; i < kUp; ++i) {
    const double up = (i + 0.5) / kUp, r = std::sqrt(1 - up * up);
    for (const double x : along) {
      const double cosine = s * r * x + c * up;
      if (cosine > 0) sum += cosine * shadowing(c, up, cosine);
    }
  }
  return 2 * sum / kUp / kAround;
}

TEST(NormalMapFunctions, ShareOfAnEvenSkyIsItsIntegral) {
  double worst = 0;
  for (const double degrees : {0.5, 1., 2., 5., 10., 20., 30., 45., 60., 70., 75., 75.6, 80., 85.}) {
    const auto c = static_cast<float>(std::cos(degrees * kPi / 180));
    const double integral = keptByQuadrature(double{c}), off = std::abs(double{keptOfEvenSky(c)} - integral);
    EXPECT_LT(off, 3e-6) << degrees << " degrees: " << integral;
    worst = std::max(worst, off);
  }
  printf("share of an even sky: at most %.2g off its integral\n", worst);
  EXPECT_EQ(keptOfEvenSky(1), 1.0f);
  EXPECT_EQ(keptOfEvenSky(1.0000001f), 1.0f);
  EXPECT_NEAR(keptOfEvenSky(1e-6f), 0.5f, 1e-6f);  // all of the half that it faces
  EXPECT_EQ(keptOfEvenSky(0), 0.0f);
  EXPECT_EQ(keptOfEvenSky(-0.5f), 0.0f);
}

TEST(NormalMapFunctions, ShadowingIsTheFormula) {
  for (double angle = -89; angle < 90; angle += 3)
    for (double light = -89; light < 90; light += 0.7) {
      const double a = angle * kPi / 180, l = light * kPi / 180;
      const double smoothMapped = std::cos(a), smoothLight = std::cos(l), mappedLight = std::cos(l - a);
      if (mappedLight <= 1e-3) continue;
      EXPECT_NEAR(pastBumps(float(smoothMapped), float(smoothLight), float(mappedLight)),
                  shadowing(smoothMapped, smoothLight, mappedLight), 2e-5)
          << angle << ' ' << light;
    }
  EXPECT_EQ(pastBumps(0.5f, -0.1f, 0.5f), 0.0f);
  EXPECT_EQ(pastBumps(-0.5f, 0.5f, 0.5f), 0.0f);
}

class NormalMaps : public GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  }
  static Settings small() {
    Settings s;
    s.voxel.resolution = 16;
    s.matrix.gpu.rays = 64;
    s.light.shadowResolution = 256;
    s.specular.mode = SpecularMode::off;
    return s;
  }
  static TracedPicture traced(const Scene& scene, glm::uvec2 size, const TraceOptions& options) {
    return makePathTracer(scene)->render(scene.cameras.at(0), size, options);
  }
  static glm::dvec3 mean(const Picture& p) {
    glm::dvec3 sum(0);
    for (const glm::vec4& pixel : p.linear) sum += glm::dvec3(pixel);
    return sum / double(p.linear.size());
  }
};

/// One texel that leans: tangent-space (204, 152, 230).
SceneImage leaning() {
  return {"leaning", 1, 1, false, {204, 152, 230, 255}};
}
double leaningCosine() {
  const glm::dvec3 s = 2.0 * glm::dvec3(204, 152, 230) / 255.0 - 1.0;
  return glm::normalize(s).z;
}

TEST_F(NormalMaps, LightOnBothSidesOfALeaningMap) {
  // A floor, double-sided, whose vertices' normals lean, too, with either handedness; suns all around it, looked at
  // from the side that they shine on.
  double least = 1;
  for (const float hand : {1.0f, -1.0f})
    for (const double side : {1.0, -1.0})
      for (const double degrees : {-70.0, -30.0, 0.0, 20.0, 50.0, 65.0, 80.0}) {
        SceneBuilder b;
        Material& m = b.scene.materials[0];
        m.baseColor = glm::vec4(0.5f);
        m.doubleSided = true;
        m.normalTexture.image = 0;
        b.scene.images.push_back(leaning());
        b.addQuad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8});
        const glm::vec3 normal = glm::normalize(glm::vec3(0.1f, 1, -0.2f));
        for (glm::vec3& n : b.scene.normals) n = normal;
        for (glm::vec4& t : b.scene.tangents)
          t = glm::vec4(glm::normalize(glm::vec3(1, 0, 0) - normal * normal.x), hand);
        const double a = degrees * kPi / 180;
        const glm::dvec3 towards = side * glm::normalize(glm::dvec3(std::sin(a), std::cos(a), 0.15));
        b.addLight(LightType::Sun, 10).direction = glm::vec3(-towards);
        b.addCamera({0, side * 3, 0}, {0, 0, 0}, 0.1f, {0, 0, -1});
        const Scene scene = b.finish();
        const double expected = traced(scene, {2, 2}, {.samples = 2, .centred = true}).lit.mean[0].x;
        Stage stage(context(), scene, small());
        const double drawn = stage.draw(VIEW_LIT, {2, 2}).at(0, 0).x;
        EXPECT_NEAR(drawn, expected, 1e-3 * expected + 1e-6) << hand << ", side " << side << ", " << degrees;
        const glm::dvec3 face(0, side, 0);
        if (expected > 0) least = std::min(least, expected / (0.5 * 10 / kPi * glm::dot(face, towards)));
      }
  EXPECT_LT(least, 0.9);  // something was in the shadow of bumps, or leaned away
}

/// Six walls that face inwards.
void addRoom(SceneBuilder& b, float half) {
  const glm::vec3 x(2 * half, 0, 0), y(0, 2 * half, 0), z(0, 0, 2 * half), lo(-half), hi(half);
  b.addQuad(lo, y, z);
  b.addQuad(lo, z, x);
  b.addQuad(lo, x, y);
  b.addQuad(hi, -z, -y);
  b.addQuad(hi, -x, -z);
  b.addQuad(hi, -y, -x);
}

/// A closed room whose walls emit M = 1 and reflect .8, under a map of 8 x 8 texels.
Scene bumpyRoom() {
  SceneBuilder b;
  Material& m = b.scene.materials[0];
  m.baseColor = glm::vec4(glm::vec3(0.8f), 1);
  m.emission = glm::vec3(float(1 / kPi));
  m.normalTexture.image = 0;
  SceneImage image{.name = "bumps", .width = 8, .height = 8, .srgb = false, .rgba = {}};
  for (uint32_t i = 0; i < 64; ++i) {
    const auto lean = [&](uint32_t by) { return static_cast<uint8_t>(128 + int(i * by % 97) - 48); };
    image.rgba.insert(image.rgba.end(), {lean(31), lean(57), 220, 255});
  }
  b.scene.images.push_back(image);
  addRoom(b, 1);
  b.addCamera({0.3, 0.2, 0.8}, {-0.4, -0.3, -1}, 1.2f);
  return b.finish();
}

/// A square whose normals lean to one side and to the other, texel by texel: their mean is flat, and what each leaves
/// is not 1.
void addRidges(SceneBuilder& b) {
  Material& m = b.scene.materials[0];
  m.baseColor = glm::vec4(glm::vec3(0.6f), 1);
  m.doubleSided = true;
  m.normalTexture.image = 0;
  m.normalTexture.sampler.linearMag = false;
  SceneImage image{.name = "ridges", .width = 128, .height = 128, .srgb = false, .rgba = {}};
  for (uint32_t i = 0; i < 128 * 128; ++i) {
    const bool left = (i + i / 128) % 2 != 0;
    image.rgba.insert(image.rgba.end(), {uint8_t(left ? 51 : 204), uint8_t(left ? 103 : 152), 230, 255});
  }
  b.scene.images.push_back(image);
  b.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
}

TEST_F(NormalMaps, FurnaceWithBumpsIsThatOfThePathTracer) {
  const Scene scene = bumpyRoom();
  const TracedPicture expected = traced(scene, {64, 64}, {.samples = 256});
  for (const bool kernels : {false, true}) {
    Lit lit(context(), scene, small());
    ForwardEffects effects;
    effects.kernels = kernels;
    const glm::dvec3 drawn = mean(lit.draw(VIEW_LIT, {64, 64}, effects)),
                     indirect = mean(lit.draw(VIEW_INDIRECT, {64, 64}, effects));
    printf("lit %.5f, path tracer %.5f +- %.5f; indirect %.5f, %.5f +- %.5f\n", drawn.x, expected.lit.pictureMean.x,
           expected.lit.pictureError.x, indirect.x, expected.indirect.pictureMean.x, expected.indirect.pictureError.x);
    EXPECT_NEAR(drawn.x, expected.lit.pictureMean.x, 4 * expected.lit.pictureError.x);
    EXPECT_NEAR(indirect.x, expected.indirect.pictureMean.x, 4 * expected.indirect.pictureError.x);
    EXPECT_LT(expected.lit.pictureError.x, 0.003 * expected.lit.pictureMean.x);
    EXPECT_LT(expected.lit.pictureMean.x, 0.9 / (1 - 0.8) / kPi);  // bumps take more than noise could
  }
}

TEST_F(NormalMaps, FacetsTakeTheMeanOfWhatBumpsLeave) {
  const double expected = 0.6 * double{keptOfEvenSky(float(leaningCosine()))};
  EXPECT_LT(expected, 0.59);
  for (const bool masked : {false, true}) {
    SceneBuilder b;
    addRidges(b);
    if (masked) {  // two of three columns are left
      b.scene.materials[0].alpha = AlphaMode::Mask;
      b.scene.materials[0].baseColorTexture.image = 1;
      b.scene.materials[0].baseColorTexture.sampler.linearMag = false;
      SceneImage mask{.name = "mask", .width = 24, .height = 1, .srgb = true, .rgba = {}};
      for (uint32_t i = 0; i < 24; ++i)
        mask.rgba.insert(mask.rgba.end(), {255, 255, 255, uint8_t(i % 3 != 0 ? 255 : 0)});
      b.scene.images.push_back(mask);
    }
    const Scene scene = b.finish();
    const SceneOnDevice device(context(), scene);
    const HostFacets facets = hostFacets(context(), makeFacets(context(), device, small()));
    ASSERT_GT(facets.albedo.size(), 256u);
    for (const glm::vec3& albedo : facets.albedo) ASSERT_NEAR(albedo.x, expected, 2e-3) << masked;
  }
}

TEST_F(NormalMaps, PixelsLargerThanTexelsTakeTheMean) {
  SceneBuilder b;
  addRidges(b);
  Material& lamp = b.newMaterial();
  lamp = Material{.emission = glm::vec3(float(1 / kPi)), .lambertian = true};
  lamp.baseColor = glm::vec4(0, 0, 0, 1);
  addRoom(b, 2);
  b.addCamera({0, 1.8, 0}, {0, 0, 0}, 0.8f, {0, 0, -1});  // 6 texels to a pixel
  const Scene scene = b.finish();
  const TracedPicture expected = traced(scene, {16, 16}, {.samples = 1024});
  Lit lit(context(), scene, small());
  const glm::dvec3 drawn = mean(lit.draw(VIEW_LIT, {16, 16}));
  printf("lit %.5f, path tracer %.5f +- %.5f\n", drawn.x, expected.lit.pictureMean.x, expected.lit.pictureError.x);
  EXPECT_NEAR(drawn.x, expected.lit.pictureMean.x, 4 * expected.lit.pictureError.x);
  EXPECT_LT(expected.lit.pictureMean.x, 0.95 * 0.6 / kPi);
}

}  // namespace
}  // namespace irad::test::normal_maps_suite
