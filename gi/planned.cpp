// The plan's table of effects, what becomes of the settings under it, and a pipeline's plan over time.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "gi/plan.h"
#include "gi/stage_keys.h"
#include "renderer/forward.h"

namespace irad {

const EffectInfo& effectInfo(Effect effect) {
  static constexpr EffectInfo infos[]{
#define IRAD_EFFECT(id, ...) {__VA_ARGS__},
      IRAD_EFFECTS(IRAD_EFFECT)
#undef IRAD_EFFECT
  };
  return infos[static_cast<size_t>(effect)];
}

Effect effectOf(LightType type) {
  static constexpr std::array effects{
#define IRAD_LIGHT_EFFECT(constant, number, id, effect, gltf, name, one, many, map, traits) Effect::effect,
      IRAD_LIGHT_KINDS(IRAD_LIGHT_EFFECT)
#undef IRAD_LIGHT_EFFECT
  };
  return effects.at(static_cast<size_t>(type));
}

uint64_t EffectPlan::bytesNotAllocated() const {
  uint64_t sum = 0;
  for (const EffectRow& r : rows) sum += r.bytesNotAllocated;
  return sum;
}

EffectMode forcedMode(const Settings& settings, Effect effect) {
  if (effect == Effect::emitterSampling) return settings.matrix.emitterSampling;
  const auto mode = effectInfo(effect).mode;
  return mode ? settings.effects.*mode : EffectMode::automatic;
}

void forceEffects(Settings& settings, EffectMode mode) {
  for (size_t i = 0; i < kEffects; ++i)
    if (const auto member = effectInfo(static_cast<Effect>(i)).mode) settings.effects.*member = mode;
}

Settings obeyed(const Settings& settings, const EffectPlan& plan) {
  Settings s = settings;
  for (const EffectRow& row : plan.rows)
    if (const auto mode = row.info().mode)
      s.effects.*mode = row.state == EffectState::off ? EffectMode::off : EffectMode::on;
  if (plan.off(Effect::specular)) s.specular.mode = SpecularMode::off;
  if (!plan.pixelEmitters) s.sample.emitters = EmitterLookup::facets;
  if (plan.off(Effect::blur) && s.sample.gpu.filter_ == SampleFilter::blur) s.sample.gpu.filter_ = SampleFilter::linear;
  return s;
}

std::string planJson(const EffectPlan& plan, int indent) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const EffectRow& r : plan.rows) {
    nlohmann::ordered_json row{
        {"effect", r.info().name}, {"state", r.stateName()}, {"reason", r.reason}, {"skip", r.skipName()}};
    if (r.epsilon > 0) {
      row["epsilon"] = nlohmann::ordered_json::parse(fmt::format("{}", r.epsilon));
      row["epsilon_of"] = r.of;
    }
    row["bytes_not_allocated"] = r.bytesNotAllocated;
    out.push_back(std::move(row));
  }
  return out.dump(indent);
}

Planned::Planned(const Scene& scene, const Settings& settings)
    : traits(measure(scene, settings.voxel.resolution)),
      plan_(irad::plan(traits, settings)),
      settings_(obeyed(settings, plan_)) {}

void Planned::decide(const Settings& wanted) {
  plan_ = irad::plan(traits, wanted, &plan_);
  const Settings next = obeyed(wanted, plan_);
  const Redo first = firstDifference(settings_, next);
  settings_ = next;
  // What was learned from the voxels holds for the settings that they were made with.
  if (first <= Redo::Voxels && traits.build) {
    traits.build.reset();
    decide(wanted);
  }
}

bool Planned::shines(const GpuLight& light, const Scene& scene, const Settings& wanted) const {
  const Effect kind = effectOf(LightType{light.type});
  if (!on(kind)) return false;
  return forcedMode(wanted, kind) == EffectMode::on || measureLight(light, scene, wanted.voxel.resolution).mayLight();
}

std::vector<GpuMaterial> Planned::materials(const std::vector<GpuMaterial>& all) const {
  std::vector<GpuMaterial> out = all;
  for (GpuMaterial& m : out) {
    if (!on(Effect::emission)) {
      m.emission = glm::vec3(0);
      m.flags &= ~MATERIAL_EMISSIVE_TEXTURE;
    }
    if (!on(Effect::alphaTest)) m.flags &= ~MATERIAL_ALPHA_MASK;
    if (!on(Effect::normalMap)) m.flags &= ~MATERIAL_NORMAL_TEXTURE;
  }
  return out;
}

ForwardEffects Planned::forwardEffects() const {
  ForwardEffects e;
  for (const LightKind& kind : lightKinds()) e.lights[kind.type] = on(effectOf(kind.type));
  e.emission = on(Effect::emission);
  e.alphaTest = on(Effect::alphaTest);
  e.normalMap = on(Effect::normalMap);
  e.specular = on(Effect::specular);
  e.highlights = std::ranges::any_of(traits.materials, [](const auto& m) { return m.triangles > 0 && m.f0 > 0; });
  return e;
}

}  // namespace irad
