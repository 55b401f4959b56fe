// Shader variants: an effect that a scene has no use for is left out, with its target and its memory, and the picture
// stays the same, bit for bit; and the pipeline with all effects stands in while a variant is compiled.
#include <gtest/gtest.h>

#include <future>
#include <set>

#include "renderer/base/error.h"
#include "shaders/shared/passes.h"
#include "tests/effects_fixture.h"
#include "tests/lit_stage.h"
#include "tests/test_shaders.h"

namespace irad::test::variants_suite {
namespace {

using Constants = std::map<uint32_t, uint32_t>;

class VariantKeys : public EffectsTest {
 protected:
  /// The pipelines of "RE Forward" among those that a picture took.
  std::vector<PipelineUse> forward(Scene scene, const ForwardEffects& effects = {}) {
    Lit lit(context(), std::move(scene), small());
    context().pipelinesUsed();
    lit.draw(VIEW_LIT, {16, 16}, effects);
    std::vector<PipelineUse> used = context().pipelinesUsed();
    std::erase_if(used, [](const PipelineUse& use) { return use.shaders.front() != "forward/forward.vert"; });
    return used;
  }
  static constexpr ForwardEffects kNone{.lights = {},
                                        .emission = false,
                                        .alphaTest = false,
                                        .normalMap = false,
                                        .glass = false,
                                        .highlights = false,
                                        .indirect = false,
                                        .specular = false};
};

TEST_F(VariantKeys, LeftOutEffectsAreInThePipelinesKeyAndTakeTheirCodeAlong) {
  PipelineUse all = forward(room(true)).at(0);
  const PipelineUse none = forward(room(true), kNone).at(0);
  EXPECT_EQ(all.constants.erase(FORWARD_TEXTURED), 1u);  // nothing is
  const auto instructions = [&](const Constants& leftOut) {
    PipelineUse variant = all;
    for (const auto& [id, value] : leftOut) variant.constants[id] = value;
    return specializedInstructions(*gpu().shaders, std::span(&variant, 1));
  };
  Constants every;
  for (uint32_t id = FORWARD_LIGHTS; id < FORWARD_PCF; ++id) {
    EXPECT_EQ(all.constants.count(id), 0u) << id;
    EXPECT_EQ(none.constants.at(id), 0u) << id;
    // Points share their code with spots, but for their shadow cubes.
    const bool cubes = id == FORWARD_LIGHTS + LIGHT_POINT;
    EXPECT_LT(instructions({{id, 0}, {cubes ? FORWARD_LIGHTS + LIGHT_CUBE_MAPS : id, 0}}), instructions({})) << id;
    every[id] = 0;
  }
  EXPECT_LT(4 * instructions(every), instructions({}));
}

TEST_F(VariantKeys, TexturesAreLookedUpWhereAMaterialHasOne) {
  const auto expect = [&](Scene scene, const std::multiset<bool>& wanted) {
    std::multiset<bool> textured;
    for (const PipelineUse& use : forward(std::move(scene))) textured.insert(!use.constants.contains(FORWARD_TEXTURED));
    EXPECT_EQ(textured, wanted);
  };
  Scene all = room(true, {}, /*textured=*/true);
  for (Material& m : all.materials) m.baseColorTexture.image = 1;
  expect(room(true), {false});
  expect(room(true, {}, /*textured=*/true), {false, true});
  expect(all, {true});
}

/// What the plan can force is compared in effects_test.cpp.
TEST_F(VariantKeys, HighlightsAreLeftOutBitForBitWhereNoMaterialHasALobe) {
  const Scene matt = room(/*emits=*/true, {lamp(0.3)});
  for (const bool lobe : {false, true}) {
    Lit lit(context(), lobe ? glossy(matt) : matt, small());
    const Picture all = lit.draw(VIEW_LIT), some = lit.draw(VIEW_LIT, {64, 64}, {.highlights = false});
    EXPECT_EQ(same(all.linear, some.linear) && all.display == some.display, !lobe);
  }
}

/// (That their memory goes with them: effects_test.cpp.)
TEST_F(VariantKeys, TargetsComeAndGoWithThem) {
  Lit lit(context(), glossy(room(/*emits=*/true, {lamp(0.3)})), small());
  Targets targets(context(), {64, 64});
  const auto draw = [&](SpecularMode mode, const ForwardEffects& effects = {}) {
    lit.stage.settings.specular.mode = mode;
    lit.stage.draw(VIEW_LIT, targets, 0, lit.inputs(), lit.indirect(), effects);
    timings().endFrame(0, /*setup=*/false, 0);
    EXPECT_EQ(static_cast<bool>(targets.glossy), static_cast<bool>(targets.specular) && mode == SpecularMode::compute);
    return targets.present();
  };
  EXPECT_EQ(draw(SpecularMode::compute, kNone), 0u);
  EXPECT_EQ(draw(SpecularMode::compute), TARGETS_ALL);
  EXPECT_EQ(draw(SpecularMode::fragment), TARGETS_ALL);  // pixels trace by themselves: there is no list of them
  recorded();
  EXPECT_EQ(draw(SpecularMode::off), TARGETS_ALL & ~TARGET_SPECULAR);
  EXPECT_EQ(recorded(), (Stages{"RE Depth", "RE Forward", "View"}));
  EXPECT_EQ(draw(SpecularMode::compute, kNone), 0u);
}

/// A context of its own, whose second thread waits at a gate before it compiles.
class Bridge : public GpuTest {
 protected:
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
    const std::filesystem::path root = sourceFolder();
    shaders.add("effects.comp", compileGlsl(root / "shaders", (root / "tests/shaders/effects.comp").string()));
  }
  /// Runs the shader; the constants that its pipeline has to have, and how many are compiled meanwhile.
  void run(bool first, bool second, const Constants& constants, std::optional<uint64_t> compiled = {}) {
    struct {
      uint64_t to;
      uint32_t count = 100, nothing = 0;
    } push{};
    const Buffer to(own->device, "out", Subsystem::Staging, 4 * push.count);
    own->pipelinesUsed();
    const uint64_t before = own->counters().pipelines;
    Frame frame = own->begin();
    Pass pass = frame.pass("Effects");
    push.to = pass.out(to);
    pass.shader("effects.comp").effect(0, first).effect(1, second).push(push).dispatch(push.count);
    frame.submitAndWait();
    EXPECT_EQ(own->counters().pipelines - before, compiled.value_or(own->counters().pipelines - before));
    const std::vector<uint32_t> values = downloadAs<uint32_t>(*own, to);
    for (uint32_t i = 0; i < push.count; ++i) EXPECT_EQ(values.at(i), i);
    const std::vector<PipelineUse> used = own->pipelinesUsed();
    ASSERT_EQ(used.size(), 1u);
    EXPECT_EQ(used[0].constants, constants);
  }
  /// Until the thread has nothing left to do.
  void settle() {
    while (own->variantsCompiling() > 0) own->begin().submitAndWait();
  }
};

TEST_F(Bridge, TheFirstPictureWaitsForItsOwnAlone) {
  const uint64_t before = own->counters().pipelines;
  run(false, true, {{0, 0}}, 1);
  EXPECT_EQ(own->variantsCompiling(), 1u);  // the one with all effects, for later
  run(true, false, {{1, 0}}, 1);            // another variant before that is there
  gate.set_value();
  settle();
  EXPECT_EQ(own->counters().pipelines - before, 3u);
}

TEST_F(Bridge, AllEffectsStandInUntilTheVariantIsThere) {
  run(true, true, {});
  const uint64_t before = own->counters().pipelines;
  for (int frame = 0; frame < 3; ++frame) run(false, false, {}, 0);
  EXPECT_EQ(own->variantsCompiling(), 1u);
  gate.set_value();
  settle();
  EXPECT_EQ(own->counters().pipelines - before, 1u);
  run(false, false, {{0, 0}, {1, 0}});
  // Where a picture must not depend on what is ready, every pass waits.
  own->bridgeVariants(false);
  run(false, true, {{0, 0}});
}

TEST_F(Bridge, WhatTheThreadMeetsIsThrownByTheNextFrame) {
  run(true, true, {});
  failure = "the compiler gave up";
  run(false, true, {});
  gate.set_value();
  try {
    settle();
    FAIL() << "no error";
  } catch (const WorkError& error) {
    EXPECT_EQ(std::string(error.what()), failure);
  }
  // The next picture asks again.
  failure.clear();
  run(false, true, {});
  settle();
  run(false, true, {{0, 0}});
}

TEST_F(Bridge, OtherShadersDropWhatIsBeingCompiledAndItsEndWaits) {
  run(true, true, {});
  run(false, true, {});
  run(true, false, {});
  EXPECT_EQ(own->variantsCompiling(), 2u);
  addShader();  // as a reload does
  run(true, true, {});
  EXPECT_EQ(own->variantsCompiling(), 0u);
  gate.set_value();
  run(false, false, {});
  own.reset();
}

}  // namespace
}  // namespace irad::test::variants_suite
