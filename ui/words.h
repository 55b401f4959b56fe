// Counts and shares in words: "1 sweep", "2 sweeps"; never "-0.00 %".
#pragma once

#include <cstdint>
#include <string>

namespace irad {

/// "1 sweep", "12,000 sweeps"; `many` where it is not `one` with an s.
std::string counted(uint64_t n, const char* one, const char* many = nullptr);
/// A share in percent with so many decimals; what rounds to zero has no sign. `plus`: with a sign where it is positive.
std::string percentText(double share, int decimals, bool plus = false);

}  // namespace irad
