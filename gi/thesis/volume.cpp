#include "gi/thesis/volume.h"

#include "gi/facets.h"
#include "gi/lighting.h"
#include "gi/settings.h"
#include "gi/subsystems.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/solve.h"

namespace irad {

RadianceVolume makeVolume(Context& context, const Grid& grid) {
  return {Image(context.device, {.name = "radiance volume",
                                 .subsystem = Subsystem::Volumes,
                                 .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                 .width = grid.dims.x,
                                 .height = grid.dims.y,
                                 .depth = grid.dims.z,
                                 .volume = true}),
          Buffer(context.device, "clamped voxels", Subsystem::Volumes, sizeof(uint32_t))};
}

void scatterVolume(Frame& frame, const FacetList& facets, Lighting& light, const Settings& settings) {
  frame.pass("GI Scatter Clear").clear(light.volume.image, ClearColor{});
  if (facets.count == 0) return;
  frame.pass("GI Scatter Clear").fill(light.volume.clamped, 0);
  Pass pass = frame.pass("GI Scatter");
  ScatterVolumePush push{};
  push.facets = pass.in(facets.record);
  push.radiosity = pass.in(light.radiosity);
  push.direct = pass.in(light.direct);
  push.dims = facets.grid.dims;
  push.removal = settings.scatter.edgeRemoval ? light.gain.radiosity : 0.0f;
  push.clamped = pass.out(light.volume.clamped);
  pass.shader("thesis/scatter_volume.comp").write(light.volume.image).push(push).dispatch(facets.count);
  frame.readback(light.volume.clamped, 0, sizeof(uint32_t),
                 [&count = light.report.clampedVoxels](std::span<const uint8_t> b) {
                   std::memcpy(&count, b.data(), sizeof(count));
                 });
}

}  // namespace irad
