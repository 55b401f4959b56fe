// What this scene calls for: which effects run, and in words why. A pure function of numbers: passes ask the plan,
// never the scene, and no device is needed to test it.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "gi/settings.h"
#include "gi/traits.h"

namespace irad {

// X(identifier, "name", "label", "setting that forces it"): the rows of the plan, in order.
#define IRAD_EFFECTS(X)                                                                 \
  X(emission, "emission", "Emissive facets", "effects.emission")                        \
  X(emitterSampling, "emitter-sampling", "Emitter sampling", "matrix.emitter_sampling") \
  X(sun, "sun", "Sun", "effects.sun")                                                   \
  X(point, "point", "Point lights", "effects.point")                                    \
  X(spot, "spot", "Spot lights", "effects.spot")                                        \
  X(matrix, "matrix", "Matrix and solve", "effects.matrix")                             \
  X(specular, "specular", "Specular", "effects.specular")                               \
  X(secondFacet, "second-facet", "Second facet", "effects.second_facet")                \
  X(field, "field", "Distance field", "effects.field")                                  \
  X(relight, "relight", "Relight", "effects.relight")                                   \
  X(rebuild, "rebuild", "Rebuild", "")                                                  \
  X(alphaTest, "alpha-test", "Alpha test", "effects.alpha_test")                        \
  X(normalMap, "normal-map", "Normal maps", "effects.normal_map")                       \
  X(blur, "blur", "Blur", "effects.blur")                                               \
  X(redraw, "redraw", "Redraw", "")

enum class Effect : uint32_t {
#define IRAD_EFFECT(id, name, label, setting) id,
  IRAD_EFFECTS(IRAD_EFFECT)
#undef IRAD_EFFECT
};
inline constexpr size_t kEffects = static_cast<size_t>(Effect::redraw) + 1;

struct EffectInfo {
  Effect effect;
  const char *name, *label;
  const char* setting;  ///< that forces it; "" where nothing does
};
const EffectInfo& effectInfo(Effect effect);

/// asleep: called for, but nothing is due; what it has made is kept.
enum class EffectState : uint32_t { off, asleep, on };
template <>
struct EnumNames<EffectState> {
  static constexpr std::array names{"off", "asleep", "on"};
};
/// How the picture may differ from that with the effect forced on. exact: not in one bit, what is left out is provably
/// 0; threshold: by no more than `epsilon` of `of`.
enum class Skip : uint32_t { exact, threshold };
template <>
struct EnumNames<Skip> {
  static constexpr std::array names{"exact", "threshold"};
};

struct EffectRow {
  Effect effect{};
  EffectState state = EffectState::on;
  std::string reason;  ///< with the figures: "2 of 14 materials emit, 12 W/(m^2 sr) at most"
  Skip skip = Skip::exact;
  float epsilon = 0;  ///< of a threshold skip, a share of `of`
  /// emitterSampling: that of the sum over all facets; rays and samples of single ones differ by their noise.
  const char* of = "the largest H";
  uint64_t bytesNotAllocated = 0;  ///< while it is off, by the formulas of METHOD section 10; 0: unknown before a build
};

struct EffectPlan {
  std::array<EffectRow, kEffects> rows;
  bool pixelEmitters = false;  ///< sample.emitters = pixels is obeyed; the row of emission says why not
  const EffectRow& row(Effect effect) const { return rows[static_cast<size_t>(effect)]; }
  bool on(Effect effect) const { return row(effect).state == EffectState::on; }
  bool off(Effect effect) const { return row(effect).state == EffectState::off; }
  uint64_t bytesNotAllocated() const;
};

/// `before`: the plan until now, for what must not flicker at its trigger: an effect that is on goes off only where a
/// wider one lets go of it too. blur: half of effects.blur_noise; lights: LightTraits::nears; field for specular rays:
/// materials up to 0.05 rougher than specular.max_roughness.
EffectPlan plan(const SceneTraits& traits, const Settings& settings, const EffectPlan* before = nullptr);

/// The settings that stages get: `settings` with every effects.* decided (on or off), and off where it has a setting of
/// its own written there (specular.mode, voxel.facets, sample.filter, sample.emitters).
Settings obeyed(const Settings& settings, const EffectPlan& plan);

/// automatic where nothing forces it. (Of emitterSampling see matrix.emitter_sampling.)
EffectMode forcedMode(const Settings& settings, Effect effect);
/// Of every effect that can be forced by effects.*.
void forceEffects(Settings& settings, EffectMode mode);

/// [{"effect": "sun", "state": "off", "reason": ..., "skip": "exact", "bytes_not_allocated": 16777216}, ...]
std::string planJson(const EffectPlan& plan, int indent = -1);

}  // namespace irad
