#include "gi/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "gi/brute_force.h"
#include "gi/emitters.h"
#include "gi/facets.h"
#include "gi/field.h"
#include "gi/gather.h"
#include "gi/gather_emitters.h"
#include "gi/glass.h"
#include "gi/host_facets.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/pixel_emitters.h"
#include "gi/plan.h"
#include "gi/products.h"
#include "gi/scatter.h"
#include "gi/scene_shape.h"
#include "gi/shadow_needs.h"
#include "gi/sky.h"
#include "gi/solve.h"
#include "gi/specular.h"
#include "gi/stage_keys.h"
#include "gi/subsystems.h"
#include "gi/views/passes.h"
#include "gi/voxelize.h"
#include "gi/watch.h"
#include "gi/writeback.h"
#include "renderer/base/error.h"
#include "renderer/scene/material_edits.h"

namespace irad {

namespace {

/// No other state of any pipeline has this number.
uint64_t newState() {
  static std::atomic<uint64_t> last = 0;
  return ++last;
}

/// What surfaces give pictures, of all that those are drawn from.
constexpr uint32_t kFromSurfaces =
    FROM_TARGETS | FROM_DEPTH | FROM_DIRECT_LIGHT | FROM_INDIRECT_LIGHT | FROM_REFLECTIONS | FROM_EMITTED;

/// Whether surfaces are there that a picture may be drawn from. What comes straight from emitters is told apart where a
/// picture asks, which changes the roundings of the rest.
bool holdsSurfaces(const Targets::Surfaces& held, const Targets::Surfaces& wanted) {
  const uint32_t there = (held.from & FROM_TARGETS) != 0 ? held.from | FROM_DEPTH : held.from;
  return held.key == wanted.key && (wanted.from & ~there) == 0 && ((wanted.from ^ there) & FROM_EMITTED) == 0;
}

/// Wall-clock milliseconds since `start`.
double since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

struct Pipeline::Impl {
  Impl(Context& c, Scene s, const Settings& wanted, ExpectedIrradiance h)
      : context(c),
        scene(std::move(s)),
        expected(std::move(h)),
        settings(wanted),
        planned(scene, wanted),
        onDevice(c, scene),
        surfaces(scene) {
    content = {.lights = lightContent(onDevice.lightValues)};
    lookAtRegion(planned.traits.region);
    lookAtSurfaces(scene.materials, content);
    lookAtSky(scene.lights);
    useSun();
    decide();
  }

  Context& context;
  Scene scene;
  ExpectedIrradiance expected;
  Settings settings;  ///< the user's; stages get planned.settings()
  Planned planned;
  SceneOnDevice onDevice;
  Buffer camera;
  uint64_t frameIndex = 0;
  Revision revision;
  uint64_t state = newState();  ///< of all that pictures are drawn from
  uint64_t solvedFrame = 0;     ///< of the last solve
  uint64_t shaders = 0;         ///< ShaderLibrary::generation() of the last build

  // What there is to be made, and what was made, by content. Shadow maps are not the product of a stage, but have a key
  // like one.
  SurfaceContent surfaces;
  SceneContent content;
  std::optional<std::vector<SamePlace>> repeats;  ///< once something has been built
  StageKeys made;
  uint64_t shadowsMade = 0, shadowsWanted = 0;

  Products now;  ///< what pictures are drawn from
  std::optional<ShadowMaps> shadows;
  Image picture;  ///< the reference picture
  View pictureOf = VIEW_LIT;

  Sky sky;                        ///< that the settings ask for
  std::optional<SkySun> sunUsed;  ///< that is among the device's lights
  SkyOnDevice skyOnDevice;        ///< that the light is made with; none where the plan has it off

  // ---- What the plan says ----

  /// The first stage that the next prepare() has to run. Those that come of it follow.
  Redo due() const { return firstDifference(made, wanted()); }
  StageKeys wanted() const { return stageKeys(content, planned.settings()); }
  bool shadowsDue() const { return shadowsMade != shadowsWanted; }

  /// Decides anew on what is known by now; what that changes becomes due.
  void decide() {
    planned.decide(settings);
    // With the settings that the present voxels were made with, what those voxels have shown holds again.
    if (!planned.traits.build && now.facets && due() > Redo::Voxels) {
      learn(now);
      planned.decide(settings);
    }
    useMaterials();
    shadowsWanted = shadowKey(onDevice.lightValues);
  }

  /// The key of the shadow maps that these lights need.
  uint64_t shadowKey(std::span<const GpuLight> lights) const {
    Digest digest;
    digest.add(content.surfaces)
        .add(planned.on(Effect::alphaTest))
        .add(planned.on(Effect::glass))
        .add(planned.tinted())
        .add(settings.light.shadowResolution);
    const ShadowNeeds needs = shadowNeeds();
    digest.add(needs.filter).add(needs.bleedReduction).add(needs.points);
    if (needs.filter == ShadowFilter::vsm) digest.add(needs.taps);
    const std::vector<int> layers = shadowLayers(context.device, lights, needs);
    for (size_t i = 0; i < lights.size(); ++i) digest.add(layers[i]).add(shadowContent(lights[i]));
    return digest.value();
  }

