// The range of a view's values, and the display picture that it leads to. Reductions are of integers: the same picture
// gives the same range, bit for bit.
#include "gi/settings.h"
#include "gi/views/passes.h"
#include "renderer/frame/frame.h"
#include "renderer/targets.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/passes.h"
#include "shaders/shared/view.h"

namespace irad {

void findRange(Frame& frame, const ViewInfo& info, const Settings& settings, Targets& targets) {
  const ViewSettings& view = settings.view;
  RangePush push{};
  push.size = targets.size;
  push.kind = info.kind;
  push.mode = view.range;
  push.low = view.low;
  push.high = view.high;
  push.percentile = view.percentile;
  if (!info.hasRange()) {  // luminances, of which camera.auto_exposure wants the upper end
    push.mode = RangeMode::percentile;
    push.percentile = AUTO_EXPOSURE_PERCENTILE;
  } else if (view.range == RangeMode::standard) {
    push.mode = info.rangeMin < info.rangeMax ? RangeMode::manual : RangeMode::automatic;
    push.low = info.rangeMin;
    push.high = info.rangeMax;
  }
  measureRange(frame, "View range", push, targets.linear, targets.viewRange, targets.viewBins);
}

void measureRange(Frame& frame, const char* stage, RangePush push, const Image& linear, const Buffer& range,
                  const Buffer& bins) {
  frame.pass(stage).update(range, ViewRange{.least = UINT32_MAX});
  if (push.mode == RangeMode::percentile) frame.pass(stage).fill(bins, 0);
  Pass measure = frame.pass(stage);
  push.range = measure.out(range);
  push.bins = measure.out(bins);
  measure.shader("view/range_measure.comp").read(linear).push(push).dispatch(push.size);
  Pass resolve = frame.pass(stage);
  push.range = resolve.out(range);
  push.bins = resolve.in(bins);
  resolve.shader("view/range_resolve.comp").push(push).dispatchWorkgroups(1);
}

void finishView(Frame& frame, const ViewInfo& info, const Settings& settings, glm::uvec3 dims, Targets& targets) {
  Pass pass = frame.pass("View");
  FinishPush push{};
  push.range = pass.in(targets.viewRange);
  push.size = targets.size;
  push.kind = info.kind;
  push.colorMap = colorMapOf(info, settings);
  push.automatic = exposesItself(info, settings) ? 1 : 0;
  push.exposure = linearExposure(settings);
  push.toneCurve = settings.camera.gpu.toneCurve;
  push.dims = dims;
  push.surroundings = resolveShape(info.view, settings.view.shape) == ViewShape::slice ? 1 : 0;
  pass.shader("view/finish.comp")
      .constant(CONSTANT_HAS_INDIRECT, (targets.present() & TARGET_INDIRECT) != 0)
      .read(targets.linear, targets.albedo, targets.direct, targets.bound(&Targets::indirect))
      .write(targets.display)
      .push(push)
      .dispatch(targets.size);
}

}  // namespace irad
