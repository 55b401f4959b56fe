#include "gi/hits_on_host.h"

#include <span>

#include "gi/facets.h"
#include "gi/host_pass.h"
#include "gi/host_trace.h"
#include "gi/ray_kernel.h"
#include "renderer/frame/frame.h"
#include "renderer/resources.h"

namespace irad {

const HostTrace* hostTraceIfAny(Context& context, const FacetList& facets, const MatrixParams& params,
                                const char* stage) {
  if (!context.device.isCpu || params.hitRule != HitRule::triangles || !canTraceOnHost()) return nullptr;
  if (!facets.hostTrace) timedOnHost(context, stage, [&] { facets.hostTrace = makeHostTrace(context, facets); });
  return facets.hostTrace.get();
}

void traceMapped(Context& context, const RayKernel& kernel, const HostTrace* host, const MatrixParams& params,
                 uint32_t firstRow, uint32_t rows, const Buffer& hits, bool sky, const char* stage) {
  if (host != nullptr) {
    const std::span<uint32_t> mapped(static_cast<uint32_t*>(hits.mapped), uint64_t{rows} * params.rays);
    timedOnHost(context, stage,
                [&] { host->rows(params, firstRow, rows, mapped, /*threads=*/0, sky, kernel.tintShift); });
    return;
  }
  Frame frame = context.begin();
  traceRows(frame, kernel, params, firstRow, rows, hits, sky, stage);
  // The device's writes are made visible to the host.
  frame.pass(stage)
      .declare(hits, {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT})
      .record([](VkCommandBuffer) {});
  frame.submitAndWait();
}

}  // namespace irad
