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

/// Fills in the rows, those first that others depend on.
class Planner {
 public:
  Planner(const SceneTraits& traits, const Settings& settings, const EffectPlan* before)
      : t_(traits), s_(settings), before_(before) {
    for (size_t i = 0; i < kEffects; ++i) plan_.rows[i].effect = static_cast<Effect>(i);
  }

  EffectPlan run() {
    emission();
    light(Effect::sun, LightType::Sun, "sun", "suns");
    light(Effect::point, LightType::Point, "point light", "point lights");
    light(Effect::spot, LightType::Spot, "spot light", "spot lights");
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

  /// The state by mode and need; `bytes`: what being off saves.
  void decide(Effect effect, bool calledFor, std::string reason, uint64_t bytes = 0) {
    decide(effect, forcedMode(s_, effect), calledFor, std::move(reason), bytes);
  }
  void decide(Effect effect, EffectMode mode, bool calledFor, std::string reason, uint64_t bytes) {
    EffectRow& r = row(effect);
    r.state = (mode == EffectMode::automatic ? calledFor : mode == EffectMode::on) ? EffectState::on : EffectState::off;
    const bool against = (r.state == EffectState::on) != calledFor;
    r.reason = against ? fmt::format("forced {}: {}", EnumNames<EffectMode>::names[static_cast<size_t>(mode)], reason)
                       : std::move(reason);
    if (r.state == EffectState::off) r.bytesNotAllocated = bytes;
  }

  /// Hysteresis of a trigger that an edit may cross back and forth: what `trigger` has put on stays on while the wider
  /// `keeps` holds.
  bool held(Effect effect, bool trigger, bool keeps) const {
    return trigger || (keeps && before_ != nullptr && before_->on(effect));
  }

  size_t used() const {
    return static_cast<size_t>(
        std::count_if(t_.materials.begin(), t_.materials.end(), [](const auto& m) { return m.triangles > 0; }));
  }
  /// "none of 25 materials", "2 of 3 materials".
  std::string ofMaterials(size_t n) const {
    const std::string all = counted(used(), "material", "materials");
    return used() == 0 ? all : fmt::format("{} of {}", n == 0 ? "none" : std::to_string(n), all);
  }
  template <class Has>
  size_t with(Has&& has) const {
    return static_cast<size_t>(std::count_if(t_.materials.begin(), t_.materials.end(),
                                             [&](const auto& m) { return m.triangles > 0 && has(m); }));
  }
  float most(float MaterialTraits::*value) const {
    float out = 0;
    for (const MaterialTraits& m : t_.materials)
      if (m.triangles > 0) out = std::max(out, m.*value);
    return out;
  }
  uint64_t facets() const { return t_.build ? t_.build->facets : 0; }

  void emission() {
    const size_t emitting = with([](const MaterialTraits& m) { return m.emission > 0; });
    std::string reason = ofMaterials(emitting) + (emitting > 1 ? " emit" : " emits");
    if (emitting > 0) reason += fmt::format(", {:.3g} W/(m^2 sr) at most", most(&MaterialTraits::emission));
    // M in the list, F M, and that as shading samples it.
    decide(Effect::emission, emitting > 0, std::move(reason), facets() * (12 + 16 + 16));
    shines_ |= emitting > 0 && plan_.on(Effect::emission);
  }

  void light(Effect effect, LightType type, const char* one, const char* many) {
    size_t all = 0, shining = 0, lighting = 0, near = 0;
    uint64_t maps = 0;
    const uint64_t flat = 4ull * s_.light.shadowResolution * s_.light.shadowResolution;
    for (const LightTraits& l : t_.lights) {
      if (l.type != type) continue;
      ++all;
      shining += l.shines;
      lighting += l.lights();
      near += l.mayLight();
      maps += l.cube ? flat / 4 * 6 : flat;
    }
    std::string reason = counted(all, one, many);
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
    shines_ |= calledFor && plan_.on(effect);
  }

  void specular() {
    const size_t lobes = with([](const MaterialTraits& m) { return m.f0 > 0; });
    const auto smootherThan = [&](float limit) {
      return with([&](const MaterialTraits& m) { return m.f0 > 0 && m.leastRoughness < limit; });
    };
    const size_t traced = smootherThan(s_.specular.gpu.maxRoughness);
    const bool off = s_.specular.mode == SpecularMode::off;
    std::string reason = "specular.mode = off";
    if (!off && lobes == 0)
      reason = "every material is Lambertian";
    else if (!off && !shines_)
      reason = "no light to reflect";
    else if (!off && traced == 0)
      reason = fmt::format("{} of {}, all rougher than {:.3g}: no rays, H alone is reflected", lobes,
                           counted(used(), "material reflects", "materials reflect"), s_.specular.gpu.maxRoughness);
    else if (!off)
      reason = fmt::format("{} smoother than {:.3g}: rays where F0 H is above {:.3g} of the largest H",
                           ofMaterials(traced), s_.specular.gpu.maxRoughness, s_.specular.gpu.threshold);
    // Reflected radiance, the list of pixels that trace.
    const uint64_t bytes = t_.pixels * (16 + 4);
    decide(Effect::specular, off ? EffectMode::off : s_.effects.specular, !off && lobes > 0 && shines_,
           std::move(reason), bytes);
    constexpr float kMargin = 0.05f;
    tracesSpecular_ = plan_.on(Effect::specular) && (traced > 0 || s_.effects.specular == EffectMode::on);
    nearlyTraces_ = plan_.on(Effect::specular) && smootherThan(s_.specular.gpu.maxRoughness + kMargin) > 0;
  }

  void matrix() {
    const float albedo = most(&MaterialTraits::albedo);
    const bool reads = albedo > 0 || plan_.on(Effect::specular);
    std::string reason = !shines_ ? "no light at all: H is 0 everywhere"
                         : !reads ? "light, but every albedo is 0: no surface shows H, and its views are black"
                                  : fmt::format("light, and albedos of up to {:.3g}", albedo);
    if (t_.build && t_.build->matrix) reason += fmt::format("; {:.3g} % of the rays escape", 100 * t_.build->escaped);
    // csr keeps 4 B per distinct column, of which there are at most as many as rays.
    const uint64_t rowBytes =
        s_.matrix.format == MatrixFormat::csr ? 4ull * s_.matrix.gpu.rays + 12 : 8ull * s_.matrix.gpu.rays + 8;
    constexpr uint64_t kLight = 7 * 16 + 4;  // D, F M, H, B twice, as shading samples them; row sums
    decide(Effect::matrix, shines_ && reads, reason, facets() * (rowBytes + kLight));
    // Lights that are there may be turned up again: what was built for them is kept.
    EffectRow& r = row(Effect::matrix);
    if (r.state == EffectState::off && s_.effects.matrix == EffectMode::automatic && !t_.lights.empty() && t_.build &&
        t_.build->matrix) {
      r.state = EffectState::asleep;
      r.reason += "; kept for the lights that there are";
      r.bytesNotAllocated = 0;
    }
  }
  void emitterSampling() {
    EffectRow& r = row(Effect::emitterSampling);
    const bool emits = plan_.on(Effect::emission) && most(&MaterialTraits::emission) > 0;
    const uint32_t emitters = t_.build ? t_.build->emitters : 0;
    const EffectMode mode = s_.matrix.emitterSampling == EmitterSampling::automatic ? EffectMode::automatic
                            : s_.matrix.emitterSampling == EmitterSampling::on      ? EffectMode::on
                                                                                    : EffectMode::off;
    const auto said = [&](bool calledFor, std::string reason) {
      decide(Effect::emitterSampling, mode, calledFor, std::move(reason), facets() * 16);
    };
    if (!emits || !plan_.on(Effect::matrix))
      return decide(Effect::emitterSampling, EffectMode::automatic, false,
                    emits ? "no matrix, no first gather" : "nothing emits", facets() * 16);
    r.skip = Skip::threshold;
    r.epsilon = kEmitterAgreement;
    r.of = "the sum of F M";
    if (!t_.build) return said(true, "known once the emissive facets are counted");
    const std::string share = fmt::format("{} of {} facets emit", emitters, t_.build->facets);
    if (!emittersAreFew(emitters, t_.build->facets)) return said(false, share + ", a tenth or more: rays find them");
    // What light moves is not F M: once tried it stands until the matrix is another one.
    const bool tried = t_.build->sampled || t_.build->sampledShare > 0 ||
                       (mode == EffectMode::automatic && t_.light.due > Redo::Solve);
    if (!tried) return said(true, share + ", less than a tenth");
    r.epsilon = std::max(r.epsilon, std::abs(1 - t_.build->sampledShare));
    said(t_.build->sampled,
         fmt::format("{}; their samples bring {:.4g} of what the rays do", share, t_.build->sampledShare));
  }

  void pixelEmitters() {
    EffectRow& r = row(Effect::emission);
    if (s_.sample.emitters != EmitterLookup::pixels || !plan_.on(Effect::emission)) return;
    uint64_t triangles = 0;
    for (const MaterialTraits& m : t_.materials) triangles += m.emission > 0 ? m.triangles : 0;
    plan_.pixelEmitters =
        triangles > 0 && triangles <= MAX_EMISSIVE_TRIANGLES && s_.sample.gpu.gated != 0 && !plan_.off(Effect::matrix);
    if (plan_.pixelEmitters)
      r.reason += fmt::format("; pixels look for {}", counted(triangles, "triangle", "triangles"));
    else if (triangles > MAX_EMISSIVE_TRIANGLES)
      r.reason += fmt::format("; {} triangles, more than {} that pixels could look for: facets serve", triangles,
                              MAX_EMISSIVE_TRIANGLES);
    else if (triangles > 0 && s_.sample.gpu.gated == 0)
      r.reason += "; pixels cannot look for it, sample.gated = false: the volume does not tell it from other light";
  }

  void secondFacet() {
    const uint64_t keys = t_.build ? 4 * t_.build->voxels : 0;
    if (s_.voxel.facets < 2) return decide(Effect::secondFacet, EffectMode::off, false, "voxel.facets = 1", keys);
    if (t_.facesOneWay) return decide(Effect::secondFacet, false, "all faces look one way: no voxel has two", keys);
    if (!t_.build) return decide(Effect::secondFacet, true, "known once the scene is voxelized", keys);
    const uint32_t second = t_.build->facets - t_.build->solidVoxels;
    decide(Effect::secondFacet, second > 0,
           fmt::format("{} of {} solid voxels {} a second facet", second == 0 ? "none" : std::to_string(second),
                       t_.build->solidVoxels, second > 1 ? "hold" : "holds"),
           keys);
  }

  void field() {
    const bool byMatrix = !plan_.off(Effect::matrix) && s_.matrix.gpu.traversal == TRAVERSAL_SDF;
    const bool skips = s_.specular.gpu.traversal == TRAVERSAL_SDF;
    const bool bySpecular = tracesSpecular_ && skips;
    const bool calledFor = held(Effect::field, byMatrix || bySpecular, nearlyTraces_ && skips);
    const uint64_t voxels = t_.build ? t_.build->voxels : 0;
    std::string reason = byMatrix && bySpecular ? "rays of the matrix and specular rays skip by it"
                         : byMatrix             ? "rays of the matrix skip by it"
                         : bySpecular           ? "specular rays skip by it"
                         : calledFor            ? "kept: materials are barely too rough for specular rays"
                                                : "no ray reads it; views make their own";
    decide(Effect::field, calledFor, std::move(reason),
           s_.field.method == FieldMethod::chebyshev ? voxels : 5 * voxels);
  }

  void relight() {
    EffectRow& r = row(Effect::relight);
    if (plan_.off(Effect::matrix)) return decide(Effect::relight, EffectMode::off, false, "no indirect light", 0);
    const LightState& l = t_.light;
    const bool due = l.due <= Redo::Scatter;
    const std::string bound =
        fmt::format("error bound {:.2g} {} {:.2g} W/m^2", l.bound, l.bound <= l.tolerance ? "<=" : ">", l.tolerance);
    const std::string reason =
        due ? fmt::format("{} is due", EnumNames<Redo>::names[static_cast<size_t>(std::max(l.due, Redo::Gather))])
            : bound;
    // Light at rest is kept, where nobody stops it for good.
    const bool stopped = s_.effects.relight == EffectMode::off;
    decide(Effect::relight, stopped || due || !l.settled, reason);
    if (r.state == EffectState::off && !stopped) r.state = EffectState::asleep;
    r.skip = Skip::threshold;
    r.epsilon = s_.solver.tolerance;
  }

  void rebuild() {
    const bool due = t_.light.due <= Redo::Matrix;
    row(Effect::rebuild).reason =
        due ? fmt::format("due from {} on", EnumNames<Redo>::names[static_cast<size_t>(t_.light.due)])
            : "geometry and build settings are as they were built";
    row(Effect::rebuild).state = due ? EffectState::on : EffectState::asleep;
  }

  void materialFeature(Effect effect, bool MaterialTraits::*has, const char* one, const char* many) {
    const size_t n = with([&](const MaterialTraits& m) { return m.*has; });
    decide(effect, n > 0, fmt::format("{} {}", ofMaterials(n), n > 1 ? many : one));
  }

  void blur() {
    if (plan_.off(Effect::matrix)) return decide(Effect::blur, EffectMode::off, false, "no indirect light", 0);
    if (s_.sample.gpu.filter_ != FILTER_BLUR)
      return decide(Effect::blur, EffectMode::off, false,
                    fmt::format("sample.filter = {}", EnumNames<SampleFilter>::names[s_.sample.gpu.filter_]), 0);
    EffectRow& r = row(Effect::blur);
    r.skip = Skip::threshold;
    r.epsilon = s_.effects.blurNoise;
    const uint64_t copies = facets() * (plan_.on(Effect::emission) ? 32 : 16);
    if (!t_.light.noise) return decide(Effect::blur, true, "what it changes is known after a relight", copies);
    const float noise = *t_.light.noise;
    const bool noisy = held(Effect::blur, !(noise <= r.epsilon), !(noise <= 0.5f * r.epsilon));
    decide(Effect::blur, noisy,
           fmt::format("it changes H by {:.2g} of the largest at most, {} {:.2g}{}", noise,
                       noise <= r.epsilon ? "<=" : ">", r.epsilon,
                       noisy && noise <= r.epsilon ? "; once on it stays so above half of that" : ""),
           copies);
  }

  void redraw() {
    EffectRow& r = row(Effect::redraw);
    r.state = t_.redraw.value_or(true) ? EffectState::on : EffectState::asleep;
    r.reason = !t_.redraw   ? "each picture that is asked for"
               : *t_.redraw ? "camera, scene, settings or light have changed"
                            : "camera, scene, settings and light are as drawn";
  }

  const SceneTraits& t_;
  const Settings& s_;
  const EffectPlan* before_;
  EffectPlan plan_;
  bool shines_ = false;          ///< light enters the scene
  bool tracesSpecular_ = false;  ///< some pixels may
  bool nearlyTraces_ = false;    ///< if specular.max_roughness were a little higher
};

}  // namespace

EffectPlan plan(const SceneTraits& traits, const Settings& settings, const EffectPlan* before) {
  return Planner(traits, settings, before).run();
}

}  // namespace irad
