// The per-facet light buffers, and what shading samples of them (docs/method.md 6 and 7, T 5.9).
#include "gi/scatter.h"

#include "gi/facets.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/row_noise.h"
#include "gi/settings.h"
#include "gi/subsystems.h"
#include "gi/thesis/volume.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/constants.h"

namespace irad {

namespace {

constexpr const char* kScatterStage = "GI Scatter";

/// Makes the buffer where it is wanted, and frees it where it is not.
void fit(const Device& device, const char* name, uint64_t bytes, bool wanted, Buffer& buffer) {
  if (wanted != static_cast<bool>(buffer)) buffer = wanted ? Buffer(device, name, Subsystem::Solver, bytes) : Buffer();
}

/// The standard error of H per facet; null where nothing knows it. Until the blur is recorded `blurred` is free.
const Buffer* noiseOf(Frame& frame, const FacetList& facets, const FormFactors& matrix, const Lighting& light,
                      const SolverSettings& solver) {
  const FrameMean& frames = light.frameMean;
  if (frames.standardError) return frames.weights.frames() > 1 ? &frames.standardError : nullptr;
  if (!matrix) return nullptr;
  rowNoise(frame, facets, matrix, solver, light, /*squares=*/light.blurred, /*error=*/light.radiosityNext);
  return &light.radiosityNext;
}

/// Blurs into the copies, where there are any, and measures the change.
void blur(Frame& frame, const FacetList& facets, const FormFactors& matrix, Lighting& light,
          const SolverSettings& solver) {
  const bool stores = static_cast<bool>(light.blurred), emitted = stores && light.emitted;
  const Buffer* noise = stores ? noiseOf(frame, facets, matrix, light, solver) : nullptr;
  frame.pass(kScatterStage).fill(light.blurChange, 0);
  Pass pass = frame.pass(kScatterStage);
  BlurLinksPush push{};
  push.surface = pass.in(facets.surface.record);
  push.voxel = pass.in(facets.voxel);
  push.reverse = pass.in(facets.reverse);
  push.indirect = pass.in(light.indirect);
  if (stores) push.blurred = pass.out(light.blurred);
  if (emitted) {
    push.emitted = pass.in(light.emitted);
    push.blurredEmitted = pass.out(light.blurredEmitted);
  }
  push.change = pass.out(light.blurChange);
  if (noise) push.error = pass.in(*noise);
  push.dims = facets.grid.dims;
  push.count = facets.count;
  pass.shader("gi/blur_links.comp")
      .constant(CONSTANT_EMITTED, emitted)
      .constant(CONSTANT_SCATTER_STORES, stores)
      .constant(CONSTANT_BLUR_WEIGHS, noise != nullptr)
      .push(push)
      .dispatch(facets.count);
  frame.readback(light.blurChange, 0, sizeof(float), [&change = light.report.blurChange](std::span<const uint8_t> b) {
    std::memcpy(&change.emplace(), b.data(), sizeof(float));
  });
}

}  // namespace

void scatter(Frame& frame, const FacetList& facets, const FormFactors& matrix, Lighting& light,
             const Settings& settings, bool watchBlur) {
  const SampleParams& sample = settings.sample.gpu;
  const bool may = facets.surface && facets.count > 0;
  const bool blurs = may && sample.filter_ == SampleFilter::blur, watches = may && (blurs || watchBlur);
  const Device& device = frame.context().device;
  const uint64_t bytes = 16ull * facets.count;
  fit(device, "blurred H", bytes, blurs, light.blurred);
  fit(device, "blurred F M", bytes, blurs && light.emitted, light.blurredEmitted);
  fit(device, "change by the blur", sizeof(uint32_t), watches, light.blurChange);
  if (watches) blur(frame, facets, matrix, light, settings.solver);
  if (light.volume) scatterVolume(frame, facets, light, settings);
}

}  // namespace irad