  void useMaterials() {
    std::vector<GpuMaterial> wanted = gpuMaterials(planned.materials(scene.materials));
    const auto bytes = [](const auto& v) { return std::as_bytes(std::span(v)); };
    if (!std::ranges::equal(bytes(wanted), bytes(onDevice.materialValues)))
      onDevice.setMaterials(context, std::move(wanted));
  }

  void lookAtSurfaces(const std::vector<Material>& of, SceneContent& in) const {
    in.surfaces = surfaces.surfaces(of);
    in.materials = surfaces.materials(of);
    in.emission = surfaces.emission(of);
  }

  void lookAtLights(std::span<const GpuLight> lights) {
    planned.traits.lights.clear();
    for (const GpuLight& light : lights)
      planned.traits.lights.push_back(measureLight(light, scene, settings.voxel.resolution));
    content.lights = lightContent(lights);
    decide();
  }

  void lookAtSky(std::span<const Light> lights) {
    sky = makeSky(settings.sky, skyInputs(scene, lights), &sky);
    planned.traits.sky = sky.largest();
    content.sky = scene.sky ? Digest().add(std::as_bytes(std::span(scene.sky->sha256))).value() : 0;
  }
  /// regionOrWhole(), which may look at every triangle, but where settings leave the region as it is.
  SceneRegion regionWith(const Settings& wanted) const {
    const bool same =
        wanted.scene.region == settings.scene.region && wanted.matrix.gpu.hitRule == settings.matrix.gpu.hitRule;
    return same ? planned.traits.region : regionOrWhole(scene, wanted);
  }
  /// UsageError where the box that settings or scene ask for holds nothing of it, of which the traits say nothing.
  SceneShape shape() {
    if (!repeats) repeats = samePlaces(scene);
    const bool boxed = settings.scene.region.mode == RegionMode::box || scene.region;
    return {boxed ? regionOf(scene, settings) : planned.traits.region, *repeats};
  }
  static uint64_t regionKey(const SceneRegion& of) { return Digest().add(of.lo).add(of.hi).value(); }
  void lookAtRegion(const SceneRegion& now) {
    planned.traits.region = now;
    content.region = regionKey(now);
  }
  /// Settings or sky have changed.
  void lookAgain() {
    lookAtSky(scene.lights);
    const bool moved = useSun();
    lookAtLights(onDevice.lightValues);
    if (!moved || !shadows || !shadowsDue()) return;
    try {
      redrawShadows();
    } catch (const Error&) {
      // Its shadows are still due: prepare() says what is in the way.
    }
  }
  /// The sun of the sky, where the sky may shine.
  std::optional<SkySun> skySun() const {
    const bool may = settings.effects.sky != EffectMode::off && settings.matrix.gpu.hitRule == HitRule::triangles;
    return may ? sky.sun : std::nullopt;
  }
  /// These lights, and behind them the sun of the sky.
  std::vector<GpuLight> withSun(std::vector<Light> lights) const {
    if (const std::optional<SkySun> sun = skySun()) {
      const float most = std::max({sun->irradiance.x, sun->irradiance.y, sun->irradiance.z});
      lights.push_back({.name = "sun of the sky",
                        .type = LightType::Sun,
                        .direction = -sun->towards,
                        .color = sun->irradiance / most,
                        .intensity = most});
    }
    return gpuLights(lights, scene.origin);
  }
  /// Where that has changed it becomes one of the device's lights. Returns whether it has.
  bool useSun() {
    if (skySun() == sunUsed) return false;
    sunUsed = skySun();
    std::vector<GpuLight> values = withSun(scene.lights);
    if (shadows && shadowsMade == shadowKey(values)) keepShadows(values, onDevice.lightValues);
    onDevice.setLights(context, std::move(values), shadowNeeds().shines);
    return true;
  }
  void redrawShadows() {
    const auto start = std::chrono::steady_clock::now();
    shadows = drawShadows(context, onDevice, settings.light.shadowResolution, shadowNeeds());
    shadowsMade = shadowsWanted;
    context.timings.endFrame(frameIndex, /*setup=*/false, since(start));
  }

  void learn(const Products& p) { planned.traits.build = buildTraits(p); }

  /// The light's state, which changes from frame to frame.
  LightState lightState() const {
    LightState state = planned.traits.light;
    state.due =
        std::min({due(), shadowsDue() ? Redo::Gather : Redo::Nothing, reflectionsDue() ? Redo::Solve : Redo::Nothing});
    if (now.light) state.report = now.light->report;
    return state;
  }

  bool lit() const { return planned.plan().indirectLight(); }
  /// H by the rays of frames, without a matrix.
  bool framewise() const { return planned.on(Effect::bruteForce); }
  bool relights() const { return settings.effects.relight != EffectMode::off; }

  // ---- What is due ----

