#include "gi/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "gi/emitter_rule.h"
#include "gi/region.h"
#include "gi/stage_keys.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/number_text.h"
#include "renderer/forward.h"
#include "renderer/shadow.h"
#include "shaders/shared/pixel_emitters.h"

namespace irad {
namespace {

/// "no sun", "1 sun", "3 suns".
std::string counted(size_t n, const char* one, const char* many) {
  return n == 0 ? fmt::format("no {}", one) : fmt::format("{} {}", n, n == 1 ? one : many);
}

/// Fills in the rows; those that others depend on come first. Each row's function says what scene and settings call
/// for, and what being off saves; decide() what becomes of that.
class Planner {
 public:
  Planner(const SceneTraits& traits, const Settings& settings, const EffectPlan* before)
      : t_(traits), b_(traits.build.value_or(BuildTraits{})), s_(settings), before_(before) {
    std::ranges::copy_if(traits.materials, std::back_inserter(used_), [](const auto& m) { return m.triangles > 0; });
  }

  EffectPlan run() {
    for (const LightKind& kind : lightKinds()) lamps_ |= lit(light(kind));
    emits_ = lit(emission());
    lit(sky());
    if (shines_) plan_.noLight.clear();
    nothingDiffuse();
    for (const auto row : {&Planner::specular, &Planner::matrix, &Planner::bruteForce, &Planner::writeback,
                           &Planner::emitterSampling, &Planner::field, &Planner::relight, &Planner::glass,
                           &Planner::alphaTest, &Planner::normalMap, &Planner::blur})
      decide((this->*row)());
    const bool builds = t_.light.due <= Redo::Matrix;
    decide(sleeps(Effect::rebuild, builds,
                  builds ? fmt::format("due from {} on", nameOf(t_.light.due))
                         : "geometry and build settings are as they were built"));
    decide(sleeps(Effect::redraw, t_.redraw.value_or(true),
                  !t_.redraw   ? "each picture that is asked for"
                  : *t_.redraw ? "camera, scene, settings or light have changed"
                               : "camera, scene, settings and light are as drawn"));
    pixelEmitters();
    return plan_;
  }

 private:
  /// Whether the effect is called for, and on.
  bool decide(EffectRow r) {
    const EffectMode mode = r.possible ? forcedMode(s_, r.effect) : EffectMode::automatic;
    const EffectState called = r.state;
    if (mode != EffectMode::automatic) r.state = when(mode == EffectMode::on);
    if (r.state != called) r.reason = fmt::format("forced {}: {}", nameOf(mode), r.reason);
    if (r.state != EffectState::off) r.bytesNotAllocated = 0;
    plan_.rows[static_cast<size_t>(r.effect)] = r;
    return called == EffectState::on && r.state == EffectState::on;
  }
  /// The same of a kind of light. What lies outside the region is no light by itself.
  bool lit(const EffectRow& r) {
    const bool lights = decide(r) && (r.effect != Effect::sky || t_.sky > 0);
    if (!lights) plan_.noLight.push_back(plan_.row(r.effect).reason);
    shines_ |= lights;
    return lights;
  }

  static EffectState when(bool calledFor) { return calledFor ? EffectState::on : EffectState::off; }
  /// What is not due sleeps.
  static EffectRow sleeps(Effect effect, bool due, std::string reason) {
    return {.effect = effect, .state = due ? EffectState::on : EffectState::asleep, .reason = std::move(reason)};
  }
  /// Off because of another setting or effect, whatever forces it on.
  static EffectRow never(EffectRow r, std::string reason) {
    r.state = EffectState::off;
    r.reason = std::move(reason);
    r.possible = false;
    return r;
  }
  /// Hysteresis of triggers that an edit may cross back and forth. `share`: of what the effect comes on at; half of it
  /// keeps it on, and is added to the reason.
  void comesOn(EffectRow& r, double share) const {
    const bool stays = share > 0.5 && share <= 1 && before_ != nullptr && before_->on(r.effect);
    if (stays) r.reason += "; near enough to stay on";
    r.state = when(share > 1 || stays);
  }
  /// What is there of an effect that is not called for is kept, for when it is again.
  void keep(EffectRow& r, const char* why) const {
    if (r.state == EffectState::on || forcedMode(s_, r.effect) != EffectMode::automatic) return;
    r.state = EffectState::asleep;
    r.reason += why;
  }

