// What a scene calls for: which effects run, and in words why. plan() is a pure function of numbers: passes ask the
// plan, never the scene, and no device is needed to test it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gi/settings.h"
#include "gi/traits.h"

namespace irad {

struct ForwardEffects;

// X(identifier, "name", "label", "setting that forces it", the same where it is one of effects.*): the rows of the
// plan, in order.
#define IRAD_EFFECTS(X)                                                                          \
  X(emission, "emission", "Emissive facets", "effects.emission", &EffectSettings::emission)      \
  X(emitterSampling, "emitter-sampling", "Emitter sampling", "matrix.emitter_sampling", nullptr) \
  X(sun, "sun", "Sun", "effects.sun", &EffectSettings::sun)                                      \
  X(point, "point", "Point lights", "effects.point", &EffectSettings::point)                     \
  X(spot, "spot", "Spot lights", "effects.spot", &EffectSettings::spot)                          \
  X(sky, "sky", "Sky", "effects.sky", &EffectSettings::sky)                                      \
  X(matrix, "matrix", "Matrix and solve", "effects.matrix", &EffectSettings::matrix)             \
  X(bruteForce, "brute-force", "Brute force", "", nullptr)                                       \
  X(specular, "specular", "Specular", "effects.specular", &EffectSettings::specular)             \
  X(writeback, "writeback", "Writeback", "effects.writeback", &EffectSettings::writeback)        \
  X(field, "field", "Distance field", "effects.field", &EffectSettings::field)                   \
  X(relight, "relight", "Relight", "effects.relight", &EffectSettings::relight)                  \
  X(rebuild, "rebuild", "Rebuild", "", nullptr)                                                  \
  X(alphaTest, "alpha-test", "Alpha test", "effects.alpha_test", &EffectSettings::alphaTest)     \
  X(glass, "glass", "Glass", "effects.glass", &EffectSettings::glass)                            \
  X(normalMap, "normal-map", "Normal maps", "effects.normal_map", &EffectSettings::normalMap)    \
  X(blur, "blur", "Blur", "effects.blur", &EffectSettings::blur)                                 \
  X(redraw, "redraw", "Redraw", "", nullptr)

enum class Effect : uint32_t {
#define IRAD_EFFECT(id, ...) id,
  IRAD_EFFECTS(IRAD_EFFECT)
#undef IRAD_EFFECT
};
inline constexpr size_t kEffects = static_cast<size_t>(Effect::redraw) + 1;

/// That of a kind of light.
Effect effectOf(LightType type);

struct EffectInfo {
  const char *name, *label, *setting;
  EffectMode EffectSettings::*mode;
};
const EffectInfo& effectInfo(Effect effect);

/// asleep: called for, but nothing is due; what it has made is kept.
#define IRAD_EFFECT_STATES(X) X(off, "off") X(asleep, "asleep") X(on, "on")
IRAD_ENUM(EffectState, IRAD_EFFECT_STATES)

struct EffectRow {
  Effect effect{};
  EffectState state = EffectState::off;
  std::string reason;  ///< with the figures: "2 of 14 materials with emission, 12 W/(m^2 sr) at most"
  /// How the picture may differ from that with the effect forced on. Exact: not in one bit, what is left out is
  /// provably 0 (`epsilon` 0); threshold: by no more than `epsilon`, a share of `of`.
  float epsilon = 0;
  /// relight: the mean H, by area. emitterSampling: that of the sum over all facets; rays and samples of single ones
  /// differ by their noise.
  const char* of = "the largest H";
  uint64_t bytesNotAllocated = 0;  ///< while it is off, by the formulas of docs/method.md 10; 0: unknown before a build
  bool possible = true;            ///< false: another setting or effect has it off, whatever forces it on

  const EffectInfo& info() const { return effectInfo(effect); }
  const char* stateName() const { return nameOf(state); }
  const char* skipName() const { return epsilon > 0 ? "threshold" : "exact"; }
};

struct EffectPlan {
  std::array<EffectRow, kEffects> rows;
  bool pixelEmitters = false;  ///< sample.emitters = pixels is obeyed; the row of emission says why not
  /// The reasons of all kinds of light where none lights the scene; else nothing.
  std::vector<std::string> noLight;
  /// Where there is light, but no material that scatters it and no sky: why surfaces are black all the same, and what
  /// would mend it, a sentence each; else nothing.
  std::vector<std::string> nothingDiffuse;
  const EffectRow& row(Effect effect) const { return rows[static_cast<size_t>(effect)]; }
  bool on(Effect effect) const { return row(effect).state == EffectState::on; }
  bool off(Effect effect) const { return row(effect).state == EffectState::off; }
  /// H is computed, by either method.
  bool indirectLight() const { return on(Effect::matrix) || on(Effect::bruteForce); }
  /// Neither computed nor kept.
  bool noIndirectLight() const { return off(Effect::matrix) && off(Effect::bruteForce); }
  uint64_t bytesNotAllocated() const;
};

/// `before`: the plan until now, so that effects do not flicker at their triggers: one that is on goes off only at half
/// of the share that it comes on at. (Lights: twice as far; field for specular rays: 0.05 rougher.)
EffectPlan plan(const SceneTraits& traits, const Settings& settings, const EffectPlan* before = nullptr);

/// automatic where nothing forces it.
EffectMode forcedMode(const Settings& settings, Effect effect);
/// Sets every effect that effects.* can force.
void forceEffects(Settings& settings, EffectMode mode);

/// The settings that stages get: `settings` with every effects.* decided (on or off), and off where it has a setting of
/// its own written there (specular.mode, sample.filter, sample.emitters).
Settings obeyed(const Settings& settings, const EffectPlan& plan);

/// [{"effect": "sun", "state": "off", "reason": ..., "skip": "exact", "bytes_not_allocated": 16777216}, ...]
std::string planJson(const EffectPlan& plan, int indent = -1);

/// A pipeline's plan over time: what is known of its scene, what was decided of it, and the settings its stages get.
class Planned {
 public:
  /// Decides for a scene of which nothing is built.
  Planned(const Scene& scene, const Settings& settings);

  SceneTraits traits;  ///< whoever learns of a change writes it here, then decides

  const EffectPlan& plan() const { return plan_; }
  bool on(Effect effect) const { return plan_.on(effect); }
  /// There are panes that tint what passes.
  bool tinted() const;
  /// obeyed() for the plan as it is.
  const Settings& settings() const { return settings_; }

  /// Decides anew.
  void decide(const Settings& wanted);
  /// Whether a light gets a shadow map and is summed up. Where its kind is on, the lights do that reach the scene or
  /// nearly do; where the kind is forced on, all of them do.
  bool shines(const GpuLight& light, const Scene& scene, const Settings& wanted) const;
  /// The scene's materials, less what the plan has off.
  std::vector<Material> materials(std::vector<Material> all) const;
  /// Which parts of forward shading are on. The rasterizer is not the plan's choice.
  ForwardEffects forwardEffects() const;

 private:
  EffectPlan plan_;
  Settings settings_;
};

}  // namespace irad
