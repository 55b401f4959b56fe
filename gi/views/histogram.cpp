#include "gi/views/histogram.h"

#include <cstring>

#include "gi/settings.h"
#include "gi/views/passes.h"
#include "renderer/frame/frame.h"
#include "renderer/targets.h"

namespace irad {
namespace {

constexpr const char* kStage = "View histogram";
constexpr float kLightPercentile = 99;  ///< brighter pixels are counted as beyond the axis

/// Where the view's kind says what its values lie between.
std::optional<glm::vec2> knownAxis(uint32_t kind) {
  if (kind == VIEW_KIND_COLOR) return glm::vec2(0, 1);
  if (kind == VIEW_KIND_NORMAL) return glm::vec2(-1, 1);
  return std::nullopt;
}

}  // namespace

bool hasHistogram(const ViewInfo& info) {
  return info.kind != VIEW_KIND_SITE;
}

void HistogramCounter::count(Frame& frame, const ViewInfo& info, const Image& linear, const Buffer* shown,
                             const std::optional<glm::vec2>& wanted, std::function<void(const Histogram&)> done) {
  const Device& device = frame.context().device;
  if (!histogram_) {
    values_ = Buffer(device, "values of the histogram", Subsystem::Targets, sizeof(ViewRange));
    bins_ = Buffer(device, "values of the histogram, sorted", Subsystem::Targets, 4ull * RANGE_BINS);
    histogram_ = Buffer(device, "histogram", Subsystem::Targets, sizeof(Histogram));
  }
  const glm::uvec2 size{linear.desc.width, linear.desc.height};
  const std::optional<glm::vec2> axis = wanted ? wanted : knownAxis(info.kind);
  HistogramPush push{};
  push.size = size;
  push.kind = info.kind;
  if (axis) {
    push.fixedAxis = 1;
    push.low = axis->x;
    push.high = axis->y;
  } else {
    RangePush range{};
    range.size = size;
    range.kind = info.kind;
    range.mode = info.hasRange() ? RangeMode::automatic : RangeMode::percentile;
    range.percentile = kLightPercentile;
    measureRange(frame, kStage, range, linear, values_, bins_);
  }
  frame.pass(kStage).fill(histogram_, 0);
  Pass pass = frame.pass(kStage);
  if (!axis) push.values = pass.in(values_);
  if (!axis && shown != nullptr) push.shown = pass.in(*shown);
  push.histogram = pass.out(histogram_);
  pass.shader("view/histogram.comp").read(linear).push(push).dispatch(size);
  frame.readback(histogram_, 0, sizeof(Histogram), [done = std::move(done)](std::span<const uint8_t> bytes) {
    Histogram histogram;
    std::memcpy(&histogram, bytes.data(), sizeof(histogram));
    done(histogram);
  });
}

}  // namespace irad