  /// "none of 25 materials with a normal map", "2 of 3 materials with a normal map".
  template <class Has>
  EffectRow materials(Effect effect, Has has, const char* what, uint64_t bytes = 0) const {
    const auto n = std::ranges::count_if(used_, has);
    std::string reason = counted(used_.size(), "material", "materials");
    if (!used_.empty()) reason = fmt::format("{} of {} {}", n == 0 ? "none" : std::to_string(n), reason, what);
    return {.effect = effect, .state = when(n > 0), .reason = std::move(reason), .bytesNotAllocated = bytes};
  }
  float most(float MaterialTraits::*value) const {
    return used_.empty() ? 0 : std::ranges::max(used_, {}, value).*value;
  }
  bool byTriangles() const { return s_.matrix.gpu.hitRule == HitRule::triangles; }

  EffectRow emission() const {
    const uint64_t bytes = b_.facets * (12 + 16 + 16);  // M in the list, F M, and that as shading samples it
    const auto emits = [](const MaterialTraits& m) { return m.emission > 0; };
    EffectRow r = materials(Effect::emission, emits, "with emission", bytes);
    if (r.state == EffectState::on)
      r.reason += fmt::format(", {:.3g} W/(m^2 sr) at most", most(&MaterialTraits::emission));
    return r;
  }

  EffectRow light(const LightKind& kind) const {
    EffectRow r{.effect = effectOf(kind.type)};
    size_t all = 0, shining = 0, lighting = 0, sized = 0;
    double share = 0;
    const uint64_t flat =
        shadowTexelBytes(s_.light.shadowFilter) * s_.light.shadowResolution * s_.light.shadowResolution;
    for (const LightTraits& l : t_.lights) {
      if (l.type != kind.type) continue;
      ++all;
      shining += l.shines;
      lighting += l.share() > 1;
      sized += l.share() > 1 && l.size;
      share = std::max(share, l.share());
      r.bytesNotAllocated += l.cube ? flat / 4 * 6 : flat;
    }
    r.reason = counted(all, kind.one, kind.many);
    if (all > 0)
      r.reason += fmt::format(": {} on and with an intensity, of these {} in reach of the scene", shining, lighting);
    if (sized > 0) r.reason += fmt::format("; penumbrae of {}, by {} points", sized, s_.light.points);
    comesOn(r, share);
    return r;
  }

  EffectRow sky() const {
    // A start for every row's bins, an entry for each of them in which a ray escapes, and what that brings.
    const double escaping = b_.escaped * double(b_.facets * s_.matrix.gpu.rays);
    EffectRow r{.effect = Effect::sky,
                .reason = fmt::format("sky.source = {}", nameOf(s_.sky.source)),
                .bytesNotAllocated = b_.facets * (4 + 16) + static_cast<uint64_t>(4 * escaping)};
    const bool source = s_.sky.source != SkySource::none;
    if (source) r.reason += fmt::format(", {:.3g} W/(m^2 sr) at most", t_.sky);
    if (!byTriangles())
      return never(r, r.reason + (source ? "; not with matrix.hit_rule = thesis, which has no sky" : ""));
    // What lies outside the region is met by the rays that escape, as a sky is.
    if (!t_.region.whole) r.reason += "; rays that leave scene.region meet what lies outside of it";
    r.state = when(t_.sky > 0 || !t_.region.whole);
    if (source && b_.sky) keep(r, "; what was built for it is kept");  // it may be turned up again
    return r;
  }

  /// Metals show what is around them, which is black without a sky, but for highlights of the lights.
  void nothingDiffuse() {
    const bool metal = most(&MaterialTraits::f0) > 0 && most(&MaterialTraits::albedo) == 0;
    // Rays to what lies outside the region are in the sky's row, too.
    if (!metal || !shines_ || emits_ || (plan_.on(Effect::sky) && t_.sky > 0)) return;
    const std::string which = used_.size() == 1 ? "The one material is not diffuse"
                                                : fmt::format("None of {} materials is diffuse", used_.size());
    plan_.nothingDiffuse = {which + ": metal shows what is around it, and nothing there gives light.",
                            "A sky would: sky.source = constant or preetham, or a picture of one (--sky FILE, or "
                            "dropped into the window)."};
  }

  EffectRow specular() const {
    const uint64_t bytes = t_.pixels * (16 + 4);  // reflected radiance, the list of pixels that trace
    const auto reflects = [](const MaterialTraits& m) { return m.f0 > 0; };
    EffectRow r = materials(Effect::specular, reflects, "with a specular lobe", bytes);
    if (s_.specular.mode == SpecularMode::off) return never(r, "specular.mode = off");
    if (r.state == EffectState::off) return r;
    const SpecularParams& rays = s_.specular.gpu;
    r.state = when(shines_);
    if (!shines_) r.reason += ", no light to reflect";
    r.reason += fmt::format(
        "; roughness {:.3g} at least, rays up to {:.3g} (metals {:.3g}) where F0 H is above {:.3g} of the largest H",
        std::ranges::min(used_, {}, &MaterialTraits::leastRoughness).leastRoughness, rays.maxRoughness,
        rays.metalRoughness, rays.threshold);
    return r;
  }

