// "RE Specular": reflections of the voxelized scene (METHOD section 8).
#include <algorithm>
#include <array>

#include "gi/views.h"
#include "shaders/shared/passes.h"

namespace irad {
namespace {

/// Filter steps: pixels between taps, and the roughness below which a lobe is too narrow for that much blur.
struct FilterStep {
  uint32_t step;
  float leastRoughness;
};
constexpr std::array<FilterStep, 3> kFilter{{{1, 0.03f}, {2, 0.08f}, {4, 0.15f}}};

/// Which of gi/trace.glsl's walks serves the settings and the field that there is.
uint32_t traceMethod(const Settings& settings, const Field& field) {
  const bool bytes = static_cast<bool>(field.chebyshev);
  if (settings.specular.gpu.traversal == TRAVERSAL_DDA) return bytes ? TRACE_DDA_FIELD : TRACE_DDA_REVERSE;
  if (field.method == FieldMethod::jfa && field.jfaDistance) return TRACE_JFA;
  return bytes ? TRACE_SKIP : TRACE_DDA_REVERSE;
}

}  // namespace

void traceSpecular(Frame& frame, const ViewInputs& inputs, const Buffer& camera, const Settings& settings,
                   Targets& targets) {
  const bool possible = inputs.facets != nullptr && inputs.field != nullptr && inputs.lighting != nullptr;
  if (settings.specular.mode == SpecularMode::off || !possible) {
    frame.pass("RE Specular").clear(targets.specular, ClearColor{});
    return;
  }
  const FacetList& facets = *inputs.facets;
  const Field& field = *inputs.field;
  const Lighting& lighting = *inputs.lighting;
  SamplerDesc nearest{Wrap::Clamp, Wrap::Clamp, /*linearMag*/ false, /*linearMin*/ false, /*mips*/ false};
  nearest.linearMips = false;
  const VkSampler point = sampler(frame.context().device, nearest);

  SpecularPush push{};
  push.camera = camera.address;
  push.grid = facets.grid;
  push.facets = facets.record.address;
  push.radiosity = lighting.radiosity.address;
  push.chebyshev = field.chebyshev.address;
  push.params = settings.specular.gpu;
  push.jfaMax = field.jfaMax;
  const uint32_t method = traceMethod(settings, field);
  const bool inFragment = settings.specular.mode == SpecularMode::fragment;

  // Trace.
  Pass trace = frame.pass("RE Specular");
  if (inFragment) {
    trace.shaders({"specular/screen.vert", method == TRACE_JFA ? "specular/trace_jfa.frag" : "specular/trace.frag"});
  } else {
    trace.shader(method == TRACE_JFA ? "specular/trace_jfa.comp" : "specular/trace.comp");
  }
  trace.constant(0, method)
      .constant(1, settings.matrix.gpu.hitRule)
      .constant(2, static_cast<uint32_t>(facets.encoding))
      .read(camera, facets.record, facets.shape, facets.reverse, lighting.radiosity)
      .sample(targets.depth, point)
      .read(targets.normal, targets.geometric, targets.f0, targets.indirect);
  if (field.chebyshev) trace.read(field.chebyshev);
  if (!inFragment) trace.write(targets.linear);
  if (method == TRACE_JFA) trace.sample(field.jfaDistance, point);
  trace.push(push);
  if (inFragment) {
    trace.color(targets.specular, ClearColor{}).draw(3);
    return;
  }
  const uint32_t groupsX = (targets.size.x + 7) / 8, groupsY = (targets.size.y + 7) / 8;
  const auto dispatch = [=](Commands& commands) { commands.dispatchGroups(groupsX, groupsY); };
  trace.run(dispatch);

  // Filter; linear and specular take turns, so that the last of the three steps ends in `specular`.
  const Image* from = &targets.linear;
  const Image* to = &targets.specular;
  for (size_t i = 0; i < kFilter.size(); ++i) {
    const bool last = i + 1 == kFilter.size();
    if (settings.specular.gpu.filter_ == 0 && !last) continue;
    push.step_ = settings.specular.gpu.filter_ != 0 ? kFilter[i].step : 0;
    push.leastRoughness = kFilter[i].leastRoughness;
    push.resolve = last ? 1 : 0;
    frame.pass("RE Specular")
        .shader("specular/filter.comp")
        .read(camera)
        .sample(targets.depth, point)
        .read(targets.normal, targets.geometric, targets.f0, targets.indirect, *from)
        .write(*to)
        .push(push)
        .run(dispatch);
    std::swap(from, to);
  }
}

}  // namespace irad
