#include "ui/histogram.h"

#include "gi/views/draw.h"
#include "renderer/frame/frame.h"
#include "ui/session.h"

namespace irad {

void ShownHistogram::record(Session& session, Frame& frame) {
  const ViewInfo* info = viewInfo(session.view);
  if (!wanted || info == nullptr || !hasHistogram(*info)) {
    if (asked_) counter_ = {};  // no memory for what is not shown
    asked_.reset();
    counts.reset();
    return;
  }
  const bool difference = session.showsDifference();
  const Targets& targets = difference ? session.comparison->difference : session.targets;
  const Asked asked{session.pictures, session.view, difference, axis};
  if (session.pictures == 0 || asked_ == asked || !targets.linear) return;
  asked_ = asked;
  counter_.count(frame, difference ? differenceInfo() : *info, targets.linear,
                 info->hasRange() || difference ? &targets.viewRange : nullptr, axis,
                 [this, view = session.view, difference](const Histogram& histogram) {
                   counts = Counts{histogram, view, difference};
                 });
}

}  // namespace irad
