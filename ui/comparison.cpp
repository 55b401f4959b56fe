#include "ui/comparison.h"

#include <cmath>

#include "gi/export.h"

namespace irad {
namespace {

std::vector<glm::vec4> linearPixels(Context& context, const Targets& targets) {
  const std::vector<std::byte> bytes = download(context, targets.linear);
  const auto* pixels = reinterpret_cast<const glm::vec4*>(bytes.data());
  return {pixels, pixels + bytes.size() / sizeof(glm::vec4)};
}

}  // namespace

bool measureComparison(Context& context, Session& session) {
  Comparison& comparison = *session.comparison;
  const Side &a = session.sideA(), &b = session.sideB();
  if (comparison.result || !session.allAsleep() || !a.targets.linear || a.targets.size != b.targets.size) return false;
  const auto irradiance = [&](const Pipeline& p) {
    return readVolume(context, Volume::irradiance, p.facets(), p.field(), p.lighting());
  };
  const std::optional<double> exposure = comparison.wantFlip ? std::optional(session.exposure()) : std::nullopt;
  comparison.result = Comparison::Result{.picture = measurePicture(a.targets.size, linearPixels(context, b.targets),
                                                                   linearPixels(context, a.targets), {}, exposure),
                                         .voxels = compareVoxels(irradiance(*b.pipeline), irradiance(*a.pipeline))};
  return true;
}

}  // namespace irad
