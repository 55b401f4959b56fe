// Each row of the effect plan on a device. What calls for an effect flips: it is there with the next picture, with its
// passes, memory and shader code; it flips back, and they are gone, to the last byte. Where the scene does not call for
// it, forced on it gives the same bits.
#include "app/plan_proof.h"
#include "gi/lighting.h"
#include "gi/plan.h"
#include "renderer/targets.h"
#include "shaders/shared/passes.h"
#include "tests/effects_fixture.h"

namespace irad::test::effect_rows_suite {
namespace {

/// The first is what thresholds are judged by.
constexpr View kViews[] = {VIEW_LIT,      VIEW_IRRADIANCE, VIEW_DIRECT_IRRADIANCE,
                           VIEW_INDIRECT, VIEW_SPECULAR,   VIEW_NORMAL};
constexpr glm::uvec2 kSize{32, 24};

const Scene kEmpty = room(/*emits=*/false), kGlossy = glossy(kEmpty), kLamp = room(/*emits=*/true, {lamp(0.3)}),
            kTextured = room(/*emits=*/true, {lamp(0.3)}, /*textured=*/true),
            kEven = furnaceBox(0.5f);  // H is the same everywhere but for what lights add to it

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
  const Scene& scene;
  Flip flip;
  const char *stage, *memory, *shader;  ///< of the effect alone: a stage, a buffer or image, a shader; "": none
  uint32_t constant;                    ///< constant of "RE Forward", in the key where the effect is off
};
using E = Effect;
const Row kRows[] = {
    {E::emission, kLamp, flip("effects.emission"), "GI Solve Emitters", "emitted share F M", "", FORWARD_EMISSION},
    {E::emitterSampling, kLamp, flip("matrix.emitter_sampling", "off", "on"), "", "emitters' correction",
     "gi/sample_emitters", kNone},
    {E::sun, kEmpty, flip({lamp(0.3)}, sun()), "", "shadow maps", "", FORWARD_LIGHTS + LIGHT_SUN},
    {E::point, kEmpty, flip({sun()}, lamp(0.3)), "", "shadow cubes", "", FORWARD_LIGHTS + LIGHT_POINT},
    {E::spot, kEmpty, flip({lamp(0.3)}, spot()), "", "shadow maps", "", FORWARD_LIGHTS + LIGHT_SPOT},
    {E::matrix, kEmpty, flip({}, lamp(0.3)), "GI BuildMatrix", "indirect irradiance H", "", FORWARD_INDIRECT},
    {E::specular, kGlossy, flip({}, lamp(0.3)), "RE Specular", "specular radiance", "", FORWARD_F0},
    {E::secondFacet, kLamp, flip("effects.second_facet"), "", "", "", kNone},
    {E::field, kLamp, flip("matrix.traversal", "dda", "sdf"), "GI SDF", "chebyshev field", "", kNone},
    {E::alphaTest, kTextured, flip("effects.alpha_test"), "", "", "forward/depth_masked.frag", kNone},
    {E::normalMap, kTextured, flip("effects.normal_map"), "", "", "", FORWARD_NORMAL_MAP},
    {E::blur, kEven, flip({}, spot()), "", "blurred H", "", kNone},
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
    const uint64_t staging = bytesOf(Subsystem::Staging.text);
    shown.bytes = usedBytes() - staging;
    const EffectRow now = pipeline.plan().row(row.effect);
    SCOPED_TRACE(fmt::format("{} {}: {}", now.info().name, now.stateName(), now.reason));
    EXPECT_EQ(now.state == EffectState::on, wanted);
    EXPECT_FALSE(now.reason.empty());
    EXPECT_TRUE(!*row.stage || any(stages, row.stage) == wanted) << row.stage;
    EXPECT_TRUE(!*row.memory || holds(row.memory) == wanted) << row.memory;
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
  std::unique_ptr<app::Bench> bench(const Scene& scene) {
    return std::make_unique<app::Bench>(context(), scene, settings(), kSize, VIEW_LIT, scene.cameras.at(0));
  }
};

class EffectRows : public Rows, public ::testing::WithParamInterface<size_t> {};

TEST_P(EffectRows, ComeWithinOneFrameAndGoWithTheirMemory) {
  const Row& row = kRows[GetParam()];
  const auto bench = this->bench(row.scene);
  Pipeline& pipeline = bench->pipeline();
  Targets targets(context(), kSize);
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
  app::require(app::proveEach(effectInfo(row.effect).name, *bench, kViews));
}

INSTANTIATE_TEST_SUITE_P(Plan, EffectRows, ::testing::Range(size_t{0}, std::size(kRows)), [](const auto& info) {
  std::string name = effectInfo(kRows[info.param].effect).name;
  std::erase(name, '-');
  return name;
});

TEST_F(Rows, KindsOfLightThatAreNotThereAreLeftOutBitForBit) {
  const auto bench = this->bench(room(/*emits=*/true));
  const Light narrow = spot(), wide = spot(0.17f);
  const std::vector<Light> sets[]{
      {narrow, wide, lamp(0.3)}, {sun(), lamp(0.3)}, {sun(), narrow, wide}, {sun()}, {narrow}, {wide}, {lamp(0.3)}, {}};
  for (const std::vector<Light>& there : sets) {
    bench->pipeline().setLights(there);
    bench->prepare({});
    app::require(app::proveEach(fmt::format("set {}", &there - sets), *bench, kViews));
  }
}

/// Lamps that are dragged about: what is there after the first place stays, and what is not does not come.
TEST_F(Rows, LightsThatMoveSwitchNothing) {
  const std::vector<Light> places{lamp(0.2), lamp(0.1), lamp(-0.2), lamp(0.3)};
  // Where its range ends at the room's wall. 16 voxels of 1/8: two of them wide is the trigger, four where it lets go.
  const auto atReach = [](double gap, double nextGap) {
    std::vector<Light> out(4, lamp(1 + gap));
    for (Light& light : out) light.position.y = 0, light.range = 1;
    out[1].position.x = out[3].position.x = 1 + nextGap;
    return out;
  };
  const struct {
    const char *state, *memory;
    const Scene& scene;
    float blurNoise;
    char picture;
    std::vector<Light> places;
  } drags[]{{"point on", "has shadow cubes, has matrix", kEmpty, 0.01f, '.', atReach(1.2, 1.3)},
            {"point off", "no shadow cubes, no matrix", kEmpty, 0.01f, '.', atReach(2, 1.3)},
            // The blur is watched, not tried: where it shows nothing it stays off.
            {"blur off", "no blurred H", kEven, 0.9f, ' ', places},
            {"blur on", "has blurred H", kLamp, 1e-4f, ' ', places},
            // Lights do not change F M, nor what was found of its samples.
            {"emitter-sampling on", "has emitters' correction", kLamp, 0.01f, ' ', places}};
  for (const auto& drag : drags) {
    Settings s = settings();
    s.effects.blurNoise = drag.blurNoise;
    Pipeline pipeline(context(), drag.scene, s);
    std::vector<bool> first;
    for (size_t i = 0; i < drag.places.size(); ++i) {
      const auto drop = [&](Pipeline& p) {
        p.setLights({drag.places[i]});
        if (i > 0) expect(p, {}, drag.state);
      };
      walk(pipeline, {{drop, fmt::format("{}, {}", drag.state, drag.memory), drag.picture}});
      std::vector<bool> on;
      for (const EffectRow& row : pipeline.plan().rows) on.push_back(row.state == EffectState::on);
      if (i == 0) first = on;
      EXPECT_EQ(on, first);
    }
  }
}

/// What it would change is the same number, measured with its copies or without.
TEST_F(Rows, TheBlurIsMeasuredAlike) {
  const auto noise = [&](float epsilon) {
    Settings s = settings();
    s.effects.blurNoise = epsilon;
    const auto pipeline = prepared(kLamp, s);
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
