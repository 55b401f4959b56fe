#include "gi/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gi/emitter_rule.h"
#include "shaders/shared/pixel_emitters.h"

namespace irad {
namespace {

/// "no sun", "1 sun", "3 suns".
std::string counted(size_t n, const char* one, const char* many) {
  return n == 0 ? fmt::format("no {}", one) : fmt::format("{} {}", n, n == 1 ? one : many);
}

/// Fills in the rows; those that others depend on come first.
class Planner {
 public:
  Planner(const SceneTraits& traits, const Settings& settings, const EffectPlan* before)
      : t_(traits), s_(settings), before_(before) {
    for (size_t i = 0; i < kEffects; ++i) plan_.rows[i].effect = static_cast<Effect>(i);
    for (const MaterialTraits& m : traits.materials)
      if (m.triangles > 0) used_.push_back(&m);
  }

  EffectPlan run() {
    for (const LightKind& kind : lightKinds()) light(kind);
    emission();
    if (shines_) plan_.noLight.clear();
    specular();
    matrix();
    emitterSampling();
    pixelEmitters();
    secondFacet();
    field();
    relight();
    rebuild();
    materialFeature(Effect::alphaTest, &MaterialTraits::alphaTest, "is cut out by its alpha", "are cut out by alpha");
    materialFeature(Effect::normalMap, &MaterialTraits::normalMap, "has a normal map", "have a normal map");
    blur();
    redraw();
    return plan_;
  }

 private:
  EffectRow& row(Effect effect) { return plan_.rows[static_cast<size_t>(effect)]; }

  /// Sets the state by need and by what forces it; `bytes`: what being off saves.
  void decide(Effect effect, bool calledFor, std::string reason, uint64_t bytes = 0,
              std::optional<EffectMode> forced = {}) {
    EffectRow& r = row(effect);
    const EffectMode mode = forced.value_or(forcedMode(s_, effect));
    const bool on = mode == EffectMode::automatic ? calledFor : mode == EffectMode::on;
    r.state = on ? EffectState::on : EffectState::off;
    r.reason = on == calledFor ? std::move(reason) : fmt::format("forced {}: {}", nameOf(mode), reason);
    if (!on) r.bytesNotAllocated = bytes;
  }
  /// The same, but what is not due sleeps.
  void sleeps(Effect effect, bool due, std::string reason) {
    decide(effect, due, std::move(reason));
    if (plan_.off(effect) && !due) row(effect).state = EffectState::asleep;
  }
  /// Whether there is light of a kind, once its effect is decided.
  bool lit(Effect effect, bool calledFor) {
    const bool lights = calledFor && plan_.on(effect);
    if (!lights) plan_.noLight.push_back(row(effect).reason);
    shines_ |= lights;
    return lights;
  }
  /// Off because of another setting or effect, whatever forces it on.
  void without(Effect effect, std::string reason, uint64_t bytes = 0) {
    decide(effect, false, std::move(reason), bytes, EffectMode::off);
  }
  EffectRow& threshold(Effect effect, float epsilon) {
    EffectRow& r = row(effect);
    r.threshold = true;
    r.epsilon = epsilon;
    return r;
  }

  /// Hysteresis of a trigger that an edit may cross back and forth: what `trigger` has put on stays on while the wider
  /// `keeps` holds.
  bool held(Effect effect, bool trigger, bool keeps) const {
    return trigger || (keeps && before_ != nullptr && before_->on(effect));
  }

  /// "none of 25 materials", "2 of 3 materials".
  std::string ofMaterials(size_t n) const {
    const std::string all = counted(used_.size(), "material", "materials");
    return used_.empty() ? all : fmt::format("{} of {}", n == 0 ? "none" : std::to_string(n), all);
  }
  template <class Has>
  size_t with(Has&& has) const {
    return static_cast<size_t>(std::ranges::count_if(used_, [&](const auto* m) { return has(*m); }));
  }
  float most(float MaterialTraits::*value) const {
    float out = 0;
    for (const MaterialTraits* m : used_) out = std::max(out, m->*value);
    return out;
  }
  uint64_t facets() const { return t_.build ? t_.build->facets : 0; }
  uint64_t voxels() const { return t_.build ? t_.build->voxels : 0; }

