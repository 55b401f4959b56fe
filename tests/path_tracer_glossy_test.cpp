// The path tracer's full material (TraceOptions::glossy) and its bounces: the lobe by quadrature against the formulas
// of the literature written as others write them, pictures against closed forms. Means are held to three of their own
// standard errors.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "gi/check/path_lobe.h"
#include "gi/check/path_tracer.h"
#include "gi/check/scenes.h"
#include "tests/support.h"

namespace irad::test::path_tracer_glossy_suite {
namespace {

constexpr double kPi = std::numbers::pi;
using truth::Lobe;

glm::dvec3 direction(double cosine, double phi) {
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

/// The BRDF as glTF 2.0, appendix B, writes it: D by the cosine, V = G / (4 n.l n.v) with two roots.
double gltfBrdf(double f0, double roughness, const glm::dvec3& n, const glm::dvec3& v, const glm::dvec3& l) {
  const double a2 = std::pow(roughness, 4), nl = glm::dot(n, l), nv = glm::dot(n, v);
  if (nl <= 0 || nv <= 0) return 0;
  const glm::dvec3 h = glm::normalize(v + l);
  const double nh = glm::dot(n, h), d = a2 / (kPi * std::pow(nh * nh * (a2 - 1) + 1, 2)),
               vis = 0.5 / (nl * std::sqrt(nv * nv * (1 - a2) + a2) + nv * std::sqrt(nl * nl * (1 - a2) + a2));
  return (f0 + (1 - f0) * std::pow(1 - glm::dot(v, h), 5)) * d * vis;
}

/// What the lobe reflects of an even light, by quadrature over half vectors: their slopes are spread as D has them, so
/// that narrow lobes need no more points than wide ones.
double reflectanceOf(double f0, double roughness, double cosine) {
  const glm::dvec3 v = direction(cosine, 0), n(0, 0, 1);
  const double alpha = roughness * roughness;
  constexpr int kSteps = 600;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double u = (i + 0.5) / kSteps, tangent2 = alpha * alpha * u / (1 - u), nh = 1 / std::sqrt(1 + tangent2);
      const glm::dvec3 h = direction(nh, 2 * kPi * (j + 0.5) / kSteps), l = 2 * glm::dot(v, h) * h - v;
      if (l.z <= 0 || glm::dot(v, h) <= 0) continue;
      const double d = alpha * alpha / (kPi * std::pow(nh * nh * (alpha * alpha - 1) + 1, 2));
      // Half vectors have the density D n.h here, directions 1 / (4 v.h) of it.
      sum += gltfBrdf(f0, roughness, n, v, l) * l.z * 4 * glm::dot(v, h) / (d * nh);
    }
  return sum / kSteps / kSteps;
}

TEST(PathLobe, IsThatOfGltf) {
  truth::Random random(1, 2);
  for (const double roughness : {0.05, 0.3, 0.6, 1.0})
    for (int i = 0; i < 200; ++i) {
      const glm::dvec3 n = glm::normalize(direction(2 * random.next() - 1, 2 * kPi * random.next()));
      const glm::dmat3 frame = truth::frameAbout(n);
      const glm::dvec3 v = frame * direction(0.05 + 0.95 * random.next(), 2 * kPi * random.next()),
                       l = frame * direction(0.01 + 0.99 * random.next(), 2 * kPi * random.next());
      const double known = gltfBrdf(0.3, roughness, n, v, l), value = Lobe(glm::dvec3(0.3), roughness, n, v).value(l).x;
      EXPECT_NEAR(value, known, 1e-9 * known + 1e-12) << roughness;
      // The same from both ends.
      EXPECT_NEAR(Lobe(glm::dvec3(0.3), roughness, n, l).value(v).x, value, 1e-9 * value + 1e-15) << roughness;
    }
  EXPECT_EQ(Lobe(glm::dvec3(1), 0.5, {0, 0, 1}, {0, 0, 1}).value({0.6, 0, -0.8}), glm::dvec3(0)) << "from below";
}

TEST(PathLobe, ReflectsNoMoreThanItGetsAndAsManyRaysAsItSays) {
  const glm::dvec3 n(0, 0, 1);
  truth::Random random(3, 4);
  for (const double roughness : {0.1, 0.3, 0.6, 1.0})
    for (const double cosine : {0.1, 0.5, 1.0}) {
      const double known = reflectanceOf(1, roughness, cosine);
      EXPECT_LE(known, 1 + 1e-4) << roughness << " " << cosine;
      EXPECT_GT(known, 0.3) << roughness << " " << cosine;
      // By its own directions: the mean weight is the reflectance, and no weight is above 1.
      const Lobe lobe(glm::dvec3(1), roughness, n, direction(cosine, 0.7));
      double sum = 0, squares = 0, most = 0;
      constexpr int kDraws = 40'000;
      std::array<int, 4> inQuarter{};
      for (int i = 0; i < kDraws; ++i) {
        const glm::dvec3 l = lobe.draw(random);
        const double w = l.z > 0 ? lobe.value(l).x * l.z / lobe.density(l) : 0;
        sum += w;
        squares += w * w;
        most = std::max(most, w);
        if (l.z > 0) ++inQuarter[(l.x > 0) + 2 * (l.y > 0)];
      }
      const double mean = sum / kDraws, error = std::sqrt((squares / kDraws - mean * mean) / kDraws);
      EXPECT_NEAR(mean, known, 4 * error + 1e-3) << roughness << " " << cosine;
      EXPECT_LE(most, 1 + 1e-9);
      // The density by quadrature, a quarter of the hemisphere at a time: how many draws lie there.
      if (roughness < 0.3) continue;
      constexpr int kSteps = 800;
      std::array<double, 4> share{};
      for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
          const glm::dvec3 l = direction((i + 0.5) / kSteps, 2 * kPi * (j + 0.5) / kSteps);
          share[(l.x > 0) + 2 * (l.y > 0)] += lobe.density(l) * 2 * kPi / kSteps / kSteps;
        }
      for (size_t q = 0; q < 4; ++q) {
        const double p = share[q], n = kDraws;
        EXPECT_NEAR(inQuarter[q] / n, p, 4 * std::sqrt(p * std::max(1 - p, 1e-3) / n) + 1e-3)
            << roughness << " " << cosine << " quarter " << q;
      }
    }
}

class PathTracingGlossy : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  }
};

