#include "gi/thesis/volume.h"

#include "gi/facets.h"
#include "gi/settings.h"
#include "gi/subsystems.h"
#include "shaders/shared/indirect.h"
#include "shaders/shared/solve.h"

namespace irad {

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

void scatterVolume(Frame& frame, const FacetList& facets, Lighting& light, const Settings& settings) {
  frame.pass("GI Scatter Clear").clear(light.volume, ClearColor{});
  if (facets.count == 0) return;
  const bool holdsRadiosity = settings.sample.gpu.gated == 0 || settings.scatter.edgeRemoval;
  const Buffer& value = holdsRadiosity ? light.radiosity : light.indirect;
  frame.pass("GI Scatter Clear").fill(light.clamped, 0);
  Pass pass = frame.pass("GI Scatter");
  ScatterVolumePush push{};
  push.facets = pass.in(facets.record);
  push.value = pass.in(value);
  push.direct = pass.in(light.direct);
  push.dims = facets.grid.dims;
  push.removal = settings.scatter.edgeRemoval ? light.gain.radiosity : 0.0f;
  push.clamped = pass.out(light.clamped);
  pass.shader("thesis/scatter_volume.comp").write(light.volume).push(push).dispatch(facets.count);
  frame.readback(light.clamped, 0, sizeof(uint32_t), [&count = light.report.clampedVoxels](std::span<const uint8_t> b) {
    std::memcpy(&count, b.data(), sizeof(count));
  });
}

void lookUpVolume(Frame& frame, const Image& volume, const Buffer& grid, const SampleParams& sample, Targets& targets) {
  SamplerDesc linear{Wrap::Clamp, Wrap::Clamp};
  linear.mips = linear.linearMips = false;
  Pass pass = frame.pass("RE Forward");
  pass.write(targets.indirect).read(targets.linear).sample(volume, sampler(frame.context().device, linear));
  pass.shader("thesis/indirect_volume.comp")
      .push(VolumeIndirectPush{pass.in(grid), sample, targets.size})
      .dispatch(targets.size);
}

}  // namespace irad
