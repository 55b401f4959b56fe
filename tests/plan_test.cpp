// The effect plan: every row of it in both directions, on numbers alone.
#include "gi/plan.h"
#include "shaders/shared/pixel_emitters.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <set>

namespace irad {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A grey room with a lamp, built and at rest.
SceneTraits lit() {
  SceneTraits t;
  t.materials = {{.triangles = 10, .albedo = 0.5f}, {.triangles = 2, .emission = 3, .albedo = 0.5f}};
  t.triangles = 12;
  t.build =
      BuildTraits{.voxels = 1000, .facets = 500, .solidVoxels = 400, .emitters = 5, .sampled = true, .matrix = true};
  t.light = {.due = Redo::Nothing, .settled = true, .bound = 1e-4f, .tolerance = 2e-4f, .noise = 0.1f};
  return t;
}

LightTraits light(LightType type, bool shines = true, bool reaches = true) {
  return {.type = type, .shines = shines, .reaches = reaches, .nears = reaches};
}

Settings usual() {
  return defaultSettings(/*cpuDevice=*/true);
}

EffectState stateOf(Effect effect, const SceneTraits& t, const Settings& s = usual()) {
  return plan(t, s).row(effect).state;
}

constexpr EffectState kOn = EffectState::on, kOff = EffectState::off, kAsleep = EffectState::asleep;

TEST(Plan, RowsAreNamedAndExplained) {
  const EffectPlan p = plan(lit(), usual());
  std::set<std::string> names;
  for (const EffectRow& row : p.rows) {
    const EffectInfo& info = effectInfo(row.effect);
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_FALSE(row.reason.empty()) << info.name;
    EXPECT_EQ(&p.row(row.effect), &row);
    if (*info.setting) {
      EXPECT_NO_THROW(settingValue(usual(), info.setting)) << info.setting;
    }
  }
  EXPECT_EQ(names.size(), kEffects);
}

TEST(Plan, EmissionIsCalledForByAnyEmissiveMaterialInUse) {
  SceneTraits t = lit();
  EXPECT_EQ(stateOf(Effect::emission, t), kOn);
  EXPECT_TRUE(contains(plan(t, usual()).row(Effect::emission).reason, "1 of 2 materials emits, 3 W/(m^2 sr)"));
  t.materials[1].triangles = 0;  // nothing has it
  const EffectPlan without = plan(t, usual());
  EXPECT_TRUE(without.off(Effect::emission));
  EXPECT_EQ(without.row(Effect::emission).skip, Skip::exact);
  EXPECT_EQ(without.row(Effect::emission).bytesNotAllocated, 500u * (12 + 16 + 16));
}

TEST(Plan, PixelsLookForEmittersWhereTheyCan) {
  SceneTraits t = lit();
  EXPECT_FALSE(plan(t, usual()).pixelEmitters);
  Settings s = usual();
  s.sample.emitters = EmitterLookup::pixels;
  const auto reason = [&] { return plan(t, s).row(Effect::emission).reason; };
  EXPECT_TRUE(plan(t, s).pixelEmitters);
  EXPECT_TRUE(contains(reason(), fmt::format("pixels look for {} triangles", t.materials[1].triangles)));
  EXPECT_EQ(obeyed(s, plan(t, s)).sample.emitters, EmitterLookup::pixels);
  t.materials[1].triangles = MAX_EMISSIVE_TRIANGLES + 1;
  EXPECT_FALSE(plan(t, s).pixelEmitters);
  EXPECT_TRUE(contains(reason(), "257 triangles, more than 256"));
  EXPECT_EQ(obeyed(s, plan(t, s)).sample.emitters, EmitterLookup::facets);
  t.materials[1].triangles = MAX_EMISSIVE_TRIANGLES;
  EXPECT_TRUE(plan(t, s).pixelEmitters);
  s.sample.gpu.gated = 0;  // the thesis's volume
  EXPECT_FALSE(plan(t, s).pixelEmitters);
  EXPECT_TRUE(contains(reason(), "sample.gated = false"));
  s.sample.gpu.gated = 1;
  s.effects.matrix = EffectMode::off;
  EXPECT_FALSE(plan(t, s).pixelEmitters);
  s.effects.matrix = EffectMode::automatic;
  s.effects.emission = EffectMode::off;
  EXPECT_FALSE(plan(t, s).pixelEmitters);
  s.effects.emission = EffectMode::on;
  t.materials[1].emission = 0;  // of nothing
  EXPECT_FALSE(plan(t, s).pixelEmitters);
}

TEST(Plan, LightsAreCalledForWhereTheyLightTheScene) {
  const std::pair<Effect, LightType> kinds[]{
      {Effect::sun, LightType::Sun}, {Effect::point, LightType::Point}, {Effect::spot, LightType::Spot}};
  for (const auto& [effect, type] : kinds) {
    SceneTraits t = lit();
    EXPECT_EQ(stateOf(effect, t), kOff);
    t.lights = {light(type)};
    EXPECT_EQ(stateOf(effect, t), kOn);
    for (const auto& [other, otherType] : kinds) {
      if (other != effect) {
        EXPECT_EQ(stateOf(other, t), kOff);
      }
    }
    t.lights = {light(type, /*shines=*/false)};
    EXPECT_EQ(stateOf(effect, t), kOff);
    EXPECT_TRUE(contains(plan(t, usual()).row(effect).reason, "none with an intensity"));
    t.lights = {light(type, true, /*reaches=*/false)};
    EXPECT_EQ(stateOf(effect, t), kOff);
    EXPECT_TRUE(contains(plan(t, usual()).row(effect).reason, "none reaches the scene"));
    EXPECT_EQ(plan(t, usual()).row(effect).bytesNotAllocated, 4u * 2048 * 2048);
    t.lights.push_back(light(type));
    EXPECT_EQ(stateOf(effect, t), kOn);
  }
}

TEST(Plan, MatrixIsCalledForByLightAndAlbedo) {
  SceneTraits t = lit();
  EXPECT_EQ(stateOf(Effect::matrix, t), kOn);
  // No albedo: nothing shows H.
  for (MaterialTraits& m : t.materials) m.albedo = 0;
  EXPECT_EQ(stateOf(Effect::matrix, t), kOff);
  // But for a lobe, which reflects it.
  t.materials[0].f0 = 0.9f;
  EXPECT_EQ(stateOf(Effect::matrix, t), kOn);
  Settings without = usual();
  without.specular.mode = SpecularMode::off;
  EXPECT_EQ(stateOf(Effect::matrix, t, without), kOff);
  // No light.
  t = lit();
  t.materials[1].emission = 0;
  t.build.reset();
  EXPECT_EQ(stateOf(Effect::matrix, t), kOff);
  EXPECT_TRUE(contains(plan(t, usual()).row(Effect::matrix).reason, "no light at all"));
  EXPECT_TRUE(contains(plan(t, usual()).row(Effect::emission).reason, "none of 2 materials emits"));
  for (const Effect dark : {Effect::specular, Effect::emitterSampling, Effect::field, Effect::relight, Effect::blur})
    EXPECT_EQ(stateOf(dark, t), kOff) << effectInfo(dark).name;
  t.lights = {light(LightType::Point)};
  EXPECT_EQ(stateOf(Effect::matrix, t), kOn);
}

TEST(Plan, MatrixSaysHowManyRaysEscape) {
  SceneTraits t = lit();
  t.build->escaped = 0.125;
  EXPECT_TRUE(contains(plan(t, usual()).row(Effect::matrix).reason, "12.5 % of the rays escape"));
  t.build->matrix = false;
  EXPECT_FALSE(contains(plan(t, usual()).row(Effect::matrix).reason, "escape"));
}

TEST(Plan, MatrixIsKeptForLightsThatAreThere) {
  SceneTraits t = lit();
  t.materials[1].emission = 0;
  t.lights = {light(LightType::Point, /*shines=*/false)};
  EXPECT_EQ(stateOf(Effect::matrix, t), kAsleep);
  EXPECT_EQ(plan(t, usual()).row(Effect::matrix).bytesNotAllocated, 0u);
  EXPECT_EQ(stateOf(Effect::field, t), kOn);  // of the matrix that is kept
  t.build->matrix = false;                    // never built
  EXPECT_EQ(stateOf(Effect::matrix, t), kOff);
  t.build->matrix = true;
  t.lights.clear();  // taken away
  EXPECT_EQ(stateOf(Effect::matrix, t), kOff);
}

TEST(Plan, SpecularIsCalledForByALobeInTheLight) {
  SceneTraits t = lit();
  EXPECT_EQ(stateOf(Effect::specular, t), kOff);
  EXPECT_TRUE(contains(plan(t, usual()).row(Effect::specular).reason, "Lambertian"));
  t.materials[0].f0 = 0.04f;
  t.materials[0].leastRoughness = 0.3f;
  EXPECT_EQ(stateOf(Effect::specular, t), kOn);
  t.materials[1].emission = 0;
  EXPECT_EQ(stateOf(Effect::specular, t), kOff);
  t.materials[1].emission = 1;
  Settings s = usual();
  s.specular.mode = SpecularMode::off;
  EXPECT_EQ(stateOf(Effect::specular, t, s), kOff);
  s.effects.specular = EffectMode::on;  // the mode says where; there is nowhere
  EXPECT_EQ(stateOf(Effect::specular, t, s), kOff);
  // Too rough for rays: H alone is reflected, and no ray needs the field.
  s = usual();
  s.matrix.gpu.traversal = TRAVERSAL_DDA;
  EXPECT_EQ(stateOf(Effect::field, t, s), kOn);
  t.materials[0].leastRoughness = 0.9f;
  EXPECT_EQ(stateOf(Effect::specular, t, s), kOn);
  EXPECT_TRUE(contains(plan(t, s).row(Effect::specular).reason, "no rays"));
  EXPECT_EQ(stateOf(Effect::field, t, s), kOff);
}

TEST(Plan, EmittersAreSampledWhereTheyAreFew) {
  SceneTraits t = lit();
  EXPECT_EQ(stateOf(Effect::emitterSampling, t), kOn);
  t.build->emitters = 50;
  t.build->sampled = false;
  EXPECT_EQ(stateOf(Effect::emitterSampling, t), kOff);
  EXPECT_EQ(plan(t, usual()).row(Effect::emitterSampling).skip, Skip::threshold);
  t.build->emitters = 49;
  t.light.due = Redo::Gather;  // not tried yet
  EXPECT_EQ(stateOf(Effect::emitterSampling, t), kOn);
  t.light.due = Redo::Nothing;  // tried: no ray met one
  EXPECT_EQ(stateOf(Effect::emitterSampling, t), kOff);
  t.build->sampledShare = 0.8f;  // tried, and the sums did not agree
  EXPECT_EQ(stateOf(Effect::emitterSampling, t), kOff);
  t.light.due = Redo::Gather;  // a light has moved: F M is what it was
  EXPECT_EQ(stateOf(Effect::emitterSampling, t), kOff);
  t.materials[1].emission = 0;
  t.lights = {light(LightType::Sun)};
  EXPECT_EQ(stateOf(Effect::emitterSampling, t), kOff);
  EXPECT_EQ(plan(t, usual()).row(Effect::emitterSampling).skip, Skip::exact);
}

TEST(Plan, SecondFacetUnlessThereIsNone) {
  SceneTraits t = lit();
  EXPECT_EQ(stateOf(Effect::secondFacet, t), kOn);
  EXPECT_TRUE(contains(plan(t, usual()).row(Effect::secondFacet).reason, "100 of 400 solid voxels"));
  t.build->facets = t.build->solidVoxels;
  EXPECT_EQ(stateOf(Effect::secondFacet, t), kOff);
  EXPECT_EQ(plan(t, usual()).row(Effect::secondFacet).bytesNotAllocated, 4000u);
  t.build.reset();
  EXPECT_EQ(stateOf(Effect::secondFacet, t), kOn);
  t.facesOneWay = true;
  EXPECT_EQ(stateOf(Effect::secondFacet, t), kOff);
  t = lit();
  Settings one = usual();
  one.voxel.facets = 1;
  EXPECT_EQ(stateOf(Effect::secondFacet, t, one), kOff);
}

TEST(Plan, FieldIsCalledForByRaysThatReadIt) {
  SceneTraits t = lit();
  EXPECT_EQ(stateOf(Effect::field, t), kOn);
  Settings s = usual();
  s.matrix.gpu.traversal = TRAVERSAL_DDA;
  EXPECT_EQ(stateOf(Effect::field, t, s), kOff);  // Lambertian: no specular rays
  EXPECT_EQ(plan(t, s).row(Effect::field).bytesNotAllocated, 1000u);
  t.materials[0].f0 = 0.04f;
  t.materials[0].leastRoughness = 0.1f;
  EXPECT_EQ(stateOf(Effect::field, t, s), kOn);
  s.specular.gpu.traversal = TRAVERSAL_DDA;
  EXPECT_EQ(stateOf(Effect::field, t, s), kOff);
}

TEST(Plan, RelightAndRebuildSleepUntilTheyAreDue) {
  SceneTraits t = lit();
  EXPECT_EQ(stateOf(Effect::relight, t), kAsleep);
  EXPECT_EQ(plan(t, usual()).row(Effect::relight).reason, "error bound 0.0001 <= 0.0002 W/m^2");
  EXPECT_EQ(stateOf(Effect::rebuild, t), kAsleep);
  t.light.settled = false;
  t.light.bound = 1;
  EXPECT_EQ(stateOf(Effect::relight, t), kOn);
  t.light.due = Redo::Gather;
  EXPECT_EQ(stateOf(Effect::relight, t), kOn);
  EXPECT_EQ(stateOf(Effect::rebuild, t), kAsleep);
  t.light.due = Redo::Shade;
  t.light.settled = true;
  EXPECT_EQ(stateOf(Effect::relight, t), kAsleep);
  t.light.due = Redo::Matrix;
  EXPECT_EQ(stateOf(Effect::rebuild, t), kOn);
  Settings s = usual();
  t.light.due = Redo::Nothing;
  s.effects.relight = EffectMode::on;
  EXPECT_EQ(stateOf(Effect::relight, t, s), kOn);
}

TEST(Plan, MaterialFeatures) {
  SceneTraits t = lit();
  EXPECT_EQ(stateOf(Effect::alphaTest, t), kOff);
  EXPECT_EQ(stateOf(Effect::normalMap, t), kOff);
  t.materials[0].alphaTest = true;
  EXPECT_EQ(stateOf(Effect::alphaTest, t), kOn);
  EXPECT_EQ(stateOf(Effect::normalMap, t), kOff);
  t.materials[1].normalMap = true;
  EXPECT_EQ(stateOf(Effect::normalMap, t), kOn);
}

TEST(Plan, BlurGoesOffBelowHalfItsTriggerAndOnAboveIt) {
  SceneTraits t = lit();
  Settings s = usual();
  s.effects.blurNoise = 0.01f;
  const auto at = [&](float noise, const EffectPlan& before) {
    t.light.noise = noise;
    return plan(t, s, &before);
  };
  const EffectPlan on = plan(t, s), off = at(0.001f, on);
  EXPECT_TRUE(on.on(Effect::blur));
  EXPECT_TRUE(off.off(Effect::blur));
  EXPECT_EQ(off.row(Effect::blur).skip, Skip::threshold);
  EXPECT_EQ(off.row(Effect::blur).epsilon, 0.01f);
  EXPECT_TRUE(at(0.007f, on).on(Effect::blur));  // between half and all of it each stays as it was
  EXPECT_TRUE(at(0.007f, off).off(Effect::blur));
  EXPECT_TRUE(at(0.012f, off).on(Effect::blur));
  EXPECT_TRUE(at(0.004f, on).off(Effect::blur));
  t.light.noise.reset();  // of a light whose noise is not known
  EXPECT_TRUE(plan(t, s, &off).on(Effect::blur));
  s.sample.gpu.filter_ = FILTER_LINEAR;
  EXPECT_TRUE(plan(t, s, &on).off(Effect::blur));
}

/// How often the effect goes on or off while `at(i)` makes the traits and settings of step i.
int switches(Effect effect, EffectPlan before, const std::function<std::pair<SceneTraits, Settings>(int)>& at) {
  int count = 0;
  for (int i = 0; i < 20; ++i) {
    const auto [traits, settings] = at(i);
    const EffectPlan now = plan(traits, settings, &before);
    count += now.on(effect) != before.on(effect);
    before = now;
  }
  return count;
}

TEST(Plan, JitterAboutATriggerSwitchesAtMostOnce) {
  SceneTraits t = lit();
  Settings s = usual();
  // Between the two bounds each state stays; where only the trigger's own side is touched, it settles there.
  const std::pair<Effect, LightType> kinds[]{
      {Effect::sun, LightType::Sun}, {Effect::point, LightType::Point}, {Effect::spot, LightType::Spot}};
  for (const auto& [effect, type] : kinds) {
    const auto jitter = [&, type = type](int i) {
      t.lights = {light(type, true, /*reaches=*/i % 2 == 0)};
      t.lights[0].nears = true;
      return std::pair(t, s);
    };
    EXPECT_EQ(switches(effect, plan(lit(), s), jitter), 1) << effectInfo(effect).name;
    // A light alone, that the matrix is there for.
    SceneTraits dark = t;
    dark.materials[1].emission = 0;
    const auto alone = [&](int i) {
      dark.lights = jitter(i).first.lights;
      return std::pair(dark, s);
    };
    EXPECT_EQ(switches(Effect::matrix, plan(alone(0).first, s), alone), 0) << effectInfo(effect).name;
    // Out of the wider bounds it goes.
    t.lights[0].reaches = t.lights[0].nears = false;
    const EffectPlan on = plan(jitter(0).first, s);
    t.lights[0].reaches = t.lights[0].nears = false;
    EXPECT_TRUE(plan(t, s, &on).off(effect));
  }

  t = lit();
  s.effects.blurNoise = 0.01f;
  const auto noise = [&](int i) {
    t.light.noise = i % 2 == 0 ? 0.0099f : 0.0101f;
    return std::pair(t, s);
  };
  EXPECT_EQ(switches(Effect::blur, plan(lit(), s), noise), 0);
  t.light.noise = 0;
  EXPECT_EQ(switches(Effect::blur, plan(t, s), noise), 1);

  // The field that specular rays alone read, while their roughness limit is dragged.
  t = lit();
  t.materials[0].f0 = 0.04f;
  t.materials[0].leastRoughness = 0.5f;
  s.matrix.gpu.traversal = TRAVERSAL_DDA;
  const auto limit = [&](int i) {
    s.specular.gpu.maxRoughness = i % 2 == 0 ? 0.49f : 0.51f;
    return std::pair(t, s);
  };
  s.specular.gpu.maxRoughness = 0.2f;
  EXPECT_EQ(switches(Effect::field, plan(t, s), limit), 1);
  const EffectPlan on = plan(t, s, nullptr);
  s.specular.gpu.maxRoughness = 0.4f;
  EXPECT_TRUE(plan(t, s, &on).off(Effect::field));
}

TEST(Plan, RedrawFollowsTheWindow) {
  SceneTraits t = lit();
  EXPECT_EQ(stateOf(Effect::redraw, t), kOn);
  t.redraw = false;
  EXPECT_EQ(stateOf(Effect::redraw, t), kAsleep);
  t.redraw = true;
  EXPECT_EQ(stateOf(Effect::redraw, t), kOn);
}

TEST(Plan, OverridesWinAndSaySo) {
  for (const EffectRow& row : plan(lit(), usual()).rows) {
    const EffectInfo& info = effectInfo(row.effect);
    if (!std::string(info.setting).starts_with("effects.")) continue;
    for (const char* value : {"on", "off"}) {
      Settings s = usual();
      applySetting(s, fmt::format("{}={}", info.setting, value));
      SceneTraits t = lit();
      t.materials[0].f0 = 0.04f;
      t.lights.clear();
      const EffectPlan p = plan(t, s);
      EXPECT_EQ(p.row(row.effect).state, std::string(value) == "on" ? kOn : kOff) << info.setting;
      EXPECT_EQ(p.row(row.effect).state != plan(t, usual()).row(row.effect).state,
                p.row(row.effect).reason.starts_with("forced"))
          << info.setting << ": " << p.row(row.effect).reason;
    }
  }
  Settings all = usual();
  forceEffects(all, EffectMode::on);
  SceneTraits dark;
  dark.materials = {{.triangles = 1, .albedo = 0.5f}};
  const EffectPlan p = plan(dark, all);
  for (const EffectRow& row : p.rows)
    if (std::string(effectInfo(row.effect).setting).starts_with("effects.")) {
      EXPECT_EQ(row.state, kOn) << row.reason;
    }
}

TEST(Plan, ObeyedSettingsAreDecided) {
  Settings s = usual();
  s.effects.secondFacet = s.effects.blur = EffectMode::off;
  const Settings o = obeyed(s, plan(lit(), s));
  for (const SettingInfo& info : settingInfos(o))
    if (info.kind == "choice" && std::string(info.meta.name).starts_with("effects.")) {
      EXPECT_NE(info.value, "auto") << info.meta.name;
    }
  EXPECT_EQ(o.specular.mode, SpecularMode::off);
  EXPECT_EQ(o.voxel.facets, 1u);
  EXPECT_EQ(o.sample.gpu.filter_, FILTER_LINEAR);
  EXPECT_EQ(obeyed(o, plan(lit(), o)).sample.gpu.filter_, FILTER_LINEAR);
  // What no effect has a say in stays.
  EXPECT_EQ(o.matrix.gpu.rays, s.matrix.gpu.rays);
}

TEST(Plan, ThesisForcesOnWhatItsStagesAlwaysDo) {
  Settings thesis = usual();
  applyPreset(thesis, "thesis");
  SceneTraits t = lit();
  t.materials[1].emission = 0;
  t.build.reset();
  const EffectPlan p = plan(t, thesis);
  for (const Effect e : {Effect::emission, Effect::matrix, Effect::specular, Effect::field, Effect::blur})
    EXPECT_TRUE(p.on(e)) << effectInfo(e).name;
  EXPECT_TRUE(p.off(Effect::secondFacet));
}

TEST(Plan, Json) {
  const auto json = nlohmann::json::parse(planJson(plan(lit(), usual())));
  ASSERT_EQ(json.size(), kEffects);
  EXPECT_EQ(json[0]["effect"], "emission");
  EXPECT_EQ(json[0]["state"], "on");
  EXPECT_EQ(json[0]["skip"], "exact");
  for (const auto& row : json) {
    EXPECT_TRUE(row["bytes_not_allocated"].is_number_unsigned());
    EXPECT_EQ(row.contains("epsilon"), row["skip"] == "threshold");
  }
}

}  // namespace
}  // namespace irad
