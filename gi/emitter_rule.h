// When emissive facets are low-probability, high-energy (METHOD section 5, T 5.6), so that samples of them stand in for
// the rays that find them.
#pragma once

#include <cstdint>

namespace irad {

/// Their power per area is then at least ten times the mean.
inline bool emittersAreFew(uint32_t emitters, uint32_t facets) {
  return emitters > 0 && emitters < facets / 10;
}
/// By how much the sums of F M by samples and by rays may differ, statistics apart, as a share.
inline constexpr float kEmitterAgreement = 0.05f;

}  // namespace irad