  void emission() {
    const size_t emitting = with([](const MaterialTraits& m) { return m.emission > 0; });
    std::string reason = ofMaterials(emitting) + (emitting > 1 ? " emit" : " emits");
    if (emitting > 0) reason += fmt::format(", {:.3g} W/(m^2 sr) at most", most(&MaterialTraits::emission));
    // M in the list, F M, and that as shading samples it.
    decide(Effect::emission, emitting > 0, std::move(reason), facets() * (12 + 16 + 16));
    emits_ = lit(Effect::emission, emitting > 0);
  }

  void light(const LightKind& kind) {
    const Effect effect = effectOf(kind.type);
    size_t all = 0, shining = 0, lighting = 0, near = 0;
    uint64_t maps = 0;
    const uint64_t flat = 4ull * s_.light.shadowResolution * s_.light.shadowResolution;
    for (const LightTraits& l : t_.lights) {
      if (l.type != kind.type) continue;
      ++all;
      shining += l.shines;
      lighting += l.lights();
      near += l.mayLight();
      maps += l.cube ? flat / 4 * 6 : flat;
    }
    std::string reason = counted(all, kind.one, kind.many);
    const bool calledFor = held(effect, lighting > 0, near > 0);
    if (lighting > 0)
      reason = fmt::format("{} of {} {} the scene", lighting, reason, lighting == 1 ? "lights" : "light");
    else if (calledFor)
      reason += fmt::format(": {} just out of the scene's reach", near);
    else if (shining > 0)
      reason += fmt::format(": {} with an intensity, none reaches the scene", shining);
    else if (all > 0)
      reason += ", none with an intensity";
    decide(effect, calledFor, std::move(reason), maps);
    lit(effect, calledFor);
  }

  void specular() {
    const float limit = s_.specular.gpu.maxRoughness;
    const uint64_t bytes = t_.pixels * (16 + 4);  // reflected radiance, the list of pixels that trace
    if (s_.specular.mode == SpecularMode::off) return without(Effect::specular, "specular.mode = off", bytes);
    const size_t lobes = with([](const MaterialTraits& m) { return m.f0 > 0; });
    const auto smootherThan = [&](float roughness) {
      return with([&](const MaterialTraits& m) { return m.f0 > 0 && m.leastRoughness < roughness; });
    };
    const size_t traced = smootherThan(limit);
    std::string reason;
    if (lobes == 0)
      reason = "every material is Lambertian";
    else if (!shines_)
      reason = "no light to reflect";
    else if (traced == 0)
      reason = fmt::format("{} of {}, all rougher than {:.3g}: no rays, H alone is reflected", lobes,
                           counted(used_.size(), "material reflects", "materials reflect"), limit);
    else
      reason = fmt::format("{} smoother than {:.3g}: rays where F0 H is above {:.3g} of the largest H",
                           ofMaterials(traced), limit, s_.specular.gpu.threshold);
    decide(Effect::specular, lobes > 0 && shines_, std::move(reason), bytes);
    constexpr float kMargin = 0.05f;
    tracesSpecular_ = plan_.on(Effect::specular) && (traced > 0 || s_.effects.specular == EffectMode::on);
    nearlyTraces_ = plan_.on(Effect::specular) && smootherThan(limit + kMargin) > 0;
  }

