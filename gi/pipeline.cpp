#include "gi/pipeline.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "gi/host_facets.h"
#include "renderer/error.h"

namespace irad {

namespace {

/// Wall-clock milliseconds since `start`.
double since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

struct Pipeline::Impl {
  Impl(Context& c, Scene s, const Settings& wanted)
      : context(c), scene(std::move(s)), settings(wanted), onDevice(c, scene) {}

  Context& context;
  Scene scene;
  Settings settings;
  SceneOnDevice onDevice;
  Buffer camera;
  uint64_t frameIndex = 0;
  Revision revision;
  uint64_t solvedFrame = 0;  ///< of the last solve

  /// The first stage that the next prepare() has to run. Later stages follow it.
  Redo dirty = Redo::Voxels;
  bool shadowsDirty = true;

  /// One member per stage's product; all of one facet list.
  struct Products {
    std::optional<FacetList> facets;
    Buffer gridRecord;  ///< one Grid
    std::optional<Field> field;
    std::optional<FormFactors> matrix;
    std::optional<Emitters> emitters;
    std::optional<Lighting> light;
    Buffer reference;  ///< H by the oracle, for its view; none where the scene does not know it
    ViewFields fields;
  };
  Products now;  ///< what pictures are drawn from
  std::optional<ShadowMaps> shadows;
  Image picture;  ///< the reference picture

  void prepare(uint32_t maxSweeps, const Progress& progress) {
    if (dirty <= Redo::Voxels) {
      // The new list's products replace the old ones together, once they are lit. Until then the old picture stays.
      Products fresh;
      build(fresh, Redo::Voxels, progress);
      relight(fresh, Redo::Gather, maxSweeps, progress);
      now = std::move(fresh);
    } else {
      if (dirty <= Redo::Matrix) {
        build(now, dirty, progress);
        dirty = Redo::Gather;
      }
      if (dirty > Redo::Scatter && now.light->report.settled()) return;
      relight(now, dirty <= Redo::Scatter ? dirty : Redo::Solve, maxSweeps, progress);
    }
    dirty = Redo::Nothing;
  }

  /// Everything from the geometry to the matrix: T's "Init" set. `first`: the stage to start from.
  void build(Products& p, Redo first, const Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    ++revision.build;
    const auto report = [&](const char* stage, float fraction) {
      if (progress && !progress(stage, fraction)) throw WorkError("cancelled");
    };

    // 2. Voxels: which triangle fills which voxel, with what albedo, normal and emission.  4. Facets: the solid ones,
    // compacted in Morton order, with the map back from voxels.
    if (first <= Redo::Voxels) {
      report("GI Voxelization", 0);
      Voxels voxels = voxelize(context, onDevice, settings);
      report("GI CompactList", 0);
      p.facets = compactFacets(context, voxels, settings);
      p.gridRecord = makeBuffer<Grid>(context, "Grid", Subsystem::Voxels, std::span<const Grid>(&p.facets->grid, 1));
      p.emitters = listEmitters(context, *p.facets);
      p.reference = makeReference(*p.facets);
    }

    // 3. Distance to the nearest solid voxel, for every voxel.
    std::optional<Field> field;
    if (first <= Redo::Field) {
      report("GI SDF", 0);
      field = buildField(context, *p.facets, settings);
    }

    // 5. F_ij: share of cosine-weighted directions from facet i that first meet facet j.
    report("GI BuildMatrix", 0);
    // The old matrix is the largest thing there is; a rebuild under a changed list cannot use it, so it goes first.
    if (first <= Redo::Voxels) now.matrix.reset();
    p.matrix = buildMatrix(context, *p.facets, field ? *field : *p.field, settings,
                           [&](float fraction) { return !progress || progress("GI BuildMatrix", fraction); });
    if (field) p.field = std::move(field);
    if (p.light) p.light->emittedCurrent = false;  // F M of the old F
    context.timings.endFrame(frameIndex, /*setup=*/true, since(start));
  }

  Buffer makeReference(const FacetList& list) {
    if (!scene.expectedIrradiance || list.count == 0) return {};
    const HostFacets host = hostFacets(context, list);
    std::vector<glm::vec4> h;
    for (size_t i = 0; i < host.count(); ++i)
      h.emplace_back(glm::vec3(scene.expectedIrradiance(host.position[i], host.normal[i])), 0.0f);
    return makeBuffer<glm::vec4>(context, "oracle's H", Subsystem::Solver, h);
  }

