// Light straight from emissive triangles, looked for by each pixel ("RE Emitters", sample.emitters = pixels), against
// closed forms in double precision.
#include <algorithm>
#include <numbers>
#include <random>
#include <string>

#include "gi/pixel_emitters.h"
#include "gi/subsystems.h"
#include "shaders/shared/pixel_emitters.h"
#include "tests/effects_fixture.h"

namespace irad::test::pixel_emitters_suite {
namespace {

/// Lambert's formula for the part of a triangle above the horizon of a point at 0, in double precision.
double formFactorTriangle(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& normal) {
  std::vector<glm::dvec3> above;
  for (size_t i = 0; i < 3; ++i) {
    const glm::dvec3 a = corners[i], b = corners[(i + 1) % 3];
    const double ha = glm::dot(a, normal), hb = glm::dot(b, normal);
    if (ha > 0) above.push_back(a);
    if ((ha > 0) != (hb > 0)) above.push_back(a + (b - a) * (ha / (ha - hb)));
  }
  double sum = 0;
  for (size_t i = 0; i < above.size(); ++i) {
    const glm::dvec3 a = glm::normalize(above[i]), b = glm::normalize(above[(i + 1) % above.size()]);
    const glm::dvec3 c = glm::cross(a, b);
    if (glm::length(c) > 0) sum += std::atan2(glm::length(c), glm::dot(a, b)) * glm::dot(glm::normalize(c), normal);
  }
  return std::abs(sum) / (2 * std::numbers::pi);
}

TEST(PolygonLight, ArcTangentToThreeTenMillionths) {
  double worst = 0;
  for (int i = -400; i <= 400; ++i) {
    const double x = std::pow(10.0, i / 50.0);
    const auto y = static_cast<float>(x);
    worst = std::max(worst, std::abs(arcTangent(y, 1.0f) / std::atan(static_cast<double>(y)) - 1));
  }
  printf("arcTangent: largest relative error %.2g\n", worst);
  EXPECT_LT(worst, 3e-7);
  EXPECT_FLOAT_EQ(arcTangent(1.0f, 0.0f), 0.5f * IRAD_PI);
  EXPECT_EQ(arcTangent(0.0f, 1.0f), 0.0f);
}

TEST(PolygonLight, TrianglesAboveAcrossAndBelowTheHorizon) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vec = [&] { return glm::dvec3(unit(random), unit(random), unit(random)); };
  double worst = 0, sum = 0;
  std::array<int, 4> cases{};
  for (int i = 0; i < 20'000; ++i) {
    // As the shader has them: in fp32.
    const glm::vec3 normal = glm::normalize(glm::vec3(vec()) + glm::vec3(0, 0, 1e-3f));
    const double size = std::pow(10.0, unit(random));
    const glm::dvec3 at = 3.0 * vec();
    const std::array<glm::vec3, 3> t{at + size * vec(), at + size * vec(), at + size * vec()};
    const double expected = formFactorTriangle({t[0], t[1], t[2]}, glm::normalize(glm::dvec3(normal)));
    const double error = std::abs(triangleFormFactor(t[0], t[1], t[2], normal) - expected);
    worst = std::max(worst, error);
    sum += error;
    ++cases[static_cast<size_t>(std::ranges::count_if(t, [&](const glm::vec3& v) { return glm::dot(v, normal) > 0; }))];
  }
  printf("form factors of triangles: largest error %.2g, mean %.2g\n", worst, sum / 20'000);
  EXPECT_LT(worst, 2e-5);  // of edges that all but pass through the point
  EXPECT_LT(sum / 20'000, 1e-7);
  for (const int n : cases) EXPECT_GT(n, 1000);  // none to three corners above
}

class PixelEmitters : public EffectsTest {
 protected:
  static constexpr uint32_t kSize = 64;
  static constexpr double kHalf = 1.0;  ///< of the picture, world units
  static Settings settings(EmitterLookup emitters = EmitterLookup::pixels) {
    Settings s = at(32, 64);
    s.specular.mode = SpecularMode::off;
    s.sample.emitters = emitters;
    return s;
  }
  /// Looks down at the floor from `height`.
  static Camera above(double height) {
    Camera camera;
    camera.position = {0, height, 0};
    camera.orientation = glm::quat(std::sqrt(0.5f), -std::sqrt(0.5f), 0, 0);
    camera.orthographic = true;
    camera.ymag = kHalf;
    camera.znear = 0.01f;
    return camera;
  }
  static glm::dvec3 onFloor(uint32_t x, uint32_t y) {
    return {((x + 0.5) / kSize * 2 - 1) * kHalf, 0, ((y + 0.5) / kSize * 2 - 1) * kHalf};
  }
  std::vector<glm::vec4> draw(Pipeline& pipeline, const Camera& camera, View view = VIEW_EMITTER_IRRADIANCE) {
    pipeline.prepare();
    Targets targets(context(), {kSize, kSize});
    Frame frame = context().begin();
    pipeline.render(frame, camera, view, targets);
    frame.submitAndWait();
    const std::vector<std::byte> raw = download(context(), targets.linear);
    std::vector<glm::vec4> out(size_t{kSize} * kSize);
    std::memcpy(out.data(), raw.data(), raw.size());
    return out;
  }
  std::vector<glm::vec4> draw(const Scene& scene, const Settings& s, const Camera& camera,
                              View view = VIEW_EMITTER_IRRADIANCE) {
    Pipeline pipeline(context(), scene, s);
    return draw(pipeline, camera, view);
  }
  using Quad = std::array<glm::dvec3, 4>;
  static double formFactor(const Quad& q, const glm::dvec3& p, const glm::dvec3& n) {
    return formFactorTriangle({q[0] - p, q[1] - p, q[2] - p}, n) +
           formFactorTriangle({q[0] - p, q[2] - p, q[3] - p}, n);
  }
  static void add(SceneBuilder& b, uint32_t material, const Quad& q, uint32_t n = 1) {
    b.quad(material, q[0], q[1], q[2], q[3], n);
  }
  /// Faces down; its sides lie on no voxel's.
  static constexpr Quad kLamp{glm::dvec3(-0.31, 1.03, -0.23), glm::dvec3(0.42, 1.03, -0.23),
                              glm::dvec3(0.42, 1.03, 0.37), glm::dvec3(-0.31, 1.03, 0.37)};
  static constexpr Quad kFloor{glm::dvec3(-1, 0, 1), glm::dvec3(1, 0, 1), glm::dvec3(1, 0, -1), glm::dvec3(-1, 0, -1)};
  static Scene lampAboveFloor(uint32_t cuts = 1) {
    SceneBuilder b;
    add(b, b.material(glm::vec3(0.5f)), kFloor);
    add(b, b.material(glm::vec3(0.1f), glm::vec3(3, 2, 1)), kLamp, cuts);
    return b.finish("lamp above a floor");
  }
};

TEST_F(PixelEmitters, ALampAboveAFloor) {
  const auto byPixels = draw(lampAboveFloor(), settings(), above(2)),
             byFacets = draw(lampAboveFloor(), settings(EmitterLookup::facets), above(2));
  double worst = 0, facetsWorst = 0;
  for (uint32_t y = 0; y < kSize; ++y)
    for (uint32_t x = 0; x < kSize; ++x) {
      const double f = formFactor(kLamp, onFloor(x, y), {0, 1, 0});
      const glm::dvec3 expected = f * glm::dvec3(3, 2, 1);
      for (int c = 0; c < 3; ++c) {
        worst = std::max(worst, std::abs(byPixels[y * kSize + x][c] / expected[c] - 1));
        facetsWorst = std::max(facetsWorst, std::abs(byFacets[y * kSize + x][c] / expected[c] - 1));
      }
    }
  printf("lamp above a floor: largest relative error %.2g by pixels, %.2g by facets\n", worst, facetsWorst);
  EXPECT_LT(worst, 1e-4);
  EXPECT_GT(facetsWorst, 1e-2);  // that is what pixel emitters are for
}

TEST_F(PixelEmitters, ALampThatGoesOnBehindTheHorizon) {
  // A wall that looks along +x, seen from there; a third of the lamp is behind its plane.
  const Quad wall{glm::dvec3(0, -0.4, 1), glm::dvec3(0, -0.4, -1), glm::dvec3(0, 0.8, -1), glm::dvec3(0, 0.8, 1)};
  SceneBuilder b;
  add(b, b.material(glm::vec3(0.5f)), wall);
  add(b, b.material(glm::vec3(0.1f), glm::vec3(2)), kLamp);
  Camera camera = above(0);
  camera.position = {2, 0, 0};
  camera.orientation = glm::quat(std::sqrt(0.5f), 0, std::sqrt(0.5f), 0);  // right: -z
  const auto picture = draw(b.finish("a lamp behind the horizon"), settings(), camera);
  double worst = 0;
  for (uint32_t y = 0; y < kSize; ++y)
    for (uint32_t x = 0; x < kSize; ++x) {
      const glm::dvec3 p(0, (1 - (y + 0.5) / kSize * 2) * kHalf, (1 - (x + 0.5) / kSize * 2) * kHalf);
      if (p.y < -0.4 || p.y > 0.8) continue;
      const double expected = 2 * formFactor(kLamp, p, {1, 0, 0});
      worst = std::max(worst, std::abs(picture[y * kSize + x].x / expected - 1));
    }
  printf("a lamp a third behind the horizon: largest relative error %.2g\n", worst);
  EXPECT_LT(worst, 3e-4);
}

TEST_F(PixelEmitters, UmbraAndPenumbra) {
  // A block below the lamp; the camera is below the block.
  SceneBuilder b;
  const uint32_t m = b.material(glm::vec3(0.5f));
  add(b, m, kFloor);
  b.box({m, m, m, m, m, m}, {-0.25f, 0.15f, -0.2f}, {0.25f, 0.27f, 0.3f}, /*inward=*/false);
  add(b, b.material(glm::vec3(0.1f), glm::vec3(1)), kLamp);
  const auto picture = draw(b.finish("umbra"), settings(), above(0.1));
  // Along an axis the shadow that a point of the lamp casts reaches at least as far as that of the block's top, and no
  // farther than that of its top or its bottom. Within `all` every point of the lamp casts its shadow, beyond `any`
  // none does. Shares that are seen are averaged over two pixels around.
  constexpr double kAround = 2.5 * 2 * kHalf / kSize;
  struct Range {
    double low, high;
    bool contains(double x) const { return x > low && x < high; }
  };
  const auto shadow = [](Range lamp, Range block) {
    Range all{-1e9, 1e9}, any{1e9, -1e9};
    for (const double from : {lamp.low, lamp.high}) {
      const auto cast = [&](double height) {
        const double t = 1.03 / (1.03 - height);
        return Range{from + (block.low - from) * t, from + (block.high - from) * t};
      };
      const Range top = cast(0.27), bottom = cast(0.15);
      all = {std::max(all.low, top.low + kAround), std::min(all.high, top.high - kAround)};
      any = {std::min({any.low, top.low - kAround, bottom.low - kAround}),
             std::max({any.high, top.high + kAround, bottom.high + kAround})};
    }
    return std::pair(all, any);
  };
  const auto [allX, anyX] = shadow({-0.31, 0.42}, {-0.25, 0.25});
  const auto [allZ, anyZ] = shadow({-0.23, 0.37}, {-0.2, 0.3});
  uint32_t dark = 0, bright = 0, between = 0;
  double worst = 0;
  for (uint32_t y = 0; y < kSize; ++y)
    for (uint32_t x = 0; x < kSize; ++x) {
      const glm::dvec3 p = onFloor(x, y);
      const float e = picture[y * kSize + x].x;
      const double f = formFactor(kLamp, p, {0, 1, 0});
      EXPECT_GE(e, 0);
      EXPECT_LE(e, 1.0001 * f);
      const bool umbra = allX.contains(p.x) && allZ.contains(p.z), lit = !anyX.contains(p.x) || !anyZ.contains(p.z);
      if (umbra) {
        ++dark;
        EXPECT_EQ(e, 0) << p.x << ", " << p.z;
      } else if (lit) {
        ++bright;
        worst = std::max(worst, std::abs(e / f - 1));
      } else {
        ++between;
      }
    }
  printf("umbra: %u pixels dark, %u lit to %.2g, %u between\n", dark, bright, worst, between);
  EXPECT_GT(dark, 20u);
  EXPECT_GT(bright, 500u);
  EXPECT_LT(worst, 1e-4);
}

TEST_F(PixelEmitters, BothSidesOfASheetEmit) {
  // The floor looks up at the sheet's back.
  for (const bool doubleSided : {false, true}) {
    SceneBuilder b;
    add(b, b.material(glm::vec3(0.5f)), kFloor);
    const Quad turned{kLamp[3], kLamp[2], kLamp[1], kLamp[0]};
    add(b, b.material(glm::vec3(0.1f), glm::vec3(1), doubleSided), turned);
    const auto picture = draw(b.finish("a sheet"), settings(), above(0.9));
    double worst = 0;
    for (uint32_t y = 0; y < kSize; ++y)
      for (uint32_t x = 0; x < kSize; ++x) {
        const double expected = doubleSided ? formFactor(kLamp, onFloor(x, y), {0, 1, 0}) : 0;
        worst = std::max(worst, std::abs(picture[y * kSize + x].x - expected));
      }
    EXPECT_LT(worst, 1e-4) << doubleSided;
  }
}

TEST_F(PixelEmitters, OnlyTheEmittersShareOfHChanges) {
  const Scene scene = mixedRoom();
  std::array<std::vector<glm::vec4>, 2> h, e;
  for (const int pixels : {0, 1}) {
    Settings s = settings(pixels == 1 ? EmitterLookup::pixels : EmitterLookup::facets);
    Pipeline pipeline(context(), scene, s);
    h.at(pixels) = EffectsTest::draw((pipeline.prepare(), pipeline), VIEW_IRRADIANCE);
    e.at(pixels) = EffectsTest::draw(pipeline, VIEW_EMITTER_IRRADIANCE);
  }
  float moved = 0;
  for (size_t i = 0; i < h[0].size(); ++i)
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(h[1][i][c] - h[0][i][c], e[1][i][c] - e[0][i][c], 1e-5f * (1 + h[0][i][c]));
      moved = std::max(moved, std::abs(e[1][i][c] - e[0][i][c]));
    }
  EXPECT_GT(moved, 0.01f);
}

TEST_F(PixelEmitters, WhatHHoldsOfEmittersIsTakenOutByTheGainThatItWasSolvedWith) {
  // At lambda .8 H holds .8 F M, also after nothing relights or the guard puts the old light back.
  Settings s = settings();
  s.solver.gpu.lambda = 0.8f;
  const Scene scene = mixedRoom();
  Pipeline pipeline(context(), scene, s);
  const auto picture = [&] {
    pipeline.prepare();
    return EffectsTest::draw(pipeline, VIEW_IRRADIANCE);
  };
  const auto by = picture();
  s.effects.relight = EffectMode::off;
  s.solver.gpu.lambda = 0.5f;
  pipeline.set(s);
  EXPECT_TRUE(same(picture(), by)) << "no light was solved";
  s.effects.relight = EffectMode::automatic;
  s.solver.gpu.lambda = 2;
  pipeline.set(s);
  const auto restored = picture();
  ASSERT_TRUE(pipeline.lighting().report.diverging);
  EXPECT_TRUE(same(restored, by)) << "the light from before";
}

TEST_F(PixelEmitters, ComeAndGoWithTheSetting) {
  Pipeline pipeline(context(), lampAboveFloor(), settings(EmitterLookup::facets));
  const auto facets = draw(pipeline, above(2), VIEW_LIT);
  recorded();
  EXPECT_FALSE(any(facts(pipeline), "has seen share of emitters"));
  EXPECT_GT(pipeline.set(settings()), Redo::Scatter) << "nothing is built again";
  const auto pixels = draw(pipeline, above(2), VIEW_LIT);
  timings().endFrame(0, /*setup=*/false, 0);
  EXPECT_TRUE(recorded().contains("RE Emitters"));
  EXPECT_FALSE(same(pixels, facets));
  EXPECT_TRUE(same(draw(pipeline, above(2), VIEW_LIT), pixels)) << "the same picture twice";
  EXPECT_TRUE(same(draw(lampAboveFloor(), settings(), above(2), VIEW_LIT), pixels)) << "and from the start";
  pipeline.set(settings(EmitterLookup::facets));
  EXPECT_TRUE(same(draw(pipeline, above(2), VIEW_LIT), facets));
}

TEST_F(PixelEmitters, AutoLooksWhereFacetsDiffer) {
  // A lamp less than a voxel above the floor: beside it light falls off within a voxel, further away slowly.
  SceneBuilder b;
  add(b, b.material(glm::vec3(0.5f)), kFloor);
  Quad low = kLamp;
  for (glm::dvec3& p : low) p.y = 0.05;
  add(b, b.material(glm::vec3(0.1f), glm::vec3(3)), low);
  const Scene scene = b.finish("lamp at a floor");
  const auto pixels = draw(scene, settings(), above(2)),
             facets = draw(scene, settings(EmitterLookup::facets), above(2)),
             automatic = draw(scene, settings(EmitterLookup::automatic), above(2));
  int asPixels = 0, asFacets = 0;
  for (size_t i = 0; i < pixels.size(); ++i) {
    const float p = pixels[i].x, f = facets[i].x, a = automatic[i].x;
    if (std::abs(p - f) < 0.05f * f) continue;
    // What a pixel's rays find is averaged with those around that look as well.
    asPixels += std::abs(a - p) < 0.1f * std::abs(p - f);
    asFacets += a == f;
  }
  EXPECT_GT(asPixels, 100);
  EXPECT_GT(asFacets, 100);
}

TEST_F(PixelEmitters, AutoLooksWhereSamplesLeaveFacetsInDoubt) {
  // Of two lamps far apart one sample of two goes to either: the facets' F M scatters, though by less than what tells a
  // lamp's shadow.
  SceneBuilder b;
  add(b, b.material(glm::vec3(0.5f)), kFloor);
  const uint32_t lamp = b.material(glm::vec3(0.1f), glm::vec3(3));
  for (const double x : {-0.9, 0.9}) {
    Quad side = kLamp;
    for (glm::dvec3& p : side) p = {p.x + x, 0.8, p.z};
    add(b, lamp, side);
  }
  const Scene scene = b.finish("two lamps");
  const auto apart = [&](EmitterLookup emitters, uint32_t samples) {
    Settings s = settings(emitters);
    s.matrix.emitterSamples = samples;
    s.matrix.emitterSampling = EffectMode::on;
    const auto truth = draw(scene, settings(), above(2)), picture = draw(scene, s, above(2));
    double error = 0, sum = 0;
    for (size_t i = 0; i < truth.size(); ++i) {
      error += std::pow(double{picture[i].x} - double{truth[i].x}, 2);
      sum += std::pow(double{truth[i].x}, 2);
    }
    return std::sqrt(error / sum);
  };
  const double facets = apart(EmitterLookup::facets, 8), automatic = apart(EmitterLookup::automatic, 8);
  fmt::print("two lamps, 8 samples: facets {:.4f}, auto {:.4f} of F M away from pixels\n", facets, automatic);
  EXPECT_GT(facets, 0.03);
  EXPECT_LT(automatic, 0.2 * facets);
}

TEST_F(PixelEmitters, FacetsServeWhereThereAreTooManyTriangles) {
  const auto one = draw(lampAboveFloor(), settings(), above(2));
  // 242 triangles in place of 2.
  const auto many = draw(lampAboveFloor(11), settings(), above(2));
  for (size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(many[i].x, one[i].x, 1e-4f * one[i].x);
  // 288.
  const Scene tooMany = lampAboveFloor(12);
  Pipeline pipeline(context(), tooMany, settings());
  EXPECT_TRUE(same(draw(pipeline, above(2)), draw(tooMany, settings(EmitterLookup::facets), above(2))));
  EXPECT_NE(pipeline.plan().row(Effect::emission).reason.find("do not look for 288 triangles"), std::string::npos);
  EXPECT_EQ(pipeline.obeyed().sample.emitters, EmitterLookup::facets);
}

TEST_F(PixelEmitters, WhatATextureLeavesDarkDoesNotCount) {
  // 288 triangles that would emit, but for their texture.
  SceneBuilder b;
  const uint32_t floor = b.material(glm::vec3(0.5f)), lamp = b.material(glm::vec3(0.1f), glm::vec3(3, 2, 1)),
                 dark = b.material(glm::vec3(0.5f), glm::vec3(1));
  add(b, floor, kFloor);
  add(b, lamp, kLamp);
  const glm::dvec3 below(0, -0.2, 0);
  add(b, dark, {kFloor[0] + below, kFloor[1] + below, kFloor[2] + below, kFloor[3] + below}, 12);
  Scene scene = b.finish("a dark texture");
  scene.images.push_back({.name = "black", .width = 1, .height = 1, .srgb = false, .rgba = {0, 0, 0, 255}});
  scene.materials.at(dark).emissiveTexture.image = 0;
  Pipeline pipeline(context(), scene, settings());
  const auto picture = draw(pipeline, above(0.9));
  EXPECT_TRUE(pipeline.plan().pixelEmitters);
  for (uint32_t y = 0; y < kSize; ++y)
    for (uint32_t x = 0; x < kSize; ++x) {
      const double expected = 3 * formFactor(kLamp, onFloor(x, y), {0, 1, 0});
      EXPECT_NEAR(picture[y * kSize + x].x, expected, 1e-4 * expected);
    }
}

TEST_F(PixelEmitters, TexturesAndMasksAreAveraged) {
  // The left half of the texture is white; one of the two triangles has a quarter of it, the other three.
  Scene scene = lampAboveFloor();
  scene.images.push_back({.name = "half", .width = 64, .height = 1, .srgb = false, .rgba = {}});
  for (int x = 0; x < 64; ++x)
    for (int c = 0; c < 4; ++c) scene.images.back().rgba.push_back(c == 3 || x < 32 ? 255 : 0);
  for (size_t i = 0; i < scene.positions.size(); ++i) scene.uv0.at(i) = {(scene.positions[i].x + 0.31f) / 0.73f, 0.5f};
  for (const bool mask : {false, true}) {
    Material& lamp = scene.materials.at(1);
    lamp.emissiveTexture.image = mask ? -1 : 0;
    lamp.baseColorTexture.image = -1;
    if (mask) {  // where the red channel would be dark, alpha is 0
      for (int x = 32; x < 64; ++x) scene.images.back().rgba[4 * x + 3] = 0;
      lamp.baseColorTexture.image = 0;
      lamp.alpha = AlphaMode::Mask;
      lamp.alphaCutoff = 0.5f;
    }
    const World w = world(scene, settings());
    const Buffer grid =
        makeBuffer<Grid>(context(), "grid", Subsystem::Voxels, std::span<const Grid>(&w.facets.grid, 1));
    const EmissiveTriangles list =
        listEmissiveTriangles(context(), *w.device, measure(scene, 32).materials, w.facets, grid);
    ASSERT_EQ(list.count, 2u);
    const auto triangles = downloadAs<EmissiveTriangle>(context(), list.triangles);
    const auto [low, high] = std::minmax(triangles[0].exitance.x, triangles[1].exitance.x);
    EXPECT_NEAR(low, 3 * 0.25f, 0.03f) << mask;
    EXPECT_NEAR(high, 3 * 0.75f, 0.03f) << mask;
    EXPECT_NEAR(glm::length(triangles[0].edge1), 0.73f * w.facets.grid.inverseEdge, 1e-3f);
  }
}

}  // namespace
}  // namespace irad::test::pixel_emitters_suite
