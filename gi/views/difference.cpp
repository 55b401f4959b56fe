// Two pictures of the same view, one less the other.
#include <fmt/format.h>

#include "gi/views/passes.h"
#include "renderer/frame/frame.h"
#include "renderer/targets.h"
#include "shaders/shared/view.h"

namespace irad {
namespace {

/// Drawn like a view that is not in the list: signed, without a range of its own, with nothing around it.
constexpr ViewInfo kDifference{.view = UINT32_MAX,
                               .name = "difference",
                               .label = "Difference",
                               .unit = "",
                               .group = "",
                               .kind = VIEW_KIND_SIGNED,
                               .rangeMin = 0,
                               .rangeMax = 0,
                               .shape = std::nullopt,
                               .from = FROM_TARGETS};

}  // namespace

Quantity differenceQuantity(const ViewInfo& info, const Settings& settings) {
  const Quantity of = shownQuantity(info, settings);
  if (info.kind == VIEW_KIND_NORMAL) return {of.name + ": angle between A and B", "degrees"};
  if (info.kind == VIEW_KIND_SITE) return {of.name + ": 1 where they differ", ""};
  return {of.name + (info.hasRange() ? ": B \u2212 A" : ": luminance, B \u2212 A"), of.unit};
}

const ViewInfo& differenceInfo() {
  return kDifference;
}

void drawDifference(Frame& frame, const ViewInfo& info, const Settings& settings, const Targets& values,
                    const Targets& reference, Targets& out) {
  frame.pass("View")
      .shader("view/difference.comp")
      .read(values.linear, reference.linear)
      .write(out.linear)
      .push(DifferencePush{.size = out.size, .kind = info.kind})
      .dispatch(out.size);
  findRange(frame, kDifference, settings, out);
  finishView(frame, kDifference, settings, glm::uvec3(1), out);
}

}  // namespace irad