  void prepare(uint32_t maxSweeps, const Progress& progress) {
    Redo first = due();
    if (first <= Redo::Voxels) {
      // What the voxels have shown depends on the shaders that made them, too.
      if (std::exchange(shaders, context.shaders.generation()) != context.shaders.generation()) {
        planned.traits.build.reset();
        decide();
      }
      // The new list's products replace the old ones together, once they are lit. Until then the old picture stays.
      Products fresh;
      build(fresh, Redo::Voxels, progress);
      relight(fresh, StagesDue::from(Redo::Emission), maxSweeps, progress);
      now = std::move(fresh);
    } else {
      StagesDue due(made, wanted());
      const auto done = [this](std::initializer_list<Redo> stages) {
        const StageKeys keys = wanted();
        for (const Redo stage : stages) made[stage] = keys[stage];
      };
      if (first <= Redo::Matrix) {
        build(now, first, progress);
        done({Redo::Voxels, Redo::Field, Redo::Matrix});
        due.add(StagesDue::from(Redo::Emission));
      }
      if (due.has(Redo::Materials)) {
        made.forget(Redo::Materials);
        shadeFacets(now, due.has(Redo::Emission), progress);
        done({Redo::Materials});
      }
      fitField(now);
      if (!relights()) return;
      // A mean over frames would begin anew each time; it goes on by itself.
      if (settings.effects.relight == EffectMode::on && !framewise()) due.add(StagesDue::from(Redo::Gather));
      if (first > Redo::Scatter && !due.has(Redo::Solve)) {
        if (now.light->report.settled() && !reflectionsDue()) return;
        due.add(StagesDue::from(Redo::Solve));
      }
      for (const Redo stage : {Redo::Emission, Redo::Gather, Redo::Solve, Redo::Scatter})
        if (due.has(stage)) made.forget(stage);
      relight(now, due, maxSweeps, progress);
    }
    made = wanted();
  }

  /// What materials give the facets of voxels that stay: rho and M, with what is listed of the emitters where these are
  /// others.
  void shadeFacets(Products& p, bool emitters, const Progress& progress) {
    if (progress && !progress("GI Materials", 0)) throw WorkError("cancelled");
    const Settings& obeyed = planned.settings();
    if (p.facets->surface && p.facets->count > 0 && !p.parts) {
      const auto start = std::chrono::steady_clock::now();
      p.parts = listParts(context, onDevice, shape(), obeyed);
      context.timings.endFrame(frameIndex, /*setup=*/true, since(start));
    }
    const auto start = std::chrono::steady_clock::now();
    ++revision.materials;
    shadeAnew(context, onDevice, p.gridRecord, obeyed, *p.facets, p.parts);
    if (emitters) {
      p.emitters = listEmitters(context, *p.facets);
      p.emissiveTriangles = listEmissiveTriangles(context, onDevice, planned.traits.materials, *p.facets, p.gridRecord);
    }
    learn(p);
    context.timings.endFrame(frameIndex, /*setup=*/false, since(start));
  }

  /// Everything from the geometry to the matrix: the thesis's "Init" set. `first`: the stage to start from.
  void build(Products& p, Redo first, const Progress& progress) {
    requireMatching(settings);
    const auto start = std::chrono::steady_clock::now();
    ++revision.build;
    const Settings& obeyed = planned.settings();
    const auto report = [&](const char* stage, float fraction) {
      if (progress && !progress(stage, fraction)) throw WorkError("cancelled");
    };

    // 2, 4. Voxels and facets: which triangles have a piece in which voxel, and which of their sides one facet stands
    // for, with what albedo, normal and emission; in Morton order, with the map back from voxels.
    if (first <= Redo::Voxels) {
      report("GI Voxelization", 0);
      p.facets = makeFacets(context, onDevice, shape(), obeyed, [&] { report("GI Voxelization", 0); });
      p.gridRecord = makeBuffer<Grid>(context, "Grid", Subsystem::Voxels, std::span<const Grid>(&p.facets->grid, 1));
      p.emitters = listEmitters(context, *p.facets);
      p.emissiveTriangles = listEmissiveTriangles(context, onDevice, planned.traits.materials, *p.facets, p.gridRecord);
      p.reference = makeReference(*p.facets);
    }

    // 3. Distance to the nearest solid voxel, for every voxel.
    std::optional<Field> field;
    if (first <= Redo::Field || !fieldFits(p)) {
      report("GI SDF", 0);
      field = plannedField(p);
    }

    // 5. F_ij: share of cosine-weighted directions from facet i that first meet facet j.
    report("GI BuildMatrix", 0);
    // The old matrix is the largest thing there is; a rebuild under a changed list cannot use it, so it goes first,
    // and what the host traces its rays with.
    if (first <= Redo::Voxels) {
      made.forget(Redo::Matrix);
      now.matrix.reset();
      if (now.facets) now.facets->hostTrace.reset();
    }
    p.matrix = planned.on(Effect::matrix)
                   ? buildMatrix(context, *p.facets, field ? *field : *p.field, obeyed,
                                 [&](float fraction) { return !progress || progress("GI BuildMatrix", fraction); })
                   : FormFactors{};
    if (field) p.field = std::move(field);
    learn(p);
    context.timings.endFrame(frameIndex, /*setup=*/true, since(start));
  }