  /// T's "per-frame" set, on the lights as they are: D, then H <- F B and B <- M + rho (D + H) until the error bound
  /// holds, then H to where shading reads it.
  void relight(Products& p, Redo first, uint32_t maxSweeps, const Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    ++revision.light;
    // A new list has no light yet: given up now it would stay black.
    if (progress && !progress("GI Solve", 0) && p.light) throw WorkError("cancelled");
    if (!p.light) p.light = makeLighting(context, *p.facets, settings);
    if (first <= Redo::Gather) {
      Frame frame = context.begin(frameIndex);
      gather(frame, onDevice, *shadows, *p.facets, *p.light, settings);
      frame.submitAndWait();
    }
    if (first <= Redo::Solve) {
      solve(context, *p.facets, *p.matrix, *p.light, settings, maxSweeps, {&*p.emitters, &*p.field});
      solvedFrame = frameIndex;
    }
    Frame frame = context.begin(frameIndex);
    scatter(frame, *p.facets, *p.light, settings);
    frame.submitAndWait();
    context.timings.endFrame(frameIndex++, /*setup=*/false, since(start));
  }

  ShadowNeeds shadowNeeds() const { return {.alphaTest = onDevice.anyAlphaMask}; }

  /// Materials and lights that the scene has, and reflections where they are traced.
  ForwardEffects forwardEffects() const {
    ForwardEffects e;
    e.lights = kindsOf(onDevice.shining);
    e.emission = onDevice.anyEmission;
    e.alphaTest = onDevice.anyAlphaMask;
    e.normalMap = e.highlights = false;
    for (const Draw& draw : scene.draws) {
      const uint32_t flags = onDevice.materialValues.at(draw.material).flags;
      e.normalMap |= (flags & MATERIAL_NORMAL_TEXTURE) != 0;
      e.highlights |= (flags & MATERIAL_LAMBERTIAN) == 0;
    }
    e.specular = e.highlights && settings.specular.mode != SpecularMode::off;
    return e;
  }

