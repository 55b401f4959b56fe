// The range of a view's values, and the display picture that it leads to. Reductions are of integers: the same picture
// gives the same range, bit for bit.
#include "gi/view_passes.h"
#include "shaders/shared/passes.h"
#include "shaders/shared/view.h"

namespace irad {

void findRange(Frame& frame, const ViewInfo& info, const Settings& settings, Targets& targets) {
  const ViewSettings& view = settings.view;
  RangePush push{};
  push.range = targets.viewRange.address;
  push.bins = targets.viewBins.address;
  push.size = targets.size;
  push.kind = info.kind;
  push.mode = static_cast<uint32_t>(view.range);
  push.low = view.low;
  push.high = view.high;
  push.percentile = view.percentile;
  if (view.range == RangeMode::standard) {
    push.mode = info.rangeMin < info.rangeMax ? RANGE_MANUAL : RANGE_AUTO;
    push.low = info.rangeMin;
    push.high = info.rangeMax;
  }
  frame.pass("View range").update(targets.viewRange, ViewRange{.least = UINT32_MAX});
  if (push.mode == RANGE_PERCENTILE) frame.pass("View range").fill(targets.viewBins, 0);
  frame.pass("View range")
      .shader("view/range_measure.comp")
      .read(targets.linear)
      .write(targets.viewRange, targets.viewBins)
      .push(push)
      .run([&](Commands& commands) { commands.dispatchGroups((targets.size.x + 7) / 8, (targets.size.y + 7) / 8); });
  frame.pass("View range")
      .shader("view/range_resolve.comp")
      .read(targets.viewBins)
      .write(targets.viewRange)
      .push(push)
      .run([](Commands& commands) { commands.dispatchGroups(1); });
}

void finishView(Frame& frame, const ViewInfo& info, const Settings& settings, glm::uvec3 dims, Targets& targets) {
  FinishPush push{};
  push.range = targets.viewRange.address;
  push.size = targets.size;
  push.kind = info.kind;
  push.colorMap = colorMapOf(info, settings);
  push.exposure = linearExposure(settings);
  push.toneCurve = settings.camera.gpu.toneCurve;
  push.dims = dims;
  push.surroundings = resolveShape(info.view, settings.view.shape) == SHAPE_SLICE ? 1 : 0;
  frame.pass("View")
      .shader("view/finish.comp")
      .constant(0, (targets.present() & TARGET_INDIRECT) != 0)
      .read(targets.viewRange, targets.linear, targets.albedo, targets.direct, targets.bound(&Targets::indirect))
      .write(targets.display)
      .push(push)
      .run([&](Commands& commands) { commands.dispatchGroups((targets.size.x + 7) / 8, (targets.size.y + 7) / 8); });
}

}  // namespace irad
