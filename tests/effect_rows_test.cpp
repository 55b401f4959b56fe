// Each row of the effect plan on a device. What calls for an effect flips: it is there with the next picture, with its
// passes, memory and shader code; it flips back, and they are gone, to the last byte. Where the scene does not call for
// it, forced on it gives the same bits.
#include "gi/lighting.h"
#include "gi/plan.h"
#include "renderer/targets.h"
#include "shaders/shared/passes.h"
#include "tests/effects_fixture.h"

namespace irad::test::effect_rows_suite {
namespace {

constexpr View kViews[] = {VIEW_IRRADIANCE, VIEW_LIT,      VIEW_DIRECT_IRRADIANCE,
                           VIEW_INDIRECT,   VIEW_SPECULAR, VIEW_NORMAL};

Scene emptyRoom() {
  return room(/*emits=*/false);
}
Scene lampRoom() {
  return room(/*emits=*/true, {lamp(0.3)});
}
Scene texturedRoom() {
  return room(/*emits=*/true, {lamp(0.3)}, /*textured=*/true);
}
Scene glossyRoom() {
  Scene scene = emptyRoom();
  scene.materials[0].lambertian = false;
  scene.materials[0].roughness = 0.2f;
  return scene;
}
/// H is the same everywhere but for what lights add to it.
Scene evenRoom() {
  return furnaceBox(0.5f);
}

using Flip = std::array<Edit, 2>;  // the scene no longer calls for the effect; it does
Flip flip(std::vector<Light> always, Light flipped) {
  std::vector<Light> all = always;
  all.push_back(std::move(flipped));
  return {lights(std::move(always)), lights(std::move(all))};
}
/// Back to what the scene calls for.
Flip flip(const std::string& name, const std::string& off = "off", const std::string& on = "auto") {
  return {setting(name + "=" + off), setting(name + "=" + on)};
}

constexpr uint32_t kNone = UINT32_MAX;
/// How one effect is called for, and what it brings along.
struct Row {
  Effect effect;
  Scene (*scene)();
  Flip flip;
  const char *stage, *memory, *shader;  ///< of the effect alone: a stage, a buffer or image, a shader; "": none
  uint32_t constant;                    ///< constant of "RE Forward", in the key where the effect is off
};
using E = Effect;
const Row kRows[] = {
    {E::emission, lampRoom, flip("effects.emission"), "GI Solve Emitters", "emitted share F M", "", FORWARD_EMISSION},
    {E::emitterSampling, lampRoom, flip("matrix.emitter_sampling", "off", "on"), "", "emitters' correction",
     "gi/sample_emitters", kNone},
    {E::sun, emptyRoom, flip({lamp(0.3)}, sun()), "", "shadow maps", "", FORWARD_LIGHTS + LIGHT_SUN},
    {E::point, emptyRoom, flip({sun()}, lamp(0.3)), "", "shadow cubes", "", FORWARD_LIGHTS + LIGHT_POINT},
    {E::spot, emptyRoom, flip({lamp(0.3)}, spot()), "", "shadow maps", "", FORWARD_LIGHTS + LIGHT_SPOT},
    {E::matrix, emptyRoom, flip({}, lamp(0.3)), "GI BuildMatrix", "indirect irradiance H", "", FORWARD_INDIRECT},
    {E::specular, glossyRoom, flip({}, lamp(0.3)), "RE Specular", "specular radiance", "", FORWARD_F0},
    {E::secondFacet, lampRoom, flip("effects.second_facet"), "", "", "", kNone},
    {E::field, lampRoom, flip("matrix.traversal", "dda", "sdf"), "GI SDF", "chebyshev field", "", kNone},
    {E::alphaTest, texturedRoom, flip("effects.alpha_test"), "", "", "forward/depth_masked.frag", kNone},
    {E::normalMap, texturedRoom, flip("effects.normal_map"), "", "", "", FORWARD_NORMAL_MAP},
    {E::blur, evenRoom, flip({}, spot()), "", "blurred H", "", kNone},
};

class Rows : public EffectsTest {
 protected:
  struct Shown {
    Pixels picture;
    uint64_t bytes = 0;  ///< without staging, which is kept
  };
  static Settings settings() {
    Settings s = small();
    s.effects.blurNoise = 1e-2f;
    return s;
  }
  /// One prepare and one picture: with all that the effect brings where it is `wanted`, else with nothing of it.
  Shown show(Pipeline& pipeline, Targets& targets, const Row& row, bool wanted) {
    context().finish();
    timings().reset();
    context().pipelinesUsed();
    pipeline.darken();  // so that the light does not depend on what was there before
    pipeline.prepare();
    Shown shown{.picture = draw(pipeline, targets)};
    const Stages stages = recorded();
    shown.bytes = bytesOf([](const MemoryRow& held) { return held.subsystem != Subsystem::Staging; });
    const EffectRow now = pipeline.plan().row(row.effect);
    SCOPED_TRACE(fmt::format("{} {}: {}", now.info().name, now.stateName(), now.reason));
    EXPECT_EQ(now.state == EffectState::on, wanted);
    EXPECT_FALSE(now.reason.empty());
    EXPECT_EQ(*row.stage && any(stages, row.stage), *row.stage && wanted) << row.stage;
    EXPECT_EQ(holds(row.memory), *row.memory && wanted) << row.memory;
    if (row.effect == E::secondFacet) {
      EXPECT_EQ(pipeline.facets().count > pipeline.facets().solidVoxels, wanted);
    }
    bool ran = false;
    for (const PipelineUse& use : context().pipelinesUsed()) {
      for (const std::string& shader : use.shaders) ran |= *row.shader && shader.starts_with(row.shader);
      // The key names what is left out: an effect that is on is the shader's own default.
      if (row.constant == kNone || use.shaders.front() != "forward/forward.vert") continue;
      const auto at = use.constants.find(row.constant);
      const bool mayHaveIt = row.effect != E::normalMap || !use.constants.contains(FORWARD_TEXTURED);
      EXPECT_TRUE(!mayHaveIt || (at == use.constants.end()) == wanted);
      EXPECT_TRUE(at == use.constants.end() || at->second == 0);
    }
    EXPECT_EQ(ran, wanted && *row.shader) << row.shader;
    return shown;
  }
  /// With `force` applied, which is taken back, every view is as planned: the same bits, or H within `epsilon` of its
  /// largest.
  template <class Force>
  void expectSame(Pipeline& pipeline, Targets& targets, Force&& force, float epsilon = 0) {
    const auto pictures = [&] {
      pipeline.darken();
      pipeline.prepare();
      std::vector<Pixels> out;
      for (const View view : kViews) out.push_back(draw(pipeline, targets, view));
      return out;
    };
    const Settings planned = pipeline.settings();
    const std::vector<Pixels> before = pictures();
    Settings forced = planned;
    force(forced);
    pipeline.set(forced);
    const std::vector<Pixels> after = pictures();
    const float allowed = epsilon * pipeline.lighting().report.largestH;
    for (size_t i = 0; epsilon == 0 && i < before.size(); ++i) EXPECT_TRUE(same(before[i], after[i])) << kViews[i];
    for (size_t i = 0; epsilon > 0 && i < before[0].size(); ++i) ASSERT_NEAR(before[0][i].x, after[0][i].x, allowed);
    pipeline.set(planned);
  }
  void expectSameForcedOn(Pipeline& pipeline, Targets& targets, const EffectRow& row) {
    SCOPED_TRACE(row.info().name);
    if (const auto mode = row.info().mode)
      expectSame(
          pipeline, targets, [&](Settings& s) { s.effects.*mode = EffectMode::on; }, row.epsilon);
  }
};

class EffectRows : public Rows, public ::testing::WithParamInterface<size_t> {};

TEST_P(EffectRows, ComeWithinOneFrameAndGoWithTheirMemory) {
  const Row& row = kRows[GetParam()];
  Pipeline pipeline(context(), row.scene(), settings());
  Targets targets(context(), {32, 24});
  std::array<Shown, 2> first;  // off, on
  for (const bool again : {false, true})
    for (const bool wanted : {false, true}) {
      row.flip[wanted](pipeline);
      Shown shown = show(pipeline, targets, row, wanted);
      // The field only saves time.
      EXPECT_EQ(wanted && same(shown.picture, first[0].picture), wanted && row.effect == E::field);
      EXPECT_TRUE(!wanted || !*row.memory || shown.bytes > first[0].bytes);
      EXPECT_TRUE(!again || same(shown.picture, first[wanted].picture));
      EXPECT_TRUE(!again || shown.bytes == first[wanted].bytes);
      first[wanted] = std::move(shown);
    }
  row.flip[false](pipeline);
  pipeline.prepare();
  // Not called for, rather than taken away by a setting.
  if (forcedMode(pipeline.settings(), row.effect) == EffectMode::automatic)
    expectSameForcedOn(pipeline, targets, pipeline.plan().row(row.effect));
}

INSTANTIATE_TEST_SUITE_P(Plan, EffectRows, ::testing::Range(size_t{0}, std::size(kRows)), [](const auto& info) {
  std::string name = effectInfo(kRows[info.param].effect).name;
  std::erase(name, '-');
  return name;
});

TEST_F(Rows, APlainRoomHasNoPartOfWhatItDoesNotCallFor) {
  Pipeline pipeline(context(), room(/*emits=*/false, {lamp(0.3)}), settings());
  Targets targets(context(), {32, 24});
  pipeline.prepare();
  std::set<Effect> off;
  for (const Row& row : kRows) {
    if (!pipeline.plan().off(row.effect)) continue;
    off.insert(row.effect);
    show(pipeline, targets, row, false);
    EXPECT_FALSE(targets.specular);
    EXPECT_FALSE(targets.glossy);
    EXPECT_FALSE(pipeline.facets().hasEmission);
    EXPECT_FALSE(pipeline.lighting().emitted);
    expectSameForcedOn(pipeline, targets, pipeline.plan().row(row.effect));
    EXPECT_EQ(holds("emitted share F M"), row.effect == E::emission);  // until the next prepare
  }
  for (const E e : {E::emission, E::emitterSampling, E::sun, E::spot, E::specular, E::alphaTest, E::normalMap})
    EXPECT_TRUE(off.contains(e)) << effectInfo(e).name;
  EXPECT_EQ(pipeline.plan().row(E::specular).bytesNotAllocated, 32u * 24 * 20);
}

TEST_F(Rows, KindsOfLightThatAreNotThereAreLeftOutBitForBit) {
  Pipeline pipeline(context(), room(/*emits=*/true), settings());
  Targets targets(context(), {32, 24});
  const Light narrow = spot(), wide = spot(0.17f);
  const std::vector<Light> sets[]{
      {narrow, wide, lamp(0.3)}, {sun(), lamp(0.3)}, {sun(), narrow, wide}, {sun()}, {narrow}, {wide}, {lamp(0.3)}, {}};
  for (const std::vector<Light>& there : sets) {
    SCOPED_TRACE(&there - sets);
    pipeline.setLights(there);
    expectSame(pipeline, targets,
               [](Settings& s) { s.effects.sun = s.effects.point = s.effects.spot = EffectMode::on; });
  }
}

/// Lamps that are dragged about: what is there after the first place stays, and what is not does not come.
TEST_F(Rows, LightsThatMoveSwitchNothing) {
  const std::vector<Light> places{lamp(0.2), lamp(0.1), lamp(-0.2), lamp(0.3)};
  // Where its range ends at the room's wall. 16 voxels of 1/8: two of them wide is the trigger, four where it lets go.
  const auto atReach = [](double gap) {
    Light light = lamp(1 + gap);
    light.position.y = 0;
    light.range = 1;
    return light;
  };
  const struct {
    Effect effect;
    Scene scene;
    float blurNoise;
    bool on;
    const char* terms;
    std::vector<Light> places;
  } drags[]{{E::point,
             emptyRoom(),
             0.01f,
             true,
             "point on, has shadow cubes, has matrix",
             {atReach(1.2), atReach(1.3), atReach(1.2), atReach(1.3)}},
            {E::point,
             emptyRoom(),
             0.01f,
             false,
             "point off, no shadow cubes, no matrix",
             {atReach(2), atReach(1.3), atReach(2), atReach(1.3)}},
            // The blur is watched, not tried: where it shows nothing it stays off.
            {E::blur, evenRoom(), 0.9f, false, "blur off, no blurred H", places},
            {E::blur, lampRoom(), 1e-4f, true, "blur on, has blurred H", places},
            // Lights do not change F M, nor what was found of its samples.
            {E::emitterSampling, lampRoom(), 0.01f, true, "emitter-sampling on, has emitters' correction", places}};
  for (const auto& drag : drags) {
    Settings s = settings();
    s.effects.blurNoise = drag.blurNoise;
    Pipeline pipeline(context(), drag.scene, s);
    uint64_t flips = 0;
    for (size_t i = 0; i < drag.places.size(); ++i) {
      const auto drop = [&](Pipeline& p) {
        p.setLights({drag.places[i]});
        EXPECT_TRUE(i == 0 || p.plan().on(drag.effect) == drag.on);
      };
      walk(pipeline, {{drop, drag.terms, drag.effect == E::point ? '.' : ' '}});
      if (i == 0) flips = pipeline.flips();
    }
    EXPECT_EQ(pipeline.flips(), flips);
  }
}

/// What it would change is the same number, measured with its copies or without.
TEST_F(Rows, TheBlurIsMeasuredAlike) {
  const auto noise = [&](float epsilon) {
    Settings s = settings();
    s.effects.blurNoise = epsilon;
    const auto pipeline = prepared(lampRoom(), s);
    pipeline->setLights({lamp(-0.1)});
    pipeline->darken();
    pipeline->prepare();
    EXPECT_EQ(pipeline->plan().on(E::blur), epsilon < 0.5f);
    return pipeline->traits().light.noise.value_or(-1);
  };
  const float with = noise(1e-4f), without = noise(0.99f);
  EXPECT_GT(with, 0);
  EXPECT_EQ(with, without);
}

}  // namespace
}  // namespace irad::test::effect_rows_suite
