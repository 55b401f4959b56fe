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
#include "gi/settings.h"
#include "gi/subsystems.h"
#include "gi/views/draw.h"
#include "renderer/frame/frame.h"
#include "renderer/resources.h"
#include "renderer/targets.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/indirect.h"

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
  if (field.method == FieldMethod::jfa && field.jfaDistance) return TRACE_JFA;
  return bytes ? TRACE_SKIP : TRACE_DDA_REVERSE;
}

/// W/m^2. In the dark no pixel traces rays, unless the threshold is 0.
float leastReflected(float threshold, float largestH) {
  return threshold > 0 ? std::max(threshold * largestH, std::numeric_limits<float>::min()) : 0;
}

}  // namespace

void traceSpecular(Frame& frame, const ViewInputs& inputs, const Buffer& camera, const Settings& settings,
                   Targets& targets) {
  const bool traces = settings.specular.mode != SpecularMode::off && targets.f0 && targets.indirect &&
                      inputs.facets != nullptr && inputs.field != nullptr && inputs.lighting != nullptr;
  // T 5.11: every pixel by itself, unfiltered.
  const bool alone = settings.specular.mode == SpecularMode::fragment;
  const bool kernels = static_cast<bool>(targets.visible);
  const bool lists = traces && (!alone || kernels);
  targets.fit(frame.context(), &Targets::specular, traces);
  if (lists != static_cast<bool>(targets.glossy))
    targets.glossy = lists ? Buffer(frame.context().device, "glossy pixels", Subsystem::Targets,
                                    4ull * (GLOSSY_FIRST + targets.size.x * targets.size.y))
                           : Buffer();
  if (!traces) return;
  const FacetList& facets = *inputs.facets;
  const Field& field = *inputs.field;
  const Lighting& lighting = *inputs.lighting;
  SamplerDesc nearest{Wrap::Clamp, Wrap::Clamp, /*linearMag*/ false, /*linearMin*/ false, /*mips*/ false};
  nearest.linearMips = false;
  const VkSampler point = sampler(frame.context().device, nearest);

  SpecularPush common{};
  common.grid = facets.grid;
  common.params = settings.specular.gpu;
  common.jfaMax = field.jfaMax;
  common.leastReflected = leastReflected(settings.specular.gpu.threshold, lighting.litH);
  const uint32_t method = traceMethod(settings, field);
  const bool volume = method == TRACE_JFA;
  const auto traced = [&](Pass& pass, const Emitters* emitters = nullptr) -> Pass& {
    SpecularPush push = common;
    push.camera = pass.in(camera);
    push.facets = pass.in(facets.record);
    push.radiosity = pass.in(lighting.radiosity);
    push.chebyshev = pass.inIfAny(field.chebyshev);
    if (lists) push.glossy = pass.in(targets.glossy);
    if (emitters != nullptr) push.emitters = pass.in(emitters->record);
    pass.constant(CONSTANT_TRACE_METHOD, method)
        .constant(CONSTANT_TRACE_HIT_RULE, settings.matrix.gpu.hitRule)
        .constant(CONSTANT_NORMALS, facets.encoding)
        .constant(CONSTANT_TRACE_MANY, facets.slots > 2)
        .constant(CONSTANT_TRACE_EMITTERS, emitters != nullptr)
        .sample(targets.depth, point)
        .read(targets.normal, targets.geometric, targets.f0);
    if (alone) pass.read(targets.indirect);
    if (lists) pass.write(alone ? targets.specular : targets.linear);
    if (volume) pass.sample(field.jfaDistance, point);
    return pass.push(push);
  };

  if (!lists) {
    Pass pass = frame.pass("RE Specular");
    pass.shaders({"specular/screen.vert", volume ? "specular/trace_jfa.frag" : "specular/trace.frag"});
    traced(pass).color(targets.specular, ClearColor{}).draw(3);
    return;
  }

  // List the pixels that trace; the others have their reflection with this step.
  frame.pass("RE Specular").update(targets.glossy, glm::uvec4(0, alone ? GLOSSY_PARTS : 1, 1, 0));
  Pass classify = frame.pass("RE Specular");
  SpecularPush push = common;
  push.camera = classify.in(camera);
  push.glossy = classify.out(targets.glossy);
  classify.shader("specular/classify.comp")
      .constant(CONSTANT_FILTERED, !alone)
      .sample(targets.depth, point)
      .read(targets.normal, targets.f0, targets.indirect)
      .write(targets.linear, targets.specular)
      .push(push)
      .dispatch(targets.size);

  // Trace.
  Pass trace = frame.pass("RE Specular");
  if (alone) {
    trace.shader(volume ? "specular/trace_picture_jfa.comp" : "specular/trace_picture.comp");
    traced(trace).dispatchIndirect(targets.glossy);
    return;
  }
  trace.shader(volume ? "specular/trace_jfa.comp" : "specular/trace.comp");
  const bool emitters = inputs.emitters != nullptr && inputs.emitters->count > 0;
  traced(trace, emitters ? inputs.emitters : nullptr).dispatchIndirect(targets.glossy);

  // Filter; linear and specular take turns, so that the last of the three steps ends in `specular`.
  const Image* from = &targets.linear;
  const Image* to = &targets.specular;
  for (size_t i = 0; i < kFilter.size(); ++i) {
    const bool last = i + 1 == kFilter.size();
    if (settings.specular.gpu.filter_ == 0 && !last) continue;
    Pass filter = frame.pass("RE Specular");
    push.camera = filter.in(camera);
    push.glossy = filter.in(targets.glossy);
    filter.shader("specular/filter.comp")
        .constant(CONSTANT_FILTER_STEP, settings.specular.gpu.filter_ != 0 ? kFilter[i].step : 0)
        .constant(CONSTANT_FILTER_RESOLVE, last)
        .constant(CONSTANT_LEAST_ROUGHNESS, std::bit_cast<uint32_t>(kFilter[i].leastRoughness))
        .read(targets.normal, targets.geometric, targets.f0, targets.indirect, *from)
        .write(*to)
        .push(push)
        .dispatchIndirect(targets.glossy);
    std::swap(from, to);
  }
}

}  // namespace irad
