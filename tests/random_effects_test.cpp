// Random scenes and settings, as planned and with everything forced on: the same bits.
#include <iterator>
#include <random>
#include <sstream>

#include "app/plan_proof.h"
#include "tests/effects_fixture.h"

namespace irad::test::random_effects_suite {
namespace {

class Dice {
 public:
  explicit Dice(uint32_t seed) : random_(seed) {}
  uint32_t below(uint32_t n) { return static_cast<uint32_t>(random_() % n); }
  bool one(uint32_t in) { return below(in) == 0; }
  float unit() { return static_cast<float>(random_() % 65536) / 65536.0f; }
  float between(float a, float b) { return a + (b - a) * unit(); }
  glm::vec3 vec(float a, float b) { return {between(a, b), between(a, b), between(a, b)}; }

 private:
  std::mt19937 random_;
};

/// Textures, masks, normal maps, lobes: each on some materials, and in some scenes on none.
void furnish(Scene& scene, Dice& dice) {
  const bool textured = dice.one(2), masked = dice.one(3), mapped = dice.one(3), lobes = dice.one(2);
  const glm::vec4 black(0, 0, 0, 1), white(1);
  /// With chance 1 : `in`, an image of a few texels between `least` and `most`.
  const auto maybe = [&](TextureUse& use, uint32_t in, bool srgb, const glm::vec4& least, const glm::vec4& most) {
    if (!dice.one(in)) return;
    SceneImage image{
        .name = "random", .width = 1 + dice.below(8), .height = 1 + dice.below(8), .srgb = srgb, .rgba = {}};
    for (uint32_t i = 0; i < 4 * image.width * image.height; ++i)
      image.rgba.push_back(static_cast<uint8_t>(255 * std::clamp(dice.between(least[i % 4], most[i % 4]), 0.0f, 1.0f)));
    scene.images.push_back(std::move(image));
    use.image = static_cast<int>(scene.images.size()) - 1;
    use.uvSet = dice.below(2);
    if (dice.one(2)) use.transform = {{dice.between(-2, 2), 0.3f}, {-0.2f, dice.between(0.5f, 2)}, {dice.unit(), 0}};
  };
  for (Material& m : scene.materials) {
    m.lambertian = !lobes || dice.one(2);
    m.metallic = dice.one(2) ? 1.0f : 0.0f;
    m.roughness = dice.unit();
    if (textured) {
      maybe(m.baseColorTexture, 2, true, black, white);
      maybe(m.metallicRoughnessTexture, 2, false, black, white);
      maybe(m.occlusionTexture, 4, false, black, white);
      maybe(m.emissiveTexture, 3, true, {-1, -1, -1, 1}, dice.one(2) ? black : white);
    }
    if (mapped) maybe(m.normalTexture, 2, false, {0.2f, 0.2f, 0.9f, 1}, {0.8f, 0.8f, 0.9f, 1});
    if (masked && dice.one(2)) {
      m.alpha = dice.one(2) ? AlphaMode::Mask : AlphaMode::Blend;
      m.alphaCutoff = dice.unit();
      maybe(m.baseColorTexture, 1, true, glm::vec4(0), white);
    }
  }
  const bool coloured = dice.one(3);
  for (size_t i = 0; i < scene.positions.size(); ++i) {
    const glm::vec3 p = scene.positions[i], n = glm::abs(scene.normals[i]);
    scene.uv0[i] = n.x > 0.7f ? glm::vec2(p.y, p.z) : n.y > 0.7f ? glm::vec2(p.x, p.z) : glm::vec2(p);
    scene.uv1[i] = 3.0f * scene.uv0[i];
    if (coloured) scene.colors[i] = glm::vec4(dice.vec(0, 1), dice.one(2) ? 1.0f : dice.unit());
  }
}

Scene randomScene(Dice& dice) {
  SceneBuilder b;
  const bool black = dice.one(5), emits = dice.one(2);
  std::vector<uint32_t> walls;
  for (int i = 0; i < 6; ++i)
    walls.push_back(b.material(black ? glm::vec3(0) : dice.vec(0, 0.9f),
                               emits && i == 3 ? dice.vec(0, 4) : glm::vec3(0), /*doubleSided=*/dice.one(4)));
  if (dice.one(4)) {
    b.quad(walls[0], {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}, 2);  // a floor alone: all faces one way
  } else {
    b.box(walls, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
    if (dice.one(2)) b.sphere(walls[1], dice.vec(-0.4f, 0.4f), dice.between(0.1f, 0.4f), /*inward=*/false, 8);
    if (dice.one(3)) b.quad(walls[2], {-0.5, 0, 0.5}, {0.5, 0, 0.5}, {0.5, 0.2, -0.5}, {-0.5, 0.2, -0.5});
  }
  b.camera({0.9, 0.6, 0.9}, {-0.5, -0.3, -0.6});
  Scene scene = b.finish("random");
  furnish(scene, dice);
  for (uint32_t i = dice.below(4); i > 0; --i) {
    Light light;
    light.type = static_cast<LightType>(dice.below(LIGHT_KINDS));
    light.position = scene.origin + glm::dvec3(dice.vec(-3, 3));
    light.direction = glm::normalize(dice.vec(-1, 1) + glm::vec3(0, 1e-3f, 0));
    light.color = dice.vec(0, 1);
    light.intensity = dice.one(3) ? 0 : dice.between(0.1f, 5);
    if (lightKind(light.type).has(LIGHT_RANGE) && dice.one(2)) light.range = dice.between(0.2f, 4);
    light.innerCos = 0.95f;
    light.outerCos = dice.between(0.1f, 0.9f);
    scene.lights.push_back(light);
  }
  return scene;
}

/// Draws every setting that decides which kernels and products there are. The solver's kernels add up in different
/// orders, so both sides of a comparison have the same one.
Settings randomSettings(Dice& dice) {
  Settings s = defaultSettings(/*cpuDevice=*/true);
  s.matrix.gpu.rays = 16;
  s.light.shadowResolution = 64;
  s.effects.blurNoise = 0;  // the only threshold among effects.*
  s.voxel.resolution = 8 + dice.below(7);
  s.specular.gpu.maxRoughness = dice.unit();
  for (const char* choice :
       {"voxel.facets 1 2 3 4", "voxel.method raster conservative", "voxel.normals axis6 axis26 oct8 oct16",
        "matrix.traversal dda sdf", "matrix.hit_rule thesis robust", "matrix.jitter false true",
        "matrix.format padded csr", "matrix.emitter_sampling off auto on", "field.method chebyshev chebyshev jfa",
        "solver.kernel auto tree subgroup row", "scatter.edge_removal false false false false false true",
        "sample.filter nearest linear blur", "sample.emitters facets pixels", "sample.gated true true true false",
        "sample.premultiplied false true", "specular.mode off fragment compute", "specular.traversal dda sdf"}) {
    std::istringstream in(choice);
    const std::vector<std::string> words{std::istream_iterator<std::string>(in), {}};
    applySetting(s, words[0] + "=" + words[1 + dice.below(static_cast<uint32_t>(words.size()) - 1)]);
  }
  return s;
}

class RandomEffects : public EffectsTest {
 protected:
  /// The scene of a seed with settings that it shares with others: compiling their kernels is what takes the time.
  void comparePlannedWithForced(uint32_t seed) {
    Dice dice(seed), settingsDice(1000 + seed / 6);
    const Scene scene = randomScene(dice);
    const Settings settings = randomSettings(settingsDice);
    const auto bench = [&](const Settings& s) {
      auto made = std::make_unique<app::Bench>(context(), scene, s, glm::uvec2(32, 24), VIEW_LIT, scene.cameras.at(0));
      made->prepare({});
      return made;
    };
    const auto planned = bench(settings), forced = bench(app::allForcedOn(settings));
    const EffectPlan plan = planned->pipeline().plan(), all = forced->pipeline().plan();
    std::string name = fmt::format("seed {}, left out:", seed);
    for (const EffectRow& row : plan.rows)
      if (row.state == EffectState::off && !all.off(row.effect)) {
        name += std::string(" ") + row.info().name;
        ++leftOut_[static_cast<size_t>(row.effect)];
      }
    // Where light falls only on albedos of 0, no surface shows H: it is not computed, and its views are black.
    const bool shown = !plan.off(Effect::matrix) || forced->pipeline().lighting().report.largestH == 0;
    constexpr View kViews[]{VIEW_LIT, VIEW_IRRADIANCE};
    const app::ProofRow proven = app::proveAll(name, *planned, *forced, std::span(kViews).first(shown ? 2 : 1));
    EXPECT_TRUE(proven.difference->pixels == 0) << name << ": " << proven.difference->text();
  }
  static inline std::array<uint32_t, kEffects> leftOut_{};  ///< how often, of the seeds so far
};

TEST_F(RandomEffects, EverythingForcedOnGivesTheSameBits) {
  for (uint32_t seed = 1; seed <= 6; ++seed) comparePlannedWithForced(seed);
}

TEST_F(RandomEffects, EverythingForcedOnGivesTheSameBitsOverAndOver) {
  IRAD_ONLY_WITH_ALL();
  for (uint32_t seed = 7; seed <= 60; ++seed) comparePlannedWithForced(seed);
  // Each of them, again and again.
  for (const Effect e : {Effect::emission, Effect::sun, Effect::point, Effect::spot, Effect::matrix, Effect::specular,
                         Effect::secondFacet, Effect::field, Effect::alphaTest, Effect::normalMap})
    EXPECT_GT(leftOut_[static_cast<size_t>(e)], 1u) << effectInfo(e).name;
}

}  // namespace
}  // namespace irad::test::random_effects_suite
