// What is measured of scenes for the effect plan, on the CPU: materials over all that their textures hold, lights,
// faces.
#include "gi/traits.h"

#include <gtest/gtest.h>

#include "gi/plan.h"
#include "renderer/gpu_scene.h"
#include "tests/forward_support.h"

namespace irad::traits_suite {
namespace {

/// One quad of one material.
test::SceneBuilder quad() {
  test::SceneBuilder b;
  b.addQuad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  return b;
}
MaterialTraits material(const Scene& scene) {
  return measure(scene, 64).materials.at(0);
}

TEST(Traits, OneLitTexelOfA4kTextureEmits) {
  test::SceneBuilder b = quad();
  Material& m = b.scene.materials[0];
  m.emission = glm::vec3(2);
  m.emissiveTexture.image = 0;
  m.emissiveTexture.transform = glm::mat3x2(0.01f);  // sampling a corner of it changes nothing: coordinates repeat
  const size_t size = 4096, last = size * size - 1;
  b.scene.images.push_back({"emissive", size, size, /*srgb=*/true, std::vector<uint8_t>(4 * size * size, 0)});
  Scene scene = b.finish();
  std::vector<uint8_t>& rgba = scene.images[0].rgba;
  EXPECT_EQ(material(scene).emission, 0.0f);
  for (const size_t texel : {size_t{0}, last, size * 1234 + 567}) {
    rgba[4 * texel + 2] = 1;  // blue
    const SceneTraits t = measure(scene, 64);
    EXPECT_GT(t.materials.at(0).emission, 0.0f);
    EXPECT_TRUE(plan(t, defaultSettings(/*cpuDevice=*/true)).on(Effect::emission));
    rgba[4 * texel + 2] = 0;
  }
  rgba[4 * 7 + 1] = 255;  // green
  EXPECT_NEAR(material(scene).emission, 2 * 0.7152f, 1e-4f);
  scene.materials[0].emission = glm::vec3(2, 0, 2);  // the factor is 0 in that channel
  EXPECT_EQ(material(scene).emission, 0.0f);
}

TEST(Traits, MaterialsBoundTheirTextures) {
  test::SceneBuilder b = quad();
  Material& m = b.scene.materials[0];
  m.lambertian = false;
  m.metallic = 1;
  m.roughness = 0.8f;
  m.baseColor = glm::vec4(0.5f, 0.25f, 0, 1);
  m.metallicRoughnessTexture.image = 0;
  m.normalTexture.image = 0;
  m.alpha = AlphaMode::Mask;
  b.scene.images.push_back({"rough", 2, 1, false, {0, 128, 51, 255, 0, 255, 204, 255}});  // g: .5, 1; b: .2, .8
  const MaterialTraits t = material(b.finish());
  EXPECT_EQ(t.triangles, 2u);
  EXPECT_NEAR(t.leastRoughness, 0.8f * 128 / 255, 1e-6f);
  EXPECT_NEAR(t.albedo, 0.5f * 0.8f, 1e-6f);
  EXPECT_NEAR(t.f0, 0.5f * 0.8f, 1e-6f);
  EXPECT_TRUE(t.alphaTest);
  EXPECT_TRUE(t.normalMap);
}

TEST(Traits, ABlackMetalIsNotLambertian) {
  test::SceneBuilder b = quad();
  Material& m = b.scene.materials[0];
  m.baseColor = {0, 0, 0, 1};
  m.metallic = 1;
  EXPECT_EQ(material(b.finish()).f0, 0.0f);
  m.lambertian = false;
  EXPECT_GT(material(b.finish()).f0, 0.0f);
}

TEST(Traits, LightsReachWhatTheirRangeAndConeLeave) {
  test::SceneBuilder b;
  b.addBox({-1, -1, -1}, {1, 1, 1});
  const Scene scene = b.finish();
  GpuLight l{};
  l.outerCos = 0.8f;
  const auto shines = [&](glm::vec3 intensity) {
    l.intensity = intensity;
    return measureLight(l, scene, 64).shines;
  };
  EXPECT_FALSE(shines(glm::vec3(0)));
  EXPECT_TRUE(shines({0, 0, 1e-20f}));
  EXPECT_TRUE(shines(glm::vec3(1)));
  enum Reach { out, near, in };
  const auto reach = [&] {
    const LightTraits t = measureLight(l, scene, 64);
    EXPECT_EQ(t.lights(), t.reaches);
    EXPECT_EQ(t.mayLight(), t.nears);
    return t.reaches && t.nears ? in : t.nears ? near : out;
  };
  l.type = LIGHT_SUN;
  EXPECT_EQ(reach(), in);
  l.type = LIGHT_POINT;
  l.position = {5, 0, 0};
  // 0: without a range; 4 to the box, voxels of 1/32
  for (const auto& [range, expected] : {std::pair{0.0f, in}, {3.85f, out}, {3.9f, near}, {4.1f, in}}) {
    l.range = range;
    EXPECT_EQ(reach(), expected) << range;
  }
  l.type = LIGHT_SPOT;
  l.range = 0;
  // Half an angle of 37 degrees about the direction; the box is seen under at most 20 from the horizontal. The last has
  // .644 of half-angle; the bounds' sphere .377, or .400 wider.
  const std::pair<glm::vec3, Reach> directions[]{
      {{-1, 0, 0}, in}, {{1, 0, 0}, out}, {{0, 1, 0}, out}, {{-std::cos(1.03f), std::sin(1.03f), 0}, near}};
  for (const auto& [direction, expected] : directions) {
    l.direction = direction;
    EXPECT_EQ(reach(), expected) << direction.x;
  }
  l.outerCos = 0.1f;
  EXPECT_EQ(reach(), in);
  l.position = {0.5f, 0, 0};  // inside
  l.outerCos = 0.99f;
  EXPECT_EQ(reach(), in);
}

TEST(Traits, FacesOneWay) {
  test::SceneBuilder plane = quad();
  plane.addQuad({-1, 0, 1}, {0, 0.2f, 2}, {2, 0, 0});
  Scene scene = plane.finish();
  EXPECT_TRUE(measure(scene, 64).facesOneWay);
  scene.materials[0].doubleSided = true;  // its back shows
  EXPECT_FALSE(measure(scene, 64).facesOneWay);
  test::SceneBuilder box;
  box.addBox({-1, -1, -1}, {1, 1, 1});
  EXPECT_FALSE(measure(box.finish(), 64).facesOneWay);
}

}  // namespace
}  // namespace irad::traits_suite
