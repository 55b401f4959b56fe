#include "ui/words.h"

#include <fmt/format.h>

#include <cstdio>

#include "renderer/base/number_text.h"

namespace irad {

std::string withDigits(double value, int digits) {
  if (value == 0) return "0";
  char buffer[48];  // fmt's '#' makes "100.0" of 100
  std::snprintf(buffer, sizeof buffer, "%#.*g", digits, value);
  std::string text(buffer);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string counted(uint64_t n, const char* one, const char* many) {
  if (n == 1) return fmt::format("1 {}", one);
  return many ? fmt::format("{} {}", withThousands(n), many) : fmt::format("{} {}s", withThousands(n), one);
}

std::string percentText(double share, int decimals, bool plus) {
  const double percent = unsignedZero(100 * share, decimals);
  return plus && percent > 0 ? fmt::format("{:+.{}f} %", percent, decimals)
                             : fmt::format("{:.{}f} %", percent, decimals);
}

}  // namespace irad
