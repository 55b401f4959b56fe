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
  t.build =
      BuildTraits{.voxels = 1000, .facets = 500, .solidVoxels = 400, .emitters = 5, .sampled = true, .matrix = true};
  t.light = {.due = Redo::Nothing, .settled = true, .bound = 1e-4f, .tolerance = 2e-4f, .noise = 0.1f};
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

// Edits of the lit room `t` and the usual settings `s`.
#define EDIT(...) [](T& t, S& s) { (void)t, (void)s, __VA_ARGS__; }
constexpr auto none = [](T&, S&) {};
constexpr auto unlit = EDIT(t.materials[1].emission = 0);
constexpr auto dark = EDIT(unlit(t, s), t.build.reset());
constexpr auto turnedDown = EDIT(unlit(t, s), t.lights = {light(LightType::Point, /*shines=*/false)});
constexpr auto black = EDIT(t.materials[0].albedo = t.materials[1].albedo = 0);
constexpr auto glossy = EDIT(t.materials[0].f0 = 0.04f, t.materials[0].leastRoughness = 0.3f);
constexpr auto rough = EDIT(glossy(t, s), t.materials[0].leastRoughness = 0.9f);
constexpr auto dda = EDIT(s.matrix.gpu.traversal = Traversal::dda);
constexpr auto noMode = EDIT(glossy(t, s), s.specular.mode = SpecularMode::off);
constexpr auto few = EDIT(t.build->emitters = 49, t.build->sampled = false);  // emitters, not tried yet or in vain
constexpr auto thesis = EDIT(applyPreset(s, "thesis"), dark(t, s));           // forces on what its stages always do
constexpr auto sky = EDIT(s.sky.source = SkySource::constant, t.sky = 2);
constexpr auto framewise = EDIT(s.solver.method = SolverMethod::bruteForce, t.build->matrix = t.build->sampled = false,
                                t.light.frames = 9, t.light.standardError = 1e-4f);
constexpr auto writes = EDIT(s.writeback.mode = WritebackMode::compute);
constexpr auto byPixels = EDIT(s.sample.emitters = EmitterLookup::pixels);

