// The registry of views and what each draws: composition, colour map, voxels, odd values.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "gi/emitters.h"
#include "gi/host_matrix.h"
#include "shaders/shared/view.h"
#include "tests/lit_stage.h"

namespace irad::test::views_suite {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

class Views : public GpuTest {};

/// A closed-looking corner: floor and back wall of albedo .5 and (.2, .4, .8), one sun.
Scene cornerScene(float emission = 0) {
  SceneBuilder b;
  b.scene.materials[0].baseColor = {0.5f, 0.5f, 0.5f, 1};
  b.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
  Material& wall = b.newMaterial();
  wall.baseColor = {0.2f, 0.4f, 0.8f, 1};
  wall.emission = glm::vec3(emission);
  b.addQuad({-2, 0, -2}, {4, 0, 0}, {0, 4, 0});
  b.addLight(LightType::Sun, kPi).direction = glm::normalize(glm::vec3(0.2f, -1, -0.6f));
  b.addCamera({0, 2, 8}, {0, 1.5, 0}, 0.6f);
  return b.finish();
}

Settings smallSettings() {
  Settings s;
  s.voxel.resolution = 16;
  s.matrix.gpu.rays = 64;
  return s;
}

TEST(ViewRegistry, EnumeratesWhatTheIssueAsksFor) {
  std::set<std::string> names;
  for (size_t i = 0; i < views().size(); ++i) {
    const ViewInfo& info = views()[i];
    EXPECT_EQ(info.view, i) << info.name;  // identifiers are the rows' numbers
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_EQ(findView(info.name), info.view);
    EXPECT_FALSE(std::string(info.label).empty());
    EXPECT_FALSE(std::string(info.group).empty());
    EXPECT_TRUE(!info.hasRange() || info.rangeMin <= info.rangeMax) << info.name;
  }
  for (const char* name : {"lit", "no-gi", "direct", "indirect", "specular", "voxel-albedo", "voxel-normal", "distance",
                           "irradiance", "radiosity", "row-occupancy", "pin-holes", "distance-jfa",
                           "distance-chebyshev", "jfa-seeds", "jfa-error", "shadow-map", "error"})
    EXPECT_TRUE(findView(name)) << name;
  EXPECT_FALSE(findView("lot"));
}

TEST(ViewRegistry, EveryViewIsDrawnFromSomething) {
  constexpr uint32_t kVolumes = FROM_FACETS | FROM_FACET_VALUES | FROM_MATRIX | FROM_ANY_FIELD;
  for (const ViewInfo& info : views()) {
    EXPECT_NE(info.from, 0u) << info.name;
    // A volume is seen as a shape, but where it is held against a surface in the picture.
    EXPECT_EQ(info.shape.has_value(), info.isFrom(kVolumes) && !info.isFrom(FROM_DEPTH)) << info.name;
    EXPECT_EQ(resolveShape(info.view, ViewShape::automatic), info.shape) << info.name;
    // One set of values per facet, one field, one of everything else.
    for (const uint32_t only : {FROM_FACET_VALUES, FROM_ANY_FIELD})
      EXPECT_LE(std::popcount(info.from & only), 1) << info.name;
    // What qualifies another source stands beside it.
    EXPECT_TRUE(!info.isFrom(FROM_EXACT) || info.isFrom(FROM_ANY_FIELD)) << info.name;
    for (const uint32_t light : {FROM_EMITTED, FROM_DIRECT_LIGHT, FROM_INDIRECT_LIGHT, FROM_REFLECTIONS})
      EXPECT_TRUE(!info.isFrom(light) || info.isFrom(FROM_TARGETS)) << info.name;
  }
}

TEST_F(Views, UnknownIsMagenta) {
  Stage stage(context(), cornerScene());
  const Picture p = stage.draw(9999, {16, 16});
  for (size_t i = 0; i < p.linear.size(); ++i) {
    ASSERT_EQ(p.linear[i], glm::vec4(1, 0, 1, 1));
    ASSERT_EQ(p.display[4 * i], 255);
    ASSERT_EQ(p.display[4 * i + 1], 0);
    ASSERT_EQ(p.display[4 * i + 2], 255);
  }
}

TEST_F(Views, EveryOneDrawsSomethingFinite) {
  Lit lit(context(), cornerScene(0.5f), smallSettings());
  for (const ViewInfo& info : views()) {
    const Picture p = lit.draw(info.view);
    double sum = 0;
    for (const glm::vec4& c : p.linear) {
      ASSERT_TRUE(std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z)) << info.name;
      sum += std::abs(c.x) + std::abs(c.y) + std::abs(c.z);
    }
    // The corner's materials are Lambertian, no ray of it starts behind a surface, it is covered, there is no oracle
    // for it and no picture, no sky, and nothing is written back; the Chebyshev field is exact, and jump flooding may
    // be; a matrix has no standard error.
    const std::set<View> maybeZero{VIEW_SPECULAR,  VIEW_INVALID_RAYS,      VIEW_PIN_HOLES,
                                   VIEW_REFERENCE, VIEW_JFA_ERROR,         VIEW_CHEBYSHEV_ERROR,
                                   VIEW_ERROR,     VIEW_STANDARD_ERROR,    VIEW_REFERENCE_PICTURE,
                                   VIEW_WRITEBACK, VIEW_WRITEBACK_WRITERS, VIEW_SKY_IRRADIANCE};
    EXPECT_TRUE(sum > 0 || maybeZero.contains(info.view)) << info.name;
  }
}