  void matrix() {
    const float albedo = most(&MaterialTraits::albedo);
    const bool reads = albedo > 0 || plan_.on(Effect::specular);
    const bool built = t_.build && t_.build->matrix;
    std::string reason = !shines_ ? "no light at all: H is 0 everywhere"
                         : !reads ? "light, but every albedo is 0: no surface shows H, and its views are black"
                                  : fmt::format("light, and albedos of up to {:.3g}", albedo);
    if (built) reason += fmt::format("; {:.3g} % of the rays escape", 100 * t_.build->escaped);
    // csr keeps 4 B per distinct column, of which there are at most as many as rays.
    const uint64_t rays = s_.matrix.gpu.rays,
                   rowBytes = s_.matrix.format == MatrixFormat::csr ? 4 * rays + 12 : 8 * rays + 8;
    constexpr uint64_t kLight = 7 * 16 + 4;  // D, F M, H, B twice, as shading samples them; row sums
    decide(Effect::matrix, shines_ && reads, std::move(reason), facets() * (rowBytes + kLight));
    // Lights that are there may be turned up again: what was built for them is kept.
    EffectRow& r = row(Effect::matrix);
    if (r.state == EffectState::off && s_.effects.matrix == EffectMode::automatic && !t_.lights.empty() && built) {
      r.state = EffectState::asleep;
      r.reason += "; kept for the lights that there are";
      r.bytesNotAllocated = 0;
    }
  }

  void emitterSampling() {
    const uint64_t bytes = facets() * 16;
    if (!emits_ || !plan_.on(Effect::matrix))
      return without(Effect::emitterSampling, emits_ ? "no matrix, no first gather" : "nothing emits", bytes);
    EffectRow& r = threshold(Effect::emitterSampling, kEmitterAgreement);
    r.of = "the sum of F M";
    constexpr EffectMode kModes[]{EffectMode::off, EffectMode::automatic, EffectMode::on};  // of EmitterSampling
    const EffectMode mode = kModes[static_cast<size_t>(s_.matrix.emitterSampling)];
    const auto said = [&](bool calledFor, std::string reason) {
      decide(Effect::emitterSampling, calledFor, std::move(reason), bytes, mode);
    };
    if (!t_.build) return said(true, "known once the emissive facets are counted");
    const BuildTraits& b = *t_.build;
    const std::string share = fmt::format("{} of {} facets emit", b.emitters, b.facets);
    if (!emittersAreFew(b.emitters, b.facets)) return said(false, share + ", a tenth or more: rays find them");
    // F M does not depend on the lights: once the samples were tried, the outcome holds until the matrix is another
    // one.
    const bool tried = b.sampled || b.sampledShare > 0 || (mode == EffectMode::automatic && t_.light.due > Redo::Solve);
    if (!tried) return said(true, share + ", less than a tenth");
    r.epsilon = std::max(r.epsilon, std::abs(1 - b.sampledShare));
    said(b.sampled, fmt::format("{}; their samples bring {:.4g} of what the rays do", share, b.sampledShare));
  }

  void pixelEmitters() {
    if (s_.sample.emitters != EmitterLookup::pixels || !plan_.on(Effect::emission)) return;
    uint64_t triangles = 0;
    for (const MaterialTraits& m : t_.materials) triangles += m.emission > 0 ? m.triangles : 0;
    const bool few = triangles <= MAX_EMISSIVE_TRIANGLES, gated = s_.sample.gpu.gated != 0;
    plan_.pixelEmitters = triangles > 0 && few && gated && !plan_.off(Effect::matrix);
    std::string& reason = row(Effect::emission).reason;
    if (plan_.pixelEmitters)
      reason += fmt::format("; pixels look for {}", counted(triangles, "triangle", "triangles"));
    else if (!few)
      reason += fmt::format("; {} triangles, more than {} that pixels could look for: facets serve", triangles,
                            MAX_EMISSIVE_TRIANGLES);
    else if (triangles > 0 && !gated)
      reason += "; pixels cannot look for it, sample.gated = false: the volume does not tell it from other light";
  }

  void secondFacet() {
    const uint64_t keys = 4 * voxels();
    if (s_.voxel.facets < 2) return without(Effect::secondFacet, "voxel.facets = 1", keys);
    if (t_.facesOneWay) return decide(Effect::secondFacet, false, "all faces look one way: no voxel has two", keys);
    if (!t_.build) return decide(Effect::secondFacet, true, "known once the scene is voxelized", keys);
    const uint32_t second = t_.build->facets - t_.build->solidVoxels;
    decide(Effect::secondFacet, second > 0,
           fmt::format("{} of {} solid voxels {} a second facet", second == 0 ? "none" : std::to_string(second),
                       t_.build->solidVoxels, second > 1 ? "hold" : "holds"),
           keys);
  }