  IndirectInputs indirectInputs(View view) const {
    IndirectInputs in;
    if (!now.facets || now.facets->count == 0 || !now.light) return in;
    in.grid = &now.gridRecord;
    in.shape = &now.facets->shape;
    in.reverse = &now.facets->reverse;
    in.around = &now.facets->around;
    in.shaded = &now.light->shaded;
    if (view == VIEW_DIRECT_IRRADIANCE || view == VIEW_EMITTER_IRRADIANCE) in.shadedEmitted = &now.light->shadedEmitted;
    in.volume = now.light->volume ? &now.light->volume : nullptr;
    in.normalEncoding = static_cast<uint32_t>(now.facets->encoding);
    in.sample = settings.sample.gpu;
    return in;
  }
};

Pipeline::Pipeline(Context& context, Scene scene, const Settings& settings)
    : impl_(std::make_unique<Impl>(context, std::move(scene), settings)) {
  impl_->camera = Buffer(context.device, "Camera", Subsystem::Targets, sizeof(GpuCamera));
}
Pipeline::~Pipeline() = default;

const Scene& Pipeline::scene() const {
  return impl_->scene;
}
SceneOnDevice& Pipeline::device() {
  return impl_->onDevice;
}
const Settings& Pipeline::settings() const {
  return impl_->settings;
}

Redo Pipeline::set(const Settings& settings) {
  const Redo first = difference(impl_->settings, settings);
  if (impl_->settings.light.shadowResolution != settings.light.shadowResolution) impl_->shadowsDirty = true;
  // F M depends on how emitters are sampled, which no other stage does.
  const MatrixSettings &before = impl_->settings.matrix, &after = settings.matrix;
  if (impl_->now.light &&
      (before.emitterSampling != after.emitterSampling || before.emitterSamples != after.emitterSamples))
    impl_->now.light->emittedCurrent = false;
  impl_->settings = settings;
  impl_->dirty = std::min(impl_->dirty, first);
  return impl_->dirty;
}

void Pipeline::setLights(std::vector<Light> lights) {
  Impl& p = *impl_;
  for (const Light& light : lights)
    if (const std::string problem = unsound(light); !problem.empty()) throw UsageError(problem);
  std::vector<GpuLight> values = gpuLights(lights, p.scene.origin);
  const auto start = std::chrono::steady_clock::now();
  ShadowMaps maps = drawShadows(p.context, p.onDevice, values, p.settings.light.shadowResolution, p.shadowNeeds());
  p.onDevice.setLights(p.context, std::move(values), p.shadowNeeds().shines);
  p.shadows = std::move(maps);
  p.scene.lights = std::move(lights);
  p.shadowsDirty = false;
  p.dirty = std::min(p.dirty, Redo::Gather);
  p.context.timings.endFrame(p.frameIndex, /*setup=*/false, since(start));
}

void Pipeline::lightsChanged() {
  impl_->shadowsDirty = true;
  impl_->dirty = std::min(impl_->dirty, Redo::Gather);
}

void Pipeline::darken() {
  if (!impl_->now.light) return;
  impl_->now.light = makeLighting(impl_->context, *impl_->now.facets, impl_->settings);
  impl_->dirty = std::min(impl_->dirty, Redo::Gather);
}

void Pipeline::invalidate(Redo from) {
  impl_->dirty = std::min(impl_->dirty, from);
}

void Pipeline::prepare(const Progress& progress, uint32_t maxSweeps) {
  Impl& p = *impl_;
  const uint32_t sweeps = maxSweeps != 0 ? maxSweeps : p.settings.solver.maxSweeps;
  if (p.shadowsDirty) {
    const auto start = std::chrono::steady_clock::now();
    p.shadows = drawShadows(p.context, p.onDevice, p.settings.light.shadowResolution, p.shadowNeeds());
    p.shadowsDirty = false;
    p.context.timings.endFrame(p.frameIndex, /*setup=*/false, since(start));
  }
  p.prepare(sweeps, progress);
}

bool Pipeline::asleep() const {
  return current() && impl_->now.light->report.settled();
}

bool Pipeline::current() const {
  return impl_->dirty >= Redo::Shade && !impl_->shadowsDirty && impl_->now.light;
}

void Pipeline::solvedAfresh(const Progress& progress, const std::function<void()>& draw) {
  Impl& p = *impl_;
  IRAD_CHECK(current(), "what the settings call for has not been prepared");
  if (progress && !progress("GI Solve", 0)) throw WorkError("cancelled");
  struct Before {
    Impl& p;
    std::optional<Lighting> light = std::exchange(p.now.light, std::nullopt);
    uint64_t solvedFrame = p.solvedFrame;
    ~Before() {
      p.now.light = std::move(light);
      p.solvedFrame = solvedFrame;
    }
  } before{p};
  p.relight(p.now, Redo::Gather, p.settings.solver.maxSweeps, {});
  draw();
}

std::vector<Finding> Pipeline::findings() const {
  const Impl::Products& p = impl_->now;
  if (!p.light) return {};
  const Grid& grid = p.facets->grid;
  return irad::findings(p.light->report, grid, impl_->scene.origin + glm::dvec3(grid.origin), impl_->solvedFrame);
}

void Pipeline::render(Frame& frame, const Camera& camera, View view, Targets& targets, const Buffer* range) {
  Impl& p = *impl_;
  const GpuCamera gpu = makeGpuCamera(p.scene, camera, targets.size);
  frame.pass("Camera").update(p.camera, gpu);

  ShadeParams shade = p.settings.camera.gpu;
  shade.exposure = std::exp2(p.settings.camera.exposureEv);
  const IndirectInputs indirect = p.indirectInputs(view);
  drawForward(frame, p.onDevice, *p.shadows, indirect, p.camera, shade, targets, p.forwardEffects());

  ViewInputs inputs;
  inputs.scene = &p.onDevice;
  if (p.now.facets) inputs.facets = &*p.now.facets;
  if (p.now.field) inputs.field = &*p.now.field;
  if (p.now.matrix) inputs.matrix = &*p.now.matrix;
  if (p.now.light) inputs.lighting = &*p.now.light;
  if (p.now.emitters) inputs.emitters = &*p.now.emitters;
  if (p.now.reference) inputs.reference = &p.now.reference;
  if (p.shadows) inputs.shadows = &*p.shadows;
  if (p.picture) inputs.picture = &p.picture;
  inputs.fields = &p.now.fields;
  inputs.range = range;
  traceSpecular(frame, inputs, p.camera, p.settings, targets);
  drawView(frame, view, inputs, p.camera, p.settings, targets);
}

void Pipeline::setReference(glm::uvec2 size, std::span<const glm::vec4> pixels) {
  IRAD_CHECK_OP(pixels.size(), ==, size_t{size.x} * size.y);
  ImageDesc desc;
  desc.name = "reference picture";
  desc.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  desc.width = size.x;
  desc.height = size.y;
  impl_->picture = Image(impl_->context.device, desc);
  upload(impl_->context, impl_->picture, std::as_bytes(pixels));
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
