// When emissive facets are low-probability, high-energy (docs/method.md 5, T 5.6), so that samples of them stand in for
// the rays that find them.
#pragma once

#include <cstdint>

namespace irad {

/// The power per area of such emitters is at least ten times the mean.
inline bool emittersAreFew(uint32_t emitters, uint32_t facets) {
  return emitters > 0 && emitters < facets / 10;
}
/// By what share the sums of F M by samples and by rays may differ, beside their statistical error.
inline constexpr float kEmitterAgreement = 0.05f;

}  // namespace irad