/// Looks along a direction without perspective, `half` to each side of the origin, which it is `away` from.
Camera along(glm::dvec3 way, double away, float half) {
  way = glm::normalize(way);
  const glm::vec3 up = std::abs(way.y) > 0.9 ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
  return {.name = "plan",
          .position = -away * way,
          .orientation = glm::quatLookAt(glm::vec3(way), up),
          .orthographic = true,
          .ymag = half,
          .znear = 1e-4f};
}

/// Of material 0, in the plane y = 0.
SceneBuilder floorOf(glm::vec3 base, float metallic, float roughness) {
  SceneBuilder b;
  const uint32_t m = b.material(base);
  b.edit(m).metallic = metallic;
  b.edit(m).roughness = roughness;
  b.quad(m, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
  return b;
}
/// The same in the middle of a closed black box of lamps of radiance 1, or those given (-x +x -y +y -z +z).
Scene amidLamps(SceneBuilder b, std::array<float, 6> radiance = {1, 1, 1, 1, 1, 1}) {
  std::vector<uint32_t> walls;
  for (const float l : radiance) {
    walls.push_back(b.material(glm::vec3(0), glm::vec3(l * static_cast<float>(kPi)), /*doubleSided=*/true));
    b.edit(walls.back()).lambertian = true;
  }
  b.box(walls, {-3, -3, -3}, {3, 3, 3}, /*inward=*/true);
  return b.finish("lamps");
}

TracedPicture traced(const Scene& scene, const Camera& camera, uint32_t edge, const TraceOptions& options) {
  return makePathTracer(scene)->render(camera, {edge, edge}, options);
}

void expectMean(const TracedLight& light, double expected, double relative, const char* what) {
  const double mean = light.pictureMean.x, error = light.pictureError.x;
  printf("%s: %.6g +- %.2g, expected %.6g\n", what, mean, error, expected);
  EXPECT_NEAR(mean, expected, 3 * error + 2e-5 * expected) << what;
  EXPECT_LE(error, relative * expected) << what << ": too noisy to say anything";
}

TEST_F(PathTracingGlossy, AnEvenLightShowsTheReflectance) {
  for (const float roughness : {0.1f, 0.4f, 1.0f})
    for (const double slope : {0.0, 1.7}) {
      const double cosine = 1 / std::sqrt(1 + slope * slope);
      const Camera camera = along({slope, -1, 0}, 2, 0.2f);
      const TraceOptions options{.samples = 128, .glossy = true};
      expectMean(traced(amidLamps(floorOf(glm::vec3(1), 1, roughness)), camera, 16, options).lit,
                 reflectanceOf(1, double{roughness}, cosine), 0.005, "white metal");
      const TracedPicture both = traced(amidLamps(floorOf(glm::vec3(0.5f), 0, roughness)), camera, 16, options);
      const double lobe = reflectanceOf(0.04, double{roughness}, cosine);
      expectMean(both.lit, 0.5 + lobe, 0.005, "of .5, with a coat");
      expectMean(both.indirect, 0.5, 0.005, "its diffuse part");
      expectMean(both.specular, lobe, 0.05, "its lobe");
    }
}

TEST_F(PathTracingGlossy, AMirrorShowsWhatLiesBehindItself) {
  // Every wall has a radiance of its own; the camera looks down towards +x, the mirror up at that wall.
  const std::array<float, 6> walls{1, 2, 3, 4, 5, 6};
  const glm::vec3 gold(0.9f, 0.6f, 0.3f);
  const Camera camera = along({1, -0.5, 0}, 2, 0.1f);
  for (const float metallic : {1.0f, 0.0f}) {
    // Without metal a black base, so that the lobe is alone.
    const glm::vec3 base = metallic > 0 ? gold : glm::vec3(0);
    const TracedPicture p =
        traced(amidLamps(floorOf(base, metallic, 0), walls), camera, 4, {.samples = 4, .glossy = true});
    for (int c = 0; c < 3; ++c) {
      const double f0 = metallic > 0 ? double{gold[c]} : 0.04,
                   f = f0 + (1 - f0) * std::pow(1 - 0.5 / std::sqrt(1.25), 5);
      for (const glm::dvec3& l : p.lit.mean) EXPECT_NEAR(l[c], 2 * f, 1e-6) << c;
      for (const glm::dvec3& l : p.indirect.mean) EXPECT_EQ(l[c], 0);
    }
  }
  // A known sky in place of walls, an even one of radiance 2.
  SkyTexels texels{.size = {8, 4}, .texels = std::vector<glm::vec3>(32, glm::vec3(2))};
  Sky sky;
  sky.whole = std::make_shared<const SkyTexels>(texels);
  sky.scale = glm::vec3(1);
  const TracedPicture p = makePathTracer(floorOf(glm::vec3(1), 1, 0).finish("mirror"), sky)
                              ->render(camera, {4, 4}, {.samples = 4, .glossy = true});
  for (const glm::dvec3& l : p.lit.mean) EXPECT_NEAR(l.x, 2, 1e-9);
}

TEST_F(PathTracingGlossy, MirrorsFaceToFace) {
  // Both of F0 = .7, the upper one shines: L = f + f^3 + f^5 + ... seen from between them, straight down.
  const double f = double{0.7f};
  SceneBuilder b = floorOf(glm::vec3(0.7f), 1, 0);
  const uint32_t lamp = b.material(glm::vec3(0.7f), glm::vec3(static_cast<float>(kPi)));
  b.edit(lamp).metallic = 1;
  b.edit(lamp).roughness = 0;
  b.quad(lamp, {-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1});
  const TracedPicture p =
      traced(b.finish("mirrors"), along({0, -1, 0}, 0.5, 0.5f), 16, {.samples = 256, .glossy = true, .bounces = 7});
  expectMean(p.lit, f / (1 - f * f), 0.005, "mirrors face to face");
  for (size_t k = 0; k < 7; ++k)
    if (k % 2 == 0)
      expectMean(p.bounces[k], std::pow(f, static_cast<double>(k) + 1), 0.02, "by bounces");
    else
      EXPECT_EQ(p.bounces[k].pictureMean.x, 0) << k;
}

TEST_F(PathTracingGlossy, OfWhatIsSeenAlone) {
  // A ceiling of .5 that a white metal floor shines at: with the lobe of the ceiling alone the floor is black.
  SceneBuilder b = floorOf(glm::vec3(1), 1, 0.5f);
  b.quad(b.material(glm::vec3(0.5f)), {-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1});
  b.point({0.9, 0.5, 0}, 10);
  const Scene scene = b.finish("floor and ceiling");
  const TraceOptions all{.samples = 64, .glossy = true}, seen{.samples = 64, .glossy = true, .glossySeen = true};
  const Camera up = along({0, 1, 0}, -0.5, 0.2f), down = along({0, -1, 0}, 0.5, 0.2f);
  const TracedPicture a = traced(scene, up, 8, all), s = traced(scene, up, 8, seen);
  EXPECT_GT(a.indirect.pictureMean.x, 10 * a.indirect.pictureError.x);
  EXPECT_EQ(s.indirect.pictureMean.x, 0);
  EXPECT_NEAR(s.lit.pictureMean.x, a.lit.pictureMean.x - a.indirect.pictureMean.x - a.specular.pictureMean.x, 1e-9);
  // The floor is seen as ever, in the light that the ceiling gives back.
  EXPECT_GT(traced(scene, down, 8, seen).specular.pictureMean.x, 0);
  EXPECT_EQ(traced(scene, down, 8, seen).indirect.pictureMean.x, 0);
}

TEST_F(PathTracingGlossy, HighlightsOnARoughPlane) {
  const glm::dvec3 n(0, 1, 0), way = glm::normalize(glm::dvec3(1, -1.2, 0.3));
  for (const float roughness : {0.0f, 0.2f, 0.7f})
    for (const float metallic : {0.0f, 0.6f}) {
      Scene scene = floorOf(glm::vec3(0.5f), metallic, roughness).finish("floor");
      const double f0 = 0.04 + (0.5 - 0.04) * double{metallic}, albedo = 0.5 * (1 - double{metallic});
      const auto expect = [&](const char* what, const glm::dvec3& towards, double irradiance) {
        const TracedPicture p = traced(scene, along(way, 2, 1e-4f), 1, {.samples = 2, .centred = true, .glossy = true});
        // As narrow as .002, and no narrower.
        const double seen = std::max(double{roughness}, std::sqrt(0.002));
        const double known = irradiance * glm::dot(n, towards) * (albedo / kPi + gltfBrdf(f0, seen, n, -way, towards));
        EXPECT_NEAR(p.lit.mean[0].x, known, 2e-5 * known) << what << " " << roughness << " " << metallic;
        EXPECT_EQ(p.indirect.mean[0].x, 0);
        EXPECT_EQ(p.specular.mean[0].x, 0);
      };
      // Near the mirror's direction, and exactly there.
      const glm::dvec3 near = glm::normalize(glm::dvec3(1, 1.25, 0.35)), mirror(way.x, -way.y, way.z);
      for (const glm::dvec3& l : {near, mirror}) {
        scene.lights = {{.type = LightType::Sun, .direction = glm::vec3(-l), .intensity = 10}};
        if (roughness > 0 || l == near)  // in single precision a peak of 8e4 falls by 1e-4
          expect("sun", -glm::dvec3(glm::normalize(scene.lights[0].direction)), 10);
        scene.lights = {{.type = LightType::Point, .position = scene.origin + 2.0 * l, .intensity = 10}};
        if (roughness > 0 || l == near) expect("point", l, 10.0 / 4);
      }
    }
}

/// A room with all kinds of light and a mirror, metals and coats.
Scene glossyRoom() {
  SceneBuilder b = lampRoom();
  const auto add = [&](glm::vec3 base, float metallic, float roughness, glm::vec3 at, float size) {
    const uint32_t m = b.material(base);
    b.edit(m).metallic = metallic;
    b.edit(m).roughness = roughness;
    b.box(std::vector<uint32_t>(6, m), at - size, at + size, /*inward=*/false);
  };
  add({0.9f, 0.7f, 0.5f}, 1, 0.3f, {0.5f, -0.7f, -0.3f}, 0.25f);
  add({0.3f, 0.5f, 0.7f}, 0, 0.4f, {-0.6f, -0.6f, 0.2f}, 0.2f);
  add({0.8f, 0.8f, 0.8f}, 1, 0.7f, {0.1f, -0.8f, 0.6f}, 0.15f);
  b.point({0.3, 0.5, 0.2}, 0.5f);
  return b.finish("glossy room");
}

TEST_F(PathTracingGlossy, AllWaysToFindLightAgree) {
  const Scene scene = glossyRoom();
  Sky none;
  std::array<TracedPicture, 3> p;
  for (const TraceStrategy s : {TraceStrategy::both, TraceStrategy::lights, TraceStrategy::bounces})
    p[static_cast<size_t>(s)] =
        traced(scene, scene.cameras[0], 24,
               {.samples = 192, .seed = 5 + static_cast<uint64_t>(s), .glossy = true, .strategy = s});
  const auto expectAgree = [](const TracedLight& a, const TracedLight& b, const char* what) {
    for (int c = 0; c < 3; ++c) {
      const double sigma = std::hypot(a.pictureError[c], b.pictureError[c]);
      EXPECT_NEAR(a.pictureMean[c], b.pictureMean[c], 3 * sigma) << what << c;
      EXPECT_LT(sigma, 0.05 * b.pictureMean[c]) << what << ": too noisy to say anything";
    }
  };
  for (const size_t s : {1u, 2u}) {
    printf("lit %.5f +- %.5f, %.5f +- %.5f\n", p[0].lit.pictureMean.x, p[0].lit.pictureError.x, p[s].lit.pictureMean.x,
           p[s].lit.pictureError.x);
    expectAgree(p[0].lit, p[s].lit, "lit");
    expectAgree(p[0].indirect, p[s].indirect, "indirect");
    expectAgree(p[0].specular, p[s].specular, "specular");
  }
  EXPECT_LT(p[0].lit.pictureError.x, p[1].lit.pictureError.x);
  EXPECT_LT(p[0].lit.pictureError.x, p[2].lit.pictureError.x);
}

TEST_F(PathTracingGlossy, SkiesFoundInAllWaysAgree) {
  // Bright in one corner; on a rough metal floor that leans away.
  SkyTexels texels{.size = {32, 16}, .texels = std::vector<glm::vec3>(512, glm::vec3(0.5f))};
  for (const size_t at : {130u, 131u, 162u, 163u}) texels.texels[at] = glm::vec3(40, 30, 20);
  Sky sky;
  sky.whole = std::make_shared<const SkyTexels>(texels);
  sky.scale = glm::vec3(1);
  const Scene scene = floorOf({0.9f, 0.8f, 0.7f}, 0.5f, 0.35f).finish("floor");
  const auto tracer = makePathTracer(scene, sky);
  std::array<TracedPicture, 3> p;
  for (const TraceStrategy s : {TraceStrategy::both, TraceStrategy::lights, TraceStrategy::bounces})
    p[static_cast<size_t>(s)] = tracer->render(along({0.5, -1, 0.2}, 2, 0.3f), {16, 16},
                                               {.samples = 1024, .seed = 9, .glossy = true, .strategy = s});
  for (const size_t s : {1u, 2u})
    for (int c = 0; c < 3; ++c) {
      const double sigma = std::hypot(p[0].lit.pictureError[c], p[s].lit.pictureError[c]);
      EXPECT_NEAR(p[0].lit.pictureMean[c], p[s].lit.pictureMean[c], 3 * sigma) << s;
      EXPECT_LT(sigma, 0.03 * p[0].lit.pictureMean[c]) << "too noisy to say anything";
    }
}

TEST_F(PathTracingGlossy, LambertianMaterialsGiveTheBitsOfTheDiffuseOne) {
  Scene scene = glossyRoom();
  for (Material& m : scene.materials) m.lambertian = true, m.metallic = 0, m.roughness = 1;
  const TracedPicture glossy = traced(scene, scene.cameras[0], 16, {.samples = 16, .glossy = true}),
                      diffuse = traced(scene, scene.cameras[0], 16, {.samples = 16});
  EXPECT_EQ(glossy.lit.mean, diffuse.lit.mean);
  EXPECT_EQ(glossy.indirect.mean, diffuse.indirect.mean);
  EXPECT_EQ(glossy.rays, diffuse.rays);
  EXPECT_EQ(glossy.specular.pictureMean, glm::dvec3(0));
  EXPECT_TRUE(diffuse.specular.mean.empty());
}

TEST_F(PathTracingGlossy, TheSameSumsFromAnyNumberOfThreadsAndCalls) {
  const Scene scene = glossyRoom();
  TracedSums whole, parts;
  const TraceOptions options{.samples = 12, .threads = 1, .glossy = true, .bounces = 3};
  makePathTracer(scene)->add(scene.cameras[0], {16, 16}, options, whole);
  for (const uint32_t n : {5u, 7u})
    makePathTracer(scene)->add(scene.cameras[0], {16, 16}, {.samples = n, .threads = 3, .glossy = true, .bounces = 3},
                               parts);
  EXPECT_EQ(whole.lit, parts.lit);
  EXPECT_EQ(whole.specular, parts.specular);
  EXPECT_EQ(whole.bounces, parts.bounces);
}

// ---- Bounces, of diffuse surfaces ----

TEST_F(PathTracingGlossy, BouncesInAFurnaceAreAGeometricSeries) {
  // Emission M = 1 everywhere: what came after k reflections is rho^(k + 1) / pi, and [0] has what is emitted, too.
  const double rho = 0.6f;
  const Scene scene = furnaceBox(0.6f);
  const TracedPicture p = traced(scene, scene.cameras[0], 16, {.samples = 256, .bounces = 6}),
                      none = traced(scene, scene.cameras[0], 16, {.samples = 256});
  EXPECT_EQ(p.lit.mean, none.lit.mean) << "counting changes nothing";
  double sum = 0;
  for (size_t k = 0; k < 6; ++k) {
    const double known = (std::pow(rho, static_cast<double>(k) + 1) + (k == 0 ? 1 : 0)) / kPi;
    expectMean(p.bounces[k], known, 0.02, "bounce");
    sum += p.bounces[k].pictureMean.x;
  }
  expectMean(p.lit, 1 / (1 - rho) / kPi, 0.005, "all of them");
  EXPECT_NEAR((p.lit.pictureMean.x - sum) * kPi, std::pow(rho, 7) / (1 - rho), 0.01);
}

TEST_F(PathTracingGlossy, BouncesInAnIntegratingSphere) {
  // I = 10 cd in the middle of radius 2: E = 2.5 straight, rho^k E after k reflections.
  const double rho = 0.7f;
  SceneBuilder b;
  b.sphere(b.material(glm::vec3(0.7f)), glm::vec3(0), 2, /*inward=*/true, /*rings=*/256);
  Scene scene = b.finish("sphere");
  scene.lights = {{.type = LightType::Point, .position = scene.origin, .intensity = 10}};
  const Camera camera{.position = scene.origin + glm::dvec3(0.5, 0.3, 0), .yfov = 1.5f, .znear = 0.01f};
  const TracedPicture p = traced(scene, camera, 24, {.samples = 64, .bounces = 5});
  for (size_t k = 0; k < 5; ++k) {
    const double known = rho * std::pow(rho, static_cast<double>(k)) * 2.5 / kPi, mean = p.bounces[k].pictureMean.x;
    // The chords of 256 rings lie within 1 - cos(pi / 512) of the sphere.
    EXPECT_NEAR(mean, known, 3 * p.bounces[k].pictureError.x + 1e-4 * known) << k;
    EXPECT_LT(p.bounces[k].pictureError.x, 0.01 * known) << k;
  }
  glm::dvec3 sum(0);
  for (const TracedLight& bounce : p.bounces) sum += bounce.pictureMean;
  EXPECT_LT(sum.x, p.lit.pictureMean.x);
}

}  // namespace
}  // namespace irad::test::path_tracer_glossy_suite
