#include "gi/check/writeback_figures.h"

#include <cmath>
#include <string_view>

#include "gi/facets.h"
#include "gi/host_facets.h"
#include "gi/lighting.h"
#include "gi/writeback_pass.h"
#include "renderer/base/error.h"
#include "renderer/frame/frame.h"
#include "renderer/targets.h"

namespace irad {

WritebackFigures measureWriteback(Context& context, Pipeline& pipeline, const Camera& camera, glm::uvec2 size,
                                  uint32_t frames, const Progress& progress) {
  WritebackFigures out;
  Targets targets(context, size);
  out.rounds = pipeline.settleReflections(camera, targets, progress);
  context.timings.reset();
  const std::vector<float> area = downloadAs<float>(context, pipeline.facets().area);
  // Relative to the first frame, so that light that stays the same has no deviation at all.
  std::vector<double> first(area.size()), sum(area.size()), squares(area.size());
  for (uint32_t i = 0; i < frames; ++i) {
    if (progress && !progress("still frames", static_cast<float>(i) / static_cast<float>(frames)))
      throw WorkError("cancelled");
    Frame frame = context.begin(i);
    pipeline.render(frame, camera, VIEW_LIT, targets);
    frame.submitAndWait();
    context.timings.endFrame(i, /*setup=*/false, 0);
    if (!pipeline.asleep()) pipeline.prepare();
    const std::vector<glm::vec3> b = perFacet(context, pipeline.facets(), pipeline.lighting().radiosity);
    for (size_t f = 0; f < b.size(); ++f) {
      const double value = (double{b[f].x} + b[f].y + b[f].z) / 3;
      if (i == 0) first[f] = value;
      const double change = value - first[f];
      sum[f] += change / frames;
      squares[f] += change * change / frames;
    }
  }
  double all = 0, variance = 0;
  for (size_t f = 0; f < area.size(); ++f) {
    all += double{area[f]};
    out.meanB += double{area[f]} * (first[f] + sum[f]);
    variance += double{area[f]} * std::max(squares[f] - sum[f] * sum[f], 0.0);
  }
  if (all > 0) out.meanB /= all;
  if (out.meanB > 0) out.flicker = std::sqrt(variance / all) / out.meanB;
  for (const Timings::Row& row : context.timings.rows())
    if (row.kind == WorkKind::Frame && std::string_view(row.stage).starts_with(kWritebackStage))
      out.ms += row.stats.p50;
  if (const auto& report = pipeline.lighting().writeback.report) out.report = *report;
  return out;
}

}  // namespace irad