TEST_F(Views, LitIsTheSumOfItsParts) {
  Lit lit(context(), cornerScene(), smallSettings());
  const Picture all = lit.draw(VIEW_LIT), direct = lit.draw(VIEW_DIRECT), indirect = lit.draw(VIEW_INDIRECT),
                specular = lit.draw(VIEW_SPECULAR), h = lit.draw(VIEW_IRRADIANCE), albedo = lit.draw(VIEW_ALBEDO);
  double brightest = 0;
  for (size_t i = 0; i < all.linear.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      ASSERT_NEAR(all.linear[i][c], direct.linear[i][c] + indirect.linear[i][c] + specular.linear[i][c], 1e-5);
      ASSERT_NEAR(indirect.linear[i][c], albedo.linear[i][c] * h.linear[i][c] / kPi, 1e-5);
      brightest = std::max<double>(brightest, indirect.linear[i][c]);
    }
  EXPECT_GT(brightest, 0.01);  // light does go from floor to wall
  EXPECT_EQ(lit.draw(VIEW_NO_GI).linear, direct.linear);
}

TEST_F(Views, RepeatIsBitEqual) {
  Settings settings = smallSettings();
  Lit lit(context(), cornerScene(), settings);
  for (const View view : {VIEW_LIT, VIEW_SPECULAR, VIEW_RADIOSITY, VIEW_DISTANCE, VIEW_DEPTH, VIEW_JFA_FIELD_ERROR}) {
    const Picture a = lit.draw(view), b = lit.draw(view);
    EXPECT_TRUE(a.linear == b.linear);
    EXPECT_EQ(a.display, b.display);
  }
}

TEST_F(Views, VoxelsShowTheFacets) {
  // The wall's cells show its albedo, its normal +Z, and (emission .5) M = .5 pi; the picture's middle column meets it.
  Lit lit(context(), cornerScene(0.5f), smallSettings());
  const auto middle = [&](View view) { return lit.draw(view).at(32, 8); };
  const glm::vec4 albedo = middle(VIEW_VOXEL_ALBEDO);
  EXPECT_NEAR(albedo.x, 0.2, 1e-3);
  EXPECT_NEAR(albedo.y, 0.4, 1e-3);
  EXPECT_NEAR(albedo.z, 0.8, 1e-3);
  EXPECT_NEAR(middle(VIEW_VOXEL_NORMAL).z, 1, 1e-4);
  EXPECT_NEAR(middle(VIEW_VOXEL_EMISSION).x, 0.5 * kPi, 1e-3);
  EXPECT_GE(middle(VIEW_FACET_COUNT).x, 1);
  // B = M + rho (D + H): at least M.
  EXPECT_GE(middle(VIEW_RADIOSITY).z, 0.5 * kPi);
  const float sum = middle(VIEW_ROW_SUM).x, occupancy = middle(VIEW_ROW_OCCUPANCY).x;
  EXPECT_GE(sum, 0);
  EXPECT_LE(sum, 1 + 4e-6);
  EXPECT_LE(occupancy, sum + 1e-5);  // merged columns: never more entries than hits
}

