// The per-facet light buffers, and what shading samples of them (METHOD sections 6 and 7, T 5.9).
#include "gi/stages.h"
#include "shaders/shared/solve.h"

namespace irad {

Lighting makeLighting(Context& context, const FacetList& facets, const Settings& settings) {
  const uint64_t bytes = 16ull * facets.count;
  const Device& device = context.device;
  Lighting light;
  light.direct = Buffer(device, "direct irradiance D", Subsystem::Solver, bytes);
  if (facets.hasEmission) light.emitted = Buffer(device, "emitted share F M", Subsystem::Solver, bytes);
  light.indirect = Buffer(device, "indirect irradiance H", Subsystem::Solver, bytes);
  light.radiosity = Buffer(device, "radiosity B (a)", Subsystem::Solver, bytes);
  light.radiosityNext = Buffer(device, "radiosity B (b)", Subsystem::Solver, bytes);
  light.residual = Buffer(device, "solver residual", Subsystem::Solver, sizeof(SolveResidual));
  light.rowSum = Buffer(device, "row sums of F", Subsystem::Solver, 4ull * facets.count);
  Frame frame = context.begin();
  for (const Buffer* b : {&light.direct, &light.emitted, &light.indirect, &light.radiosity, &light.radiosityNext,
                          &light.residual, &light.rowSum})
    if (*b) frame.pass("GI Solve Clear").fill(*b, 0);
  frame.submit();
  if (settings.sample.gpu.gated == 0) addVolume(context, facets, light);
  return light;
}

void addVolume(Context& context, const FacetList& facets, Lighting& light) {
  if (light.volume) return;
  light.volume = Image(context.device, {.name = "radiance volume",
                                        .subsystem = Subsystem::Volumes,
                                        .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                        .width = facets.grid.dims.x,
                                        .height = facets.grid.dims.y,
                                        .depth = facets.grid.dims.z,
                                        .volume = true});
  light.clamped = Buffer(context.device, "clamped voxels", Subsystem::Volumes, sizeof(uint32_t));
}

namespace {

constexpr const char* kStage = "GI Scatter";

/// Makes a buffer that is wanted, frees one that is not.
void fit(const Device& device, const char* name, uint64_t bytes, bool wanted, Buffer& buffer) {
  if (wanted != static_cast<bool>(buffer)) buffer = wanted ? Buffer(device, name, Subsystem::Solver, bytes) : Buffer();
}

/// Into the blurred copies, where there are any.
void blur(Frame& frame, const FacetList& facets, Lighting& light) {
  const bool stores = static_cast<bool>(light.blurred), emitted = stores && light.emitted;
  ScatterFacetsPush push{};
  push.facets = facets.record.address;
  push.indirect = light.indirect.address;
  push.emitted = light.emitted.address;
  push.blurred = light.blurred.address;
  push.blurredEmitted = light.blurredEmitted.address;
  push.change = light.blurChange.address;
  push.dims = facets.grid.dims;
  frame.pass(kStage).fill(light.blurChange, 0);
  Pass pass = frame.pass(kStage);
  pass.shader("gi/scatter_facets.comp")
      .constant(0, static_cast<uint32_t>(facets.encoding))
      .constant(1, emitted)
      .constant(2, stores)
      .read(facets.record, facets.voxel, facets.shape, facets.reverse, facets.around, light.indirect)
      .write(light.blurChange)
      .push(push);
  if (stores) pass.write(light.blurred);
  if (emitted) pass.read(light.emitted).write(light.blurredEmitted);
  pass.dispatch(facets.count);
  frame.readback(light.blurChange, 0, sizeof(float), [&change = light.report.blurChange](std::span<const uint8_t> b) {
    std::memcpy(&change.emplace(), b.data(), sizeof(float));
  });
}

void scatterVolume(Frame& frame, const FacetList& facets, Lighting& light, const Settings& settings) {
  frame.pass("GI Scatter Clear").clear(light.volume, ClearColor{});
  if (facets.count == 0) return;
  const bool holdsRadiosity = settings.sample.gpu.gated == 0 || settings.scatter.edgeRemoval;
  const Buffer& value = holdsRadiosity ? light.radiosity : light.indirect;
  ScatterVolumePush push{};
  push.facets = facets.record.address;
  push.value = value.address;
  push.direct = light.direct.address;
  push.dims = facets.grid.dims;
  push.removal = settings.scatter.edgeRemoval ? settings.solver.gpu.lambda : 0.0f;
  push.clamped = light.clamped.address;
  frame.pass("GI Scatter Clear").fill(light.clamped, 0);
  frame.pass(kStage)
      .shader("gi/scatter_volume.comp")
      .read(facets.record, facets.voxel, facets.albedo, facets.emission, facets.reverse, value, light.direct)
      .write(light.volume, light.clamped)
      .push(push)
      .dispatch(facets.count);
  frame.readback(light.clamped, 0, sizeof(uint32_t), [&count = light.report.clampedVoxels](std::span<const uint8_t> b) {
    std::memcpy(&count, b.data(), sizeof(count));
  });
}

}  // namespace

void scatter(Frame& frame, const FacetList& facets, Lighting& light, const Settings& settings, bool watchBlur) {
  const SampleParams& sample = settings.sample.gpu;
  const bool may = sample.gated != 0 && facets.count > 0;
  const bool blurs = may && sample.filter_ == FILTER_BLUR, watches = may && (blurs || watchBlur);
  const Device& device = frame.context().device;
  const uint64_t bytes = 16ull * facets.count;
  fit(device, "blurred H", bytes, blurs, light.blurred);
  fit(device, "blurred F M", bytes, blurs && light.emitted, light.blurredEmitted);
  fit(device, "change by the blur", sizeof(uint32_t), watches, light.blurChange);
  if (watches) blur(frame, facets, light);
  if (light.volume) scatterVolume(frame, facets, light, settings);
}

}  // namespace irad