  /// H, by either method: in `row` bytes for each facet and D, F M, H, B twice, as shading samples them.
  EffectRow indirectLight(Effect effect, uint64_t row) const {
    const float albedo = most(&MaterialTraits::albedo);
    const bool shown = albedo > 0 || plan_.on(Effect::specular);
    // No surface shows H, but D of facets tells where shadow maps let light through (gi/direct_seen.comp).
    const bool highlights = lamps_ && byTriangles() && most(&MaterialTraits::f0) > 0;
    EffectRow r{.effect = effect,
                .state = when(shines_ && (shown || highlights)),
                .reason = shines_ ? fmt::format("light, and albedos of up to {:.3g}", albedo)
                                  : "no light at all: H is 0 everywhere",
                .bytesNotAllocated = b_.facets * (row + 6 * 16)};
    if (shines_ && !shown && highlights) r.reason += ", but highlights, which facets keep behind walls";
    return r;
  }
  EffectRow matrix() const {
    // csr keeps 4 B per distinct column, of which there are at most as many as rays.
    const uint64_t rays = s_.matrix.gpu.rays,
                   row = s_.matrix.format == MatrixFormat::csr ? 4 * rays + 12 : 8 * rays + 8, solver = 16 + 4;
    if (s_.solver.method == SolverMethod::bruteForce)
      return never({.effect = Effect::matrix, .bytesNotAllocated = b_.facets * row},
                   "solver.method = brute_force: rays of each frame in its place");
    EffectRow r = indirectLight(Effect::matrix, row + solver);
    if (!b_.matrix) return r;
    r.reason += fmt::format("; {:.3g} % of the rays escape", 100 * b_.escaped);
    // Lights that are there, and what has emitted, may be turned up again.
    if (!t_.lights.empty() || t_.emitted || !plan_.off(Effect::sky)) keep(r, "; kept for the lights that there are");
    return r;
  }
  EffectRow bruteForce() const {
    const uint64_t frames = 2 * 16;
    if (s_.solver.method == SolverMethod::matrix)
      return never({.effect = Effect::bruteForce, .bytesNotAllocated = b_.facets * frames}, "solver.method = matrix");
    EffectRow r = indirectLight(Effect::bruteForce, frames);
    r.reason += fmt::format("; {} rays per facet and frame", s_.matrix.gpu.rays);
    return r;
  }

  EffectRow writeback() const {
    const WritebackMode mode = s_.writeback.mode;
    // W as it is used and as it was drawn; the counts; the sums, or the image that the mask's fragments store to.
    const uint64_t perFacet = mode == WritebackMode::compute ? 72 : 56, perPixel = byTriangles() ? 4 : 0;
    EffectRow r{.effect = Effect::writeback,
                .reason = fmt::format("writeback.mode = {}", nameOf(mode)),
                .bytesNotAllocated = b_.facets * perFacet + perPixel * t_.pixels};
    if (mode == WritebackMode::off) return never(r, r.reason);
    if (!plan_.on(Effect::specular)) return never(r, r.reason + ", but no reflections");
    if (!plan_.on(Effect::matrix)) return never(r, r.reason + ", but no matrix and solve");
    const float f0 = most(&MaterialTraits::f0);
    r.reason += fmt::format("; specular reflectance up to {:.3g}{}", f0, shines_ ? ", lit" : ", no light to reflect");
    r.state = when(f0 > 0 && shines_);
    return r;
  }