  /// Whether there is a field where the plan has it on, and none where it has it off. No stage's key says so, since a
  /// field that is only kept or dropped causes nothing to be made again; so the product itself is asked.
  bool fieldFits(const Products& p) const { return planned.on(Effect::field) == static_cast<bool>(*p.field); }
  Field plannedField(const Products& p) {
    const Settings& obeyed = planned.settings();
    return planned.on(Effect::field) ? buildField(context, *p.facets, obeyed) : Field{obeyed.field.method};
  }
  /// Rays may come to need the field of the same voxels, or stop needing it.
  void fitField(Products& p) {
    if (fieldFits(p)) return;
    const auto start = std::chrono::steady_clock::now();
    ++revision.build;
    p.field = plannedField(p);
    context.timings.endFrame(frameIndex, /*setup=*/true, since(start));
  }

  Buffer makeReference(const FacetList& list) {
    if (!expected || list.count == 0) return {};
    const HostFacets host = hostFacets(context, list);
    std::vector<glm::vec4> h;
    for (size_t i = 0; i < host.count(); ++i)
      h.emplace_back(glm::vec3(expected(host.position[i], host.normal[i])), 0.0f);
    return makeBuffer<glm::vec4>(context, "oracle's H", Subsystem::Solver, h);
  }

  /// The thesis's "per-frame" set, with the lights as they are: D, after F M where that is due, then H <- F B and B <-
  /// M + rho (D + H) until the error bound holds, then H to where shading reads it.
  void relight(Products& p, StagesDue due, uint32_t maxSweeps, const Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    ++revision.light;
    // A new list has no light yet: if it were given up now it would stay black.
    const bool mayEnd = p.light.has_value();
    const char* stage = "GI Gather";  // that runs
    const auto goesOn = [&] { return !progress || progress(stage, 0) || !mayEnd; };
    // Between steps that may take a second each on a CPU device.
    const auto breathe = [&] {
      if (!goesOn()) throw WorkError("cancelled");
    };
    if (due.has(Redo::Gather) || !p.light) place(context, planned.on(Effect::sky) ? sky : Sky{}, skyOnDevice);
    if (!lit()) return darken(p);
    // The other method's light lacks what this one keeps, and has what this one does not need. By brute force so has
    // that of facets with an M for those without, whose rays are traced anew in any case.
    const auto misfits = [&] { return static_cast<bool>(p.light->emitted) != p.facets->hasEmission; };
    const bool other =
        p.light && (static_cast<bool>(p.light->frameMean.next) != framewise() || (framewise() && misfits()));
    if (!p.light || !*p.light || other) {
      planned.traits.light.noise.reset();
      decide();
      p.light = makeLighting(context, *p.facets, planned.settings());
      due.add(StagesDue::from(Redo::Emission));
    } else if (misfits()) {
      fitEmitted(context, *p.facets, *p.light);
      due.add(Redo::Emission);
    }
    // What lies outside passes on what its materials make of it.
    if (p.facets->outer && (due.has(Redo::Materials) || due.has(Redo::Emission))) due.add(Redo::Gather);
    // Only stages that run are told: their times foretell those of the next edit.
    if (!due.has(Redo::Emission) && !due.has(Redo::Gather)) stage = due.has(Redo::Solve) ? "GI Solve" : "GI Scatter";
    breathe();
    if (due.has(Redo::Emission) && !framewise())
      gatherEmitters(context, *p.facets, *p.matrix, {&*p.emitters, &*p.field}, planned.settings(), *p.light);
    breathe();
    if (due.has(Redo::Gather)) {
      Frame frame = context.begin(frameIndex);
      gather(frame, onDevice, *shadows, *p.facets, *p.field, *p.light, planned.settings());
      lightOuter(frame, onDevice, *p.facets, *p.emitters, *p.field, skyOnDevice);
      if (!framewise()) gatherSky(frame, *p.matrix, binsOf(p.facets->outer, skyOnDevice), *p.light);
      frame.submitAndWait();
      breathe();
    }
    if (due.has(Redo::Solve)) {
      stage = "GI Solve";
      breathe();
      useReflections(*p.light, p.facets->count);
      const bool restarts = due.has(Redo::Materials) || due.has(Redo::Emission) || due.has(Redo::Gather);
      solveFor(p, restarts, maxSweeps, progress, goesOn);
      solvedFrame = frameIndex;
    }
    stage = "GI Scatter";
    goesOn();  // whatever it says: this is soon done, and the light with it
    showSolved(p);
    context.timings.endFrame(frameIndex++, /*setup=*/false, since(start));
  }

  /// To where shading reads it.
  void showSolved(Products& p) {
    if (!p.light->frameMean.held) scatterInto(p);
    learn(p);
    if (flipsBlur(p.light->report)) scatterInto(p);
  }

  /// `restarts`: frames of brute force begin anew. `maxSweeps` 0: as many as it takes; else one frame of brute force,
  /// which costs as much as a matrix.
  void solveFor(Products& p, bool restarts, uint32_t maxSweeps, const Progress& progress,
                const std::function<bool()>& goesOn) {
    const Settings& obeyed = planned.settings();
    if (!framewise()) {
      solve(context, *p.facets, *p.matrix, *p.light, obeyed, maxSweeps != 0 ? maxSweeps : obeyed.solver.maxSweeps,
            maxSweeps == 0 ? goesOn : std::function<bool()>());  // few sweeps are done before anybody asks
      return;
    }
    const bool byFrames = maxSweeps != 0;
    if (restarts && byFrames) hold(*p.light);
    bruteForce(context, *p.facets, *p.field, skyOnDevice, *p.light, obeyed, byFrames ? 1 : obeyed.solver.frames,
               restarts, [&](float fraction) { return !progress || progress("GI BruteForce", fraction); });
    FrameMean& mean = p.light->frameMean;
    if (mean.held && (++mean.heldFor >= kHeldFrames || !byFrames || p.light->report.settled())) {
      mean.held = Buffer();
      mean.heldEmitted = Buffer();
    }
  }

