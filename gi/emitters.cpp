// The table of emissive facets: specular rays and the samples of the first gather are sent to them.
#include "gi/emitters.h"

#include <algorithm>
#include <numeric>

#include "gi/facets.h"
#include "gi/subsystems.h"
#include "renderer/frame/record.h"
#include "shaders/shared/emitters.h"

namespace irad {

std::vector<Emitter> makeAliasTable(const std::vector<uint32_t>& facets, const std::vector<double>& powers) {
  // Vose 1991: entries poorer than the mean are filled up by richer ones.
  const double mean = std::accumulate(powers.begin(), powers.end(), 0.0) / static_cast<double>(powers.size());
  std::vector<Emitter> table(facets.size());
  std::vector<double> share(facets.size());
  std::vector<uint32_t> poor, rich;
  for (uint32_t i = 0; i < facets.size(); ++i) {
    table[i] = {facets[i], facets[i], 1.0f};
    share[i] = powers[i] / mean;
    (share[i] < 1.0 ? poor : rich).push_back(i);
  }
  while (!poor.empty() && !rich.empty()) {
    const uint32_t low = poor.back(), high = rich.back();
    poor.pop_back();
    table[low].other = facets[high];
    table[low].keep = static_cast<float>(share[low]);
    share[high] -= 1.0 - share[low];
    if (share[high] < 1.0) {
      rich.pop_back();
      poor.push_back(high);
    }
  }
  return table;
}

Emitters listEmitters(Context& context, const FacetList& list) {
  Emitters emitters;
  if (!list.hasEmission || list.count == 0) return emitters;
  const std::vector<float> areas = downloadAs<float>(context, list.area);
  const std::vector<glm::vec3> emission = downloadAs<glm::vec3>(context, list.emission);
  std::vector<uint32_t> facets;
  std::vector<double> powers;
  for (uint32_t i = 0; i < list.count; ++i) {
    const float exitance = luminance(emission[i]);
    if (!(exitance > 0)) continue;
    emitters.brightest = std::max(emitters.brightest, exitance);
    facets.push_back(i);
    powers.push_back(static_cast<double>(exitance) * areas[i]);
  }
  if (facets.empty()) return emitters;

  const std::vector<Emitter> table = makeAliasTable(facets, powers);
  emitters.count = static_cast<uint32_t>(table.size());
  emitters.entries = makeBuffer(context, "emitters", Subsystem::Specular, std::span<const Emitter>(table));
  RecordMaker maker(context, "emitter table", Subsystem::Specular, sizeof(EmitterTable));
  EmitterTable record{};
  record.entries = maker.of(emitters.entries);
  record.count = emitters.count;
  record.power = emitters.power = static_cast<float>(std::accumulate(powers.begin(), powers.end(), 0.0));
  emitters.record = maker.make(record);
  return emitters;
}

}  // namespace irad