  EffectRow emitterSampling() const {
    EffectRow r{.effect = Effect::emitterSampling, .bytesNotAllocated = b_.facets * 16};
    if (!emits_) return never(r, "nothing emits");
    if (plan_.on(Effect::bruteForce)) return never(r, "solver.method = brute_force: its rays meet the emitters");
    if (!plan_.on(Effect::matrix)) return never(r, "no matrix, no first gather");
    if (!byTriangles()) return never(r, "matrix.hit_rule = thesis");
    const bool few = emittersAreFew(b_.emitters, b_.facets) || !t_.build,
               automatic = s_.matrix.emitterSampling == EffectMode::automatic;
    r.epsilon = kEmitterAgreement;
    r.of = "the sum of F M";
    r.state = when(few);
    r.reason = t_.build ? fmt::format("{} of {} facets emit, {} a tenth", withThousands(b_.emitters),
                                      withThousands(b_.facets), few ? "less than" : "not less than")
                        : "known once the emissive facets are counted";
    // F M does not depend on the lights: once the samples were tried, the outcome holds until there is another matrix.
    if (t_.build && few && (b_.sampled || b_.sampledShare > 0 || (automatic && t_.light.due > Redo::Solve))) {
      r.state = when(b_.sampled);
      r.epsilon = std::max(r.epsilon, std::abs(1 - b_.sampledShare));
      r.reason += fmt::format("; their samples bring {:.4g} of what the rays do", b_.sampledShare);
    }
    return r;
  }

  void pixelEmitters() {
    if (s_.sample.emitters == EmitterLookup::facets || !plan_.on(Effect::emission)) return;
    const bool automatic = s_.sample.emitters == EmitterLookup::automatic;
    uint64_t triangles = 0;
    bool even = true;
    for (const MaterialTraits& m : used_) {
      if (m.emission <= 0) continue;
      triangles += m.triangles;
      even = even && m.evenEmission;
    }
    if (triangles == 0 || plan_.noIndirectLight()) return;
    // What emits outside the region is not in F M, whose place pixels' rays take.
    plan_.pixelEmitters =
        triangles <= MAX_EMISSIVE_TRIANGLES && byTriangles() && (even || !automatic) && t_.region.whole;
    plan_.rows[static_cast<size_t>(Effect::emission)].reason +=
        fmt::format("; {} look for {} triangles{}: {} at most{}, with matrix.hit_rule=triangles alone",
                    plan_.pixelEmitters ? "pixels" : "pixels do not", triangles,
                    automatic && plan_.pixelEmitters ? " where facets differ" : "", MAX_EMISSIVE_TRIANGLES,
                    automatic ? " and no textures" : "");
  }

  EffectRow field() const {
    const bool byMatrix = !plan_.noIndirectLight() && s_.matrix.gpu.traversal == Traversal::sdf;
    // Above 1 specular rays of some pixels skip by it; 0.5: materials are rougher by 0.05.
    double smoothness = 0;
    if (plan_.on(Effect::specular) && s_.specular.gpu.traversal == Traversal::sdf) {
      if (s_.effects.specular == EffectMode::on) smoothness = INFINITY;
      for (const MaterialTraits& m : used_)
        if (m.f0 > 0)
          smoothness =
              std::max(smoothness, 1 + 10 * (double{roughnessLimit(s_.specular.gpu, m.f0)} - m.leastRoughness));
    }
    EffectRow r{.effect = Effect::field,
                .reason = fmt::format("rays of {} {} by it, specular rays {}",
                                      plan_.on(Effect::bruteForce) ? "brute force" : "the matrix",
                                      byMatrix ? "skip" : "do not skip", smoothness > 1 ? "do" : "do not"),
                .bytesNotAllocated = s_.field.method == FieldMethod::chebyshev ? b_.voxels : 5 * b_.voxels};
    comesOn(r, byMatrix ? INFINITY : smoothness);
    return r;
  }

  EffectRow relight() const {
    if (plan_.noIndirectLight()) return never({.effect = Effect::relight}, "no indirect light");
    const SolveReport& solve = t_.light.report;
    const bool due = t_.light.due <= Redo::Scatter, frames = plan_.on(Effect::bruteForce);
    const float error = frames ? solve.standardError : solve.bound;
    std::string reason =
        frames ? fmt::format("{} of {} frames, standard error", solve.frames, s_.solver.frames) : "error bound";
    reason += fmt::format(" {:.2g} {} {:.2g} W/m^2", error, error <= solve.allowed ? "<=" : ">", solve.allowed);
    if (due) reason = fmt::format("{} is due", nameOf(std::max(t_.light.due, Redo::Materials)));
    EffectRow r = sleeps(Effect::relight, due || !solve.settled(), std::move(reason));
    r.epsilon = s_.solver.tolerance;
    r.of = "the mean H";
    return r;
  }

  EffectRow glass() const {
    EffectRow r = materials(Effect::glass, &MaterialTraits::glass, "blended with alpha below 1, or transmissive");
    if (byTriangles() || r.state == EffectState::off) return r;
    return never(r, r.reason + ", opaque with matrix.hit_rule = thesis; textured ones cut at one half");
  }

