// The per-facet light buffers, and what shading samples of them (docs/method.md 6 and 7, T 5.9).
#include "gi/scatter.h"

#include "gi/facets.h"
#include <cstdlib>
#include "gi/matrix.h"
#include "gi/sweep.h"
#include "gi/lighting.h"
#include "gi/settings.h"
#include "gi/subsystems.h"
#include "gi/thesis/volume.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/solve.h"

namespace irad {

namespace {

constexpr const char* kScatterStage = "GI Scatter";

/// Makes the buffer where it is wanted, and frees it where it is not.
void fit(const Device& device, const char* name, uint64_t bytes, bool wanted, Buffer& buffer) {
  if (wanted != static_cast<bool>(buffer)) buffer = wanted ? Buffer(device, name, Subsystem::Solver, bytes) : Buffer();
}

/// Blurs into the copies, where there are any, and measures the change.
void blur(Frame& frame, const FacetList& facets, Lighting& light, const FormFactors* matrix, const Settings& settings) {
  static const float kC = std::getenv("BLUR_C") ? std::atof(std::getenv("BLUR_C")) : 1;
  const Buffer squares(frame.context().device, "squares", Subsystem::Solver, 16ull * facets.count);
  const float emissionGain = light.correction ? light.gain.indirect : 0;
  {
    Pass pass = frame.pass(kScatterStage);
    LightSquaresPush push{};
    push.facets = pass.in(facets.record);
    push.radiosity = pass.in(light.radiosity);
    push.output_ = pass.out(light.radiosityNext);
    push.emissionGain = light.correction ? light.gain.radiosity : 0;
    pass.shader("gi/light_squares.comp").push(push).dispatch(facets.count);
  }
  Sweep sweep(frame.context(), facets, *matrix, settings.solver);
  sweep.begin(frame, kScatterStage, light.radiosityNext);
  sweep.record(frame, kScatterStage, SOLVE_PRODUCT, light.radiosityNext, squares, light);
  const bool stores = static_cast<bool>(light.blurred), emitted = stores && light.emitted;
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
  push.squares = pass.in(squares);
  push.sky = pass.inIfAny(light.sky);
  push.emissionGain = emissionGain;
  push.noise = kC / float(matrix->rays);
  push.dims = facets.grid.dims;
  push.count = facets.count;
  pass.shader("gi/blur_links.comp")
      .constant(CONSTANT_EMITTED, emitted)
      .constant(CONSTANT_SCATTER_STORES, stores)
      .push(push)
      .dispatch(facets.count);
  frame.readback(light.blurChange, 0, sizeof(float), [&change = light.report.blurChange](std::span<const uint8_t> b) {
    std::memcpy(&change.emplace(), b.data(), sizeof(float));
  });
  frame.submitAndWait();
}

}  // namespace

void scatter(Frame& frame, const FacetList& facets, Lighting& light, const Settings& settings, const FormFactors* matrix, bool watchBlur) {
  const SampleParams& sample = settings.sample.gpu;
  const bool may = facets.surface && facets.count > 0;
  const bool blurs = may && sample.filter_ == SampleFilter::blur, watches = may && (blurs || watchBlur);
  const Device& device = frame.context().device;
  const uint64_t bytes = 16ull * facets.count;
  fit(device, "blurred H", bytes, blurs, light.blurred);
  fit(device, "blurred F M", bytes, blurs && light.emitted, light.blurredEmitted);
  fit(device, "change by the blur", sizeof(uint32_t), watches, light.blurChange);
  if (watches) blur(frame, facets, light, matrix, settings);
  if (light.volume) scatterVolume(frame, facets, light, settings);
}

}  // namespace irad
