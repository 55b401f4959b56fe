#include "renderer/scene/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace irad {
namespace {

/// In double precision, so that the float it is rounded to is the same everywhere.
double decode(double s) {
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

struct Tables {
  std::array<float, 256> linear;
  std::array<float, 257> from;  ///< the least light of each code; the last is beyond all of them
  /// The code of light i / kSteps, from which to look upwards: codes are 1.2 steps apart at least.
  static constexpr int kSteps = 4096;
  std::array<uint8_t, kSteps + 1> start;

  Tables() {
    for (int code = 0; code < 256; ++code) {
      linear[code] = static_cast<float>(decode(code / 255.0));
      from[code] = static_cast<float>(decode((code - 0.5) / 255.0));
    }
    from[0] = 0.0f;
    from[256] = 2.0f;
    uint8_t code = 0;
    for (int i = 0; i <= kSteps; ++i) {
      while (static_cast<float>(i) / kSteps >= from[code + 1]) ++code;
      start[i] = code;
    }
  }
};

const Tables& tables() {
  static const Tables made;
  return made;
}

}  // namespace

float linearFromSrgb(uint8_t code) {
  return tables().linear[code];
}

uint8_t srgbFromLinear(float light) {
  const Tables& t = tables();
  const float bounded = std::clamp(light, 0.0f, 1.0f);
  uint8_t code = t.start[static_cast<int>(bounded * Tables::kSteps)];
  while (bounded >= t.from[code + 1]) ++code;
  return code;
}

}  // namespace irad