  /// A mean over frames begins in the dark, and with noise. What was shown before is shown on until it is better, which
  /// is no part of the mean. (While a light is dragged each frame begins anew, and is shown after the first few.)
  static constexpr uint32_t kHeldFrames = 8;
  void hold(Lighting& light) {
    FrameMean& mean = light.frameMean;
    if (mean.held || light.report.frames < kHeldFrames) return;
    Frame frame = context.begin();
    const auto copied = [&](const Buffer& from) {
      Buffer to(context.device, "shown while frames begin anew", Subsystem::Solver, from.bytes);
      frame.pass("GI BruteForce").copy(from, to, from.bytes);
      return to;
    };
    Buffer h = copied(light.shaded()), emitted = light.shadedEmitted() ? copied(light.shadedEmitted()) : Buffer();
    frame.submit();
    mean.held = std::move(h);
    mean.heldEmitted = std::move(emitted);
    mean.heldFor = 0;
  }

  /// Whether the picture that was drawn last has changed what is written back by more than H is known to.
  bool reflectionsDue() const {
    if (!now.light || !now.light->writeback.report || !relights()) return false;
    const std::shared_ptr<WritebackReport> report = now.light->writeback.report;
    if (report->taken) return false;
    if (report->pending) context.finish();  // the frame, unless it is still being recorded
    return !report->pending && report->change > settings.solver.tolerance * now.light->report.meanH;
  }
  /// Light is solved with what the last picture has written back.
  void useReflections(Lighting& light, uint32_t facets) {
    fitWriteback(context, facets, planned.settings(), light.writeback);
    if (light.writeback.report && !light.writeback.report->taken) takeDrawn(light.writeback);
  }

  void scatterInto(Products& p) {
    Frame frame = context.begin(frameIndex);
    const bool mayBlur =
        settings.effects.blur == EffectMode::automatic && settings.sample.gpu.filter_ == SampleFilter::blur;
    scatter(frame, *p.facets, *p.matrix, *p.light, planned.settings(), /*watchBlur=*/mayBlur);
    frame.submitAndWait();
  }

  /// Decides by how much the blur changes the light as it is: where that does not show, H is shown without it. Returns
  /// whether that puts the blur on or off.
  bool flipsBlur(const SolveReport& report) {
    if (!report.blurChange) return false;
    std::optional<float>& noise = planned.traits.light.noise;
    // In the dark it changes nothing, whatever it may do to the next light.
    if (report.largestH > 0 || !noise) noise = report.largestH > 0 ? *report.blurChange / report.largestH : 0;
    const bool was = planned.on(Effect::blur);
    decide();
    return planned.on(Effect::blur) != was;
  }

  /// No light, or nothing that shows it: H is 0 without being stored.
  void darken(Products& p) {
    p.light.emplace();
    p.light->report.converged = true;
    learn(p);
  }

  // ---- Pictures ----

  /// Of what surfaces are drawn from.
  uint64_t surfacesKey(const GpuCamera& from) const {
    return Digest().add(state).add(context.shaders.generation()).add(from).value();
  }