TEST_F(Views, RowSumsAgreeBetweenFormats) {
  Settings csr = smallSettings();
  csr.matrix.gpu.hitRule = HitRule::thesis;
  Settings padded = csr;
  padded.matrix.format = MatrixFormat::padded;
  Lit a(context(), cornerScene(), csr), b(context(), cornerScene(), padded);
  const Picture p = a.draw(VIEW_ROW_SUM), q = b.draw(VIEW_ROW_SUM);
  double largest = 0;
  for (size_t i = 0; i < p.linear.size(); ++i) {
    ASSERT_NEAR(p.linear[i].x, q.linear[i].x, 1e-4) << i;
    largest = std::max<double>(largest, p.linear[i].x);
  }
  EXPECT_GT(largest, 0.1);
}

TEST_F(Views, OddValuesAreColoured) {
  // H of NaN, infinity and below zero on the voxels: red, green, blue.
  Lit lit(context(), cornerScene(), smallSettings());
  const float values[] = {std::nanf(""), INFINITY, -1.0f};
  const uint8_t expected[3][3] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}};
  for (int k = 0; k < 3; ++k) {
    const std::vector<glm::vec4> h(lit.facets.count, glm::vec4(values[k]));
    upload(context(), lit.light.indirect, std::as_bytes(std::span(h)));
    const Picture p = lit.draw(VIEW_VOXEL_IRRADIANCE);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(p.display[4 * (8 * 64 + 32) + c], expected[k][c]) << k;
  }
}

TEST_F(Views, MirrorShowsTheWall) {
  // A mirror floor of fp32 H = 0 before a wall of constant radiosity: the reflection is B / pi, in compute and
  // fragment.
  for (const SpecularMode mode : {SpecularMode::compute, SpecularMode::fragment}) {
    Scene scene = cornerScene();
    Material& floor = scene.materials[0];
    floor.lambertian = false;
    floor.metallic = 1;
    floor.roughness = 0;
    floor.baseColor = {1, 1, 1, 1};
    Settings settings = smallSettings();
    settings.specular.mode = mode;
    settings.specular.gpu.threshold = 0;
    Lit lit(context(), std::move(scene), settings);
    const std::vector<glm::vec4> b(lit.facets.count, glm::vec4(kPi));
    upload(context(), lit.light.radiosity, std::as_bytes(std::span(b)));
    const Picture p = lit.draw(VIEW_SPECULAR, {65, 65});
    // The floor one metre before the wall, seen from the front: its mirror ray meets the wall.
    const glm::dvec3 eye(0, 2, 8), at(0, 1.5, 0), target(0, 0, -1);
    const glm::dvec3 forward = glm::normalize(at - eye), right(1, 0, 0), up = glm::cross(right, forward);
    const glm::dvec3 d = target - eye;
    const double y = glm::dot(d, up) / glm::dot(d, forward) / std::tan(0.3);
    const auto row = static_cast<uint32_t>((0.5 - 0.5 * y) * 65);
    EXPECT_NEAR(p.at(32, row).x, 1, 0.02) << static_cast<int>(mode);
  }
}

