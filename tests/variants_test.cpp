// Shader variants: an effect that a scene has no use for is left out, with its target and its memory, and the picture
// stays the same, bit for bit; and the pipeline with all effects stands in while a variant is compiled.
#include <gtest/gtest.h>

#include <future>
#include <set>

#include "renderer/error.h"
#include "shaders/shared/passes.h"
#include "tests/lit_stage.h"
#include "tests/test_shaders.h"

namespace irad::test {
namespace {

Settings small() {
  Settings s;
  s.voxel.resolution = 16;
  s.matrix.gpu.rays = 64;
  s.light.shadowResolution = 256;
  return s;
}

/// What a scene of these tests has.
struct Has {
  bool sun = true, spot = false, wideSpot = false, point = false;
  bool emission = false, mask = false, texture = false, normalMap = false, lobe = true, bounces = true;
};

int32_t addImage(Scene& scene, std::array<uint8_t, 4> a, std::array<uint8_t, 4> b) {
  SceneImage image{.name = "two texels", .width = 2, .height = 1, .srgb = false, .rgba = {}};
  for (const auto& texel : {a, b}) image.rgba.insert(image.rgba.end(), texel.begin(), texel.end());
  scene.images.push_back(image);
  return static_cast<int32_t>(scene.images.size()) - 1;
}

/// A floor with a box on it, and what is asked for.
Scene scene(const Has& has) {
  SceneBuilder b;
  Material floor = b.scene.materials[0];
  floor.baseColor = {0.6f, 0.5f, 0.4f, 1};
  floor.lambertian = !has.lobe;
  floor.roughness = 0.3f;
  if (has.texture) floor.baseColorTexture.image = addImage(b.scene, {255, 200, 150, 255}, {120, 220, 255, 255});
  if (has.normalMap) floor.normalTexture.image = addImage(b.scene, {160, 128, 250, 255}, {100, 140, 250, 255});
  b.scene.materials[0] = floor;
  b.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
  if (has.bounces) {
    Material& box = b.newMaterial();
    box.baseColor = {0.2f, 0.4f, 0.8f, 1};
    if (has.emission) box.emission = {2, 1, 0.5f};
    if (has.mask) {
      box.alpha = AlphaMode::Mask;
      box.baseColorTexture.image = addImage(b.scene, {255, 255, 255, 255}, {255, 255, 255, 0});
    }
    b.addBox({-0.5f, 0, -0.7f}, {0.6f, 1.1f, 0.3f});
  }
  if (has.sun) b.addLight(LightType::Sun, 3).direction = glm::normalize(glm::vec3(0.3f, -1, -0.6f));
  const auto place = [&](LightType type, glm::dvec3 at) -> Light& {
    Light& light = b.addLight(type, 12);
    light.position = at;
    light.direction = glm::normalize(glm::vec3(-at));
    return light;
  };
  if (has.point) place(LightType::Point, {-1.5, 1.7, 0.8});
  if (has.spot) place(LightType::Spot, {1.6, 2.2, 1}).outerCos = std::cos(0.5f);
  if (has.wideSpot) place(LightType::Spot, {0.2, 2.6, 1.2}).outerCos = std::cos(1.4f);
  b.addCamera({1.5, 2.5, 5}, {0, 0.4, 0}, 0.7f);
  return b.finish();
}

constexpr View kViews[] = {VIEW_LIT, VIEW_DIRECT_IRRADIANCE, VIEW_INDIRECT, VIEW_SPECULAR, VIEW_NORMAL};

struct Case {
  const char* name;
  Has without, with;  ///< scenes that do not, and do, have what is left out
  void (*leaveOut)(ForwardEffects&);
};
const Case kCases[] = {
    {"sun", {.sun = false, .spot = true, .wideSpot = true, .point = true}, {}, [](auto& e) { e.lights.sun = false; }},
    {"spot", {.point = true}, {.spot = true}, [](auto& e) { e.lights.spot = false; }},
    {"point", {.spot = true, .wideSpot = true}, {.point = true}, [](auto& e) { e.lights.point = false; }},
    {"all but sun", {}, {.point = true}, [](auto& e) { e.lights.point = e.lights.spot = false; }},
    {"all but spot",
     {.sun = false, .spot = true},
     {.spot = true},
     [](auto& e) { e.lights.point = e.lights.sun = false; }},
    {"all but wide spot",
     {.sun = false, .wideSpot = true},
     {.wideSpot = true},
     [](auto& e) { e.lights.point = e.lights.sun = false; }},
    {"all but point",
     {.sun = false, .point = true},
     {.point = true},
     [](auto& e) { e.lights.sun = e.lights.spot = false; }},
    {"lights",
     {.sun = false, .emission = true},
     {.emission = true},
     [](auto& e) {
       e.lights = {false, false, false};
     }},
    {"emission", {.texture = true}, {.emission = true}, [](auto& e) { e.emission = false; }},
    {"alpha test", {.texture = true}, {.mask = true}, [](auto& e) { e.alphaTest = false; }},
    {"normal map", {.texture = true}, {.texture = true, .normalMap = true}, [](auto& e) { e.normalMap = false; }},
    {"highlights", {.lobe = false}, {}, [](auto& e) { e.highlights = false; }},
    {"indirect", {.bounces = false}, {}, [](auto& e) { e.indirect = false; }},
    {"specular", {.lobe = false}, {}, [](auto& e) { e.specular = false; }},
};

class Variants : public GpuTest, public ::testing::WithParamInterface<size_t> {
 protected:
  /// Every view with all effects, then with one left out.
  static bool same(Lit& lit, const ForwardEffects& effects) {
    bool same = true;
    for (const View view : kViews) {
      const Picture all = lit.draw(view), some = lit.draw(view, {64, 64}, effects);
      same &= std::memcmp(all.linear.data(), some.linear.data(), all.linear.size() * sizeof(glm::vec4)) == 0 &&
              all.display == some.display;
    }
    return same;
  }
};

TEST_P(Variants, WhatASceneHasNotIsLeftOutBitForBit) {
  const Case& c = kCases[GetParam()];
  ForwardEffects effects;
  c.leaveOut(effects);
  Lit without(context(), scene(c.without), small());
  EXPECT_TRUE(same(without, effects)) << c.name;
  // Where the scene has it, the picture changes: the comparison would see it.
  Lit with(context(), scene(c.with), small());
  EXPECT_FALSE(same(with, effects)) << c.name;
}

INSTANTIATE_TEST_SUITE_P(Effects, Variants, ::testing::Range(size_t{0}, std::size(kCases)), [](const auto& info) {
  std::string name = kCases[info.param].name;
  std::erase(name, ' ');
  return name;
});

class Effects : public GpuTest {
 protected:
  /// Those of "RE Forward" among the pipelines that a picture took.
  static std::vector<PipelineUse> forward(Context& context) {
    std::vector<PipelineUse> used = context.pipelinesUsed();
    std::erase_if(used, [](const PipelineUse& use) { return use.shaders.front() != "forward/forward.vert"; });
    return used;
  }
  static constexpr ForwardEffects kNone{{false, false, false}, false, false, false, false, false, false};
};

TEST_F(Effects, LeftOutOnesAreInThePipelinesKeyAndTheOthersAreNot) {
  Lit lit(context(), scene({.lobe = false}), small());
  context().pipelinesUsed();
  lit.draw(VIEW_LIT);
  const std::vector<PipelineUse> all = forward(context());
  ASSERT_EQ(all.size(), 1u);  // nothing is textured
  for (uint32_t id = 0; id < FORWARD_PCF; ++id) EXPECT_EQ(all[0].constants.count(id), id == FORWARD_TEXTURED) << id;

  lit.draw(VIEW_LIT, {64, 64}, kNone);
  const std::vector<PipelineUse> none = forward(context());
  ASSERT_EQ(none.size(), 1u);
  for (uint32_t id = 0; id < FORWARD_PCF; ++id) {
    ASSERT_EQ(none[0].constants.count(id), 1u) << id;
    EXPECT_EQ(none[0].constants.at(id), 0u) << id;
  }
}

TEST_F(Effects, TexturesAreLookedUpWhereAMaterialHasOne) {
  const auto textured = [&](const Has& has) {
    Lit lit(context(), scene(has), small());
    context().pipelinesUsed();
    lit.draw(VIEW_LIT);
    std::multiset<bool> out;
    for (const PipelineUse& use : forward(context())) out.insert(!use.constants.contains(FORWARD_TEXTURED));
    return out;
  };
  EXPECT_EQ(textured({}), std::multiset<bool>{false});
  EXPECT_EQ(textured({.mask = true}), (std::multiset<bool>{false, true}));
  EXPECT_EQ(textured({.texture = true}), std::multiset<bool>{true});
}

TEST_F(Effects, TakeTheirCodeAlong) {
  Lit textured(context(), scene({.texture = true}), small()), plain(context(), scene({}), small());
  const auto instructions = [&](Lit& lit, const ForwardEffects& effects) {
    context().pipelinesUsed();
    lit.draw(VIEW_LIT, {16, 16}, effects);
    return specializedInstructions(*gpu().shaders, forward(context()));
  };
  const uint64_t all = instructions(textured, {});
  EXPECT_LT(instructions(plain, {}), all);
  for (const Case& c : kCases) {
    if (std::string(c.name) == "alpha test") continue;  // a pass of its own
    ForwardEffects effects;
    c.leaveOut(effects);
    EXPECT_LT(instructions(textured, effects), all) << c.name;
  }
  const uint64_t none = instructions(plain, kNone);
  std::printf("RE Forward: %llu SPIR-V instructions, %llu without effects\n", static_cast<unsigned long long>(all),
              static_cast<unsigned long long>(none));
  EXPECT_LT(4 * none, all);
}

TEST_F(Effects, TargetsComeAndGoWithThem) {
  Lit lit(context(), scene({.emission = true}), small());
  Targets targets(context(), {64, 64});
  const auto draw = [&](View view, const ForwardEffects& effects) {
    const Picture p = lit.stage.draw(view, targets, 0, lit.inputs(), lit.indirect(), effects);
    context().device.waitIdle();
    return p;
  };
  const auto bytes = [&] { return context().device.memory().used(); };
  draw(VIEW_LIT, kNone);
  const uint64_t least = bytes();
  EXPECT_EQ(targets.present(), 0u);
  EXPECT_FALSE(targets.glossy);

  const Picture first = draw(VIEW_LIT, {});
  EXPECT_EQ(targets.present(), TARGETS_ALL);
  EXPECT_TRUE(targets.glossy);
  const uint64_t texels = 64 * 64;
  EXPECT_GE(bytes(), least + texels * (8 + 4 * 16 + 4));

  // Back to nothing, and the memory with it; then the same picture again.
  draw(VIEW_LIT, kNone);
  EXPECT_EQ(bytes(), least);
  EXPECT_TRUE(draw(VIEW_LIT, {}).linear == first.linear);

  // Without rays in a list there is none; without reflections neither their target nor a pass.
  lit.stage.settings.specular.mode = SpecularMode::fragment;
  draw(VIEW_LIT, {});
  EXPECT_TRUE(targets.specular);
  EXPECT_FALSE(targets.glossy);
  lit.stage.settings.specular.mode = SpecularMode::off;
  gpu().timings.reset();
  draw(VIEW_LIT, {});
  gpu().timings.endFrame(0, /*setup=*/false, 0);
  EXPECT_FALSE(targets.specular);
  std::set<std::string> stages;
  for (const Timings::Row& row : gpu().timings.rows()) stages.insert(row.stage);
  EXPECT_EQ(stages, (std::set<std::string>{"RE Depth", "RE Forward", "View"}));
}

// ---- Variants while others are compiled
// ------------------------------------------------------------------------------

/// A context of its own, whose second thread waits at a gate before it compiles.
class Bridge : public GpuTest {
 protected:
  static constexpr uint32_t kCount = 100;