  ShadowNeeds shadowNeeds() const {
    ShadowNeeds needs = irad::shadowNeeds(settings);
    needs.shines = [this](const GpuLight& light) { return planned.shines(light, scene, settings); };
    needs.alphaTest = planned.on(Effect::alphaTest) || planned.on(Effect::glass);
    needs.tinted = planned.tinted();
    needs.kernels = rasterizesByKernels(context.device, settings);
    return needs;
  }
};

Pipeline::Pipeline(Context& context, Scene scene, const Settings& settings, ExpectedIrradiance expected)
    : impl_(std::make_unique<Impl>(context, std::move(scene), settings, std::move(expected))) {
  impl_->camera = Buffer(context.device, "Camera", Subsystem::Targets, sizeof(GpuCamera));
}
Pipeline::~Pipeline() = default;

Pipeline::Impl& Pipeline::changed() {
  impl_->state = newState();
  return *impl_;
}

const Scene& Pipeline::scene() const {
  return impl_->scene;
}
SceneOnDevice& Pipeline::device() {
  return impl_->onDevice;
}
const Settings& Pipeline::settings() const {
  return impl_->settings;
}
const Settings& Pipeline::obeyed() const {
  return impl_->planned.settings();
}
EffectPlan Pipeline::plan(std::optional<bool> redraw) const {
  SceneTraits traits = impl_->planned.traits;
  traits.light = impl_->lightState();
  traits.redraw = redraw;
  return irad::plan(traits, impl_->settings, &impl_->planned.plan());
}
const SceneTraits& Pipeline::traits() const {
  return impl_->planned.traits;
}

Redo Pipeline::set(const Settings& settings) {
  Impl& p = changed();
  p.lookAtRegion(p.regionWith(settings));
  p.settings = settings;
  p.lookAgain();
  return p.due();
}

Redo Pipeline::due(const Settings& settings) const {
  const Impl& p = *impl_;
  SceneTraits traits = p.planned.traits;
  traits.sky = makeSky(settings.sky, skyInputs(p.scene, p.scene.lights), &p.sky).largest();
  traits.region = p.regionWith(settings);
  SceneContent content = p.content;
  content.region = Impl::regionKey(traits.region);
  const EffectPlan plan = irad::plan(traits, settings, &p.planned.plan());
  return firstDifference(p.made, stageKeys(content, irad::obeyed(settings, plan)));
}

void Pipeline::setRegion(const std::optional<RegionBox>& box) {
  Impl& p = changed();
  p.scene.region = box;
  p.lookAtRegion(regionOrWhole(p.scene, p.settings));
  p.lookAgain();
}

void Pipeline::setLights(std::vector<Light> lights) {
  Impl& p = changed();
  for (const Light& light : lights)
    if (const std::string problem = unsound(light); !problem.empty()) throw UsageError(problem);
  std::vector<GpuLight> values = p.withSun(lights);
  const auto start = std::chrono::steady_clock::now();
  const Planned planned = p.planned;
  const SceneContent content = p.content;
  const Sky sky = p.sky;
  try {
    p.lookAtSky(lights);
    p.lookAtLights(values);
    const uint64_t key = p.shadowKey(values);
    std::optional<ShadowMaps> maps;
    if (p.shadows && p.shadowsMade == key)
      keepShadows(values, p.onDevice.lightValues);
    else
      maps = drawShadows(p.context, p.onDevice, values, p.settings.light.shadowResolution, p.shadowNeeds());
    p.onDevice.setLights(p.context, std::move(values), p.shadowNeeds().shines);
    if (maps) p.shadows = std::move(maps);
    p.shadowsMade = p.shadowsWanted = key;
  } catch (...) {
    p.planned = planned;
    p.content = content;
    p.sky = sky;
    p.shadowsWanted = p.shadowKey(p.onDevice.lightValues);
    throw;
  }
  p.scene.lights = std::move(lights);
  p.context.timings.endFrame(p.frameIndex, /*setup=*/false, since(start));
}

void Pipeline::setMaterials(std::vector<MaterialEdit> edits) {
  Impl& p = changed();
  std::vector<Material> materials = editedMaterials(p.scene, edits);
  for (const Material& material : materials)
    if (const std::string problem = unsound(material, p.scene.images.size()); !problem.empty())
      throw UsageError(problem);
  const Planned planned = p.planned;
  const SceneContent content = p.content;
  if (p.scene.fileMaterials.empty()) p.scene.fileMaterials = p.scene.materials;
  std::swap(p.scene.materials, materials);
  try {
    p.lookAtSurfaces(p.scene.materials, p.content);
    measureMaterials(p.scene, p.scene.materials, p.planned.traits);
    p.lookAgain();
  } catch (...) {
    p.planned = planned;
    p.content = content;
    std::swap(p.scene.materials, materials);
    throw;
  }
  p.scene.materialEdits = std::move(edits);
}

Redo Pipeline::due(const std::vector<MaterialEdit>& edits) const {
  const Impl& p = *impl_;
  const std::vector<Material> materials = editedMaterials(p.scene, edits);
  SceneContent content = p.content;
  p.lookAtSurfaces(materials, content);
  SceneTraits traits = p.planned.traits;
  measureMaterials(p.scene, materials, traits);
  const EffectPlan plan = irad::plan(traits, p.settings, &p.planned.plan());
  return firstDifference(p.made, stageKeys(content, irad::obeyed(p.settings, plan)));
}

bool Pipeline::adopt(Scene& scene) {
  Impl& p = changed();
  const SurfaceContent surfaces(scene);
  const std::vector<Material>&mine = fileMaterials(p.scene), &its = fileMaterials(scene);
  if (surfaces.surfaces(its) != p.surfaces.surfaces(mine) || surfaces.materials(its) != p.surfaces.materials(mine))
    return false;
  setLights(scene.lights);
  setMaterials(scene.materialEdits);
  p.scene = std::move(scene);                          // where p.onDevice looks for it
  p.lookAtRegion(regionOrWhole(p.scene, p.settings));  // cameras have a say in it
  p.lookAgain();
  return true;
}

void Pipeline::lightsChanged() {
  Impl& p = changed();
  p.shadowsMade = 0;
  p.made.forget(Redo::Gather);
}

void Pipeline::setSky(std::shared_ptr<const SkyImage> image) {
  Impl& p = changed();
  p.scene.sky = std::move(image);
  p.lookAgain();
}
const Sky& Pipeline::sky() const {
  return impl_->sky;
}

void Pipeline::darken() {
  Impl& p = changed();
  if (!p.now.light) return;
  if (*p.now.light) p.now.light = makeLighting(p.context, *p.now.facets, p.planned.settings());
  for (const Redo gone : {Redo::Emission, Redo::Gather}) p.made.forget(gone);
}

void Pipeline::invalidate(Redo from) {
  impl_->made.forget(from);
}

void Pipeline::prepare(const Progress& progress, uint32_t maxSweeps) {
  Impl& p = changed();
  p.context.timings.about(fmt::format("{}, {} voxels", p.scene.path.stem().string(), p.settings.voxel.resolution));
  if (p.shadowsDue()) {
    p.lookAtLights(p.onDevice.lightValues);  // they may have been edited there
    p.redrawShadows();
  }
  p.prepare(maxSweeps, progress);
}

bool Pipeline::asleep() const {
  if (impl_->settings.effects.relight == EffectMode::on) return false;
  return current() && (!impl_->relights() || (impl_->now.light->report.settled() && !impl_->reflectionsDue()));
}

WritebackRounds Pipeline::settleReflections(const Camera& camera, Targets& targets, const Progress& progress) {
  Impl& p = *impl_;
  WritebackRounds done;
  if (!p.now.light || !p.now.light->writeback.used) return done;
  float least = std::numeric_limits<float>::infinity();  // change of a round
  uint32_t since = 0;                                    // rounds since it was halved
  while (!done.settled && done.rounds < WritebackRounds::kMost && since < WritebackRounds::kPatience) {
    if (progress && !progress("GI Writeback", static_cast<float>(done.rounds) / WritebackRounds::kMost))
      throw WorkError("cancelled");
    ++done.rounds;
    Frame frame = p.context.begin(p.frameIndex);
    render(frame, camera, VIEW_LIT, targets);
    frame.submitAndWait();
    done.settled = !p.reflectionsDue();
    if (done.settled) break;
    const float change = p.now.light->writeback.report->change;
    since = change <= 0.5f * least ? 0 : since + 1;
    if (since == 0) least = change;
    prepare(progress);
  }
  return done;
}

bool Pipeline::current() const {
  const Impl& p = *impl_;
  const Redo needed = p.relights() ? Redo::Scatter : Redo::Matrix;
  return p.due() > needed && !p.shadowsDue() && p.now.light && p.fieldFits(p.now);
}

void Pipeline::solvedAfresh(const Progress& progress, const std::function<void()>& draw) {
  Impl& p = changed();
  IRAD_CHECK(current(), "what the settings call for has not been prepared");
  if (progress && !progress("GI Solve", 0)) throw WorkError("cancelled");
  // The mean over the frames begins in the dark in any case.
  if (p.framewise() && p.now.light->report.settled()) return draw();
  struct Before {
    Impl& p;
    std::optional<Lighting> light = std::exchange(p.now.light, std::nullopt);
    uint64_t solvedFrame = p.solvedFrame;
    Planned planned = p.planned;
    ~Before() {
      p.state = newState();
      p.planned = std::move(planned);
      p.now.light = std::move(light);
      p.solvedFrame = solvedFrame;
    }
  } before{p};
  p.relight(p.now, StagesDue::from(Redo::Emission), /*maxSweeps=*/0, progress);
  draw();
}

void Pipeline::showLight(std::span<const glm::vec4> indirect, std::span<const glm::vec4> radiosity) {
  Impl& p = changed();
  IRAD_CHECK(current() && *p.now.light, "no light has been prepared");
  const auto put = [&](const Buffer& buffer, std::span<const glm::vec4> values) {
    if (values.empty()) return;
    IRAD_CHECK_OP(values.size(), ==, p.now.facets->count);
    upload(p.context, buffer, std::as_bytes(values));
  };
  put(p.now.light->indirect, indirect);
  put(p.now.light->radiosity, radiosity);
  ++p.revision.light;
  p.scatterInto(p.now);
}

void Pipeline::goOn(const SavedFrames& frames) {
  Impl& p = changed();
  IRAD_CHECK(current() && *p.now.light && p.framewise(), "no frames to go on with");
  restoreFrames(p.context, *p.now.light, frames);
  ++p.revision.light;
  p.showSolved(p.now);
}

std::vector<Finding> Pipeline::findings() const {
  const Products& p = impl_->now;
  if (!p.light) return {};
  const Grid& grid = p.facets->grid;
  std::vector<Finding> all =
      irad::findings(p.light->report, grid, impl_->scene.origin + glm::dvec3(grid.origin), impl_->solvedFrame);
  if (const std::vector<uint32_t> lights = lightsWithoutShadow(); !lights.empty())
    all.push_back({Finding::Severity::Warning, describeWithoutShadow(impl_->scene.lights, lights)});
  return all;
}

std::vector<uint32_t> Pipeline::lightsWithoutShadow() const {
  const std::vector<GpuLight>& lights = impl_->onDevice.lightValues;
  const LightFilter shines = impl_->shadowNeeds().shines;
  std::vector<uint32_t> without;
  for (uint32_t i = 0; impl_->shadows && i < impl_->scene.lights.size(); ++i)
    if (lights[i].shadowLayer < 0 && shines(lights[i])) without.push_back(i);
  return without;
}

void Pipeline::render(Frame& frame, const Camera& camera, View view, Targets& targets, const PictureOptions& options) {
  Impl& p = *impl_;
  p.planned.traits.pixels = uint64_t{targets.size.x} * targets.size.y;
  const GpuCamera gpu = makeGpuCamera(p.scene, camera, targets.size);
  frame.pass("Camera").update(p.camera, gpu);

  // Stages whose result the view does not show are left out.
  const Settings& obeyed = p.planned.settings();
  uint32_t from = sourcesOf(view, obeyed, p.pictureOf);
  const bool writesBack = p.now.light && p.now.light->writeback.used;
  if (writesBack) from |= FROM_TARGETS | FROM_REFLECTIONS;  // every picture does
  const auto isFrom = [&](uint32_t sources) { return (from & sources) != 0; };
  const bool pixelEmitters = p.planned.plan().pixelEmitters;
  const uint32_t indirectly = FROM_INDIRECT_LIGHT | FROM_EMITTED | FROM_REFLECTIONS;
  ViewInputs inputs = viewInputs(p.now, pixelEmitters);
  inputs.scene = &p.onDevice;
  if (p.shadows) inputs.shadows = &*p.shadows;
  if (p.picture) inputs.picture = &p.picture;
  inputs.pictureOf = p.pictureOf;
  if (p.skyOnDevice) inputs.sky = &p.skyOnDevice.record;
  inputs.range = options.range;

  const auto drawSurfaces = [&](Layer layer) {
    if (isFrom(FROM_TARGETS | FROM_DEPTH)) {
      ShadeParams shade = p.settings.camera.gpu;
      shade.exposure = std::exp2(p.settings.camera.exposureEv);
      ForwardEffects effects = p.planned.forwardEffects();
      effects.layer = layer;
      effects.kernels = rasterizesByKernels(p.context.device, p.settings);
      // The facets that pixels lie on tell, too, where the lights' shadow maps let through what a wall keeps off.
      effects.wanted = {.surfaces = isFrom(FROM_TARGETS),
                        .direct = isFrom(FROM_DIRECT_LIGHT),
                        .indirect = isFrom(FROM_DIRECT_LIGHT | indirectly),
                        .reflections = isFrom(FROM_REFLECTIONS)};
      const IndirectInputs indirect = indirectInputs(p.now, view, pixelEmitters, obeyed);
      drawScene(frame, p.onDevice, *p.shadows, indirect, p.camera, shade, targets, effects);
    }
    if (isFrom(indirectly)) lightByEmitters(frame, inputs, obeyed, targets);
    if (!isFrom(FROM_REFLECTIONS)) return;
    traceSpecular(frame, inputs, p.camera, obeyed, targets);
    // What is written back is of the surfaces that are nearest.
    if (layer == Layer::first)
      writeBack(frame, inputs, p.camera, obeyed, p.skyOnDevice ? p.sky.largest() : 0.0f, targets);
  };
  const View seen = isFrom(FROM_PICTURE) ? p.pictureOf : view;
  const ViewInfo* info = viewInfo(seen);
  inputs.composed = p.planned.on(Effect::glass) && info != nullptr && info->addsUp();
  targets.fitLayers(p.context, inputs.composed, p.planned.tinted());

  // Surfaces that are in the targets already.
  const Targets::Surfaces wanted{p.surfacesKey(gpu), from & kFromSurfaces};
  const bool there = options.shareSurfaces && !inputs.composed && holdsSurfaces(targets.surfaces, wanted);
  const bool draws = wanted.from != 0 && !there;
  if (draws) targets.surfaces = {};
  const auto drawLayer = [&](Layer layer) {
    drawSurfaces(layer);
    drawTargets(frame, seen, inputs, p.camera, obeyed, targets);
  };
  if (inputs.composed) {
    drawLayers(frame, p.settings.camera.glassLayers, p.planned.tinted(), drawLayer, targets);
  } else if (draws) {
    drawSurfaces(Layer::first);
    if (!writesBack) targets.surfaces = wanted;
  }
  drawView(frame, view, inputs, p.camera, obeyed, targets);
}

void Pipeline::setReference(glm::uvec2 size, std::span<const glm::vec4> pixels, View of) {
  IRAD_CHECK_OP(pixels.size(), ==, size_t{size.x} * size.y);
  impl_->picture = {};
  if (pixels.empty()) return;
  ImageDesc desc;
  desc.name = "reference picture";
  desc.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  desc.width = size.x;
  desc.height = size.y;
  impl_->picture = Image(impl_->context.device, desc);
  impl_->pictureOf = of;
  upload(impl_->context, impl_->picture, std::as_bytes(pixels));
}
bool Pipeline::knowsIrradiance() const {
  return static_cast<bool>(impl_->expected);
}
bool Pipeline::hasReference() const {
  return static_cast<bool>(impl_->picture);
}

Revision Pipeline::revision() const {
  return impl_->revision;
}
const FacetList& Pipeline::facets() const {
  return *impl_->now.facets;
}
const Field& Pipeline::field() const {
  return *impl_->now.field;
}
const FormFactors& Pipeline::matrix() const {
  return *impl_->now.matrix;
}
const Lighting& Pipeline::lighting() const {
  return *impl_->now.light;
}
const ShadowMaps& Pipeline::shadows() const {
  return *impl_->shadows;
}

}  // namespace irad
