#include "gi/shadow_needs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "gi/settings.h"

namespace irad {

ShadowNeeds shadowNeeds(const Settings& settings) {
  return {.filter = settings.light.shadowFilter,
          .taps = settings.camera.gpu.pcf,
          .bleedReduction = settings.light.bleedReduction,
          .points = settings.light.points};
}

std::string describeWithoutShadow(std::span<const Light> lights, std::span<const uint32_t> without) {
  constexpr size_t most = 5;
  std::vector<std::string> names;
  for (const uint32_t i : without.first(std::min(without.size(), most)))
    names.push_back(lights[i].name.empty() ? fmt::format("light {}", i + 1) : lights[i].name);
  const size_t more = without.size() - names.size();
  return fmt::format(
      "{} of {} lights cast{} no shadow, and shine through walls: {}{}. The device has not the layers for more shadow "
      "maps; the strongest lights have them",
      without.size(), lights.size(), without.size() == 1 ? "s" : "", fmt::join(names, ", "),
      more > 0 ? fmt::format(" and {} more", more) : "");
}

}  // namespace irad