/// What an edit makes of an effect: its row in words, * for any.
struct Case {
  Effect effect;
  void (*edit)(T& t, S& s);
  const char* row;
};
using E = Effect;
constexpr uint32_t kMost = MAX_EMISSIVE_TRIANGLES;
const Case kCases[]{
    {E::emission, none, "on: 1 of 2 materials with emission, 3 W/(m^2 sr) at most"},
    {E::emission, EDIT(t.materials[1].triangles = 0), "off, 22000 B: none of 1 material with emission"},
    {E::emission, dark, "off: none of 2 materials with emission"},
    {E::emission, byPixels, "on: *; pixels look for 2 triangles: 256 at most, with matrix.hit_rule=triangles alone"},
    {E::emission, EDIT(byPixels(t, s), t.materials[1].triangles = kMost), "on: *; pixels look for 256 *"},
    {E::emission, EDIT(byPixels(t, s), t.materials[1].triangles = kMost + 1), "on: *; pixels do not look for 257 *"},
    {E::emission, EDIT(byPixels(t, s), s.matrix.gpu.hitRule = HitRule::thesis),
     "on: *; pixels do not look for 2 triangles: *"},
    {E::emission, EDIT(byPixels(t, s), s.effects.matrix = EffectMode::off), "on: * at most"},
    {E::emission, EDIT(byPixels(t, s), s.effects.emission = EffectMode::off), "off, 22000 B: forced off: 1 of 2 *"},
    {E::emission, EDIT(byPixels(t, s), unlit(t, s), s.effects.emission = EffectMode::on), "on: forced on: none of 2 *"},
    {E::emission, thesis, "on: *"},
    {E::emitterSampling, none, "on, within 1 of the sum of F M: 5 of 500 *; their samples bring 0 of what the rays do"},
    {E::emitterSampling, EDIT(few(t, s), t.build->emitters = 50), "off, within 0.05 *, not less than a tenth"},
    {E::emitterSampling, EDIT(few(t, s), t.light.due = Redo::Gather), "on, within 0.05 *, less than a tenth"},
    {E::emitterSampling, few, "off, within 1 of the sum of F M, 8000 B: 49 of 500 facets emit*; their samples bring *"},
    {E::emitterSampling, EDIT(few(t, s), t.build->sampledShare = 0.8f), "off, within 0.2 *their samples bring 0.8 *"},
    // A light has moved: F M is what it was.
    {E::emitterSampling, EDIT(few(t, s), t.build->sampledShare = 0.8f, t.light.due = Redo::Gather),
     "off, within 0.2 *"},
    {E::emitterSampling, EDIT(few(t, s), s.matrix.gpu.hitRule = HitRule::thesis),
     "off, 8000 B: matrix.hit_rule = thesis"},
    {E::emitterSampling, EDIT(unlit(t, s), t.lights = {light(LightType::Sun)}), "off, 8000 B: nothing emits"},
    {E::matrix, EDIT(t.build->escaped = 0.125), "on: light, and albedos of up to 0.5; 12.5 % of the rays escape"},
    {E::matrix, black, "off, 320000 B: light, and albedos of up to 0; 0 % of the rays escape"},
    {E::matrix, EDIT(black(t, s), glossy(t, s)), "on: light, and albedos of up to 0; 0 % of the rays escape"},
    {E::matrix, EDIT(black(t, s), noMode(t, s)),
     "off, 320000 B: light, and albedos of up to 0; 0 % of the rays escape"},
    {E::matrix, dark, "off: no light at all: H is 0 everywhere"},
    {E::matrix, EDIT(dark(t, s), t.lights = {light(LightType::Point)}), "on: light, and albedos of up to 0.5"},
    {E::matrix, turnedDown, "asleep: no light at all: H is 0 everywhere; 0 % of the rays escape; kept for the *"},
    {E::matrix, EDIT(unlit(t, s), t.emitted = true),
     "asleep: no light at all: H is 0 everywhere; 0 % of the rays escape; kept for the *"},
    {E::matrix, EDIT(turnedDown(t, s), t.build->matrix = false), "off, 320000 B: no light at all: H is 0 everywhere"},
    {E::matrix, unlit, "off, 320000 B: no light at all: H is 0 everywhere; 0 % of the rays escape"},
    {E::matrix, thesis, "on: *"},
    {E::matrix, framewise, "off, 262000 B: solver.method = brute_force: rays of each frame in its place"},
    {E::bruteForce, none, "off, 16000 B: solver.method = matrix"},
    {E::bruteForce, framewise, "on: light, and albedos of up to 0.5; 128 rays per facet and frame"},
    {E::bruteForce, EDIT(framewise(t, s), unlit(t, s)), "off, 64000 B: no light at all: *"},
    {E::bruteForce, EDIT(framewise(t, s), s.effects.matrix = EffectMode::off), "off, 64000 B: forced off: light, *"},
    {E::emitterSampling, framewise, "off, 8000 B: solver.method = brute_force: its rays meet the emitters"},
    {E::field, framewise, "on: rays of brute force skip by it, specular rays do not"},
    {E::relight, framewise, "asleep, *: 9 of 256 frames, standard error 0.0001 <= 0.0002 W/m^2"},
    {E::relight, EDIT(framewise(t, s), unlit(t, s)), "off: no indirect light"},
    {E::sky, none, "off, 10000 B: sky.source = none"},
    {E::sky, sky, "on: sky.source = constant, 2 W/(m^2 sr) at most"},
    {E::sky, EDIT(sky(t, s), s.matrix.gpu.hitRule = HitRule::thesis), "off, 10000 B: *; not with matrix.hit_rule *"},
    {E::sky, EDIT(sky(t, s), s.effects.sky = EffectMode::off), "off, 10000 B: forced off: sky.source = constant, 2 *"},
    {E::sky, EDIT(s.effects.sky = EffectMode::on), "on: forced on: sky.source = none"},
    {E::sky, EDIT(sky(t, s), t.sky = 0), "off, 10000 B: sky.source = constant, 0 W/(m^2 sr) at most"},
    {E::sky, EDIT(sky(t, s), t.sky = 0, t.build->sky = true), "asleep: *; what was built for it is kept"},
    {E::sky, thesis, "off: sky.source = none"},
    {E::matrix, EDIT(unlit(t, s), sky(t, s)), "on: light, and albedos of up to 0.5; 0 % of the rays escape"},
    {E::specular, thesis, "on: *"},
    {E::specular, none, "off: none of 2 materials with a specular lobe"},
    {E::specular, glossy,
     "on: 1 of 2 materials with a specular lobe; roughness 0.3 at least, rays up to 0.6 (metals 1) where F0 H is above "
     "0.0001 *"},
    {E::specular, EDIT(glossy(t, s), unlit(t, s)), "off: 1 of 2 materials * lobe, no light to reflect; *"},
    {E::specular, noMode, "off: specular.mode = off"},
    {E::specular, EDIT(noMode(t, s), s.effects.specular = EffectMode::on), "off: specular.mode = off"},
    {E::specular, rough, "on: 1 of 2 materials * roughness 0.9 at least, rays up to 0.6 *"},
    {E::writeback, thesis, "off: writeback.mode = off"},
    {E::writeback, glossy, "off, 28000 B: writeback.mode = off"},
    {E::writeback, EDIT(glossy(t, s), s.effects.writeback = EffectMode::on), "off, 28000 B: writeback.mode = off"},
    {E::writeback, EDIT(glossy(t, s), writes(t, s)),
     "on: writeback.mode = compute; specular reflectance up to 0.04, lit"},
    {E::writeback, EDIT(glossy(t, s), writes(t, s), s.effects.writeback = EffectMode::off),
     "off, 30000 B: forced off: writeback.mode = compute; *"},
    {E::writeback, EDIT(glossy(t, s), s.writeback.mode = WritebackMode::mask, t.pixels = 100),
     "on: writeback.mode = mask; *"},
    {E::writeback, writes, "off, 30000 B: writeback.mode = compute, but no reflections"},
    {E::writeback, EDIT(writes(t, s), s.effects.specular = s.effects.writeback = EffectMode::on),
     "on: forced on: writeback.mode = compute; specular reflectance up to 0, lit"},
    {E::writeback, EDIT(noMode(t, s), writes(t, s)), "off, 30000 B: writeback.mode = compute, but no reflections"},
    {E::writeback, EDIT(glossy(t, s), writes(t, s), unlit(t, s)), "off, 30000 B: *, but no reflections"},
    {E::writeback, EDIT(glossy(t, s), writes(t, s), s.effects.matrix = EffectMode::off),
     "off, 30000 B: writeback.mode = compute, but no matrix and solve"},
    {E::field, thesis, "on: *"},
    {E::field, none, "on: rays of the matrix skip by it, specular rays do not"},
    {E::field, dda, "off, 1000 B: rays of the matrix do not skip by it, specular rays do not"},
    {E::field, glossy, "on: rays of the matrix skip by it, specular rays do"},
    {E::field, EDIT(glossy(t, s), dda(t, s)), "on: rays of the matrix do not skip by it, specular rays do"},
    {E::field, EDIT(glossy(t, s), dda(t, s), s.specular.gpu.traversal = Traversal::dda), "off, 1000 B: *"},
    {E::field, EDIT(rough(t, s), dda(t, s)), "off, 1000 B: *"},
    {E::field, turnedDown, "on: rays of the matrix skip by it, *"},
    {E::field, dark, "off: rays of the matrix do not *"},
    {E::relight, none, "asleep, within 0.002 of the mean H: error bound 0.0001 <= 0.0002 W/m^2"},
    {E::relight, EDIT(t.light.settled = false, t.light.bound = 1), "on, *: error bound 1 > 0.0002 W/m^2"},
    {E::relight, EDIT(t.light.due = Redo::Gather), "on, within 0.002 of the mean H: gather is due"},
    {E::relight, EDIT(t.light.due = Redo::Shade), "asleep, *: error bound 0.0001 <= *"},
    {E::relight, EDIT(s.effects.relight = EffectMode::on), "on, *: forced on: error bound *"},
    {E::relight, dark, "off: no indirect light"},
    {E::rebuild, EDIT(t.light.due = Redo::Gather), "asleep: geometry and build settings are as they were built"},
    {E::rebuild, EDIT(t.light.due = Redo::Matrix), "on: due from matrix on"},
    {E::alphaTest, EDIT(t.materials[0].alphaTest = true), "on: 1 of 2 materials cut out by alpha"},
    {E::alphaTest, EDIT(t.materials[0].normalMap = true), "off: none of 2 materials cut out by alpha"},
    {E::alphaTest, EDIT(t.materials[0].cutIfOpaque = true), "on: 1 of 2 materials cut out by alpha"},
    {E::alphaTest, EDIT(t.materials[0].cutIfOpaque = t.materials[0].glass = true),
     "off: none of 2 materials cut out by alpha"},
    {E::alphaTest, EDIT(thesis(t, s), t.materials[0].cutIfOpaque = t.materials[0].glass = true), "on: *"},
    {E::glass, none, "off: none of 2 materials blended with alpha below 1, or transmissive"},
    {E::glass, EDIT(t.materials[1].glass = true), "on: 1 of 2 materials blended with alpha below 1, or transmissive"},
    {E::glass, EDIT(thesis(t, s), t.materials[1].glass = true),
     "off: 1 of 2 materials blended with alpha below 1, or transmissive, opaque with matrix.hit_rule = thesis; "
     "textured ones cut at one "
     "half"},
    {E::normalMap, EDIT(t.materials[0].normalMap = t.materials[1].normalMap = true), "on: 2 of 2 materials with *"},
    {E::normalMap, EDIT(t.materials[0].alphaTest = true), "off: none of 2 materials with a normal map"},
    {E::blur, thesis, "on, *"},
    {E::blur, EDIT(s.effects.blurNoise = 0.01f),
     "on, within 0.01 *: it changes H by 0.1 of the largest at most, > 0.01"},
    {E::blur, EDIT(t.light.noise = 0.001f), "off, within 0.002 *, 16000 B: it changes H by 0.001 *<= 0.002"},
    {E::blur, EDIT(t.light.noise.reset()), "on, *: what it changes is known after a relight"},
    {E::blur, EDIT(s.sample.gpu.filter_ = SampleFilter::linear), "off: sample.filter = linear"},
    {E::blur, dark, "off: no indirect light"},
    {E::redraw, none, "on: each picture that is asked for"},
    {E::redraw, EDIT(t.redraw = false), "asleep: camera, scene, settings and light are as drawn"},
    {E::redraw, EDIT(t.redraw = true), "on: camera, scene, settings or light have changed"},
};