TEST_F(Views, MatrixRowIsThatOfItsFacet) {
  for (const MatrixFormat format : {MatrixFormat::csr, MatrixFormat::padded}) {
    Settings settings = smallSettings();
    useFormat(settings, format);
    Lit lit(context(), cornerScene(), settings);
    const uint32_t facet = lit.facets.count / 2;
    std::vector<float> wanted(lit.facets.count);
    const HostRow row = readRow(context(), lit.matrix, facet);
    for (size_t i = 0; i < row.columns.size(); ++i)
      wanted[row.columns[i]] += static_cast<float>(row.hits[i]) * row.weight;
    ASSERT_GT(*std::max_element(wanted.begin(), wanted.end()), 0);
    Frame frame = context().begin();
    const Buffer& factors = lit.fields.row(frame, lit.matrix, facet);
    frame.submitAndWait();
    const auto found = downloadAs<glm::vec4>(context(), factors);
    for (uint32_t i = 0; i < lit.facets.count; ++i) ASSERT_NEAR(found[i].x, wanted[i], 1e-6f) << i;

    // The picture shows those and no other values; of a facet that is not there, none.
    const auto shown = [&](uint32_t of) {
      lit.stage.settings.view.facet = of;
      std::set<float> values;
      for (const glm::vec4& c : lit.draw(VIEW_MATRIX_ROW).linear)
        if (c.w != 0) values.insert(c.x);
      return values;
    };
    std::set<float> stored;
    for (uint32_t i = 0; i < lit.facets.count; ++i) stored.insert(found[i].x);
    const std::set<float> values = shown(facet);
    EXPECT_GT(values.size(), 1u);
    for (const float value : values) EXPECT_TRUE(stored.contains(value)) << value;
    EXPECT_EQ(shown(lit.facets.count), std::set<float>{0});
  }
}

TEST_F(Views, RimsOfThinSlabsAreLit) {
  // A slab a third of a voxel thick, seen from above: its voxels keep the two sides, none the rim. Every facet has H
  // = 1.
  SceneBuilder b;
  b.addBox({-1, -1, -0.02f}, {1, 1, 0.02f});
  b.addCamera({0, 4, 0}, {0, 0, 0}, 0.4f, {0, 0, -1});
  Settings settings = smallSettings();
  Lit lit(context(), b.finish(), settings);
  const std::vector<glm::vec4> h(lit.facets.count, glm::vec4(1));
  upload(context(), lit.light.shaded(), std::as_bytes(std::span(h)));
  uint32_t rim = 0;
  for (const glm::vec4& c : lit.draw(VIEW_IRRADIANCE, {640, 640}).linear) {
    if (c.w == 0) continue;
    ++rim;
    ASSERT_NEAR(c.x, 1, 1e-4);
  }
  EXPECT_GT(rim, 1000u);
}

/// A floor of metal before a small bright panel, whose foot is so far above it.
Scene panelAboveMetal(float roughness, float foot, float emission) {
  SceneBuilder b;
  Material& metal = b.scene.materials[0];
  metal.lambertian = false;
  metal.metallic = 1;
  metal.roughness = roughness;
  metal.baseColor = {0.9f, 0.5f, 0.2f, 1};
  b.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
  Material& panel = b.newMaterial();
  panel.lambertian = true;
  panel.emission = glm::vec3(emission);
  b.addQuad({-0.5f, foot, -1}, {1, 0, 0}, {0, 0.5f, 0});
  b.addCamera({0, 2, 8}, {0, 0.2, 0}, 0.4f);
  return b.finish();
}

/// Root mean square of the red channel's differences, where the truth is below a limit.
double apart(const Picture& p, const Picture& truth, float below = std::numeric_limits<float>::infinity()) {
  double sum = 0;
  for (size_t i = 0; i < p.linear.size(); ++i) {
    const double d = p.linear[i].x - truth.linear[i].x;
    if (truth.linear[i].x < below) sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(p.linear.size()));
}