  ShaderLibrary shaders;
  Timings timings;
  std::promise<void> gate;
  std::shared_future<void> open = gate.get_future().share();
  std::string failure;
  std::optional<Context> own;

  void SetUp() override {
    GpuTest::SetUp();
    addShader();
    own.emplace(*gpu().device, shaders, timings);
    own->bridgeVariants(true, [this] {
      open.wait();
      if (!failure.empty()) throw WorkError(failure);
    });
  }
  void addShader() {
    const std::filesystem::path root = IRAD_SOURCE_DIR;
    shaders.add("effects.comp", compileGlsl(root / "shaders", (root / "tests/shaders/effects.comp").string()));
  }
  /// Runs the shader and returns the constants that its pipeline had; checks what it wrote.
  std::map<uint32_t, uint32_t> run(bool first, bool second) {
    struct {
      uint64_t to;
      uint32_t count, nothing;
    } push{};
    const Buffer to(own->device, "out", Subsystem::Staging, 4 * kCount);
    push.to = to.address;
    push.count = kCount;
    own->pipelinesUsed();
    Frame frame = own->begin();
    frame.pass("Effects")
        .shader("effects.comp")
        .effect(0, first)
        .effect(1, second)
        .write(to)
        .push(push)
        .dispatch(kCount);
    frame.submitAndWait();
    const std::vector<uint32_t> values = downloadAs<uint32_t>(*own, to);
    for (uint32_t i = 0; i < kCount; ++i) EXPECT_EQ(values.at(i), i);
    const std::vector<PipelineUse> used = own->pipelinesUsed();
    return used.size() == 1 ? used[0].constants : std::map<uint32_t, uint32_t>{{99, 99}};
  }
  uint64_t compiled() { return own->counters().pipelines; }
  /// Until the thread has nothing left to do.
  void settle() {
    while (own->variantsCompiling() > 0) own->begin().submitAndWait();
  }
  void openAndSettle() {
    gate.set_value();
    settle();
  }
};

using Constants = std::map<uint32_t, uint32_t>;

TEST_F(Bridge, TheFirstPictureWaitsForItsOwnAlone) {
  const uint64_t before = compiled();
  EXPECT_EQ(run(false, true), (Constants{{0, 0}}));
  EXPECT_EQ(compiled() - before, 1u);
  EXPECT_EQ(own->variantsCompiling(), 1u);  // the one with all effects, for later
  // Another one before that is there: again its own alone.
  EXPECT_EQ(run(true, false), (Constants{{1, 0}}));
  EXPECT_EQ(compiled() - before, 2u);
  openAndSettle();
  EXPECT_EQ(compiled() - before, 3u);
}

TEST_F(Bridge, AllEffectsStandInUntilTheVariantIsThere) {
  EXPECT_EQ(run(true, true), Constants{});
  const uint64_t before = compiled();
  for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(run(false, false), Constants{});
  EXPECT_EQ(own->variantsCompiling(), 1u);
  EXPECT_EQ(compiled(), before);
  openAndSettle();
  EXPECT_EQ(compiled() - before, 1u);
  EXPECT_EQ(run(false, false), (Constants{{0, 0}, {1, 0}}));
  // Where a picture must not depend on what is ready, every pass waits.
  own->bridgeVariants(false);
  EXPECT_EQ(run(false, true), (Constants{{0, 0}}));
}

TEST_F(Bridge, WhatTheThreadMeetsIsThrownByTheNextFrame) {
  run(true, true);
  failure = "the compiler gave up";
  run(false, true);
  try {
    openAndSettle();
    FAIL() << "no error";
  } catch (const WorkError& error) {
    EXPECT_EQ(std::string(error.what()), failure);
  }
  // The next picture asks anew.
  failure.clear();
  EXPECT_EQ(run(false, true), Constants{});
  settle();
  EXPECT_EQ(run(false, true), (Constants{{0, 0}}));
}

TEST_F(Bridge, OtherShadersDropWhatIsBeingCompiled) {
  run(true, true);
  run(false, true);
  run(true, false);
  EXPECT_EQ(own->variantsCompiling(), 2u);
  addShader();  // as a reload does
  EXPECT_EQ(run(true, true), Constants{});
  EXPECT_EQ(own->variantsCompiling(), 0u);
  gate.set_value();
  EXPECT_EQ(run(false, false), Constants{});
}

TEST_F(Bridge, ItsEndWaitsForWhatIsBeingCompiled) {
  run(true, true);
  run(false, true);
  gate.set_value();
  own.reset();
}

}  // namespace
}  // namespace irad::test
