// Random scenes and settings, as planned and with everything forced on: the same bits.
#include <iterator>
#include <random>
#include <sstream>

#include "tests/effects_fixture.h"

namespace irad::test::random_effects_suite {
namespace {

struct Dice {
  std::mt19937 random;
  uint32_t below(uint32_t n) { return static_cast<uint32_t>(random() % n); }
  bool one(uint32_t in) { return below(in) == 0; }
  float unit() { return static_cast<float>(below(65536)) / 65536.0f; }
  float between(float a, float b) { return a + (b - a) * unit(); }
  glm::vec3 vec(float a, float b) { return {between(a, b), between(a, b), between(a, b)}; }
};

/// The room, or its floor alone, whose faces all look one way. Emission, textures, masks, normal maps, lobes: each on
/// some materials, and in some scenes on none.
Scene randomScene(Dice& dice) {
  const bool black = dice.one(5), emits = dice.one(2), textured = dice.one(2), masked = dice.one(3),
             mapped = dice.one(3), lobes = dice.one(2), coloured = dice.one(3), alone = dice.one(4);
  Scene scene = room(emits, {}, /*textured=*/true);
  if (alone) {
    // As a file's: no triangle is without a draw.
    const Draw draw = *std::ranges::find(scene.draws, 1u, &Draw::material);
    scene.indices.erase(scene.indices.begin() + draw.firstIndex + draw.indexCount, scene.indices.end());
    scene.indices.erase(scene.indices.begin(), scene.indices.begin() + draw.firstIndex);
    scene.draws = {{draw.material, 0, draw.indexCount}};
  }
  enum { normals, holes, noise, darkness };  // images: the room's, and two more
  std::vector<uint8_t> texels(4 * 8 * 2);
  for (uint8_t& byte : texels) byte = static_cast<uint8_t>(dice.below(256));
  scene.images.push_back({"noise", 8, 2, /*srgb=*/true, texels});
  scene.images.push_back({"darkness", 1, 1, /*srgb=*/true, {0, 0, 0, 255}});
  const auto use = [&](TextureUse& texture, bool used, int image) {
    texture = {};
    if (!used) return;
    texture.image = image;
    texture.uvSet = dice.below(2);
    if (dice.one(2))
      texture.transform = {{dice.between(-2, 2), 0.3f}, {-0.2f, dice.between(0.5f, 2)}, {dice.unit(), 0}};
  };
  for (Material& m : scene.materials) {
    m.baseColor = black ? glm::vec4(0, 0, 0, 1) : glm::vec4(dice.vec(0, 0.9f), 1);
    m.emission *= dice.vec(0, 1);
    m.doubleSided = dice.one(4) && !alone;
    m.lambertian = !lobes || dice.one(2);
    m.metallic = dice.one(2) ? 1.0f : 0.0f;
    m.roughness = dice.unit();
    m.alpha = !masked || dice.one(2) ? AlphaMode::Opaque : dice.one(2) ? AlphaMode::Mask : AlphaMode::Blend;
    m.alphaCutoff = dice.unit();
    const bool cut = m.alpha != AlphaMode::Opaque;
    use(m.baseColorTexture, cut || (textured && dice.one(2)), cut && dice.one(2) ? holes : noise);
    use(m.metallicRoughnessTexture, textured && dice.one(2), noise);
    use(m.occlusionTexture, textured && dice.one(4), noise);
    use(m.emissiveTexture, textured && dice.one(3), dice.one(2) ? darkness : noise);
    use(m.normalTexture, mapped && dice.one(2), normals);
  }
  for (size_t i = 0; i < scene.positions.size(); ++i) {
    scene.uv1[i] = 3.0f * scene.uv0[i];
    if (coloured) scene.colors[i] = glm::vec4(dice.vec(0, 1), dice.one(2) ? 1.0f : dice.unit());
  }
  for (uint32_t i = dice.below(4); i > 0; --i) {
    Light light = spot(dice.between(0.1f, 0.9f));
    light.type = static_cast<LightType>(dice.below(LIGHT_KINDS));
    light.position = scene.origin + glm::dvec3(dice.vec(-3, 3));
    light.direction = glm::normalize(dice.vec(-1, 1) + glm::vec3(0, 1e-3f, 0));
    light.color = dice.vec(0, 1);
    if (dice.one(3)) light.intensity = 0;
    if (lightKind(light.type).has(LIGHT_RANGE) && dice.one(2)) light.range = dice.between(0.2f, 4);
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
       {"voxel.method raster conservative", "voxel.normals axis6 axis26 oct8 oct16", "matrix.traversal dda sdf",
        "matrix.hit_rule thesis triangles triangles", "matrix.jitter false true", "matrix.format padded csr",
        "matrix.emitter_sampling off auto on", "field.method chebyshev chebyshev jfa",
        "solver.kernel auto tree subgroup row", "scatter.edge_removal false false false false false true",
        "sample.filter nearest linear blur", "sample.emitters facets pixels", "sample.premultiplied false true",
        "specular.mode off fragment compute", "specular.traversal dda sdf"}) {
    std::istringstream in(choice);
    const std::vector<std::string> words{std::istream_iterator<std::string>(in), {}};
    applySetting(s, words[0] + "=" + words[1 + dice.below(static_cast<uint32_t>(words.size()) - 1)]);
  }
  // What is the thesis's alone is refused with another hit rule.
  if (s.matrix.gpu.hitRule != HitRule::thesis) {
    s.voxel.method = VoxelMethod::conservative;
    s.matrix.format = MatrixFormat::csr;
  }
  return s;
}

class RandomEffects : public EffectsTest {};

/// Scenes and settings, by seed, in which nearly each pair of effects meets that can: one is left out while the other
/// is there, or both are. Of 600 scenes with each of three settings (compiling their kernels is what takes the time)
/// the one that adds most pairs, again and again: 342 of the 346 that the 1,800 have. The first has black metals, whose
/// highlights a shadow map once let through a wall.
TEST_F(RandomEffects, EverythingForcedOnGivesTheSameBits) {
  std::map<Effect, int> leftOut;  // how often
  struct Pair {
    uint32_t scene, settings;
  };
  constexpr Pair kPairs[]{{9, 1000},   {274, 1002}, {79, 1001}, {114, 1002}, {325, 1001},
                          {369, 1002}, {355, 1002}, {16, 1001}, {403, 1002}, {552, 1002}};
  for (const Pair& pair : kPairs) {
    Dice dice{std::mt19937(pair.scene)}, settingsDice{std::mt19937(pair.settings)};
    const Scene scene = randomScene(dice);
    const Settings settings = randomSettings(settingsDice);
    const auto planned = bench(scene, settings), forced = bench(scene, app::allForcedOn(settings));
    const EffectPlan plan = planned->pipeline().plan(), all = forced->pipeline().plan();
    std::string name = fmt::format("seeds {} and {}, left out:", pair.scene, pair.settings);
    for (const EffectRow& row : plan.rows)
      if (row.state == EffectState::off && !all.off(row.effect)) {
        name += std::string(" ") + row.info().name;
        ++leftOut[row.effect];
      }
    // Where light falls only on albedos of 0, no surface shows H: it is not computed, and its views are black.
    const bool shown = !plan.off(Effect::matrix) || forced->pipeline().lighting().report.largestH == 0;
    constexpr View kViews[]{VIEW_LIT, VIEW_IRRADIANCE};
    const app::ProofRow proven = app::proveAll(name, *planned, *forced, std::span(kViews).first(shown ? 2 : 1));
    EXPECT_TRUE(proven.difference->pixels == 0) << name << ": " << proven.difference->text();
  }
  // Each of them, again and again.
  for (const Effect e :
       {Effect::emission, Effect::sun, Effect::point, Effect::spot, Effect::sky, Effect::matrix, Effect::specular,
        Effect::field, Effect::relight, Effect::alphaTest, Effect::glass, Effect::normalMap, Effect::blur})
    EXPECT_GT(leftOut[e], 1) << effectInfo(e).name;
}

}  // namespace
}  // namespace irad::test::random_effects_suite
