#include "ui/comparison.h"

#include "renderer/error.h"

namespace irad {
namespace {

std::vector<glm::vec4> linearPixels(Context& context, const Targets& targets) {
  const std::vector<std::byte> bytes = download(context, targets.linear);
  const auto* pixels = reinterpret_cast<const glm::vec4*>(bytes.data());
  return {pixels, pixels + bytes.size() / sizeof(glm::vec4)};
}

}  // namespace

void measureComparison(Context& context, Session& session) {
  Comparison& comparison = *session.comparison;
  const Side &a = session.sideA(), &b = session.sideB();
  if (comparison.result || !session.allAsleep() || !a.targets.linear || a.targets.size != b.targets.size) return;
  const auto irradiance = [&](const Pipeline& p) {
    return readVolume(context, Volume::irradiance, p.facets(), p.field(), p.lighting());
  };
  comparison.result =
      Comparison::Result{.picture = measure(linearPixels(context, b.targets), linearPixels(context, a.targets)),
                         .voxels = compareVoxels(irradiance(*b.pipeline), irradiance(*a.pipeline))};
}

std::vector<SettingDifference> differences(const Settings& a, const Settings& b) {
  std::vector<SettingDifference> out;
  const std::vector<SettingInfo> of = settingInfos(a), against = settingInfos(b);
  IRAD_CHECK_OP(of.size(), ==, against.size());
  for (size_t i = 0; i < of.size(); ++i)
    if (of[i].value != against[i].value) out.push_back({of[i].meta.name, of[i].value, against[i].value});
  return out;
}

}  // namespace irad
