#include "ui/no_light.h"

namespace irad {

std::vector<std::string> noLight(const EffectPlan& plan) {
  std::vector<std::string> lines;
  for (const Effect kind : {Effect::sun, Effect::point, Effect::spot, Effect::emission}) {
    if (plan.on(kind)) return {};
    lines.push_back(plan.row(kind).reason);
  }
  return lines;
}

}  // namespace irad