TEST_F(Views, RaysToEmittersKeepTheMeanAndQuietIt) {
  // Sent along the lobe alone, a few rays in a hundred meet the panel.
  Settings settings = smallSettings();
  settings.specular.gpu.threshold = 0;
  settings.specular.gpu.filter_ = 0;
  Lit lit(context(), panelAboveMetal(/*roughness=*/0.3f, /*foot=*/0.6f, /*emission=*/50), settings);
  ASSERT_GT(lit.emitters.count, 0u);

  const auto draw = [&](uint32_t rays, bool aimed) {
    lit.stage.settings.specular.gpu.rays = rays;
    ViewInputs inputs = lit.inputs();
    if (!aimed) inputs.emitters = nullptr;
    return lit.stage.draw(VIEW_SPECULAR, {64, 64}, 0, inputs, lit.indirect());
  };
  const auto mean = [](const Picture& p) {
    double sum = 0;
    for (const glm::vec4& c : p.linear) sum += c.x;
    return sum / static_cast<double>(p.linear.size());
  };
  const Picture reference = draw(64, true), aimed = draw(4, true), plain = draw(4, false);
  EXPECT_NEAR(mean(reference) / mean(draw(64, false)), 1, 0.02);
  EXPECT_NEAR(mean(aimed) / mean(reference), 1, 0.02);
  // Around the panel's image, where only the lobe's tail meets it.
  EXPECT_LT(apart(aimed, reference, /*below=*/1), apart(plain, reference, /*below=*/1) / 2);
}

TEST_F(Views, TheFilterTakesTheNoiseAndLeavesTheReflection) {
  // The panel stands on the floor: its reflection ends sharply where they touch.
  for (const float roughness : {0.15f, 0.3f, 0.6f}) {
    Settings settings = smallSettings();
    settings.specular.gpu.threshold = 0;
    Lit lit(context(), panelAboveMetal(roughness, /*foot=*/0, /*emission=*/5), settings);
    const auto draw = [&](uint32_t rays, bool filtered) {
      lit.stage.settings.specular.gpu.rays = rays;
      lit.stage.settings.specular.gpu.filter_ = filtered;
      return lit.stage.draw(VIEW_SPECULAR, {128, 128}, 0, lit.inputs(), lit.indirect());
    };
    const Picture truth = draw(64, false), plain = draw(4, false), filtered = draw(4, true);
    const double noise = apart(plain, truth), left = apart(filtered, truth);
    fmt::print("roughness {}: root mean square {:.4f}, filtered {:.4f}\n", roughness, noise, left);
    EXPECT_LT(left, noise) << roughness;
  }
}

TEST(AliasTable, DrawsInProportion) {
  // The probability of a facet is the sum over entries of what they keep or pass on, each drawn with 1 / count.
  const std::vector<uint32_t> facets{4, 7, 9, 12, 20};
  const std::vector<double> powers{1, 10, 0.25, 3, 0.75};
  std::map<uint32_t, double> chance;
  for (const Emitter& e : makeAliasTable(facets, powers)) {
    chance[e.facet] += e.keep / 5.0;
    chance[e.other] += (1 - e.keep) / 5.0;
  }
  for (size_t i = 0; i < facets.size(); ++i) EXPECT_NEAR(chance[facets[i]], powers[i] / 15, 1e-6) << facets[i];
}

TEST_F(Views, RoughnessAtTheLimitTracesNoRays) {
  // The G-buffer's half precision must not bring a material of max_roughness back below the limit. The wall's radiosity
  // is far from what the diffuse irradiance reflects, so that one traced ray would show.
  Scene scene = cornerScene();
  scene.materials[0].lambertian = false;
  scene.materials[0].roughness = 0.6f;
  Settings settings = smallSettings();
  settings.specular.gpu.maxRoughness = 0.6f;
  settings.specular.gpu.fade = 0;
  settings.specular.gpu.threshold = 0;
  Lit lit(context(), std::move(scene), settings);
  const std::vector<glm::vec4> b(lit.facets.count, glm::vec4(100));
  upload(context(), lit.light.radiosity, std::as_bytes(std::span(b)));
  const Picture at = lit.draw(VIEW_SPECULAR);
  lit.stage.settings.specular.gpu.maxRoughness = 0;
  EXPECT_TRUE(at.linear == lit.draw(VIEW_SPECULAR).linear);
  lit.stage.settings.specular.gpu.maxRoughness = 0.61f;
  EXPECT_FALSE(at.linear == lit.draw(VIEW_SPECULAR).linear);
}