  /// Where there is no glass, textured materials that blend are cut out.
  EffectRow alphaTest() const {
    const bool glass = plan_.on(Effect::glass);
    const auto cut = [&](const MaterialTraits& m) { return m.alphaTest || (m.cutIfOpaque && !(glass && m.glass)); };
    return materials(Effect::alphaTest, cut, "cut out by alpha");
  }
  EffectRow normalMap() const { return materials(Effect::normalMap, &MaterialTraits::normalMap, "with a normal map"); }

  EffectRow blur() const {
    EffectRow r{.effect = Effect::blur};
    if (plan_.noIndirectLight()) return never(r, "no indirect light");
    if (const SampleFilter filter = s_.sample.gpu.filter_; filter != SampleFilter::blur)
      return never(r, fmt::format("sample.filter = {}", nameOf(filter)));
    r.epsilon = s_.effects.blurNoise;
    r.bytesNotAllocated = b_.facets * (plan_.on(Effect::emission) ? 32 : 16);
    const std::optional<float> noise = t_.light.noise;
    r.reason = noise ? fmt::format("it changes H by {:.2g} of the largest at most, {} {:.2g}", *noise,
                                   *noise <= r.epsilon ? "<=" : ">", r.epsilon)
                     : "what it changes is known after a relight";
    comesOn(r, noise ? double{*noise} / r.epsilon : INFINITY);
    return r;
  }

  const SceneTraits& t_;
  const BuildTraits b_;  ///< zeros before a build
  const Settings& s_;
  const EffectPlan* before_;
  EffectPlan plan_;
  std::vector<MaterialTraits> used_;                     ///< by any triangle
  bool emits_ = false, lamps_ = false, shines_ = false;  ///< surfaces; lights of the scene; any light enters it
};

}  // namespace

EffectPlan plan(const SceneTraits& traits, const Settings& settings, const EffectPlan* before) {
  return Planner(traits, settings, before).run();
}

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
  if (effect == Effect::bruteForce) return settings.effects.matrix;  // indirect light, by either method
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
  if (plan.on(Effect::bruteForce)) s.effects.matrix = EffectMode::on;
  if (plan.off(Effect::sky)) s.sky = {};
  if (plan.off(Effect::specular)) s.specular.mode = SpecularMode::off;
  if (plan.off(Effect::writeback)) s.writeback.mode = WritebackMode::off;
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
  return jsonText(out, indent);
}

Planned::Planned(const Scene& scene, const Settings& settings) : traits(measure(scene, settings.voxel.resolution)) {
  traits.region = regionOrWhole(scene, settings);
  plan_ = irad::plan(traits, settings);
  settings_ = obeyed(settings, plan_);
}

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

bool Planned::tinted() const {
  return on(Effect::glass) && std::ranges::any_of(traits.materials, &MaterialTraits::tinted);
}

bool Planned::shines(const GpuLight& light, const Scene& scene, const Settings& wanted) const {
  const Effect kind = effectOf(LightType{light.type});
  if (!on(kind)) return false;
  return forcedMode(wanted, kind) == EffectMode::on ||
         measureLight(light, scene, wanted.voxel.resolution).share() > 0.5;
}

std::vector<Material> Planned::materials(std::vector<Material> all) const {
  for (size_t i = 0; i < all.size(); ++i) {
    Material& m = all[i];
    const MaterialTraits& t = traits.materials.at(i);
    const bool glass = on(Effect::glass) && t.glass;
    if (!glass || !t.tinted) m.transmission = 0;
    if (!glass && m.alpha == AlphaMode::Blend) {
      m.alpha = t.cutIfOpaque ? AlphaMode::Mask : AlphaMode::Opaque;
      m.alphaCutoff = 0.5f;
    }
    if (!glass && !on(Effect::alphaTest)) m.alpha = AlphaMode::Opaque;
    if (!on(Effect::emission)) m.emission = glm::vec3(0), m.emissiveTexture = {};
    if (!on(Effect::normalMap)) m.normalTexture = {};
  }
  return all;
}

ForwardEffects Planned::forwardEffects() const {
  ForwardEffects e;
  for (const LightKind& kind : lightKinds()) e.lights[kind.type] = on(effectOf(kind.type));
  e.emission = on(Effect::emission);
  e.alphaTest = on(Effect::alphaTest) || on(Effect::glass);
  e.glass = on(Effect::glass);
  e.tinted = tinted();
  e.normalMap = on(Effect::normalMap);
  e.specular = on(Effect::specular);
  e.highlights = std::ranges::any_of(traits.materials, [](const auto& m) { return m.triangles > 0 && m.f0 > 0; });
  return e;
}

}  // namespace irad
