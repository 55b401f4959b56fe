// Each row of the effect plan on a device, in both directions: what calls for an effect flips, and it is there with the
// next picture, with its passes, memory and shader code; it flips back, and they are gone, to the last byte.
#include "shaders/shared/passes.h"
#include "tests/effects_fixture.h"

namespace irad::test {
namespace {

/// How one effect is called for, and what it brings along.
struct Row {
  Effect effect;
  std::function<Scene()> scene;
  /// Calls for the effect, or no longer does.
  std::function<void(Pipeline&, bool wanted)> flip;
  const char* stage = nullptr;     ///< of its own
  const char* memory = nullptr;    ///< a buffer or image of its own
  const char* shader = nullptr;    ///< of its own
  uint32_t constant = UINT32_MAX;  ///< of "RE Forward", in the key where the effect is off
};

Light lampAt(double x) {
  return {.name = "lamp", .type = LightType::Point, .position = {x, 0.2, 0}, .intensity = 3};
}
Light sun() {
  return {
      .name = "sun", .type = LightType::Sun, .direction = glm::normalize(glm::vec3(0.3f, -1, 0.2f)), .intensity = 2};
}
Light spot() {
  return {.name = "spot",
          .type = LightType::Spot,
          .position = {0, 0.5, 0},
          .intensity = 4,
          .innerCos = 0.95f,
          .outerCos = 0.85f};
}

/// A room with a small lamp, a floor with a normal map and a panel with holes; matt.
Scene room(bool emits = true) {
  SceneBuilder b;
  const uint32_t wall = b.material(glm::vec3(0.6f, 0.5f, 0.4f)), floor = b.material(glm::vec3(0.5f)),
                 lamp = b.material(glm::vec3(0.1f), emits ? glm::vec3(20) : glm::vec3(0)),
                 panel = b.material(glm::vec3(0.4f), glm::vec3(0), /*doubleSided=*/true);
  b.box({wall, wall, floor, wall, wall, wall}, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
  b.quad(lamp, {-0.2, 0.9, -0.2}, {0.2, 0.9, -0.2}, {0.2, 0.9, 0.2}, {-0.2, 0.9, 0.2});
  b.quad(panel, {-0.6, -0.6, -0.3}, {0.4, -0.6, -0.3}, {0.4, 0.4, -0.2}, {-0.6, 0.4, -0.2});
  b.camera({0.7, 0.3, 0.9}, {-0.2, -0.3, -0.6});
  Scene scene = b.finish("room");
  for (Material& m : scene.materials) m.lambertian = true;
  const auto image = [&](bool srgb, std::vector<uint8_t> texels) {
    scene.images.push_back({"two texels", 2, 1, srgb, std::move(texels)});
    return static_cast<int>(scene.images.size()) - 1;
  };
  scene.materials[floor].normalTexture.image = image(false, {190, 128, 230, 255, 80, 150, 230, 255});
  scene.materials[panel].baseColorTexture.image = image(true, {255, 255, 255, 255, 255, 255, 255, 0});
  scene.materials[panel].alpha = AlphaMode::Mask;
  for (size_t i = 0; i < scene.positions.size(); ++i)
    scene.uv0[i] = 2.0f * glm::vec2(scene.positions[i].x, scene.positions[i].y + scene.positions[i].z);
  return scene;
}
Scene litRoom() {
  Scene scene = room();
  scene.lights = {lampAt(0.3)};
  return scene;
}
Scene glossyRoom() {
  Scene scene = room(/*emits=*/false);
  scene.materials[0].lambertian = false;
  scene.materials[0].roughness = 0.2f;
  return scene;
}
/// H is the same everywhere but for what lights add to it.
Scene evenRoom() {
  return furnaceBox(0.5f);
}

auto lights(std::vector<Light> always, Light flipped) {
  return [=](Pipeline& p, bool wanted) {
    std::vector<Light> all = always;
    if (wanted) all.push_back(flipped);
    p.setLights(std::move(all));
  };
}
/// Back on means as the scene calls for it.
auto setting(const char* off, const char* on) {
  return [=](Pipeline& p, bool wanted) {
    Settings s = p.settings();
    applySetting(s, wanted ? on : off);
    p.set(s);
  };
}

const Row kRows[] = {
    {.effect = Effect::emission,
     .scene = litRoom,
     .flip = setting("effects.emission=off", "effects.emission=auto"),
     .stage = "GI Solve Emitters",
     .memory = "emitted share F M",
     .constant = FORWARD_EMISSION},
    {.effect = Effect::emitterSampling,
     .scene = litRoom,
     .flip = setting("matrix.emitter_sampling=off", "matrix.emitter_sampling=on"),
     .memory = "emitters' correction",
     .shader = "gi/sample_emitters"},
    {.effect = Effect::sun,
     .scene = [] { return room(); },
     .flip = lights({lampAt(0.3)}, sun()),
     .memory = "shadow maps",
     .constant = FORWARD_LIGHTS + LIGHT_SUN},
    {.effect = Effect::point,
     .scene = [] { return room(); },
     .flip = lights({sun()}, lampAt(0.3)),
     .memory = "shadow cubes",
     .constant = FORWARD_LIGHTS + LIGHT_POINT},
    {.effect = Effect::spot,
     .scene = [] { return room(); },
     .flip = lights({lampAt(0.3)}, spot()),
     .memory = "shadow maps",
     .constant = FORWARD_LIGHTS + LIGHT_SPOT},
    {.effect = Effect::matrix,
     .scene = [] { return room(/*emits=*/false); },
     .flip = lights({}, lampAt(0.3)),
     .stage = "GI BuildMatrix",
     .memory = "indirect irradiance H",
     .constant = FORWARD_INDIRECT},
    {.effect = Effect::specular,
     .scene = glossyRoom,
     .flip = lights({}, lampAt(0.3)),
     .stage = "RE Specular",
     .memory = "specular radiance",
     .constant = FORWARD_F0},
    {.effect = Effect::secondFacet,
     .scene = litRoom,
     .flip = setting("effects.second_facet=off", "effects.second_facet=auto")},
    {.effect = Effect::field,
     .scene = litRoom,
     .flip = setting("matrix.traversal=dda", "matrix.traversal=sdf"),
     .stage = "GI SDF",
     .memory = "chebyshev field"},
    {.effect = Effect::alphaTest,
     .scene = litRoom,
     .flip = setting("effects.alpha_test=off", "effects.alpha_test=auto"),
     .shader = "forward/depth_masked.frag"},
    {.effect = Effect::normalMap,
     .scene = litRoom,
     .flip = setting("effects.normal_map=off", "effects.normal_map=auto"),
     .constant = FORWARD_NORMAL_MAP},
    {.effect = Effect::blur, .scene = evenRoom, .flip = lights({}, spot()), .memory = "blurred H"},
};

class Rows : public EffectsTest {
 protected:
  struct Shown {
    std::vector<glm::vec4> picture;
    Stages stages;
    std::vector<PipelineUse> used;
    uint64_t bytes = 0;         ///< but for staging, which is kept
    bool secondFacets = false;  ///< voxels hold some
    EffectRow row;
  };
  static Settings settings() {
    Settings s = small();
    s.effects.blurNoise = 1e-2f;
    return s;
  }
  /// One prepare and one picture.
  Shown show(Pipeline& pipeline, Targets& targets, Effect effect) {
    context().finish();
    timings().reset();
    context().pipelinesUsed();
    pipeline.darken();  // so that the light does not depend on that before
    pipeline.prepare();
    Shown shown;
    shown.picture = draw(pipeline, targets);
    shown.stages = recorded();
    shown.used = context().pipelinesUsed();
    context().finish();
    for (const MemoryRow& held : context().device.memory().rows())
      if (held.subsystem != Subsystem::Staging) shown.bytes += held.bytes;
    shown.secondFacets = pipeline.facets().count > pipeline.facets().solidVoxels;
    shown.row = pipeline.plan().row(effect);
    return shown;
  }
  void expect(const Row& row, const Shown& shown, bool wanted) {
    EXPECT_EQ(shown.row.state == EffectState::on, wanted) << shown.row.reason;
    EXPECT_FALSE(shown.row.reason.empty());
    if (row.stage) {
      EXPECT_EQ(any(shown.stages, row.stage), wanted) << row.stage;
    }
    if (row.memory) {
      EXPECT_EQ(holds(row.memory), wanted) << row.memory;
    }
    bool ran = false;
    for (const PipelineUse& use : shown.used) {
      for (const std::string& shader : use.shaders) ran |= row.shader && shader.starts_with(row.shader);
      if (row.constant != UINT32_MAX && use.shaders.front() == "forward/forward.vert") {
        // The key names what is left out: an effect that is on is the shader's own default.
        const auto at = use.constants.find(row.constant);
        if (row.effect != Effect::normalMap || use.constants.count(FORWARD_TEXTURED) == 0) {
          EXPECT_EQ(at == use.constants.end(), wanted);
        }
        if (at != use.constants.end()) {
          EXPECT_EQ(at->second, 0u);
        }
      }
    }
    if (row.shader) {
      EXPECT_EQ(ran, wanted) << row.shader;
    }
    if (row.effect == Effect::secondFacet) {
      EXPECT_EQ(shown.secondFacets, wanted);
    }
  }
};

class EffectRows : public Rows, public ::testing::WithParamInterface<size_t> {};

TEST_P(EffectRows, ComeWithinOneFrameAndGoWithTheirMemory) {
  const Row& row = kRows[GetParam()];
  Pipeline pipeline(context(), row.scene(), settings());
  Targets targets(context(), {32, 24});
  const auto flipped = [&](bool wanted) {
    row.flip(pipeline, wanted);
    return show(pipeline, targets, row.effect);
  };
  const Shown off = flipped(false);
  expect(row, off, false);
  const Shown on = flipped(true);
  expect(row, on, true);
  // The field saves time alone.
  EXPECT_EQ(same(on.picture, off.picture), row.effect == Effect::field);
  if (row.memory) {
    EXPECT_GT(on.bytes, off.bytes);
  }
  const Shown offAgain = flipped(false);
  expect(row, offAgain, false);
  EXPECT_TRUE(same(offAgain.picture, off.picture));
  EXPECT_EQ(offAgain.bytes, off.bytes);
  const Shown onAgain = flipped(true);
  expect(row, onAgain, true);
  EXPECT_TRUE(same(onAgain.picture, on.picture));
  EXPECT_EQ(onAgain.bytes, on.bytes);
}

INSTANTIATE_TEST_SUITE_P(Plan, EffectRows, ::testing::Range(size_t{0}, std::size(kRows)), [](const auto& info) {
  std::string name = effectInfo(kRows[info.param].effect).name;
  std::erase(name, '-');
  return name;
});

TEST_F(Rows, APlainRoomHasNoPartOfWhatItDoesNotCallFor) {
  Scene scene = furnishedRoom();
  for (Material& m : scene.materials) m.lambertian = true;
  scene.lights = {lampAt(0.3)};
  Pipeline pipeline(context(), std::move(scene), settings());
  Targets targets(context(), {32, 24});
  for (const Row& row : kRows) {
    const Shown shown = show(pipeline, targets, row.effect);
    if (shown.row.state == EffectState::off) expect(row, shown, false);
  }
  const EffectPlan plan = pipeline.plan();
  for (const Effect e : {Effect::emission, Effect::emitterSampling, Effect::sun, Effect::spot, Effect::specular,
                         Effect::alphaTest, Effect::normalMap})
    EXPECT_TRUE(plan.off(e)) << effectInfo(e).name;
}

/// A lamp that is dragged about where its range ends at the room's wall.
TEST_F(Rows, ALightThatWaversAtItsReachSwitchesOnce) {
  Pipeline pipeline(context(), room(/*emits=*/false), settings());
  Targets targets(context(), {32, 24});
  // 16 voxels of 1/8: two of them wide is the trigger, four where it lets go.
  const auto at = [&](double gap) {
    Light lamp = lampAt(1 + gap);
    lamp.position.y = 0;
    lamp.range = 1;
    pipeline.setLights({lamp});
    pipeline.prepare();
    return draw(pipeline, targets);
  };
  const std::vector<glm::vec4> dark = at(2);
  EXPECT_TRUE(pipeline.plan().off(Effect::point));
  at(1.2);
  EXPECT_TRUE(pipeline.plan().on(Effect::point));
  const uint64_t flips = pipeline.flips();
  for (int i = 0; i < 6; ++i) {
    EXPECT_TRUE(same(at(i % 2 == 0 ? 1.3 : 1.2), dark));
    EXPECT_TRUE(holds("shadow cubes"));
    EXPECT_TRUE(pipeline.matrix());
  }
  EXPECT_EQ(pipeline.flips(), flips);
  at(2);
  EXPECT_TRUE(pipeline.plan().off(Effect::point));
  EXPECT_FALSE(holds("shadow cubes"));
}

/// The blur is watched, not tried, while lights move: where it shows nothing it stays off.
TEST_F(Rows, TheBlurStaysAsItIsWhileLightsMove) {
  for (const bool even : {true, false}) {
    Settings s = settings();
    s.effects.blurNoise = even ? 0.9f : 1e-4f;
    Pipeline pipeline(context(), even ? evenRoom() : litRoom(), s);
    pipeline.setLights({lampAt(0.2)});
    pipeline.prepare();
    EXPECT_EQ(pipeline.plan().on(Effect::blur), !even) << pipeline.plan().row(Effect::blur).reason;
    const uint64_t flips = pipeline.flips();
    for (const double x : {0.1, -0.2, 0.3, 0.1}) {
      pipeline.setLights({lampAt(x)});
      pipeline.prepare();
      EXPECT_EQ(holds("blurred H"), !even);
    }
    EXPECT_EQ(pipeline.flips(), flips);
  }
}

/// What it would change is the same number, measured with its copies or without.
TEST_F(Rows, TheBlurIsMeasuredAlike) {
  const auto noise = [&](float epsilon) {
    Settings s = settings();
    s.effects.blurNoise = epsilon;
    Pipeline pipeline(context(), litRoom(), s);
    pipeline.prepare();
    pipeline.setLights({lampAt(-0.1)});
    pipeline.darken();
    pipeline.prepare();
    EXPECT_EQ(pipeline.plan().on(Effect::blur), epsilon < 0.5f);
    return pipeline.traits().light.noise.value_or(-1);
  };
  const float with = noise(1e-4f), without = noise(0.99f);
  EXPECT_GT(with, 0);
  EXPECT_EQ(with, without);
}

/// Lights do not change F M, nor what was found of its samples.
TEST_F(Rows, EmittersAreSampledOrNotWhateverLightsDo) {
  Pipeline pipeline(context(), litRoom(), settings());
  pipeline.prepare();
  const EffectState state = pipeline.plan().row(Effect::emitterSampling).state;
  const uint64_t flips = pipeline.flips();
  for (const double x : {0.1, -0.2, 0.3}) {
    pipeline.setLights({lampAt(x)});
    EXPECT_EQ(pipeline.plan().row(Effect::emitterSampling).state, state);
    pipeline.prepare();
    EXPECT_EQ(pipeline.plan().row(Effect::emitterSampling).state, state);
  }
  EXPECT_EQ(pipeline.flips(), flips);
}

}  // namespace
}  // namespace irad::test
