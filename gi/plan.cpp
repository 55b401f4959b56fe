#include "gi/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "gi/emitter_rule.h"
#include "gi/stage_keys.h"
#include "renderer/forward.h"
#include "renderer/shadow.h"
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
      : t_(traits), b_(traits.build.value_or(BuildTraits{})), s_(settings), before_(before) {
    for (size_t i = 0; i < kEffects; ++i) plan_.rows[i].effect = static_cast<Effect>(i);
    for (const MaterialTraits& m : traits.materials)
      if (m.triangles > 0) used_.push_back(m);
  }

  EffectPlan run() {
    for (const LightKind& kind : lightKinds()) light(kind);
    emission();
    sky();
    if (shines_) plan_.noLight.clear();
    nothingDiffuse();
    specular();
    matrix();
    writeback();
    emitterSampling();
    pixelEmitters();
    field();
    relight();
    rebuild();
    glass();
    alphaTest();
    materialFeature(Effect::normalMap, &MaterialTraits::normalMap, "with a normal map");
    blur();
    redraw();
    return plan_;
  }

 private:
  EffectRow& row(Effect effect) { return plan_.rows[static_cast<size_t>(effect)]; }

  /// Sets the state by need and by what forces it; `bytes`: what being off saves.
  void decide(Effect effect, bool calledFor, std::string reason, uint64_t bytes = 0) {
    const EffectMode mode = forcedMode(s_, effect);
    const bool on = mode == EffectMode::automatic ? calledFor : mode == EffectMode::on;
    if (on != calledFor) reason = fmt::format("forced {}: {}", nameOf(mode), reason);
    without(effect, std::move(reason), on ? 0 : bytes);
    if (on) row(effect).state = EffectState::on;
  }
  /// The same, but what is not due sleeps.
  void sleeps(Effect effect, bool due, std::string reason) {
    decide(effect, due, std::move(reason));
    if (plan_.off(effect) && !due) row(effect).state = EffectState::asleep;
  }
  /// Off because of another setting or effect, whatever forces it on.
  void without(Effect effect, std::string reason, uint64_t bytes = 0) {
    EffectRow& r = row(effect);
    r.state = EffectState::off;
    r.reason = std::move(reason);
    r.bytesNotAllocated = bytes;
  }
  /// Whether there is light of a kind, once its effect is decided.
  bool lit(Effect effect, bool calledFor) {
    const bool lights = calledFor && plan_.on(effect);
    if (!lights) plan_.noLight.push_back(row(effect).reason);
    shines_ |= lights;
    return lights;
  }
  /// Hysteresis of triggers that an edit may cross back and forth. `share`: of what the effect comes on at; half of it
  /// keeps it on, and is added to the reason.
  bool held(Effect effect, double share, std::string& reason) const {
    const bool stays = share > 0.5 && share <= 1 && before_ != nullptr && before_->on(effect);
    if (stays) reason += "; near enough to stay on";
    return share > 1 || stays;
  }

  /// "none of 25 materials with a normal map", "2 of 3 materials with a normal map".
  template <class Has>
  std::pair<size_t, std::string> materials(Has has, const char* what) const {
    const auto n = static_cast<size_t>(std::ranges::count_if(used_, has));
    const std::string all = counted(used_.size(), "material", "materials");
    return {n, used_.empty() ? all : fmt::format("{} of {} {}", n == 0 ? "none" : std::to_string(n), all, what)};
  }
  float most(float MaterialTraits::*value) const {
    return used_.empty() ? 0 : std::ranges::max(used_, {}, value).*value;
  }

  void emission() {
    const float emission = most(&MaterialTraits::emission);
    std::string reason = materials([](const MaterialTraits& m) { return m.emission > 0; }, "with emission").second;
    if (emission > 0) reason += fmt::format(", {:.3g} W/(m^2 sr) at most", emission);
    // M in the list, F M, and that as shading samples it.
    decide(Effect::emission, emission > 0, std::move(reason), b_.facets * (12 + 16 + 16));
    emits_ = lit(Effect::emission, emission > 0);
  }

  void light(const LightKind& kind) {
    const Effect effect = effectOf(kind.type);
    size_t all = 0, shining = 0, lighting = 0, sized = 0;
    double share = 0;
    uint64_t maps = 0;
    const uint64_t flat =
        shadowTexelBytes(s_.light.shadowFilter) * s_.light.shadowResolution * s_.light.shadowResolution;
    for (const LightTraits& l : t_.lights) {
      if (l.type != kind.type) continue;
      ++all;
      shining += l.shines;
      lighting += l.share() > 1;
      sized += l.share() > 1 && l.size;
      share = std::max(share, l.share());
      maps += l.cube ? flat / 4 * 6 : flat;
    }
    std::string reason = counted(all, kind.one, kind.many);
    if (all > 0)
      reason += fmt::format(": {} on and with an intensity, of these {} in reach of the scene", shining, lighting);
    if (sized > 0) reason += fmt::format("; penumbrae of {}, by {} points", sized, s_.light.points);
    const bool calledFor = held(effect, share, reason);
    decide(effect, calledFor, std::move(reason), maps);
    lit(effect, calledFor);
  }

  void sky() {
    // A start for every row's bins, an entry for each of them in which a ray escapes, and what that brings.
    const uint64_t bytes =
        b_.facets * (4 + 16) + static_cast<uint64_t>(4 * b_.escaped * double(b_.facets * s_.matrix.gpu.rays));
    const SkySource source = s_.sky.source;
    std::string reason = fmt::format("sky.source = {}", nameOf(source));
    if (source != SkySource::none) reason += fmt::format(", {:.3g} W/(m^2 sr) at most", t_.sky);
    if (!byTriangles() && source != SkySource::none) reason += "; not with matrix.hit_rule = thesis, which has no sky";
    // What lies outside the region is met by the rays that escape, as a sky is.
    if (byTriangles() && t_.outer) reason += "; rays that leave scene.region meet what lies outside of it";
    if (byTriangles())
      decide(Effect::sky, t_.sky > 0 || t_.outer, std::move(reason), bytes);
    else
      without(Effect::sky, std::move(reason), bytes);
    lit(Effect::sky, t_.sky > 0);
    // A sky that is there may be turned up again: what was built for it is kept.
    EffectRow& r = row(Effect::sky);
    const bool kept = byTriangles() && source != SkySource::none && b_.sky;
    if (r.state == EffectState::on || s_.effects.sky != EffectMode::automatic || !kept) return;
    r.state = EffectState::asleep;
    r.reason += "; what was built for it is kept";
    r.bytesNotAllocated = 0;
  }

  /// Metals show what is around them, which is black without a sky, but for highlights of the lights.
  void nothingDiffuse() {
    const bool metal = most(&MaterialTraits::f0) > 0 && most(&MaterialTraits::albedo) == 0;
    if (!metal || !shines_ || emits_ || plan_.on(Effect::sky)) return;
    const std::string which = used_.size() == 1 ? "The one material is not diffuse"
                                                : fmt::format("None of {} materials is diffuse", used_.size());
    plan_.nothingDiffuse = {which + ": metal shows what is around it, and nothing there gives light.",
                            "A sky would: sky.source = constant or preetham, or a picture of one (--sky FILE, or "
                            "dropped into the window)."};
  }

  void specular() {
    const SpecularParams& rays = s_.specular.gpu;
    const uint64_t bytes = t_.pixels * (16 + 4);  // reflected radiance, the list of pixels that trace
    if (s_.specular.mode == SpecularMode::off) return without(Effect::specular, "specular.mode = off", bytes);
    auto [lobes, reason] = materials([](const MaterialTraits& m) { return m.f0 > 0; }, "with a specular lobe");
    if (lobes > 0) {
      const float least = std::ranges::min(used_, {}, &MaterialTraits::leastRoughness).leastRoughness;
      smoothness_ = -INFINITY;
      for (const MaterialTraits& m : used_)
        if (m.f0 > 0)
          smoothness_ = std::max(smoothness_, 1 + 10 * (double{roughnessLimit(rays, m.f0)} - m.leastRoughness));
      reason += fmt::format(
          "{}; roughness {:.3g} at least, rays up to {:.3g} (metals {:.3g}) where F0 H is above {:.3g} of the largest "
          "H",
          shines_ ? "" : ", no light to reflect", least, rays.maxRoughness, rays.metalRoughness, rays.threshold);
    }
    decide(Effect::specular, lobes > 0 && shines_, std::move(reason), bytes);
    if (s_.effects.specular == EffectMode::on) smoothness_ = INFINITY;
  }

  void matrix() {
    const float albedo = most(&MaterialTraits::albedo);
    const bool reads = albedo > 0 || plan_.on(Effect::specular);
    std::string reason =
        shines_ ? fmt::format("light, and albedos of up to {:.3g}", albedo) : "no light at all: H is 0 everywhere";
    if (b_.matrix) reason += fmt::format("; {:.3g} % of the rays escape", 100 * b_.escaped);
    // csr keeps 4 B per distinct column, of which there are at most as many as rays.
    const uint64_t rays = s_.matrix.gpu.rays,
                   rowBytes = s_.matrix.format == MatrixFormat::csr ? 4 * rays + 12 : 8 * rays + 8;
    constexpr uint64_t kLight = 6 * 16,  // D, F M, H, B twice, as shading samples them
        kSolve = 16 + 4, kFrames = 2 * 16;
    if (s_.solver.method == SolverMethod::bruteForce) {
      without(Effect::matrix, "solver.method = brute_force: rays of each frame in its place", b_.facets * rowBytes);
      decide(Effect::bruteForce, shines_ && reads, fmt::format("{}; {} rays per facet and frame", reason, rays),
             b_.facets * (kLight + kFrames));
      return;
    }
    without(Effect::bruteForce, "solver.method = matrix", b_.facets * kFrames);
    decide(Effect::matrix, shines_ && reads, std::move(reason), b_.facets * (rowBytes + kLight + kSolve));
    // Lights that are there, and what has emitted, may be turned up again: what was built for them is kept.
    EffectRow& r = row(Effect::matrix);
    const bool mayShine = !t_.lights.empty() || t_.emitted || !plan_.off(Effect::sky);
    if (r.state == EffectState::on || s_.effects.matrix != EffectMode::automatic || !mayShine || !b_.matrix) return;
    r.state = EffectState::asleep;
    r.reason += "; kept for the lights that there are";
    r.bytesNotAllocated = 0;
  }

  void writeback() {
    const WritebackMode mode = s_.writeback.mode;
    // W as it is used and as it was drawn; the counts; the sums, or the image that the mask's fragments store to.
    const uint64_t bytes = b_.facets * (mode == WritebackMode::compute ? 60 : 56) + (byTriangles() ? 4 * t_.pixels : 0);
    if (mode == WritebackMode::off) return without(Effect::writeback, "writeback.mode = off", bytes);
    if (!plan_.on(Effect::specular) || !plan_.on(Effect::matrix))
      return without(Effect::writeback,
                     fmt::format("writeback.mode = {}, but no {}", nameOf(mode),
                                 plan_.on(Effect::specular) ? "matrix and solve" : "reflections"),
                     bytes);
    const float f0 = most(&MaterialTraits::f0);
    std::string reason = fmt::format("writeback.mode = {}; specular reflectance up to {:.3g}{}", nameOf(mode), f0,
                                     shines_ ? ", lit" : ", no light to reflect");
    decide(Effect::writeback, f0 > 0 && shines_, std::move(reason), bytes);
  }

  void emitterSampling() {
    const uint64_t bytes = b_.facets * 16;
    if (plan_.on(Effect::bruteForce) && emits_)
      return without(Effect::emitterSampling, "solver.method = brute_force: its rays meet the emitters", bytes);
    if (!emits_ || !plan_.on(Effect::matrix) || !byTriangles())
      return without(Effect::emitterSampling,
                     !emits_                     ? "nothing emits"
                     : !plan_.on(Effect::matrix) ? "no matrix, no first gather"
                                                 : "matrix.hit_rule = thesis",
                     bytes);
    EffectRow& r = row(Effect::emitterSampling);
    r.epsilon = kEmitterAgreement;
    r.of = "the sum of F M";
    if (!t_.build) return decide(Effect::emitterSampling, true, "known once the emissive facets are counted", bytes);
    const bool few = emittersAreFew(b_.emitters, b_.facets),
               automatic = s_.matrix.emitterSampling == EffectMode::automatic;
    std::string reason =
        fmt::format("{} of {} facets emit, {} a tenth", b_.emitters, b_.facets, few ? "less than" : "not less than");
    // F M does not depend on the lights: once the samples were tried, the outcome holds until the matrix is another
    // one.
    const bool tried = few && (b_.sampled || b_.sampledShare > 0 || (automatic && t_.light.due > Redo::Solve));
    if (tried) {
      r.epsilon = std::max(r.epsilon, std::abs(1 - b_.sampledShare));
      reason += fmt::format("; their samples bring {:.4g} of what the rays do", b_.sampledShare);
    }
    decide(Effect::emitterSampling, tried ? b_.sampled : few, std::move(reason), bytes);
  }

  void pixelEmitters() {
    if (s_.sample.emitters == EmitterLookup::facets || !plan_.on(Effect::emission)) return;
    const bool automatic = s_.sample.emitters == EmitterLookup::automatic;
    uint64_t triangles = 0;
    bool even = true;
    for (const MaterialTraits& m : t_.materials) {
      if (m.emission <= 0) continue;
      triangles += m.triangles;
      even = even && m.evenEmission;
    }
    if (triangles == 0 || plan_.noIndirectLight()) return;
    // What emits outside the region is not in F M, whose place pixels' rays take.
    plan_.pixelEmitters = triangles <= MAX_EMISSIVE_TRIANGLES && byTriangles() && (even || !automatic) && !t_.outer;
    row(Effect::emission).reason +=
        fmt::format("; {} look for {} triangles{}: {} at most{}, with matrix.hit_rule=triangles alone",
                    plan_.pixelEmitters ? "pixels" : "pixels do not", triangles,
                    automatic && plan_.pixelEmitters ? " where facets differ" : "", MAX_EMISSIVE_TRIANGLES,
                    automatic ? " and no textures" : "");
  }

  void field() {
    const bool byMatrix = !plan_.noIndirectLight() && s_.matrix.gpu.traversal == Traversal::sdf;
    const bool skips = plan_.on(Effect::specular) && s_.specular.gpu.traversal == Traversal::sdf;
    std::string reason = fmt::format("rays of {} {} by it, specular rays {}",
                                     plan_.on(Effect::bruteForce) ? "brute force" : "the matrix",
                                     byMatrix ? "skip" : "do not skip", skips && smoothness_ > 1 ? "do" : "do not");
    const bool calledFor = byMatrix || (skips && held(Effect::field, smoothness_, reason));
    decide(Effect::field, calledFor, std::move(reason),
           s_.field.method == FieldMethod::chebyshev ? b_.voxels : 5 * b_.voxels);
  }

  void relight() {
    if (plan_.noIndirectLight()) return without(Effect::relight, "no indirect light");
    row(Effect::relight).epsilon = s_.solver.tolerance;
    row(Effect::relight).of = "the mean H";
    const LightState& l = t_.light;
    const bool due = l.due <= Redo::Scatter;
    // Light at rest is kept, unless relighting is switched off.
    sleeps(Effect::relight, due || !l.settled || s_.effects.relight == EffectMode::off,
           due ? fmt::format("{} is due", nameOf(std::max(l.due, Redo::Materials)))
           : plan_.on(Effect::bruteForce)
               ? fmt::format("{} of {} frames, standard error {:.2g} {} {:.2g} W/m^2", l.frames, s_.solver.frames,
                             l.standardError, l.standardError <= l.tolerance ? "<=" : ">", l.tolerance)
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

  void glass() {
    auto [n, reason] =
        materials([](const MaterialTraits& m) { return m.glass; }, "blended with alpha below 1, or transmissive");
    if (!byTriangles() && n > 0)
      return without(Effect::glass, reason + ", opaque with matrix.hit_rule = thesis; textured ones cut at one half");
    decide(Effect::glass, n > 0, std::move(reason));
  }
  /// Where there is no glass, textured materials that blend are cut out.
  void alphaTest() {
    const bool glass = plan_.on(Effect::glass);
    const auto cut = [&](const MaterialTraits& m) { return m.alphaTest || (m.cutIfOpaque && !(glass && m.glass)); };
    auto [n, reason] = materials(cut, "cut out by alpha");
    decide(Effect::alphaTest, n > 0, std::move(reason));
  }
  void materialFeature(Effect effect, bool MaterialTraits::*has, const char* what) {
    auto [n, reason] = materials(has, what);
    decide(effect, n > 0, std::move(reason));
  }

  void blur() {
    if (plan_.noIndirectLight()) return without(Effect::blur, "no indirect light");
    if (const SampleFilter filter = s_.sample.gpu.filter_; filter != SampleFilter::blur)
      return without(Effect::blur, fmt::format("sample.filter = {}", nameOf(filter)));
    const float epsilon = row(Effect::blur).epsilon = s_.effects.blurNoise;
    const uint64_t copies = b_.facets * (plan_.on(Effect::emission) ? 32 : 16);
    if (!t_.light.noise) return decide(Effect::blur, true, "what it changes is known after a relight", copies);
    const float noise = *t_.light.noise;
    std::string reason = fmt::format("it changes H by {:.2g} of the largest at most, {} {:.2g}", noise,
                                     noise <= epsilon ? "<=" : ">", epsilon);
    const bool noisy = held(Effect::blur, double{noise} / epsilon, reason);
    decide(Effect::blur, noisy, std::move(reason), copies);
  }

  bool byTriangles() const { return s_.matrix.gpu.hitRule == HitRule::triangles; }

  const SceneTraits& t_;
  const BuildTraits b_;  ///< zeros before a build
  const Settings& s_;
  const EffectPlan* before_;
  EffectPlan plan_;
  std::vector<MaterialTraits> used_;     ///< by any triangle
  bool emits_ = false, shines_ = false;  ///< surfaces; any light enters the scene
  double smoothness_ = 0;                ///< above 1 some pixels may trace; 0.5: materials are rougher by 0.05
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
  return out.dump(indent);
}

Planned::Planned(const Scene& scene, const Settings& settings) : traits(measure(scene, settings.voxel.resolution)) {
  traits.outer = liesOutside(scene, settings);
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

std::vector<GpuMaterial> Planned::materials(const std::vector<GpuMaterial>& all) const {
  std::vector<GpuMaterial> out = all;
  for (size_t i = 0; i < out.size(); ++i) {
    GpuMaterial& m = out[i];
    const MaterialTraits& t = traits.materials.at(i);
    const bool glass = on(Effect::glass) && t.glass;
    if ((m.flags & MATERIAL_TRANSMISSIVE) != 0 && !(glass && t.tinted)) {
      // As without the extension.
      m.flags &= ~MATERIAL_TRANSMISSIVE;
      if (m.alphaCutoff >= 0) m.flags &= ~MATERIAL_BLEND;
      if (m.alphaCutoff == 0) m.flags &= ~MATERIAL_ALPHA_MASK;
      if (m.alphaCutoff < 0) m.alphaCutoff = 0.5f;
    }
    if (!glass && (m.flags & MATERIAL_BLEND) != 0) {
      m.flags &= ~MATERIAL_BLEND;
      if (!t.cutIfOpaque) m.flags &= ~MATERIAL_ALPHA_MASK;
    }
    if (!on(Effect::emission)) {
      m.emission = glm::vec3(0);
      m.flags &= ~MATERIAL_EMISSIVE_TEXTURE;
    }
    if (!on(Effect::alphaTest) && !glass) m.flags &= ~MATERIAL_ALPHA_MASK;
    if (!on(Effect::normalMap)) m.flags &= ~MATERIAL_NORMAL_TEXTURE;
  }
  return out;
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
