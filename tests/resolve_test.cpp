// "RE Forward" and T 5.11's reflections by kernels: the same targets as by the graphics pipeline, up to rounding.
#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>
#include <numbers>
#include <random>
#include <set>

#include "gi/specular.h"
#include "shaders/shared/passes.h"
#include "shaders/shared/picked.h"
#include "tests/lit_stage.h"

namespace irad::test::resolve_suite {
namespace {

constexpr glm::uvec2 kSize{160, 120};
constexpr size_t kPixels = size_t{kSize.x} * kSize.y;

Settings small() {
  Settings s;
  s.voxel.resolution = 16;
  s.matrix.gpu.rays = 64;
  s.light.shadowResolution = 256;
  s.specular.mode = SpecularMode::fragment;
  return s;
}

/// Smooth, so that a mip level more or less changes little; every channel another.
int32_t addWaves(Scene& scene, glm::vec4 mean, glm::vec4 swing, bool srgb = false) {
  constexpr uint32_t kTexels = 32;
  constexpr float kTurn = 2 * std::numbers::pi_v<float> / kTexels;
  SceneImage image{.name = "waves", .width = kTexels, .height = kTexels, .srgb = srgb, .rgba = {}};
  for (uint32_t y = 0; y < kTexels; ++y)
    for (uint32_t x = 0; x < kTexels; ++x)
      for (uint32_t c = 0; c < 4; ++c) {
        const float wave =
            std::sin(kTurn * static_cast<float>((1 + c % 2) * x)) * std::cos(kTurn * static_cast<float>(y));
        const auto at = static_cast<int>(c);
        image.rgba.push_back(static_cast<uint8_t>(std::clamp(mean[at] + swing[at] * wave, 0.0f, 1.0f) * 255.0f + 0.5f));
      }
  scene.images.push_back(image);
  return static_cast<int32_t>(scene.images.size()) - 1;
}

/// Everything that a triangle can carry: the five textures on two sets of coordinates, one of them transformed, vertex
/// colours, a mask, both sides, no texture, emission, metal; triangles behind the viewer and many small ones. Whatever
/// has a texture is wholly in the picture: lavapipe clips triangles to it and reads coarse mip levels along the cuts.
Scene everything() {
  SceneBuilder b;
  Material& floor = b.scene.materials[0];
  floor = Material{.emission = {0.3f, 0.2f, 0.1f}};
  floor.baseColorTexture = {.image = addWaves(b.scene, glm::vec4(0.5f), {0.4f, 0.3f, 0.2f, 0}, /*srgb*/ true),
                            .uvSet = 1,
                            .transform = glm::mat3x2(0.6f, 0.8f, -0.8f, 0.6f, 0.1f, 0.2f)};
  floor.metallicRoughnessTexture.image = addWaves(b.scene, glm::vec4(0.4f), glm::vec4(0.3f));
  floor.normalTexture.image = addWaves(b.scene, {0.5f, 0.5f, 0.9f, 1}, {0.2f, 0.2f, 0, 0});
  floor.occlusionTexture = {.image = addWaves(b.scene, glm::vec4(0.6f), glm::vec4(0.3f)), .uvSet = 1};
  floor.emissiveTexture.image = addWaves(b.scene, glm::vec4(0.5f), glm::vec4(0.4f), /*srgb*/ true);
  b.addQuad({-3, 0, 1.6f}, {6, 0, 0}, {0, 0, -4.4f});
  for (size_t i = 0; i < 4; ++i) {
    const auto share = static_cast<float>(i);
    b.scene.uv1[i] = 2.0f * b.scene.uv0[i];
    b.scene.colors[i] = glm::vec4(1.0f - 0.1f * share, 0.8f, 0.7f + 0.1f * share, 1);
  }
  b.newMaterial() = Material{.metallic = 0, .roughness = 0.6f, .alpha = AlphaMode::Mask};
  b.scene.materials.back().baseColorTexture.image =
      addWaves(b.scene, {0.4f, 0.6f, 0.5f, 0.5f}, {0.2f, 0.2f, 0.2f, 0.5f});
  b.addQuad({-1.6f, 0, 0.4f}, {1.2f, 0, 0.3f}, {0, 1.4f, 0});
  b.newMaterial() = Material{.baseColor = {0.2f, 0.4f, 0.8f, 1}, .metallic = 0, .roughness = 0.2f, .doubleSided = true};
  b.addQuad({1.4f, 0.1f, 0.4f}, {-0.9f, 0, 0.3f}, {0, 1.2f, 0});  // its back
  b.newMaterial() = Material{.baseColor = {0.5f, 0.5f, 0.5f, 1}, .metallic = 0, .emission = {2, 1.5f, 1}};
  b.addBox({-0.3f, 0, -1.6f}, {0.3f, 0.5f, -1});
  b.newMaterial() = Material{.baseColor = {0.7f, 0.7f, 0.6f, 1}, .metallic = 0, .roughness = 0.9f};
  b.addQuad({-4, -0.02f, 9}, {8, 0, 0}, {0, 0, -12});  // reaches behind the viewer
  b.newMaterial() = Material{.baseColor = {0.9f, 0.7f, 0.3f, 1}, .metallic = 1, .roughness = 0.25f};
  for (int i = 0; i < 24; ++i)
    for (int j = 0; j < 8; ++j) {  // a bent wall
      const auto at = [](int x, int y) {
        const float u = static_cast<float>(x) / 24.0f;
        return glm::vec3(-3 + 6 * u, 0.25f * static_cast<float>(y), -2.2f - std::sin(3.0f * u));
      };
      b.addQuad(at(i, j), at(i + 1, j) - at(i, j), at(i, j + 1) - at(i, j));
    }
  b.addLight(LightType::Sun, 3).direction = glm::normalize(glm::vec3(0.3f, -1, -0.6f));
  b.addLight(LightType::Point, 12).position = {-1.5, 1.7, 1.8};
  Light& spot = b.addLight(LightType::Spot, 20);
  spot.position = {1.6, 2.2, 2};
  spot.direction = glm::normalize(glm::vec3(-1, -1.4f, -1.6f));
  b.addCamera({0.3, 1.6, 4}, {0, 0.5, 0}, 0.9f);
  Camera& flat = b.addCamera({2, 3, 4}, {0, 0.5, 0}, 0.9f);
  flat.orthographic = true;
  flat.ymag = 2.2f;
  return b.finish();
}

using Texels = std::vector<glm::vec4>;

Texels texels(Context& context, const Image& image) {
  const std::vector<std::byte> bytes = download(context, image);
  Texels out(kPixels);
  for (size_t i = 0; i < out.size(); ++i)
    if (image.desc.format == VK_FORMAT_R16G16B16A16_SFLOAT) {
      uint64_t packed;
      std::memcpy(&packed, bytes.data() + 8 * i, 8);
      out[i] = glm::unpackHalf4x16(packed);
    } else {
      std::memcpy(&out[i], bytes.data() + 16 * i, 16);
    }
  return out;
}

/// What "RE Forward" leaves.
struct Drawn {
  std::vector<float> depth;
  std::vector<glm::uvec2> visible;  ///< triangle, bits of the depth; by kernels
  std::map<std::string, Texels> targets;
};

Drawn take(Context& context, const Targets& targets) {
  Drawn drawn;
  drawn.depth.resize(kPixels);
  const std::vector<std::byte> depth = download(context, targets.depth);
  std::memcpy(drawn.depth.data(), depth.data(), depth.size());
  if (targets.visible) drawn.visible = downloadAs<glm::uvec2>(context, targets.visible);
  for (Image Targets::*image : {&Targets::normal, &Targets::geometric, &Targets::albedo, &Targets::f0, &Targets::direct,
                                &Targets::highlight, &Targets::indirect, &Targets::emitted})
    if (targets.*image) drawn.targets[(targets.*image).desc.name] = texels(context, targets.*image);
  return drawn;
}

Drawn draw(Lit& lit, Targets& targets, size_t camera, ForwardEffects effects, bool kernels) {
  effects.kernels = kernels;
  lit.stage.draw(VIEW_EMITTER_IRRADIANCE, targets, camera, lit.inputs(), lit.indirect(), effects);
  return take(lit.stage.context, targets);
}
Drawn draw(Lit& lit, size_t camera, const ForwardEffects& effects, bool kernels) {
  Targets targets(lit.stage.context, kSize);
  return draw(lit, targets, camera, effects, kernels);
}

/// Pixels whose neighbours see the same triangle, in both pictures: a block of 2 x 2, from which the graphics pipeline
/// chooses mip levels, is inside it, and so is the pixel's centre whatever the corners are rounded to.
std::vector<size_t> inside(const Drawn& hardware, const Drawn& kernels) {
  std::vector<size_t> found;
  for (uint32_t y = 1; y + 1 < kSize.y; ++y)
    for (uint32_t x = 1; x + 1 < kSize.x; ++x) {
      const size_t at = size_t{y} * kSize.x + x;
      bool same = kernels.visible[at].x != ~0u;
      for (uint32_t i = 0; same && i < 9; ++i) {
        const size_t beside = (y + i / 3 - 1) * kSize.x + x + i % 3 - 1;
        same = kernels.visible[beside].x == kernels.visible[at].x &&
               std::abs(kernels.depth[beside] - hardware.depth[beside]) < 1e-4f * kernels.depth[beside];
      }
      if (same) found.push_back(at);
    }
  return found;
}

class Resolve : public GpuTest {
 protected:
  /// Inside triangles the two differ by rounding (a half float's last bit is 5e-4 of 1) and by the mip levels that a
  /// driver makes of the same differences: a small part of a level, of textures that change by a few percent from one
  /// to the next. Where depths differ in their last bits a shadow's edge may move by a tap.
  static void same(const std::string& what, const Drawn& hardware, const Drawn& kernels, double leastInside) {
    const std::vector<size_t> pixels = inside(hardware, kernels);
    EXPECT_GT(static_cast<double>(pixels.size()), leastInside * kPixels) << what;
    EXPECT_EQ(hardware.targets.size(), kernels.targets.size()) << what;
    for (const auto& [name, expected] : hardware.targets) {
      const Texels& found = kernels.targets.at(name);
      float range = 0;
      for (const glm::vec4& v : expected) range = std::max({range, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
      double sum = 0;
      size_t off = 0;
      for (const size_t i : pixels) {
        const glm::vec4 d = glm::abs(found[i] - expected[i]);
        const float most = std::max({d.x, d.y, d.z, d.w}) / std::max(range, 1e-6f);
        sum += most;
        if (!(most <= 0.01f)) ++off;
      }
      const double mean = sum / static_cast<double>(pixels.size()), share = static_cast<double>(off) / pixels.size();
      std::printf("%-24s %-32s %5zu pixels, mean %.1e of %.3g, %.3f %% off by 1 %%\n", what.c_str(), name.c_str(),
                  pixels.size(), mean, range, 100 * share);
      EXPECT_LT(mean, 1e-4) << what << ": " << name;
      EXPECT_LT(share, 1e-3) << what << ": " << name;
    }
  }
};

TEST_F(Resolve, LeavesWhatTheGraphicsPipelineLeaves) {
  Lit lit(context(), everything(), small());
  for (const size_t camera : {0u, 1u})
    same(camera == 0 ? "perspective" : "orthographic", draw(lit, camera, {}, false), draw(lit, camera, {}, true), 0.4);
}

TEST_F(Resolve, Box) {
  Lit lit(context(), loadScene(assets() / "box.glb"), small());
  same("Box", draw(lit, 0, {}, false), draw(lit, 0, {}, true), 0.4);
}

TEST_F(Resolve, Sponza) {
  const auto scenes = sharedScenes();
  if (!scenes) GTEST_SKIP() << "no shared scenes";
  Lit lit(context(), loadScene(*scenes / "sponza/sponza_small_lit_m.glb"), small());
  same("Sponza", draw(lit, 0, {}, false), draw(lit, 0, {}, true), 0.1);
}

/// Leaves that go through each other, in 27 voxels and more: of many nothing is seen from a point, though they face
/// alike.
Scene thicket() {
  SceneBuilder b;
  b.scene.materials[0].doubleSided = true;
  b.addQuad({-1, -1, 1}, {2, 0, 0}, {0, 0, -2});
  b.addQuad({-1, 1, 1}, {0, 0, -2}, {2, 0, 0});
  std::mt19937 random(7);
  const auto about = [&random](float most) {
    return most * (2.0f * static_cast<float>(random() >> 8) / static_cast<float>(1u << 24) - 1.0f);
  };
  for (int i = 0; i < 400; ++i) {
    // A statement each, so that every compiler draws the numbers in the same order.
    const float z = about(0.35f), y = about(0.35f), x = about(0.35f);
    const glm::vec3 v{about(0.2f), about(0.48f), -0.4f + about(0.2f)};
    const glm::vec3 u{0.4f + about(0.2f), about(0.48f), about(0.2f)};
    b.addQuad({x, y, z}, u, v);
  }
  b.addLight(LightType::Sun, 2);
  b.addCamera({0.1, 0.9, 0.4}, {0, 0.1, 0}, 0.8f);
  return b.finish();
}

/// An invocation alone searches by parts, or Mesa's CPU driver would end its loops in a thicket: pixels would have the
/// wrong facet, and another one in the next picture.
TEST_F(Resolve, TheSearchForAPixelsFacetIsTheSameByOneAndByMany) {
  if (!context().device.isCpu) GTEST_SKIP() << "others have two pipelines for it, which may round differently";
  Settings s = small();
  s.voxel.resolution = 8;
  s.matrix.gpu.rays = 32;
  Lit lit(context(), thicket(), s);
  IndirectInputs inputs = lit.indirect();
  std::vector<Drawn> pictures;
  for (const uint32_t searchers : {32u, 1u}) {
    inputs.searchers = searchers;
    Targets targets(context(), kSize);
    lit.stage.draw(VIEW_EMITTER_IRRADIANCE, targets, 0, lit.inputs(), inputs, {});
    pictures.push_back(take(context(), targets));
    if (searchers > 1) continue;
    EXPECT_GT(downloadAs<uint32_t>(context(), targets.soughtAround).at(PICKED_COUNT), 100u) << "searched for around";
  }
  const auto different = [&](const char* name) {
    const Texels &many = pictures[0].targets.at(name), &one = pictures[1].targets.at(name);
    size_t count = 0;
    for (size_t i = 0; i < kPixels; ++i) count += many[i] != one[i];
    return count;
  };
  EXPECT_EQ(different("indirect irradiance"), 0u);
}

TEST_F(Resolve, LooksUpTheThesissVolume) {
  Settings s = small();
  s.matrix.gpu.hitRule = HitRule::thesis;
  Lit lit(context(), everything(), s);
  ASSERT_TRUE(lit.light.volume);
  same("volume", draw(lit, 0, {}, false), draw(lit, 0, {}, true), 0.4);
}

TEST_F(Resolve, MoreLightsThanTheUniformBlockHolds) {
  Scene scene = everything();
  scene.lights.resize(1);
  scene.lights[0].intensity = 0.05f;
  scene.lights.resize(UNIFORM_LIGHTS + 1, scene.lights[0]);
  scene.lights.back().intensity = 3;  // the one for which the block has no room
  Settings s = small();
  s.light.shadowResolution = 64;
  Lit lit(context(), std::move(scene), s);
  same("65 lights", draw(lit, 0, {}, false), draw(lit, 0, {}, true), 0.4);
}

TEST_F(Resolve, LeavesAbsentTargetsAlone) {
  // The image in an absent target's place is a target itself (Targets::bound).
  Lit lit(context(), everything(), small());
  const ForwardEffects none{.emission = false, .highlights = false, .indirect = false, .specular = false};
  same("no effects", draw(lit, 0, none, false), draw(lit, 0, none, true), 0.4);
}

TEST_F(Resolve, EveryPixelIsWrittenAndAlwaysTheSame) {
  Lit lit(context(), everything(), small());
  const Drawn first = draw(lit, 0, {}, true);
  // Where another picture was before.
  Targets used(context(), kSize);
  draw(lit, used, 1, {}, true);
  const Drawn second = draw(lit, used, 0, {}, true);
  for (const auto& [name, texels] : first.targets)
    EXPECT_EQ(std::memcmp(texels.data(), second.targets.at(name).data(), kPixels * sizeof(glm::vec4)), 0) << name;
  size_t seen = 0;
  for (size_t i = 0; i < kPixels; ++i) {
    const bool any = first.visible[i].x != ~0u;
    seen += any;
    ASSERT_EQ(first.depth[i] > 0, any) << i;
    for (const auto& [name, texels] : first.targets) ASSERT_TRUE(any || texels[i] == glm::vec4(0)) << name << " " << i;
    const glm::vec3 n(first.targets.at("normal, roughness")[i]);
    ASSERT_NEAR(glm::length(n), any ? 1.0f : 0.0f, 2e-3f) << i;
  }
  EXPECT_GT(seen, kPixels / 2);
  EXPECT_LT(seen, kPixels);
}

TEST_F(Resolve, ManyMaterialsInOneBlock) {
  // 30 x 20 squares, each of its own colour, 6 x 6 pixels and fewer: a block of 16 x 16 sees a dozen materials, and
  // there are more of them than slots in its table (forward/list_pixels.comp).
  SceneBuilder b;
  b.scene.materials.clear();
  for (uint32_t i = 0; i < 600; ++i) {
    Material m{.metallic = 0, .lambertian = true};
    m.baseColor = {static_cast<float>(i % 30) / 30.0f, static_cast<float>(i / 30) / 20.0f, 0.5f, 1};
    b.scene.materials.push_back(m);
    b.material = i;
    b.addQuad({i % 30, i / 30, 0}, {1, 0, 0}, {0, 1, 0});
  }
  b.addCamera({15, 10, 30}, {15, 10, 0}, 0.8f);
  Stage stage(context(), b.finish());
  Targets targets(context(), kSize);
  stage.draw(VIEW_ALBEDO, targets, 0, {}, {}, {.kernels = true});
  const Drawn drawn = take(context(), targets);
  std::set<uint32_t> seen;
  for (size_t i = 0; i < kPixels; ++i) {
    if (drawn.visible[i].x == ~0u) continue;
    const uint32_t material = drawn.visible[i].x / 2;
    seen.insert(material);
    const glm::vec4 wrong = drawn.targets.at("albedo, occlusion")[i] - stage.scene.materials.at(material).baseColor;
    ASSERT_LT(std::max({std::abs(wrong.x), std::abs(wrong.y), std::abs(wrong.z)}), 1e-3f) << i;
  }
  EXPECT_EQ(seen.size(), 600u);
}

TEST_F(Resolve, SliversKeepTheirCornersValues) {
  // Thinner than what corners are rounded to: a pixel that belongs to the rounded triangle may lie widths beside it.
  SceneBuilder b;
  b.scene.materials[0].doubleSided = true;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-1, 1), color(0.2f, 0.8f);
  for (uint32_t i = 0; i < 4000; ++i) {
    const glm::vec3 from(place(random), place(random), 0.3f * place(random)), to(place(random), place(random), 0);
    const glm::vec3 beside = 0.5f * (from + to) + glm::vec3(2e-5f * place(random), 2e-5f * place(random), 0);
    std::array<glm::vec4, 3> colors;
    for (glm::vec4& c : colors) c = {color(random), color(random), color(random), 1};
    b.addTriangle({from, to, beside}, colors);
  }
  b.scene.draws = {{0, 0, static_cast<uint32_t>(b.scene.indices.size())}};
  b.addCamera({0, 0, 2.4}, {0, 0, 0}, 0.8f);
  Stage stage(context(), b.finish());
  Targets targets(context(), kSize);
  stage.draw(VIEW_ALBEDO, targets, 0, {}, {}, {.kernels = true});
  const Drawn drawn = take(context(), targets);
  size_t seen = 0;
  for (size_t i = 0; i < kPixels; ++i) {
    if (drawn.visible[i].x == ~0u) continue;
    ++seen;
    const glm::vec4 albedo = drawn.targets.at("albedo, occlusion")[i];
    for (int c = 0; c < 3; ++c) {
      ASSERT_GT(albedo[c], 0.199f) << i;
      ASSERT_LT(albedo[c], 0.801f) << i;
    }
  }
  EXPECT_GT(seen, 100u);
}

TEST_F(Resolve, ReflectionsOfEveryPixelByItself) {
  // T 5.11, of the same targets by the fragment shader and by the kernel: the same rays.
  for (const FieldMethod field : {FieldMethod::chebyshev, FieldMethod::jfa}) {
    Settings s = small();
    s.field.method = field;
    Lit lit(context(), everything(), s);
    Targets targets(context(), kSize);
    draw(lit, targets, 0, {}, true);
    const GpuCamera gpu = makeGpuCamera(lit.stage.scene, lit.stage.scene.cameras.at(0), kSize);
    const Buffer camera = makeBuffer(context(), "camera", Subsystem::Targets, std::span<const GpuCamera>(&gpu, 1));
    const auto trace = [&] {
      Frame frame = context().begin();
      traceSpecular(frame, lit.inputs(), camera, s, targets);
      frame.submitAndWait();
      return texels(context(), targets.specular);
    };
    const Texels byKernel = trace();
    targets.visible = Buffer();
    const Texels byFragments = trace();
    size_t met = 0, off = 0;
    for (size_t i = 0; i < kPixels; ++i) {
      met += byFragments[i].x > 0;
      off += glm::length(byKernel[i] - byFragments[i]) > 1e-4f * glm::length(byFragments[i]);
    }
    EXPECT_GT(met, kPixels / 4);
    EXPECT_EQ(off, 0u) << static_cast<int>(field);
  }
}

}  // namespace
}  // namespace irad::test::resolve_suite
