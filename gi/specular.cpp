// "RE Specular": reflections of the voxelized scene (docs/method.md 8).
#include "gi/specular.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "gi/emitters.h"
#include "gi/facets.h"
#include "gi/field.h"
#include "gi/lighting.h"
#include "gi/picked.h"
#include "gi/ray_kernel.h"
#include "gi/settings.h"
#include "gi/specular_pass.h"
#include "gi/subsystems.h"
#include "gi/thesis/pixel_specular.h"
#include "gi/views/passes.h"
#include "renderer/frame/frame.h"
#include "renderer/targets.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/indirect.h"
#include "shaders/shared/picked.h"

namespace irad {
namespace {

/// Filter steps: pixels between taps, and the roughness below which a lobe is too narrow for that much blur.
struct FilterStep {
  uint32_t step;
  float leastRoughness;
};
constexpr std::array<FilterStep, 3> kFilter{{{1, 0.03f}, {2, 0.08f}, {4, 0.15f}}};

/// Which of gi/trace.glsl's walks fits the settings and the field at hand.
uint32_t traceMethod(const Settings& settings, const Field& field) {
  const bool bytes = static_cast<bool>(field.chebyshev);
  if (settings.specular.gpu.traversal == Traversal::dda) return bytes ? TRACE_DDA_FIELD : TRACE_DDA_REVERSE;
  if (field.method == FieldMethod::jfa && field.jumpFlood.distance) return TRACE_JFA;
  return bytes ? TRACE_SKIP : TRACE_DDA_REVERSE;
}

/// Invocations that share a pixel's rays. On a CPU those that have none, as all but one of a mirror, are work for all;
/// but no more than eight rays go to one, or Mesa's CPU driver may end its loops, after 65,535 rounds, in a crowd.
uint32_t lobeLanes(const Device& device, uint32_t rays) {
  if (!device.isCpu) return 4;
  uint32_t lanes = 2;
  while (lanes < 16 && rays > 8 * lanes) lanes *= 2;
  return lanes;
}

/// W/m^2. In the dark no pixel traces rays, unless the threshold is 0.
float leastReflected(float threshold, float largestH) {
  return threshold > 0 ? std::max(threshold * largestH, std::numeric_limits<float>::min()) : 0;
}

}  // namespace

void listGlossy(SpecularPicture& picture, bool filtered) {
  Frame& frame = picture.frame;
  Targets& targets = picture.targets;
  const Device& device = frame.context().device;
  pickNone(frame, kSpecularStage, "glossy pixels", targets.size, targets.glossy);
  Pass pass = frame.pass(kSpecularStage);
  SpecularPush push = picture.push;
  push.camera = pass.in(picture.camera);
  push.glossy = pass.out(targets.glossy);
  pass.shader("specular/classify.comp")
      .constant(CONSTANT_FILTERED, filtered)
      .sample(targets.depth, pointSampler(device))
      .read(targets.normal, targets.f0, targets.indirect)
      .write(targets.linear, targets.specular)
      .push(push)
      .dispatch(targets.size);
}

Pass& addRays(const SpecularPicture& picture, Pass& pass, const Emitters* emitters) {
  const Targets& targets = picture.targets;
  const FacetList& facets = *picture.inputs.facets;
  SpecularPush push = picture.push;
  push.camera = pass.in(picture.camera);
  push.facets = pass.in(facets.record);
  push.surface = pass.inIfAny(facets.surface.record);
  push.radiosity = pass.in(picture.inputs.lighting->radiosity);
  push.chebyshev = pass.inIfAny(picture.inputs.field->chebyshev);
  push.glossy = pass.inIfAny(targets.glossy);
  if (emitters != nullptr) push.emitters = pass.in(emitters->record);
  if (picture.inputs.sky != nullptr) push.sky = pass.in(*picture.inputs.sky);
  return mayMeet(pass, facets)
      .constant(CONSTANT_TRACE_METHOD, picture.method)
      .constant(CONSTANT_TRACE_HIT_RULE, picture.settings.matrix.gpu.hitRule)
      .constant(CONSTANT_NORMALS, facets.encoding)
      .constant(CONSTANT_TRACE_EMITTERS, emitters != nullptr)
      .constant(CONSTANT_SKY, picture.inputs.sky != nullptr)
      .sample(targets.depth, pointSampler(picture.frame.context().device))
      .read(targets.normal, targets.geometric, targets.f0, targets.indirect)
      .push(push);
}

Pass& sampleField(const SpecularPicture& picture, Pass& pass) {
  if (fieldIsImage(picture))
    pass.sample(picture.inputs.field->jumpFlood.distance, pointSampler(picture.frame.context().device));
  return pass;
}

void traceSpecular(Frame& frame, const ViewInputs& inputs, const Buffer& camera, const Settings& settings,
                   Targets& targets) {
  const bool traces = settings.specular.mode != SpecularMode::off && targets.f0 && targets.indirect &&
                      inputs.facets != nullptr && inputs.field != nullptr && inputs.lighting != nullptr;
  targets.fit(frame.context(), &Targets::specular, traces);
  if (!traces) {
    targets.glossy = Buffer();
    return;
  }
  SpecularPicture picture{frame, inputs, camera, settings, targets, {}, traceMethod(settings, *inputs.field)};
  SpecularPush& common = picture.push;
  const Grid& grid = inputs.facets->grid;
  common.dims = grid.dims;
  common.origin = grid.origin;
  common.inverseEdge = grid.inverseEdge;
  common.params = settings.specular.gpu;
  common.jfaMax = inputs.field->jumpFlood.largest;
  common.leastReflected = leastReflected(settings.specular.gpu.threshold, inputs.lighting->litH);
  if (settings.specular.mode == SpecularMode::fragment) return traceByPixel(picture);

  listGlossy(picture, /*filtered=*/true);

  Pass trace = frame.pass(kSpecularStage);
  trace.shader(fieldIsImage(picture) ? "specular/trace_jfa.comp" : "specular/trace.comp");
  const uint32_t lanes = lobeLanes(frame.context().device, settings.specular.gpu.rays);
  trace.constant(CONSTANT_LOBE_LANES, lanes).constant(CONSTANT_LOBE_WORKGROUP, lanes * PICKED_GROUP);
  const bool emitters = inputs.facets->surface && inputs.emitters != nullptr && inputs.emitters->count > 0;
  addRays(picture, trace, emitters ? inputs.emitters : nullptr).write(targets.linear);
  sampleField(picture, trace).dispatchIndirect(targets.glossy);

  // Filter; linear and specular take turns, so that the last of the three steps ends in `specular`.
  const Image* from = &targets.linear;
  const Image* to = &targets.specular;
  for (size_t i = 0; i < kFilter.size(); ++i) {
    const bool last = i + 1 == kFilter.size();
    if (settings.specular.gpu.filter_ == 0 && !last) continue;
    Pass filter = frame.pass(kSpecularStage);
    SpecularPush push = common;
    push.camera = filter.in(camera);
    push.glossy = filter.in(targets.glossy);
    filter.shader("specular/filter.comp")
        .constant(CONSTANT_FILTER_STEP, settings.specular.gpu.filter_ != 0 ? kFilter[i].step : 0)
        .constant(CONSTANT_FILTER_RESOLVE, last)
        .constant(CONSTANT_LEAST_ROUGHNESS, std::bit_cast<uint32_t>(kFilter[i].leastRoughness))
        .sample(targets.depth, pointSampler(frame.context().device))
        .read(targets.normal, targets.geometric, targets.f0, targets.indirect, *from)
        .write(*to)
        .push(push)
        .dispatchIndirect(targets.glossy);
    std::swap(from, to);
  }
}

}  // namespace irad