TEST_F(Views, MetalsHaveARoughnessLimitOfTheirOwn) {
  for (const float metallic : {0.0f, 1.0f}) {
    Scene scene = cornerScene();
    scene.materials[0].lambertian = false;
    scene.materials[0].metallic = metallic;
    scene.materials[0].roughness = 1;
    Settings settings = smallSettings();
    settings.specular.gpu.threshold = 0;
    Lit lit(context(), std::move(scene), settings);
    const std::vector<glm::vec4> b(lit.facets.count, glm::vec4(100));
    upload(context(), lit.light.radiosity, std::as_bytes(std::span(b)));
    const Picture traced = lit.draw(VIEW_SPECULAR);
    lit.stage.settings.specular.gpu.metalRoughness = 0.6f;
    EXPECT_EQ(traced.linear == lit.draw(VIEW_SPECULAR).linear, metallic == 0) << metallic;
  }
}

TEST_F(Views, LambertianSceneHasNoSpecularAtAll) {
  Lit lit(context(), cornerScene(), smallSettings());
  for (const glm::vec4& c : lit.draw(VIEW_SPECULAR).linear) ASSERT_EQ(glm::vec3(c), glm::vec3(0));
}

TEST_F(Views, DistanceFollowsEitherField) {
  Settings chebyshev = smallSettings(), jfa = chebyshev;
  jfa.field.method = FieldMethod::jfa;
  Lit a(context(), cornerScene(), chebyshev), b(context(), cornerScene(), jfa);
  const Picture p = a.draw(VIEW_DISTANCE), q = b.draw(VIEW_DISTANCE);
  // Chebyshev distances are never above Euclidean ones, so their inverses are never below.
  for (size_t i = 0; i < p.linear.size(); ++i) ASSERT_GE(p.linear[i].x * 1.02f + 1e-3f, q.linear[i].x) << i;
}

TEST_F(Views, ARangeThatIsGivenTakesThePlaceOfThePicturesOwn) {
  Lit lit(context(), cornerScene(), smallSettings());
  const ViewRange given{.low = 0, .high = 20};
  const Buffer range = makeBuffer(context(), "range", Subsystem::Targets, std::span(&given, 1));
  ViewInputs inputs = lit.inputs();
  inputs.range = &range;
  const Picture p = lit.stage.draw(VIEW_DEPTH, {64, 64}, 0, inputs, lit.indirect());
  const glm::vec3 expected = encodeSrgb(colorMap(COLOR_MAP_VIOLET_YELLOW, p.at(32, 40).x / 20)) * 255.0f;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(p.display[4 * (40 * 64 + 32) + c], expected[c], 1.01);
}

TEST_F(Views, ShadowsOfALight) {
  // A plate one metre above a floor, the sun overhead: beneath it no light, beside it all of it; in the map the plate
  // is one metre nearer than the floor.
  SceneBuilder b;
  b.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
  b.addBox({-0.5f, 1, -0.5f}, {0.5f, 1.01f, 0.5f});
  // Two pebbles, between which the map reaches.
  b.addBox({-1.6f, 0, -1.6f}, {-1.5f, 0.02f, -1.5f});
  b.addBox({1.5f, 0, 1.5f}, {1.6f, 0.02f, 1.6f});
  b.addLight(LightType::Sun, kPi).direction = {0, -1, 0};
  b.addCamera({0, 0.5, 6}, {0, 0, 0}, 0.6f);
  Lit lit(context(), b.finish(), smallSettings());
  const Picture share = lit.draw(VIEW_SHADOW, {65, 65});
  // The floor at z = 0 and, seen past the plate's shadow, at z = 1.5.
  const auto row = [&](double z) {
    const glm::dvec3 eye(0, 0.5, 6), forward = glm::normalize(-eye), up = glm::cross(glm::dvec3(1, 0, 0), forward);
    const glm::dvec3 d = glm::dvec3(0, 0, z) - eye;
    return static_cast<uint32_t>((0.5 - 0.5 * glm::dot(d, up) / glm::dot(d, forward) / std::tan(0.3)) * 65);
  };
  EXPECT_EQ(share.at(32, row(0)), glm::vec4(0, 0, 0, 1));
  EXPECT_EQ(share.at(32, row(1.5)), glm::vec4(1));
  const Picture map = lit.draw(VIEW_SHADOW_MAP, {64, 64});
  EXPECT_NEAR(map.at(4, 4).x - map.at(32, 32).x, 1.01, 0.01);
  EXPECT_EQ(map.at(32, 32).w, 1);

  lit.stage.settings.view.light = 1;  // there is none
  for (const glm::vec4& c : lit.draw(VIEW_SHADOW).linear) ASSERT_EQ(c, glm::vec4(0));
}

