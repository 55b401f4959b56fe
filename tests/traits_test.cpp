// What is measured of scenes for the effect plan, on the CPU: materials over all that their textures hold, lights.
#include "gi/traits.h"

#include <gtest/gtest.h>

#include "gi/plan.h"
#include "renderer/gpu_scene.h"
#include "tests/forward_support.h"

namespace irad::traits_suite {
namespace {

/// One quad of one material.
struct Quad : test::SceneBuilder {
  Material& material = scene.materials[0];
  Quad() { addQuad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}); }
  MaterialTraits traits() { return measure(finish(), 64).materials.at(0); }
};

TEST(Traits, OneLitTexelOfA4kTextureEmits) {
  Quad quad;
  quad.material.emission = glm::vec3(2);
  quad.material.emissiveTexture.image = 0;
  quad.material.emissiveTexture.transform = glm::mat3x2(0.01f);  // a corner of it is sampled: coordinates repeat
  const size_t size = 4096, last = size * size - 1;
  quad.scene.images.push_back({"emissive", size, size, /*srgb=*/true, std::vector<uint8_t>(4 * size * size, 0)});
  std::vector<uint8_t>& rgba = quad.scene.images[0].rgba;
  EXPECT_EQ(quad.traits().emission, 0.0f);
  for (const size_t texel : {size_t{0}, last, size * 1234 + 567}) {
    rgba[4 * texel + 2] = 1;  // blue
    EXPECT_GT(quad.traits().emission, 0.0f);
    rgba[4 * texel + 2] = 0;
  }
  rgba[4 * 7 + 1] = 255;  // green
  EXPECT_NEAR(quad.traits().emission, 2 * 0.7152f, 1e-4f);
  quad.material.emission = glm::vec3(2, 0, 2);  // the factor is 0 in that channel
  EXPECT_EQ(quad.traits().emission, 0.0f);
}

TEST(Traits, MaterialsBoundTheirTextures) {
  Quad quad;
  Material& m = quad.material;
  m.lambertian = false;
  m.metallic = 1;
  m.roughness = 0.8f;
  m.baseColor = glm::vec4(0.5f, 0.25f, 0, 1);
  m.metallicRoughnessTexture.image = 0;
  m.normalTexture.image = 0;
  m.alpha = AlphaMode::Mask;
  quad.scene.images.push_back({"rough", 2, 1, false, {0, 128, 51, 255, 0, 255, 204, 255}});  // g: .5, 1; b: .2, .8
  const MaterialTraits t = quad.traits();
  EXPECT_EQ(t.triangles, 2u);
  EXPECT_NEAR(t.leastRoughness, 0.8f * 128 / 255, 1e-6f);
  EXPECT_NEAR(t.albedo, 0.5f * 0.8f, 1e-6f);
  EXPECT_NEAR(t.f0, 0.5f * 0.8f, 1e-6f);
  EXPECT_TRUE(t.alphaTest);
  EXPECT_TRUE(t.normalMap);
  m.baseColor = {0, 0, 0, 1};  // a black metal is not Lambertian
  EXPECT_GT(quad.traits().f0, 0.0f);
  m.lambertian = true;
  EXPECT_EQ(quad.traits().f0, 0.0f);
}

TEST(Traits, LightsReachWhatTheirRangeAndConeLeave) {
  test::SceneBuilder b;
  b.addBox({-1, -1, -1}, {1, 1, 1});
  const Scene scene = b.finish();
  GpuLight light{};
  for (const glm::vec3 intensity : {glm::vec3(0), {0, 0, 1e-20f}, glm::vec3(1)}) {
    light.intensity = intensity;
    EXPECT_EQ(measureLight(light, scene, 64).shines, intensity.z > 0);
  }
  enum Reach { out, near, in };
  const auto reach = [&](uint32_t type, glm::vec3 position, float range, glm::vec3 direction = {}, float cone = 0.8f) {
    light.type = type;
    light.position = position;
    light.range = range;
    light.direction = direction;
    light.outerCos = cone;
    const double share = measureLight(light, scene, 64).share();
    return share > 1 ? in : share > 0.5 ? near : out;
  };
  const glm::vec3 there{5, 0, 0};  // 4 from the box, of voxels of 1/32
  EXPECT_EQ(reach(LIGHT_SUN, there, 0), in);
  EXPECT_EQ(reach(LIGHT_POINT, there, 0), in);  // without a range
  EXPECT_EQ(reach(LIGHT_POINT, there, 3.85f), out);
  EXPECT_EQ(reach(LIGHT_POINT, there, 3.9f), near);
  EXPECT_EQ(reach(LIGHT_POINT, there, 4.1f), in);
  // Half an angle of 37 degrees about the direction; the box is seen under at most 20 from the horizontal. `beside` has
  // .644 of half-angle; the bounds' sphere .354, two voxels wider .367, four .381.
  const glm::vec3 beside{-std::cos(1.018f), std::sin(1.018f), 0};
  EXPECT_EQ(reach(LIGHT_SPOT, there, 0, {-1, 0, 0}), in);
  EXPECT_EQ(reach(LIGHT_SPOT, there, 0, {1, 0, 0}), out);
  EXPECT_EQ(reach(LIGHT_SPOT, there, 0, {0, 1, 0}), out);
  EXPECT_EQ(reach(LIGHT_SPOT, there, 0, beside), near);
  EXPECT_EQ(reach(LIGHT_SPOT, there, 0, beside, 0.1f), in);
  EXPECT_EQ(reach(LIGHT_SPOT, {0.5f, 0, 0}, 0, beside, 0.99f), in);  // inside
}

}  // namespace
}  // namespace irad::traits_suite
