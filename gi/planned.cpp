#include "gi/planned.h"

#include <algorithm>
#include <utility>

namespace irad {

Planned::Planned(const Scene& scene, const Settings& settings)
    : traits(measure(scene, settings.voxel.resolution)),
      plan_(irad::plan(traits, settings)),
      settings_(obeyed(settings, plan_)) {}

void Planned::decide(const Settings& wanted) {
  const EffectPlan before = std::exchange(plan_, irad::plan(traits, wanted, &plan_));
  const Settings next = obeyed(wanted, plan_);
  const Redo first = difference(settings_, next);
  settings_ = next;
  for (const EffectRow& row : plan_.rows)
    if (*effectInfo(row.effect).setting != 0 && row.effect != Effect::relight)
      flips_ += plan_.on(row.effect) != before.on(row.effect) ? 1 : 0;
  // What was learned of the voxels is of the settings that they were made with.
  if (first <= Redo::Voxels && traits.build) {
    traits.build.reset();
    decide(wanted);
  }
}

bool Planned::shines(const GpuLight& light, const Scene& scene, const Settings& wanted) const {
  const Effect kind = light.type == LIGHT_SUN ? Effect::sun : light.type == LIGHT_POINT ? Effect::point : Effect::spot;
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
  e.lights = {.sun = on(Effect::sun), .spot = on(Effect::spot), .point = on(Effect::point)};
  e.emission = on(Effect::emission);
  e.alphaTest = on(Effect::alphaTest);
  e.normalMap = on(Effect::normalMap);
  e.specular = on(Effect::specular);
  e.highlights = std::ranges::any_of(traits.materials, [](const auto& m) { return m.triangles > 0 && m.f0 > 0; });
  return e;
}

}  // namespace irad