TEST_F(Views, EveryFaceOfAShadowCubeIsWhereItsLabelSays) {
  // A point light off the middle of a room: the mid-texel of each face lies at the distance of the wall on its side.
  SceneBuilder b;
  b.addBox({-2, -1, -3}, {2, 1, 3});
  b.addLight(LightType::Point, 10).position = {0.5, 0.25, -1};
  b.addCamera({0, 0, 0}, {0, 0, -1}, 0.6f);
  Lit lit(context(), b.finish(), smallSettings());
  const Picture map = lit.draw(VIEW_SHADOW_MAP, {96, 64});
  const float walls[6] = {1.5f, 2.5f, 0.75f, 1.25f, 4, 2};  // +X -X +Y / -Y +Z -Z
  for (uint32_t face = 0; face < 6; ++face)
    EXPECT_NEAR(map.at(16 + 32 * (face % 3), 16 + 32 * (face / 3)).x, walls[face], 0.01) << face;
}

TEST_F(Views, TheErrorAgainstAPictureIsSignedAndRelative) {
  Lit lit(context(), cornerScene(), smallSettings());
  const Picture drawn = lit.draw(VIEW_LIT);
  const auto compareWith = [&](glm::uvec2 size, const std::vector<glm::vec4>& pixels) {
    ImageDesc desc;
    desc.name = "reference";
    desc.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    desc.width = size.x;
    desc.height = size.y;
    lit.picture = Image(context().device, desc);
    upload(context(), lit.picture, std::as_bytes(std::span(pixels)));
  };
  compareWith({64, 64}, drawn.linear);
  for (const glm::vec4& c : lit.draw(VIEW_ERROR).linear) ASSERT_EQ(c, glm::vec4(0, 0, 0, 1));
  EXPECT_EQ(lit.draw(VIEW_REFERENCE_PICTURE).display, drawn.display);

  // Twice as bright: (L - 2 L) / sqrt(4 L^2 + epsilon).
  std::vector<glm::vec4> twice = drawn.linear;
  for (glm::vec4& c : twice) c *= 2.0f;
  compareWith({64, 64}, twice);
  const Picture error = lit.draw(VIEW_ERROR);
  for (size_t i = 0; i < error.linear.size(); ++i) {
    const float l = glm::dot(glm::vec3(drawn.linear[i]), glm::vec3(0.2126f, 0.7152f, 0.0722f));
    ASSERT_NEAR(error.linear[i].x, -l / std::sqrt(4 * l * l + VIEW_ERROR_EPSILON), 1e-5);
  }

  // One of half the width covers the picture's middle half.
  compareWith({16, 32}, std::vector<glm::vec4>(16 * 32, glm::vec4(3)));
  const Picture narrow = lit.draw(VIEW_REFERENCE_PICTURE);
  EXPECT_EQ(narrow.at(15, 30).w, 0);
  EXPECT_EQ(narrow.at(16, 30), glm::vec4(3, 3, 3, 1));
  EXPECT_EQ(narrow.at(47, 30), glm::vec4(3, 3, 3, 1));
  EXPECT_EQ(narrow.at(48, 30).w, 0);
}

}  // namespace
}  // namespace irad::test::views_suite
