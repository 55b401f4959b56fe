// Shader variants: an effect that a scene has no use for is left out, with its target and its memory, and the picture
// stays the same, bit for bit; and the pipeline with all effects stands in while a variant is compiled.
#include <gtest/gtest.h>

#include <future>
#include <numeric>
#include <set>

#include "renderer/base/error.h"
#include "shaders/shared/passes.h"
#include "tests/effects_fixture.h"
#include "tests/lit_stage.h"
#include "tests/test_shaders.h"

namespace irad::test::variants_suite {
namespace {

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
  static constexpr ForwardEffects kNone{{}, false, false, false, false, false, false};
};

TEST_F(VariantKeys, LeftOutEffectsAreInThePipelinesKeyAndTheOthersAreNot) {
  const std::vector<PipelineUse> all = forward(room(true)), none = forward(room(true), kNone);
  ASSERT_EQ(all.size(), 1u);  // nothing is textured
  ASSERT_EQ(none.size(), 1u);
  for (uint32_t id = 0; id < FORWARD_PCF; ++id) {
    EXPECT_EQ(all[0].constants.count(id), id == FORWARD_TEXTURED) << id;
    ASSERT_EQ(none[0].constants.count(id), 1u) << id;
    EXPECT_EQ(none[0].constants.at(id), 0u) << id;
  }
}

TEST_F(VariantKeys, TexturesAreLookedUpWhereAMaterialHasOne) {
  const auto textured = [&](Scene scene) {
    std::multiset<bool> out;
    for (const PipelineUse& use : forward(std::move(scene))) out.insert(!use.constants.contains(FORWARD_TEXTURED));
    return out;
  };
  Scene all = room(true, {}, /*textured=*/true);
  for (Material& m : all.materials) m.baseColorTexture.image = 1;
  EXPECT_EQ(textured(room(true)), std::multiset<bool>{false});
  EXPECT_EQ(textured(room(true, {}, /*textured=*/true)), (std::multiset<bool>{false, true}));
  EXPECT_EQ(textured(all), std::multiset<bool>{true});
}

TEST_F(VariantKeys, LeftOutEffectsTakeTheirCodeAlong) {
  std::vector<PipelineUse> all = forward(room(true, {}, /*textured=*/true));
  std::erase_if(all, [](const PipelineUse& use) { return use.constants.contains(FORWARD_TEXTURED); });
  const auto instructions = [&](const std::vector<uint32_t>& leftOut) {
    std::vector<PipelineUse> variant = all;
    for (const uint32_t id : leftOut) variant.at(0).constants[id] = 0;
    return specializedInstructions(*gpu().shaders, variant);
  };
  std::vector<uint32_t> every(FORWARD_PCF);
  std::iota(every.begin(), every.end(), 0);
  const uint64_t whole = instructions({});
  for (const uint32_t id : every) {
    std::vector<uint32_t> leftOut{id};
    // Points share their code with spots, but for their shadow cubes.
    if (id == FORWARD_LIGHTS + LIGHT_POINT) leftOut.push_back(FORWARD_LIGHTS + LIGHT_CUBE_MAPS);
    EXPECT_LT(instructions(leftOut), whole) << id;
  }
  EXPECT_LT(4 * instructions(every), whole);
}

/// What the plan can force is compared in effect_rows_test.cpp.
TEST_F(VariantKeys, HighlightsAreLeftOutBitForBitWhereNoMaterialHasALobe) {
  const Scene matt = room(/*emits=*/true, {lamp(0.3)});
  for (const bool lobe : {false, true}) {
    Lit lit(context(), lobe ? glossy(matt) : matt, small());
    const Picture all = lit.draw(VIEW_LIT), some = lit.draw(VIEW_LIT, {64, 64}, {.highlights = false});
    EXPECT_EQ(same(all.linear, some.linear) && all.display == some.display, !lobe);
  }
}

/// (That their memory goes with them: effect_rows_test.cpp.)
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

using Constants = std::map<uint32_t, uint32_t>;

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
    const std::filesystem::path root = sourceFolder();
    shaders.add("effects.comp", compileGlsl(root / "shaders", (root / "tests/shaders/effects.comp").string()));
  }
  /// Runs the shader and returns the constants that its pipeline had; checks what it wrote.
  Constants run(bool first, bool second) {
    struct {
      uint64_t to;
      uint32_t count, nothing;
    } push{};
    const Buffer to(own->device, "out", Subsystem::Staging, 4 * kCount);
    push.count = kCount;
    own->pipelinesUsed();
    Frame frame = own->begin();
    Pass pass = frame.pass("Effects");
    push.to = pass.out(to);
    pass.shader("effects.comp").effect(0, first).effect(1, second).push(push).dispatch(kCount);
    frame.submitAndWait();
    const std::vector<uint32_t> values = downloadAs<uint32_t>(*own, to);
    for (uint32_t i = 0; i < kCount; ++i) EXPECT_EQ(values.at(i), i);
    const std::vector<PipelineUse> used = own->pipelinesUsed();
    return used.size() == 1 ? used[0].constants : Constants{{99, 99}};
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

TEST_F(Bridge, TheFirstPictureWaitsForItsOwnAlone) {
  const uint64_t before = compiled();
  EXPECT_EQ(run(false, true), (Constants{{0, 0}}));
  EXPECT_EQ(compiled() - before, 1u);
  EXPECT_EQ(own->variantsCompiling(), 1u);  // the one with all effects, for later
  // Another variant, before the one with all effects is there: again only its own is compiled.
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
  // The next picture asks again.
  failure.clear();
  EXPECT_EQ(run(false, true), Constants{});
  settle();
  EXPECT_EQ(run(false, true), (Constants{{0, 0}}));
}

TEST_F(Bridge, OtherShadersDropWhatIsBeingCompiledAndItsEndWaits) {
  run(true, true);
  run(false, true);
  run(true, false);
  EXPECT_EQ(own->variantsCompiling(), 2u);
  addShader();  // as a reload does
  EXPECT_EQ(run(true, true), Constants{});
  EXPECT_EQ(own->variantsCompiling(), 0u);
  gate.set_value();
  EXPECT_EQ(run(false, false), Constants{});
  own.reset();
}

}  // namespace
}  // namespace irad::test::variants_suite
