#include "gi/shadow_needs.h"

#include "gi/settings.h"

namespace irad {

ShadowNeeds shadowNeeds(const Settings& settings) {
  return {.filter = settings.light.shadowFilter,
          .taps = settings.camera.gpu.pcf,
          .bleedReduction = settings.light.bleedReduction,
          .points = settings.light.points};
}

}  // namespace irad
