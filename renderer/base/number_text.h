// Numbers and units for the eye: panels and legends.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace irad {

/// A unit as registries spell it, for the eye: "W/m^2" becomes "W/m²".
std::string prettyUnit(std::string_view unit);
std::string milliseconds(double value);  ///< "0.12", "12.3", "1234"
double inMebibytes(uint64_t bytes);
std::string mebibytes(uint64_t bytes);  ///< "0.12 MiB", "12.3 MiB"
/// 3 significant digits, exponent where needed: "0.0123", "1.2e-06".
std::string shortNumber(double value);
std::string withThousands(uint64_t value);
/// 0 for what is printed as zero with so many decimals, so that it has no sign: no "-0.00".
double unsignedZero(double value, int decimals);

}  // namespace irad
