// The effect plan, on the CPU: every row of it in both directions, on numbers alone, and what is measured for them.
#include "gi/plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "renderer/gpu_scene.h"
#include "shaders/shared/pixel_emitters.h"
#include "tests/forward_support.h"

namespace irad::plan_suite {
namespace {

using T = SceneTraits;
using S = Settings;

/// A grey room with a lamp, built and at rest.
T lit() {
  T t;
  t.materials = {{.triangles = 10, .albedo = 0.5f}, {.triangles = 2, .emission = 3, .albedo = 0.5f}};
  t.build = BuildTraits{.voxels = 1000, .facets = 500, .emitters = 5, .sampled = true, .matrix = true};
  t.light = {.due = Redo::Nothing, .report = {.bound = 1e-4f, .allowed = 2e-4f, .converged = true}, .noise = 0.1f};
  return t;
}
S usual() {
  return defaultSettings(/*cpuDevice=*/true);
}
LightTraits light(LightType type, bool shines = true, float gap = 0) {
  return {.type = type, .shines = shines, .gap = gap};
}

/// A row in words: "off, 4000 B: voxel.facets = 1", "asleep, within 0.002 of the mean H: error bound ...".
std::string text(const EffectRow& row) {
  return fmt::format("{}{}{}: {}", row.stateName(),
                     row.epsilon > 0 ? fmt::format(", within {:.3g} of {}", row.epsilon, row.of) : "",
                     row.bytesNotAllocated > 0 ? fmt::format(", {} B", row.bytesNotAllocated) : "", row.reason);
}

/// Of the lit room and the usual settings.
using Edit = std::function<void(T& t, S& s)>;
Edit operator+(const Edit& first, const Edit& then) {
  return [=](T& t, S& s) { first(t, s), then(t, s); };
}
#define EDIT(...) Edit([]([[maybe_unused]] T& t, [[maybe_unused]] S& s) { __VA_ARGS__; })
Edit set(const std::string& assignment) {
  return [=](T&, S& s) { applySetting(s, assignment); };
}
const Edit none = EDIT();
const Edit unlit = EDIT(t.materials[1].emission = 0);
const Edit dark = unlit + EDIT(t.build.reset());
const Edit turnedDown = unlit + EDIT(t.lights = {light(LightType::Point, /*shines=*/false)});
const Edit dimSun = EDIT(t.lights = {light(LightType::Sun, /*shines=*/false)});
const Edit lamp = EDIT(t.lights = {light(LightType::Point)});
const Edit black = EDIT(t.materials[0].albedo = t.materials[1].albedo = 0);
const Edit glossy = EDIT(t.materials[0].f0 = 0.04f, t.materials[0].leastRoughness = 0.3f);
const Edit rough = glossy + EDIT(t.materials[0].leastRoughness = 0.9f);
const Edit dda = set("matrix.traversal=dda"), noMode = glossy + set("specular.mode=off");
const Edit few = EDIT(t.build->emitters = 49, t.build->sampled = false);  // emitters, not tried yet or in vain
const Edit thesis = EDIT(applyPreset(s, "thesis")) + dark;                // forces on what its stages always do
const Edit thesisRays = set("matrix.hit_rule=thesis"), byPixels = set("sample.emitters=pixels");
const Edit skyLit = set("sky.source=constant") + EDIT(t.sky = 2), writes = set("writeback.mode=compute");
const Edit framewise =
    set("solver.method=brute_force") +
    EDIT(t.build->matrix = t.build->sampled = false, t.light.report.frames = 9, t.light.report.standardError = 1e-4f);

/// The lit room with the usual settings, edited, and what its plan says.
struct Edited {
  T t = lit();
  S s = usual();
  EffectPlan plan;
  explicit Edited(const Edit& edit, const EffectPlan* before = nullptr) {
    edit(t, s);
    plan = irad::plan(t, s, before);
  }
};

/// What an edit makes of an effect: its row in words, * for any.
struct Case {
  Effect effect;
  Edit edit;
  const char* row;
};
using enum Effect;
constexpr uint32_t kMost = MAX_EMISSIVE_TRIANGLES;
const Case kCases[]{
    {emission, none, "on: 1 of 2 materials with emission, 3 W/(m^2 sr) at most"},
    {emission, EDIT(t.materials[1].triangles = 0), "off, 22000 B: none of 1 material with emission"},
    {emission, dark, "off: none of 2 materials with emission"},
    {emission, byPixels, "on: *; pixels look for 2 triangles: 256 at most, with matrix.hit_rule=triangles alone"},
    {emission, byPixels + EDIT(t.materials[1].triangles = kMost), "on: *; pixels look for 256 *"},
    {emission, byPixels + EDIT(t.materials[1].triangles = kMost + 1), "on: *; pixels do not look for 257 *"},
    {emission, byPixels + thesisRays, "on: *; pixels do not look for 2 triangles: *"},
    {emission, byPixels + set("effects.matrix=off"), "on: * at most"},
    {emission, byPixels + set("effects.emission=off"), "off, 22000 B: forced off: 1 of 2 *"},
    {emission, byPixels + unlit + set("effects.emission=on"), "on: forced on: none of 2 *"},
    {emission, thesis, "on: *"},
    {sun, dimSun + set("light.shadow_filter=hard"), "off, 16777216 B: *"},
    {sun, dimSun + set("light.shadow_filter=vsm"), "off, 67108864 B: *"},  // moments, four times a depth
    {emitterSampling, none, "on, within 1 of the sum of F M: 5 of 500 *; their samples bring 0 of what the rays do"},
    {emitterSampling, few + EDIT(t.build->emitters = 50), "off, within 0.05 *, not less than a tenth"},
    {emitterSampling, few + EDIT(t.light.due = Redo::Gather), "on, within 0.05 *, less than a tenth"},
    {emitterSampling, few, "off, within 1 of the sum of F M, 8000 B: 49 of 500 facets emit*; their samples bring *"},
    {emitterSampling, few + EDIT(t.build->sampledShare = 0.8f), "off, within 0.2 *their samples bring 0.8 *"},
    // A light has moved: F M is what it was.
    {emitterSampling, few + EDIT(t.build->sampledShare = 0.8f, t.light.due = Redo::Gather), "off, within 0.2 *"},
    {emitterSampling, few + thesisRays, "off, 8000 B: matrix.hit_rule = thesis"},
    {emitterSampling, unlit + EDIT(t.lights = {light(LightType::Sun)}), "off, 8000 B: nothing emits"},
    {matrix, EDIT(t.build->escaped = 0.125), "on: light, and albedos of up to 0.5; 12.5 % of the rays escape"},
    {matrix, black, "off, 320000 B: light, and albedos of up to 0; 0 % of the rays escape"},
    {matrix, black + glossy, "on: light, and albedos of up to 0; 0 % of the rays escape"},
    {matrix, black + noMode, "off, 320000 B: light, and albedos of up to 0; 0 % of the rays escape"},
    {matrix, black + noMode + lamp, "on: light, and albedos of up to 0, but highlights, *"},
    {matrix, black + noMode + lamp + thesisRays, "asleep: light, and albedos of up to 0; 0 % *"},
    {matrix, black + lamp, "asleep: light, and albedos of up to 0; 0 % *"},
    {matrix, dark, "off: no light at all: H is 0 everywhere"},
    {matrix, dark + lamp, "on: light, and albedos of up to 0.5"},
    {matrix, turnedDown, "asleep: no light at all: H is 0 everywhere; 0 % of the rays escape; kept for the *"},
    {matrix, unlit + EDIT(t.emitted = true),
     "asleep: no light at all: H is 0 everywhere; 0 % of the rays escape; kept for the *"},
    {matrix, turnedDown + EDIT(t.build->matrix = false), "off, 320000 B: no light at all: H is 0 everywhere"},
    {matrix, unlit, "off, 320000 B: no light at all: H is 0 everywhere; 0 % of the rays escape"},
    {matrix, thesis, "on: *"},
    {matrix, framewise, "off, 262000 B: solver.method = brute_force: rays of each frame in its place"},
    {bruteForce, none, "off, 16000 B: solver.method = matrix"},
    {bruteForce, framewise, "on: light, and albedos of up to 0.5; 128 rays per facet and frame"},
    {bruteForce, framewise + unlit, "off, 64000 B: no light at all: *"},
    {bruteForce, framewise + set("effects.matrix=off"), "off, 64000 B: forced off: light, *"},
    {emitterSampling, framewise, "off, 8000 B: solver.method = brute_force: its rays meet the emitters"},
    {field, framewise, "on: rays of brute force skip by it, specular rays do not"},
    {relight, framewise, "asleep, *: 9 of 256 frames, standard error 0.0001 <= 0.0002 W/m^2"},
    {relight, framewise + unlit, "off: no indirect light"},
    {sky, none, "off, 10000 B: sky.source = none"},
    {sky, skyLit, "on: sky.source = constant, 2 W/(m^2 sr) at most"},
    {sky, skyLit + thesisRays, "off, 10000 B: *; not with matrix.hit_rule *"},
    {sky, skyLit + set("effects.sky=off"), "off, 10000 B: forced off: sky.source = constant, 2 *"},
    {sky, set("effects.sky=on"), "on: forced on: sky.source = none"},
    {sky, skyLit + EDIT(t.sky = 0), "off, 10000 B: sky.source = constant, 0 W/(m^2 sr) at most"},
    {sky, skyLit + EDIT(t.sky = 0, t.build->sky = true), "asleep: *; what was built for it is kept"},
    {sky, thesis, "off: sky.source = none"},
    {matrix, unlit + skyLit, "on: light, and albedos of up to 0.5; 0 % of the rays escape"},
    {specular, thesis, "on: *"},
    {specular, none, "off: none of 2 materials with a specular lobe"},
    {specular, glossy,
     "on: 1 of 2 materials with a specular lobe; roughness 0.3 at least, rays up to 0.6 (metals 1) where F0 H is above "
     "0.0001 *"},
    {specular, glossy + unlit, "off: 1 of 2 materials * lobe, no light to reflect; *"},
    {specular, noMode, "off: specular.mode = off"},
    {specular, noMode + set("effects.specular=on"), "off: specular.mode = off"},
    {specular, rough, "on: 1 of 2 materials * roughness 0.9 at least, rays up to 0.6 *"},
    {writeback, thesis, "off: writeback.mode = off"},
    {writeback, glossy, "off, 28000 B: writeback.mode = off"},
    {writeback, glossy + set("effects.writeback=on"), "off, 28000 B: writeback.mode = off"},
    {writeback, glossy + writes, "on: writeback.mode = compute; specular reflectance up to 0.04, lit"},
    {writeback, glossy + writes + set("effects.writeback=off"),
     "off, 36000 B: forced off: writeback.mode = compute; *"},
    {writeback, glossy + EDIT(s.writeback.mode = WritebackMode::mask, t.pixels = 100), "on: writeback.mode = mask; *"},
    {writeback, writes, "off, 36000 B: writeback.mode = compute, but no reflections"},
    {writeback, writes + EDIT(s.effects.specular = s.effects.writeback = EffectMode::on),
     "on: forced on: writeback.mode = compute; specular reflectance up to 0, lit"},
    {writeback, noMode + writes, "off, 36000 B: writeback.mode = compute, but no reflections"},
    {writeback, glossy + writes + unlit, "off, 36000 B: *, but no reflections"},
    {writeback, glossy + writes + set("effects.matrix=off"),
     "off, 36000 B: writeback.mode = compute, but no matrix and solve"},
    {field, thesis, "on: *"},
    {field, none, "on: rays of the matrix skip by it, specular rays do not"},
    {field, dda, "off, 1000 B: rays of the matrix do not skip by it, specular rays do not"},
    {field, glossy, "on: rays of the matrix skip by it, specular rays do"},
    {field, glossy + dda, "on: rays of the matrix do not skip by it, specular rays do"},
    {field, glossy + dda + EDIT(s.specular.gpu.traversal = Traversal::dda), "off, 1000 B: *"},
    {field, rough + dda, "off, 1000 B: *"},
    {field, turnedDown, "on: rays of the matrix skip by it, *"},
    {field, dark, "off: rays of the matrix do not *"},
    {relight, none, "asleep, within 0.002 of the mean H: error bound 0.0001 <= 0.0002 W/m^2"},
    {relight, EDIT(t.light.report.converged = false, t.light.report.bound = 1), "on, *: error bound 1 > 0.0002 W/m^2"},
    {relight, EDIT(t.light.due = Redo::Gather), "on, within 0.002 of the mean H: gather is due"},
    {relight, EDIT(t.light.due = Redo::Shade), "asleep, *: error bound 0.0001 <= *"},
    {relight, set("effects.relight=on"), "on, *: forced on: error bound *"},
    {relight, dark, "off: no indirect light"},
    {rebuild, EDIT(t.light.due = Redo::Gather), "asleep: geometry and build settings are as they were built"},
    {rebuild, EDIT(t.light.due = Redo::Matrix), "on: due from matrix on"},
    {alphaTest, EDIT(t.materials[0].alphaTest = true), "on: 1 of 2 materials cut out by alpha"},
    {alphaTest, EDIT(t.materials[0].normalMap = true), "off: none of 2 materials cut out by alpha"},
    {alphaTest, EDIT(t.materials[0].cutIfOpaque = true), "on: 1 of 2 materials cut out by alpha"},
    {alphaTest, EDIT(t.materials[0].cutIfOpaque = t.materials[0].glass = true),
     "off: none of 2 materials cut out by alpha"},
    {alphaTest, thesis + EDIT(t.materials[0].cutIfOpaque = t.materials[0].glass = true), "on: *"},
    {glass, none, "off: none of 2 materials blended with alpha below 1, or transmissive"},
    {glass, EDIT(t.materials[1].glass = true), "on: 1 of 2 materials blended with alpha below 1, or transmissive"},
    {glass, thesis + EDIT(t.materials[1].glass = true),
     "off: 1 of 2 materials blended with alpha below 1, or transmissive, opaque with matrix.hit_rule = thesis; "
     "textured ones cut at one half"},
    {normalMap, EDIT(t.materials[0].normalMap = t.materials[1].normalMap = true), "on: 2 of 2 materials with *"},
    {normalMap, EDIT(t.materials[0].alphaTest = true), "off: none of 2 materials with a normal map"},
    {blur, thesis, "on, *"},
    {blur, EDIT(s.effects.blurNoise = 0.01f), "on, within 0.01 *: it changes H by 0.1 of the largest at most, > 0.01"},
    {blur, EDIT(t.light.noise = 0.001f), "off, within 0.002 *, 16000 B: it changes H by 0.001 *<= 0.002"},
    {blur, EDIT(t.light.noise.reset()), "on, *: what it changes is known after a relight"},
    {blur, EDIT(s.sample.gpu.filter_ = SampleFilter::linear), "off: sample.filter = linear"},
    {blur, dark, "off: no indirect light"},
    {redraw, none, "on: each picture that is asked for"},
    {redraw, EDIT(t.redraw = false), "asleep: camera, scene, settings and light are as drawn"},
    {redraw, EDIT(t.redraw = true), "on: camera, scene, settings or light have changed"},
};

void expectRow(const EffectRow& row, const char* pattern) {
  EXPECT_EQ(fnmatch(pattern, text(row).c_str(), 0), 0) << row.info().name << " is " << text(row) << "\nnot " << pattern;
}

TEST(Plan, SaysThatAllMetalIsBlackWithoutASky) {
  const Edit metal = EDIT(t.materials = {{.triangles = 10, .f0 = 0.9f}, {.triangles = 0, .albedo = 0.5f}},
                          t.lights = {light(LightType::Sun)});
  const auto said = [&](const Edit& edit) {
    return fmt::format("{}", fmt::join(Edited(metal + edit).plan.nothingDiffuse, " "));
  };
  EXPECT_EQ(
      said(none),
      "The one material is not diffuse: metal shows what is around it, and nothing there gives light. A sky would: "
      "sky.source = constant or preetham, or a picture of one (--sky FILE, or dropped into the window).");
  const Edit second = EDIT(t.materials[1].triangles = 1);  // which is diffuse
  EXPECT_TRUE(said(second + EDIT(t.materials[1].albedo = 0)).starts_with("None of 2 materials"));
  EXPECT_TRUE(said(EDIT(t.region.whole = false)).starts_with("The one material is not diffuse"));
  for (const Edit& edit : {second, EDIT(t.lights.clear()) /* no light at all, which noLight says */,
                           EDIT(t.materials[0].emission = 1), skyLit})
    EXPECT_EQ(said(edit), "");
}

TEST(Plan, EachRowFollowsWhatCallsForIt) {
  for (const Case& c : kCases) {
    const auto [t, s, p] = Edited(c.edit);
    expectRow(p.row(c.effect), c.row);
    std::vector<std::string> noLight;  // the reasons of all kinds
    if ((p.row(matrix).reason + p.row(bruteForce).reason).find("no light at all") != std::string::npos)
#define IRAD_EFFECT_OF_KIND(constant, number, id, effect, ...) effect,
      for (const Effect e : {IRAD_LIGHT_KINDS(IRAD_EFFECT_OF_KIND) emission, sky}) noLight.push_back(p.row(e).reason);
#undef IRAD_EFFECT_OF_KIND
    EXPECT_EQ(p.noLight, noLight) << c.row;
    // The settings that stages get are decided, and what no effect decides stays as it is.
    const S o = obeyed(s, p);
    const bool pixels = p.row(emission).reason.find("; pixels look for") != std::string::npos;
    EXPECT_TRUE(p.pixelEmitters == pixels && (o.sample.emitters != EmitterLookup::facets) == pixels) << c.row;
    for (const EffectRow& row : p.rows)
      EXPECT_TRUE(!row.info().mode || forcedMode(o, row.effect) != EffectMode::automatic) << row.info().name;
    EXPECT_EQ(o.matrix, s.matrix);
    EXPECT_EQ(obeyed(o, plan(t, o)).sample, o.sample) << c.row;
  }
}

TEST(Plan, LightsAreCalledForWhereTheyLightTheScene) {
  for (const LightKind& kind : lightKinds()) {
    const auto says = [&](std::vector<LightTraits> lights, const char* pattern) {
      const EffectPlan p = Edited([&](T& t, S&) { t.lights = std::move(lights); }).plan;
      expectRow(p.row(effectOf(kind.type)), pattern);
      for (const LightKind& other : lightKinds())
        EXPECT_TRUE(other.type == kind.type || p.off(effectOf(other.type))) << kind.name << other.name;
    };
    const LightTraits lights = light(kind.type), dim = light(kind.type, /*shines=*/false),
                      far = light(kind.type, true, /*gap=*/5);
    says({}, "off: no *");
    says({lights}, "on: 1 *: 1 on and with an intensity, of these 1 in reach of the scene");
    says({dim}, "off, 16777216 B: 1 *: 0 on and with an intensity, of these 0 *");
    says({far}, "off, 16777216 B: 1 *: 1 on and with an intensity, of these 0 in reach of the scene");
    says({far, lights}, "on: 2 *: 2 on and with an intensity, of these 1 *");
    LightTraits soft = lights, softButFar = far;
    soft.size = softButFar.size = true;
    says({soft, softButFar, lights}, "on: 3 *: 3 on and with an intensity, of these 2 *; penumbrae of 1, by 16 points");
  }
}

TEST(Plan, RowsAreNamedAndCanBeForcedWhichTheySay) {
  const Edit writing = glossy + writes;  // which nothing forces on
  std::set<std::string> names;
  for (const EffectRow& row : Edited(writing).plan.rows) {
    const EffectInfo& info = row.info();
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_TRUE(*info.setting == 0 || findSetting(info.setting).name == info.setting);
    EXPECT_EQ(info.mode != nullptr, std::string(info.setting).starts_with("effects."));
    for (const EffectState state : {EffectState::on, EffectState::off}) {
      if (!info.mode) continue;
      const std::string assignment = fmt::format("{}={}", info.setting, nameOf(state));
      const EffectRow forced = Edited(writing + set(assignment)).plan.row(row.effect);
      EXPECT_EQ(forced.state, state) << info.setting;
      EXPECT_EQ(state != row.state, forced.reason.starts_with(fmt::format("forced {}: ", nameOf(state))));
    }
  }
  EXPECT_EQ(names.size(), kEffects);
  for (const EffectRow& row : Edited(writing + EDIT(forceEffects(s, EffectMode::on)) + dark).plan.rows)
    EXPECT_TRUE(!row.info().mode || row.state == EffectState::on) << row.reason;
}

TEST(Plan, BetweenItsTriggersAnEffectStaysAsItIs) {
  /// Edits the lit room; `share`: what the effect is to stay on for, as a share of what it comes on at.
  using At = std::function<void(T&, S&, float share)>;
  std::vector<std::pair<Effect, At>> triggers{
      {blur, [](T& t, S& s, float share) { t.light.noise = s.effects.blurNoise * share; }},
      {blur,
       [](T& t, S& s, float share) {
         s.sample.gpu.filter_ = share < 0.5f ? SampleFilter::linear : SampleFilter::blur;
         t.light.noise = share > 1 ? std::nullopt : std::optional(0.7f * s.effects.blurNoise);
       }},
      // The field that specular rays alone read, while their roughness limit is dragged.
      {field, [](T& t, S& s, float share) {
         (glossy + dda)(t, s);
         s.specular.gpu.maxRoughness = t.materials[0].leastRoughness + (share - 1) / 10;
       }}};
  for (const LightKind& kind : lightKinds())
    for (const Effect effect : {effectOf(kind.type), matrix})  // which exists for such a light alone
      triggers.emplace_back(effect, [type = kind.type](T& t, S& s, float share) {
        unlit(t, s), t.lights = {light(type, true, 2 / share)};
      });
  for (const auto& [effect, at] : triggers) {
    std::optional<EffectPlan> before;
    const auto expect = [&, effect = effect, &at = at](std::initializer_list<float> shares, bool on) {
      for (const float share : shares) {
        before = Edited([&](T& t, S& s) { at(t, s, share); }, before ? &*before : nullptr).plan;
        const std::string reason = before->row(effect).reason;
        EXPECT_EQ(before->on(effect), on) << effectInfo(effect).name << share << reason;
        EXPECT_EQ(reason.ends_with("; near enough to stay on"), on && share < 1 && effect != matrix) << reason;
      }
    };
    expect({0.7f, 0.4f, 0.99f}, false);
    for (int i = 0; i < 10; ++i) expect({1.01f, 0.51f}, true);  // jitter switches it once
    expect({0.49f, 0.99f}, false);
  }
}

TEST(Plan, AnEffectThatIsOffIsWhatItsOwnSettingSays) {
  const auto with = [](const char* assignment) {
    const Edited room(glossy + set(assignment));
    return obeyed(room.s, room.plan);
  };
  for (const auto& [off, own] :
       {std::pair{"effects.specular=off", "specular.mode=off"}, {"effects.blur=off", "sample.filter=linear"}}) {
    EXPECT_EQ(with(off), with(own)) << off;
    EXPECT_NE(with(off), with("effects.sun=auto")) << off;
  }
}

TEST(Plan, Json) {
  const auto json = nlohmann::json::parse(planJson(Edited(dda).plan));
  ASSERT_EQ(json.size(), kEffects);
  EXPECT_EQ(json[static_cast<size_t>(field)], nlohmann::json::parse(R"({"effect": "field", "state": "off",
    "reason": "rays of the matrix do not skip by it, specular rays do not", "skip": "exact",
    "bytes_not_allocated": 1000})"));
  EXPECT_EQ(json[static_cast<size_t>(relight)], nlohmann::json::parse(R"({"effect": "relight", "state": "asleep",
    "reason": "error bound 0.0001 <= 0.0002 W/m^2", "skip": "threshold", "epsilon": 0.002,
    "epsilon_of": "the mean H", "bytes_not_allocated": 0})"));
}

// ---- What is measured of scenes: materials over all that their textures hold, lights ----

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
}  // namespace irad::plan_suite
