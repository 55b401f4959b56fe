#include "renderer/base/number_text.h"

#include <fmt/format.h>

#include <cmath>

namespace irad {

std::string prettyUnit(std::string_view unit) {
  std::string text;
  for (size_t i = 0; i < unit.size(); ++i)
    if (unit.substr(i, 2) == "^2") {
      text += "\u00B2";
      ++i;
    } else {
      text += unit[i];
    }
  return text;
}

std::string milliseconds(double value) {
  return value < 10     ? fmt::format("{:.2f}", value)
         : value < 1000 ? fmt::format("{:.1f}", value)
                        : fmt::format("{:.0f}", value);
}

double inMebibytes(uint64_t bytes) {
  return static_cast<double>(bytes) / (1 << 20);
}

std::string mebibytes(uint64_t bytes) {
  const double value = inMebibytes(bytes);
  return value < 9.95 ? fmt::format("{:.2f} MiB", value) : fmt::format("{:.1f} MiB", value);
}

std::string shortNumber(double value) {
  return fmt::format("{:.3g}", value);
}

std::string withThousands(uint64_t value) {
  std::string digits = fmt::format("{}", value);
  for (auto i = static_cast<ptrdiff_t>(digits.size()) - 3; i > 0; i -= 3) digits.insert(static_cast<size_t>(i), 1, ',');
  return digits;
}

double unsignedZero(double value, int decimals) {
  return std::abs(value) < 0.5 * std::pow(10.0, -decimals) ? 0 : value;
}

}  // namespace irad
