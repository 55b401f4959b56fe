// Counts and shares in words: "1 sweep", "2 sweeps"; never "-0.00 %".
#pragma once

#include <cstdint>
#include <string>

namespace irad {

/// So many significant digits, also where the last are 0, so that read-outs below each other are of one width:
/// "0.0360", "1.70", "100", "1.20e-06"; but "0". Of ticks and prose: shortNumber().
std::string withDigits(double value, int digits = 3);

/// "1 sweep", "12,000 sweeps"; `many` where it is not `one` with an s.
std::string counted(uint64_t n, const char* one, const char* many = nullptr);
/// A share in percent with so many decimals; what rounds to zero has no sign. `plus`: with a sign where it is positive.
std::string percentText(double share, int decimals, bool plus = false);

}  // namespace irad
