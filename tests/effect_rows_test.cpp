// Each row of the effect plan on a device. What calls for an effect flips: it is there with the next picture, with its
// passes, memory and shader code; it flips back, and they are gone, to the last byte. Where the scene does not call for
// it, forced on it gives the same bits.
#include "tests/effects_fixture.h"

namespace irad::test::effect_rows_suite {
namespace {

/// The first is what thresholds are judged by.
constexpr View kViews[] = {VIEW_LIT,      VIEW_IRRADIANCE, VIEW_DIRECT_IRRADIANCE,
                           VIEW_INDIRECT, VIEW_SPECULAR,   VIEW_NORMAL};

const Scene kEmpty = room(/*emits=*/false), kGlossy = glossy(kEmpty), kLamp = room(/*emits=*/true, {lamp(0.3)}),
            kTextured = room(/*emits=*/true, {lamp(0.3)}, /*textured=*/true),
            kEven = furnaceBox(0.5f);  // H is the same everywhere but for what lights add to it

/// How one effect is called for, and what it brings along.
struct Row {
  Effect effect;
  const Scene& scene;
  Edit off, on;         ///< the scene no longer calls for the effect; it does
  std::string terms{};  ///< of EffectsTest::expect(), for the effect alone
};
using E = Effect;
std::string forwardWith(uint32_t constant) {
  return fmt::format("forward with {}.", constant);
}
const Row kRows[] = {
    {E::emission, kLamp, setting("effects.emission=off"), setting("effects.emission=auto"),
     "GI Solve Emitters, has emitted share F M, " + forwardWith(FORWARD_EMISSION)},
    {E::emitterSampling, kLamp, setting("matrix.emitter_sampling=off"), setting("matrix.emitter_sampling=on"),
     "has emitters' correction, shader gi/sample_emitters"},
    {E::sun, kEmpty, lights({lamp(0.3)}), lights({lamp(0.3), sun()}),
     "has shadow maps, " + forwardWith(FORWARD_LIGHTS + LIGHT_SUN)},
    {E::point, kEmpty, lights({spot()}), lights({spot(), lamp(0.3)}),
     "has shadow cubes, " + forwardWith(FORWARD_LIGHTS + LIGHT_POINT)},
    {E::spot, kEmpty, lights({lamp(0.3)}), lights({lamp(0.3), spot()}),
     "has shadow maps, " + forwardWith(FORWARD_LIGHTS + LIGHT_SPOT)},
    {E::matrix, kEmpty, lights({}), lights({lamp(0.3)}),
     "GI BuildMatrix, has indirect irradiance H, " + forwardWith(FORWARD_INDIRECT)},
    {E::specular, kGlossy, lights({}), lights({lamp(0.3)}),
     "RE Specular, has specular radiance, " + forwardWith(FORWARD_F0)},
    {E::field, kLamp, setting("matrix.traversal=dda"), setting("matrix.traversal=sdf"), "GI SDF, has chebyshev field"},
    {E::alphaTest, kTextured, setting("effects.alpha_test=off"), setting("effects.alpha_test=auto"),
     "shader forward/depth_masked.frag"},
    {E::normalMap, kTextured, setting("effects.normal_map=off"), setting("effects.normal_map=auto"),
     forwardWith(FORWARD_NORMAL_MAP)},
    {E::blur, kEven, lights({}), lights({spot()}), "has blurred H"},
};

class Rows : public EffectsTest {
 protected:
  static Settings settings() {
    Settings s = small();
    s.effects.blurNoise = 1e-2f;
    return s;
  }
};

class EffectRows : public Rows, public ::testing::WithParamInterface<size_t> {};

TEST_P(EffectRows, ComeWithinOneFrameAndGoWithTheirMemory) {
  const Row& row = kRows[GetParam()];
  const auto bench = this->bench(row.scene, settings());
  Pipeline& pipeline = bench->pipeline();
  Targets targets(context(), kSize);
  std::array<Pixels, 2> first;  // off, on
  std::array<uint64_t, 2> bytes{};
  for (const bool again : {false, true})
    for (const bool wanted : {false, true}) {
      (wanted ? row.on : row.off)(pipeline);
      facts(pipeline);
      // One prepare and one picture: with all that the effect brings where it is wanted, else with nothing of it.
      pipeline.darken();  // so that the light does not depend on what was there before
      pipeline.prepare();
      const Pixels picture = draw(pipeline, targets);
      SCOPED_TRACE(fmt::format("{}: {}", effectInfo(row.effect).name, pipeline.plan().row(row.effect).reason));
      EXPECT_EQ(pipeline.plan().on(row.effect), wanted);
      expect(facts(pipeline), row.terms, wanted);
      // The field only saves time.
      EXPECT_EQ(wanted && same(picture, first[0]), wanted && row.effect == E::field);
      EXPECT_TRUE(!again || (same(picture, first[wanted]) && usedBytes() == bytes[wanted]));
      first[wanted] = picture;
      bytes[wanted] = usedBytes();
    }
  EXPECT_TRUE(row.terms.find("has ") == std::string::npos || bytes[1] > bytes[0]);
  row.off(pipeline);
  pipeline.prepare();
  app::require(app::proveEach(effectInfo(row.effect).name, *bench, kViews));
}

INSTANTIATE_TEST_SUITE_P(Plan, EffectRows, ::testing::Range(size_t{0}, std::size(kRows)), [](const auto& info) {
  std::string name = effectInfo(kRows[info.param].effect).name;
  std::erase(name, '-');
  return name;
});

TEST_F(Rows, KindsOfLightThatAreNotThereAreLeftOutBitForBit) {
  const auto bench = this->bench(room(/*emits=*/true), settings());
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
            {"point off", "-has shadow cubes, -has matrix", kEmpty, 0.01f, '.', atReach(2, 1.3)},
            // The blur is watched, not tried: where it shows nothing it stays off.
            {"blur off", "-has blurred H", kEven, 0.9f, ' ', places},
            {"blur on", "has blurred H", kLamp, 1e-4f, ' ', places},
            // Lights do not change F M, nor what was found of its samples.
            {"emitter-sampling on", "has emitters' correction", kLamp, 0.01f, ' ', places}};
  for (const auto& drag : drags) {
    Settings s = settings();
    s.effects.blurNoise = drag.blurNoise;
    Pipeline pipeline(context(), drag.scene, s);
    const auto on = [&] {
      std::vector<bool> out;
      for (const EffectRow& row : pipeline.plan().rows)
        out.push_back(row.effect != E::relight && row.state == EffectState::on);
      return out;
    };
    std::optional<std::vector<bool>> first;
    for (const Light& place : drag.places) {
      pipeline.setLights({place});
      EXPECT_TRUE(!first || on() == *first);
      walk(pipeline, {{{}, fmt::format("{}, {}", drag.state, drag.memory), drag.picture}});
      if (!first) first = on();
      EXPECT_EQ(on(), *first);
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
