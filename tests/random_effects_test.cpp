// Random scenes and settings, as planned and with everything forced on: the same bits.
#include <random>

#include "tests/effects_fixture.h"

namespace irad::test {
namespace {

class Dice {
 public:
  explicit Dice(uint32_t seed) : random_(seed) {}
  uint32_t below(uint32_t n) { return static_cast<uint32_t>(random_() % n); }
  bool one(uint32_t in) { return below(in) == 0; }
  float unit() { return static_cast<float>(random_() % 65536) / 65536.0f; }
  float between(float a, float b) { return a + (b - a) * unit(); }
  glm::vec3 vec(float a, float b) { return {between(a, b), between(a, b), between(a, b)}; }
  template <class E>
  E any() {
    return static_cast<E>(below(static_cast<uint32_t>(EnumNames<E>::names.size())));
  }

 private:
  std::mt19937 random_;
};

/// An image of a few texels that `texel` gives. Returns its use.
template <class Texel>
TextureUse texture(Scene& scene, Dice& dice, bool srgb, Texel&& texel) {
  SceneImage image{.name = "random", .width = 1 + dice.below(8), .height = 1 + dice.below(8), .srgb = srgb, .rgba = {}};
  for (uint32_t i = 0; i < image.width * image.height; ++i) {
    const glm::vec4 t = 255.0f * glm::clamp(glm::vec4(texel()), 0.0f, 1.0f);
    for (int c = 0; c < 4; ++c) image.rgba.push_back(static_cast<uint8_t>(t[c]));
  }
  scene.images.push_back(std::move(image));
  TextureUse use;
  use.image = static_cast<int>(scene.images.size()) - 1;
  use.uvSet = dice.below(2);
  if (dice.one(2)) use.transform = {{dice.between(-2, 2), 0.3f}, {-0.2f, dice.between(0.5f, 2)}, {dice.unit(), 0}};
  return use;
}

/// Textures, masks, normal maps, lobes: each on some materials, and in some scenes on none.
void furnish(Scene& scene, Dice& dice) {
  const bool textured = dice.one(2), masked = dice.one(3), mapped = dice.one(3), lobes = dice.one(2);
  for (Material& m : scene.materials) {
    m.lambertian = !lobes || dice.one(2);
    m.metallic = dice.one(2) ? 1.0f : 0.0f;
    m.roughness = dice.unit();
    if (textured && dice.one(2))
      m.baseColorTexture = texture(scene, dice, true, [&] { return glm::vec4(dice.vec(0, 1), 1); });
    if (textured && dice.one(2))
      m.metallicRoughnessTexture = texture(scene, dice, false, [&] { return glm::vec4(dice.vec(0, 1), 1); });
    if (textured && dice.one(4))
      m.occlusionTexture = texture(scene, dice, false, [&] { return glm::vec4(dice.vec(0, 1), 1); });
    if (textured && dice.one(3)) {
      const bool dark = dice.one(2);
      m.emissiveTexture =
          texture(scene, dice, true, [&] { return glm::vec4(dark ? glm::vec3(0) : dice.vec(-1, 1), 1); });
    }
    if (mapped && dice.one(2))
      m.normalTexture =
          texture(scene, dice, false, [&] { return glm::vec4(glm::vec2(dice.vec(0.2f, 0.8f)), 0.9f, 1); });
    if (masked && dice.one(2)) {
      m.alpha = dice.one(2) ? AlphaMode::Mask : AlphaMode::Blend;
      m.alphaCutoff = dice.unit();
      m.baseColorTexture = texture(scene, dice, true, [&] { return glm::vec4(dice.vec(0, 1), dice.unit()); });
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
                               emits && i == 3 ? dice.vec(0, 4) : glm::vec3(0),
                               /*doubleSided=*/dice.one(4)));
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
    light.type = static_cast<LightType>(dice.below(3));
    light.position = scene.origin + glm::dvec3(dice.vec(-3, 3));
    light.direction = glm::normalize(dice.vec(-1, 1) + glm::vec3(0, 1e-3f, 0));
    light.color = dice.vec(0, 1);
    light.intensity = dice.one(3) ? 0 : dice.between(0.1f, 5);
    if (light.type != LightType::Sun && dice.one(2)) light.range = dice.between(0.2f, 4);
    light.innerCos = 0.95f;
    light.outerCos = dice.between(0.1f, 0.9f);
    scene.lights.push_back(light);
  }
  return scene;
}

/// Of everything that decides which kernels and products there are. The solver's kernels add up in different orders:
/// both sides of a comparison have the same one.
Settings randomSettings(Dice& dice) {
  Settings s = defaultSettings(/*cpuDevice=*/true);
  s.voxel.resolution = 8 + dice.below(7);
  s.voxel.facets = 1 + dice.below(MAX_VOXEL_FACETS);
  s.voxel.method = dice.any<VoxelMethod>();
  s.voxel.normals = dice.any<NormalEncoding>();
  s.matrix.gpu.rays = 16;
  s.matrix.gpu.traversal = dice.below(2);
  s.matrix.gpu.hitRule = dice.below(2);
  s.matrix.gpu.jitter = dice.below(2);
  s.matrix.format = dice.any<MatrixFormat>();
  s.matrix.emitterSampling = dice.any<EmitterSampling>();
  s.field.method = dice.one(4) ? FieldMethod::jfa : FieldMethod::chebyshev;
  s.solver.kernel = dice.any<SolverKernel>();
  s.scatter.edgeRemoval = dice.one(6);
  s.sample.gpu.filter_ = dice.below(3);
  s.sample.emitters = dice.any<EmitterLookup>();
  s.sample.gpu.gated = dice.one(4) ? 0 : 1;
  s.sample.gpu.premultiplied = dice.below(2);
  s.specular.mode = dice.any<SpecularMode>();
  s.specular.gpu.traversal = dice.below(2);
  s.specular.gpu.maxRoughness = dice.unit();
  s.light.shadowResolution = 64;
  s.effects.blurNoise = 0;  // the only threshold that effects.* leave within
  return s;
}

class RandomEffects : public EffectsTest {};

TEST_F(RandomEffects, EverythingForcedOnGivesTheSameBits) {
  std::array<uint32_t, kEffects> leftOut{};
  for (uint32_t seed = 1; seed <= 60; ++seed) {
    Dice dice(seed);
    const Scene scene = randomScene(dice);
    const Settings planned = randomSettings(dice);
    Settings forced = planned;
    forceEffects(forced, EffectMode::on);
    forced.effects.relight = EffectMode::automatic;
    Pipeline a(context(), scene, planned), b(context(), scene, forced);
    a.prepare();
    b.prepare();
    std::string off;
    for (const EffectRow& row : a.plan().rows)
      if (row.state == EffectState::off && !b.plan().off(row.effect)) {
        off += std::string(" ") + effectInfo(row.effect).name;
        ++leftOut[static_cast<size_t>(row.effect)];
      }
    EXPECT_TRUE(same(draw(a), draw(b))) << "seed " << seed << ", left out:" << off;
    // Where light falls on albedos of 0 alone, H is what no surface shows: it is not computed, and its views are black.
    const bool shown = !a.plan().off(Effect::matrix) || b.lighting().report.largestH == 0;
    const std::vector<glm::vec4> h = draw(a, VIEW_IRRADIANCE);
    EXPECT_EQ(same(h, draw(b, VIEW_IRRADIANCE)), shown) << "seed " << seed << ", H, left out:" << off;
  }
  // Each of them, again and again.
  for (const Effect e : {Effect::emission, Effect::sun, Effect::point, Effect::spot, Effect::matrix, Effect::specular,
                         Effect::secondFacet, Effect::field, Effect::alphaTest, Effect::normalMap})
    EXPECT_GT(leftOut[static_cast<size_t>(e)], 1u) << effectInfo(e).name;
}

}  // namespace
}  // namespace irad::test
