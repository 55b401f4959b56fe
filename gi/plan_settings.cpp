// The plan as settings: what forces an effect, what stages get; and as JSON.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gi/plan.h"

namespace irad {
namespace {

constexpr std::array<EffectInfo, kEffects> kInfos{{
#define IRAD_EFFECT(id, name, label, setting) {Effect::id, name, label, setting},
    IRAD_EFFECTS(IRAD_EFFECT)
#undef IRAD_EFFECT
}};

struct Forced {
  Effect effect;
  EffectMode EffectSettings::*mode;
};
constexpr Forced kForced[]{{Effect::emission, &EffectSettings::emission},
                           {Effect::sun, &EffectSettings::sun},
                           {Effect::point, &EffectSettings::point},
                           {Effect::spot, &EffectSettings::spot},
                           {Effect::matrix, &EffectSettings::matrix},
                           {Effect::specular, &EffectSettings::specular},
                           {Effect::secondFacet, &EffectSettings::secondFacet},
                           {Effect::field, &EffectSettings::field},
                           {Effect::relight, &EffectSettings::relight},
                           {Effect::alphaTest, &EffectSettings::alphaTest},
                           {Effect::normalMap, &EffectSettings::normalMap},
                           {Effect::blur, &EffectSettings::blur}};

}  // namespace

EffectMode forcedMode(const Settings& settings, Effect effect) {
  for (const Forced& forced : kForced)
    if (forced.effect == effect) return settings.effects.*forced.mode;
  return EffectMode::automatic;
}

const EffectInfo& effectInfo(Effect effect) {
  return kInfos[static_cast<size_t>(effect)];
}

uint64_t EffectPlan::bytesNotAllocated() const {
  uint64_t sum = 0;
  for (const EffectRow& r : rows) sum += r.bytesNotAllocated;
  return sum;
}

Settings obeyed(const Settings& settings, const EffectPlan& plan) {
  Settings s = settings;
  for (const Forced& forced : kForced)
    s.effects.*forced.mode = plan.off(forced.effect) ? EffectMode::off : EffectMode::on;
  if (plan.off(Effect::specular)) s.specular.mode = SpecularMode::off;
  if (settings.effects.secondFacet == EffectMode::off) s.voxel.facets = 1;
  if (!plan.pixelEmitters) s.sample.emitters = EmitterLookup::facets;
  if (plan.off(Effect::blur) && s.sample.gpu.filter_ == FILTER_BLUR) s.sample.gpu.filter_ = FILTER_LINEAR;
  return s;
}

void forceEffects(Settings& settings, EffectMode mode) {
  for (const Forced& forced : kForced) settings.effects.*forced.mode = mode;
}

std::string planJson(const EffectPlan& plan, int indent) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const EffectRow& r : plan.rows) {
    nlohmann::ordered_json row{{"effect", effectInfo(r.effect).name},
                               {"state", EnumNames<EffectState>::names.at(static_cast<size_t>(r.state))},
                               {"reason", r.reason},
                               {"skip", EnumNames<Skip>::names.at(static_cast<size_t>(r.skip))}};
    if (r.skip == Skip::threshold) {
      row["epsilon"] = nlohmann::ordered_json::parse(fmt::format("{}", r.epsilon));
      row["epsilon_of"] = r.of;
    }
    row["bytes_not_allocated"] = r.bytesNotAllocated;
    out.push_back(std::move(row));
  }
  return out.dump(indent);
}

}  // namespace irad