void expectRow(const EffectRow& row, const char* pattern) {
  EXPECT_EQ(fnmatch(pattern, text(row).c_str(), 0), 0) << row.info().name << " is " << text(row) << "\nnot " << pattern;
}

TEST(Plan, SaysThatAllMetalIsBlackWithoutASky) {
  const auto said = [](void (*edit)(T&, S&)) {
    T t = lit();
    S s = usual();
    t.materials = {{.triangles = 10, .f0 = 0.9f}, {.triangles = 0, .albedo = 0.5f}};
    t.lights = {light(LightType::Sun)};
    edit(t, s);
    return fmt::format("{}", fmt::join(plan(t, s).nothingDiffuse, " "));
  };
  const std::string one = said([](T&, S&) {});
  EXPECT_EQ(
      one,
      "The one material is not diffuse: metal shows what is around it, and nothing there gives light. A sky would: "
      "sky.source = constant or preetham, or a picture of one (--sky FILE, or dropped into the window).");
  EXPECT_TRUE(said([](T& t, S&) {
                t.materials[1].triangles = 1, t.materials[1].albedo = 0;
              }).starts_with("None of 2 materials"));
  for (const auto edit : {+[](T&t, S&) { t.materials[1].triangles = 1; },  // something diffuse
                          +[](T&t, S&) { t.lights.clear(); },              // no light at all, which noLight says
                          +[](T&t, S&) { t.materials[0].emission = 1; },
                          +[](T&t, S&s) { s.sky.source = SkySource::constant, t.sky = 1; }})
    EXPECT_EQ(said(edit), "");
}

