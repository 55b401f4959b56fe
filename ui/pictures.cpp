#include "ui/pictures.h"

#include <cstring>

#include "gi/views/draw.h"
#include "renderer/frame/frame.h"

namespace irad {
namespace {

void drawDifference(Session& session, Frame& frame) {
  const ViewInfo* info = viewInfo(session.view);
  if (!session.showsDifference() || info == nullptr) return;
  const Targets &a = session.sideA().targets, &b = session.sideB().targets;
  Targets& difference = session.comparison->difference;
  if (difference.size != a.size) difference = Targets(session.context, a.size);
  irad::drawDifference(frame, *info, session.edited, b, a, difference);
}

/// What the picture of the edited side was drawn with is in its targets.
bool hasRange(const ViewInfo& info, const Session& session) {
  return info.hasRange() || (info.toneMapped() && session.pipeline->settings().camera.autoExposure);
}

/// What the legend needs comes back with the frame.
void readRange(Session& session, Frame& frame) {
  const View view = session.view;
  const bool difference = session.showsDifference();
  if (const ViewInfo* info = viewInfo(view); info == nullptr || !(hasRange(*info, session) || difference)) return;
  const Targets& targets = difference ? session.comparison->difference : session.targets;
  frame.readback(targets.viewRange, 0, sizeof(ViewRange), [&session, view, difference](std::span<const uint8_t> bytes) {
    session.range.emplace();
    std::memcpy(&*session.range, bytes.data(), sizeof(ViewRange));
    session.rangeView = view;
    session.rangeOfDifference = difference;
  });
}

}  // namespace

void drawPictures(Session& session, Frame& frame) {
  // Both sides of a comparison share one range: the same colour is the same value.
  const ViewInfo* info = viewInfo(session.view);
  const Buffer* range = nullptr;
  for (Side* side : session.sides()) {
    side->pipeline->render(frame, session.shown, session.view, side->targets, {.range = range});
    if (info != nullptr && hasRange(*info, session)) range = &session.targets.viewRange;
  }
  if (session.comparison) session.comparison->result.reset(), session.comparison->wantFlip = false;
  // Beside another view the reference says nothing.
  if (session.split && (!session.reference || session.view != session.reference->of)) session.split.reset();
  if (session.split && !session.comparison) {
    Targets& targets = session.split->targets;
    if (targets.size != session.targets.size) targets = Targets(session.context, session.targets.size);
    session.pipeline->render(frame, session.shown, VIEW_REFERENCE_PICTURE, targets, {.range = range});
  }
  drawDifference(session, frame);
  readRange(session, frame);
  session.viewDirty = session.camera.camera() != session.shown;  // it has moved on since
  ++session.pictures;
}

}  // namespace irad
