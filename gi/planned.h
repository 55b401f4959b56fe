// A pipeline's effect plan over time: what is known of its scene, what was decided of it, and the settings that its
// stages get.
#pragma once

#include "gi/plan.h"
#include "renderer/forward.h"
#include "renderer/gpu_scene.h"

namespace irad {

class Planned {
 public:
  /// Decides for a scene of which nothing is built.
  Planned(const Scene& scene, const Settings& settings);

  SceneTraits traits;  ///< whoever learns of a change writes it here, then decides

  const EffectPlan& plan() const { return plan_; }
  bool on(Effect effect) const { return plan_.on(effect); }
  /// obeyed(): of the plan as it is.
  const Settings& settings() const { return settings_; }
  /// How often an effect went on or off since the scene was loaded.
  uint64_t flips() const { return flips_; }

  /// Decides anew.
  void decide(const Settings& wanted);
  /// Whether a light is to be drawn and summed up: where its kind is on those that light the scene or nearly do, with
  /// the kind forced on all of it.
  bool shines(const GpuLight& light, const Scene& scene, const Settings& wanted) const;
  /// The scene's materials, less what the plan has off.
  std::vector<GpuMaterial> materials(const std::vector<GpuMaterial>& all) const;
  /// What of forward shading is on; by which rasterizer is not the plan's to say.
  ForwardEffects forwardEffects() const;

 private:
  EffectPlan plan_;
  Settings settings_;
  uint64_t flips_ = 0;
};

}  // namespace irad
