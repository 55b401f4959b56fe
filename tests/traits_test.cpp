// What is measured of scenes for the effect plan, on the CPU: materials over all that their textures hold, lights,
// faces.
#include "gi/traits.h"

#include <gtest/gtest.h>

#include "gi/plan.h"
#include "renderer/gpu_scene.h"
#include "tests/forward_support.h"

namespace irad {
namespace {

/// One quad whose only material has an emissive texture of this size, black but for one channel of one texel.
Scene oneTexelScene(uint32_t size, size_t texel, int channel, uint8_t value) {
  test::SceneBuilder b;
  b.addQuad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  Material& m = b.scene.materials[0];
  m.emission = glm::vec3(2);
  m.emissiveTexture.image = 0;
  // A transform that samples a corner of it changes nothing: coordinates repeat.
  m.emissiveTexture.transform = glm::mat3x2(0.01f);
  SceneImage image{"emissive", size, size, /*srgb=*/true, std::vector<uint8_t>(4ull * size * size, 0)};
  image.rgba.at(4 * texel + static_cast<size_t>(channel)) = value;
  b.scene.images.push_back(std::move(image));
  return b.finish();
}

TEST(Traits, OneLitTexelOfA4kTextureEmits) {
  const uint32_t size = 4096;
  for (const size_t texel : {size_t{0}, size_t{size} * size - 1, size_t{size} * 1234 + 567}) {
    const SceneTraits t = measure(oneTexelScene(size, texel, /*blue*/ 2, 1), 64);
    EXPECT_GT(t.materials.at(0).emission, 0.0f);
    EXPECT_TRUE(plan(t, defaultSettings(/*cpuDevice=*/true)).on(Effect::emission));
  }
  Scene black = oneTexelScene(64, 0, 2, 0);
  EXPECT_EQ(measure(black, 64).materials.at(0).emission, 0.0f);
  Scene full = oneTexelScene(64, 7, 1, 255);
  EXPECT_NEAR(measure(full, 64).materials.at(0).emission, 2 * 0.7152f, 1e-4f);
  full.materials[0].emission = glm::vec3(2, 0, 2);  // the factor has nothing of that channel
  EXPECT_EQ(measure(full, 64).materials.at(0).emission, 0.0f);
}

TEST(Traits, MaterialsBoundTheirTextures) {
  test::SceneBuilder b;
  b.addQuad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  Material& m = b.scene.materials[0];
  m.lambertian = false;
  m.metallic = 1;
  m.roughness = 0.8f;
  m.baseColor = glm::vec4(0.5f, 0.25f, 0, 1);
  m.metallicRoughnessTexture.image = 0;
  m.normalTexture.image = 0;
  m.alpha = AlphaMode::Mask;
  b.scene.images.push_back({"rough", 2, 1, false, {0, 128, 51, 255, 0, 255, 204, 255}});  // g: .5, 1; b: .2, .8
  const MaterialTraits t = measure(b.finish(), 64).materials.at(0);
  EXPECT_EQ(t.triangles, 2u);
  EXPECT_NEAR(t.leastRoughness, 0.8f * 128 / 255, 1e-6f);
  EXPECT_NEAR(t.roughness, 0.8f, 1e-6f);
  EXPECT_NEAR(t.albedo, 0.5f * 0.8f, 1e-6f);
  EXPECT_NEAR(t.f0, 0.5f * 0.8f, 1e-6f);
  EXPECT_TRUE(t.alphaTest);
  EXPECT_TRUE(t.normalMap);
}

TEST(Traits, ABlackMetalIsNotLambertian) {
  test::SceneBuilder b;
  b.addQuad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  Material& m = b.scene.materials[0];
  m.baseColor = {0, 0, 0, 1};
  m.metallic = 1;
  EXPECT_EQ(measure(b.finish(), 64).materials.at(0).f0, 0.0f);
  m.lambertian = false;
  EXPECT_GT(measure(b.finish(), 64).materials.at(0).f0, 0.0f);
}

TEST(Traits, LightsReachWhatTheirRangeAndConeLeave) {
  test::SceneBuilder b;
  b.addBox({-1, -1, -1}, {1, 1, 1});
  const Scene scene = b.finish();
  GpuLight l{};
  l.intensity = glm::vec3(1);
  l.outerCos = 0.8f;
  const auto traits = [&] { return measureLight(l, scene, 64); };
  l.type = LIGHT_SUN;
  EXPECT_TRUE(traits().lights());
  l.intensity = glm::vec3(0);
  EXPECT_FALSE(traits().shines);
  l.intensity = glm::vec3(0, 0, 1e-20f);
  EXPECT_TRUE(traits().shines);
  l.type = LIGHT_POINT;
  l.position = {5, 0, 0};
  EXPECT_TRUE(traits().reaches);  // without a range
  l.range = 3.85f;                // 4 to the box, voxels of 1/32
  EXPECT_FALSE(traits().nears);
  l.range = 3.9f;
  EXPECT_FALSE(traits().reaches);
  EXPECT_TRUE(traits().nears);
  l.range = 4.1f;
  EXPECT_TRUE(traits().reaches);
  EXPECT_TRUE(traits().nears);
  l.type = LIGHT_SPOT;
  l.range = 0;
  l.direction = {-1, 0, 0};
  EXPECT_TRUE(traits().reaches);
  l.direction = {1, 0, 0};
  EXPECT_FALSE(traits().reaches);
  l.direction = {0, 1, 0};  // 37 degrees about up; the box is seen under at most 20 from the horizontal
  EXPECT_FALSE(traits().reaches);
  l.direction = {-std::cos(1.03f), std::sin(1.03f), 0};  // .644 of half-angle; the bounds' sphere: .377, or .400 wider
  EXPECT_FALSE(traits().reaches);
  EXPECT_TRUE(traits().nears);
  l.outerCos = 0.1f;
  EXPECT_TRUE(traits().reaches);
  l.position = {0.5f, 0, 0};  // inside
  l.outerCos = 0.99f;
  EXPECT_TRUE(traits().reaches);
}

TEST(Traits, FacesOneWay) {
  test::SceneBuilder plane;
  plane.addQuad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
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
}  // namespace irad
