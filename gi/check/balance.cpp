#include "gi/check/balance.h"

#include "gi/lighting.h"

namespace irad {

EnergyShares energyShares(const CheckRun& run, const Pipeline& pipeline) {
  const HostFacets facets = run.facets(pipeline);
  const Lighting& light = pipeline.lighting();
  const std::vector<glm::vec3> d = run.read(pipeline, light.direct), h = run.read(pipeline, light.indirect),
                               b = run.read(pipeline, light.radiosity);
  const std::vector<glm::vec3> s = light.sky ? run.read(pipeline, light.sky) : std::vector<glm::vec3>(facets.count());
  double in = 0, absorbed = 0, escaped = 0;
  forEachRow(run.context, pipeline.matrix(), [&](uint32_t i, const HostRow& row) {
    const double area = facets.area[i];
    in += area * (double{facets.emission[i].x} + double{d[i].x} + double{s[i].x});
    absorbed += area * (1 - double{facets.albedo[i].x}) * (double{d[i].x} + double{h[i].x});
    escaped += area * double{b[i].x} * (1 - row.sum());
  });
  return {.accounted = (absorbed + escaped) / in, .escaped = escaped / in};
}

}  // namespace irad