  void field() {
    const bool byMatrix = !plan_.off(Effect::matrix) && s_.matrix.gpu.traversal == Traversal::sdf;
    const bool skips = s_.specular.gpu.traversal == Traversal::sdf, bySpecular = tracesSpecular_ && skips;
    const bool calledFor = held(Effect::field, byMatrix || bySpecular, nearlyTraces_ && skips);
    decide(Effect::field, calledFor,
           byMatrix && bySpecular ? "rays of the matrix and specular rays skip by it"
           : byMatrix             ? "rays of the matrix skip by it"
           : bySpecular           ? "specular rays skip by it"
           : calledFor            ? "kept: materials are barely too rough for specular rays"
                                  : "no ray reads it; views make their own",
           s_.field.method == FieldMethod::chebyshev ? voxels() : 5 * voxels());
  }

  void relight() {
    if (plan_.off(Effect::matrix)) return without(Effect::relight, "no indirect light");
    threshold(Effect::relight, s_.solver.tolerance);
    const LightState& l = t_.light;
    const bool due = l.due <= Redo::Scatter;
    // Light at rest is kept, unless relighting is switched off.
    sleeps(Effect::relight, due || !l.settled || s_.effects.relight == EffectMode::off,
           due ? fmt::format("{} is due", nameOf(std::max(l.due, Redo::Gather)))
               : fmt::format("error bound {:.2g} {} {:.2g} W/m^2", l.bound, l.bound <= l.tolerance ? "<=" : ">",
                             l.tolerance));
  }

  void rebuild() {
    const bool due = t_.light.due <= Redo::Matrix;
    sleeps(Effect::rebuild, due,
           due ? fmt::format("due from {} on", nameOf(t_.light.due))
               : "geometry and build settings are as they were built");
  }

  void redraw() {
    sleeps(Effect::redraw, t_.redraw.value_or(true),
           !t_.redraw   ? "each picture that is asked for"
           : *t_.redraw ? "camera, scene, settings or light have changed"
                        : "camera, scene, settings and light are as drawn");
  }

  void materialFeature(Effect effect, bool MaterialTraits::*has, const char* one, const char* many) {
    const size_t n = with([&](const MaterialTraits& m) { return m.*has; });
    decide(effect, n > 0, fmt::format("{} {}", ofMaterials(n), n > 1 ? many : one));
  }

  void blur() {
    if (plan_.off(Effect::matrix)) return without(Effect::blur, "no indirect light");
    if (const SampleFilter filter = s_.sample.gpu.filter_; filter != SampleFilter::blur)
      return without(Effect::blur, fmt::format("sample.filter = {}", nameOf(filter)));
    const float epsilon = threshold(Effect::blur, s_.effects.blurNoise).epsilon;
    const uint64_t copies = facets() * (plan_.on(Effect::emission) ? 32 : 16);
    if (!t_.light.noise) return decide(Effect::blur, true, "what it changes is known after a relight", copies);
    const float noise = *t_.light.noise;
    const bool quiet = noise <= epsilon, noisy = held(Effect::blur, !quiet, !(noise <= 0.5f * epsilon));
    decide(Effect::blur, noisy,
           fmt::format("it changes H by {:.2g} of the largest at most, {} {:.2g}{}", noise, quiet ? "<=" : ">", epsilon,
                       noisy && quiet ? "; once on it stays so above half of that" : ""),
           copies);
  }

  const SceneTraits& t_;
  const Settings& s_;
  const EffectPlan* before_;
  EffectPlan plan_;
  std::vector<const MaterialTraits*> used_;  ///< by any triangle
  bool emits_ = false, shines_ = false;      ///< surfaces; any light enters the scene
  bool tracesSpecular_ = false;              ///< some pixels may
  bool nearlyTraces_ = false;                ///< if specular.max_roughness were a little higher
};

}  // namespace

EffectPlan plan(const SceneTraits& traits, const Settings& settings, const EffectPlan* before) {
  return Planner(traits, settings, before).run();
}

}  // namespace irad