TEST(Plan, EachRowFollowsWhatCallsForIt) {
  for (const Case& c : kCases) {
    T t = lit();
    S s = usual();
    c.edit(t, s);
    const EffectPlan p = plan(t, s);
    expectRow(p.row(c.effect), c.row);
    std::vector<std::string> noLight;  // the reasons of all kinds
    if ((p.row(E::matrix).reason + p.row(E::bruteForce).reason).find("no light at all") != std::string::npos)
      for (const E e : {E::sun, E::point, E::spot, E::emission, E::sky}) noLight.push_back(p.row(e).reason);
    EXPECT_EQ(p.noLight, noLight) << c.row;
    // The settings that stages get are decided, and what no effect decides stays as it is.
    const S o = obeyed(s, p);
    const bool pixels = p.row(E::emission).reason.find("; pixels look for") != std::string::npos;
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
      T t = lit();
      t.lights = std::move(lights);
      const EffectPlan p = plan(t, usual());
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
    says({soft, softButFar, lights}, "on: 3 *: 3 on and with an intensity, of these 2 *; penumbrae of 1, by 32 points");
  }
}

TEST(Plan, MomentsTakeFourTimesTheMemoryOfDepths) {
  T t = lit();
  t.lights = {light(LightType::Sun, /*shines=*/false)};
  S s = usual();
  s.light.shadowFilter = ShadowFilter::hard;
  expectRow(plan(t, s).row(E::sun), "off, 16777216 B: *");
  s.light.shadowFilter = ShadowFilter::vsm;
  expectRow(plan(t, s).row(E::sun), "off, 67108864 B: *");
}

TEST(Plan, RowsAreNamedAndCanBeForcedWhichTheySay) {
  T t = lit();
  S unforced = usual();
  glossy(t, unforced), writes(t, unforced);  // which nothing forces on
  std::set<std::string> names;
  for (const EffectRow& row : plan(t, unforced).rows) {
    const EffectInfo& info = row.info();
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_TRUE(*info.setting == 0 || findSetting(info.setting).name == info.setting);
    EXPECT_EQ(info.mode != nullptr, std::string(info.setting).starts_with("effects."));
    for (const EffectState state : {EffectState::on, EffectState::off}) {
      if (!info.mode) continue;
      S s = usual();
      writes(t, s);
      applySetting(s, fmt::format("{}={}", info.setting, nameOf(state)));
      const EffectRow forced = plan(t, s).row(row.effect);
      EXPECT_EQ(forced.state, state) << info.setting;
      EXPECT_EQ(state != row.state, forced.reason.starts_with(fmt::format("forced {}: ", nameOf(state))));
    }
  }
  EXPECT_EQ(names.size(), kEffects);
  forceEffects(unforced, EffectMode::on);
  dark(t, unforced);
  for (const EffectRow& row : plan(t, unforced).rows)
    EXPECT_TRUE(!row.info().mode || row.state == EffectState::on) << row.reason;
}

TEST(Plan, BetweenItsTriggersAnEffectStaysAsItIs) {
  /// Edits the lit room; `share`: what the effect is to stay on for, as a share of what it comes on at.
  using At = std::function<void(T&, S&, float share)>;
  std::vector<std::pair<Effect, At>> triggers{
      {E::blur, [](T& t, S& s, float share) { t.light.noise = s.effects.blurNoise * share; }},
      {E::blur,
       [](T& t, S& s, float share) {
         s.sample.gpu.filter_ = share < 0.5f ? SampleFilter::linear : SampleFilter::blur;
         t.light.noise = share > 1 ? std::nullopt : std::optional(0.7f * s.effects.blurNoise);
       }},
      // The field that specular rays alone read, while their roughness limit is dragged.
      {E::field, [](T& t, S& s, float share) {
         glossy(t, s), dda(t, s);
         s.specular.gpu.maxRoughness = t.materials[0].leastRoughness + (share - 1) / 10;
       }}};
  for (const LightKind& kind : lightKinds())
    for (const E effect : {effectOf(kind.type), E::matrix})  // which exists for such a light alone
      triggers.emplace_back(effect, [type = kind.type](T& t, S& s, float share) {
        unlit(t, s), t.lights = {light(type, true, 2 / share)};
      });
  for (const auto& [effect, at] : triggers) {
    std::optional<EffectPlan> before;
    const auto expect = [&](std::initializer_list<float> shares, bool on) {
      for (const float share : shares) {
        T t = lit();
        S s = usual();
        at(t, s, share);
        before = plan(t, s, before ? &*before : nullptr);
        const std::string reason = before->row(effect).reason;
        EXPECT_EQ(before->on(effect), on) << effectInfo(effect).name << share << reason;
        EXPECT_EQ(reason.ends_with("; near enough to stay on"), on && share < 1 && effect != E::matrix) << reason;
      }
    };
    expect({0.7f, 0.4f, 0.99f}, false);
    for (int i = 0; i < 10; ++i) expect({1.01f, 0.51f}, true);  // jitter switches it once
    expect({0.49f, 0.99f}, false);
  }
}

TEST(Plan, AnEffectThatIsOffIsWhatItsOwnSettingSays) {
  const auto with = [](const std::string& assignment) {
    T t = lit();
    S s = usual();
    glossy(t, s);
    applySetting(s, assignment);
    return obeyed(s, plan(t, s));
  };
  for (const auto& [off, own] :
       {std::pair{"effects.specular=off", "specular.mode=off"}, {"effects.blur=off", "sample.filter=linear"}}) {
    EXPECT_EQ(with(off), with(own)) << off;
    EXPECT_NE(with(off), with("effects.sun=auto")) << off;
  }
}

TEST(Plan, Json) {
  T t = lit();
  S s = usual();
  dda(t, s);
  const auto json = nlohmann::json::parse(planJson(plan(t, s)));
  ASSERT_EQ(json.size(), kEffects);
  EXPECT_EQ(json[static_cast<size_t>(E::field)], nlohmann::json::parse(R"({"effect": "field", "state": "off",
    "reason": "rays of the matrix do not skip by it, specular rays do not", "skip": "exact",
    "bytes_not_allocated": 1000})"));
  EXPECT_EQ(json[static_cast<size_t>(E::relight)], nlohmann::json::parse(R"({"effect": "relight", "state": "asleep",
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
