#include "app/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "renderer/base/csv.h"

namespace irad::app {
namespace {

/// Characters of UTF-8 text: bytes that do not continue one.
size_t width(const std::string& text) {
  return static_cast<size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

std::string formatTable(const std::vector<std::vector<std::string>>& rows, const std::vector<bool>& numeric) {
  std::vector<size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
  }
  std::string out;
  for (const auto& row : rows) {
    std::string line;
    for (size_t i = 0; i < row.size(); ++i) {
      const std::string space(widths[i] - width(row[i]), ' ');
      line += i < numeric.size() && numeric[i] ? space + row[i] : row[i] + space;
      line += "  ";
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

std::string csvTable(const std::vector<std::vector<std::string>>& rows) {
  std::string out;
  for (std::vector<std::string> row : rows) {
    std::ranges::transform(row, row.begin(), csvField);
    out += fmt::format("{}\n", fmt::join(row, ","));
  }
  return out;
}

std::string markdownTable(std::vector<std::vector<std::string>> rows) {
  rows.insert(rows.begin() + 1, std::vector<std::string>(rows.at(0).size(), "---"));
  std::string out;
  for (const auto& row : rows) out += fmt::format("| {} |\n", fmt::join(row, " | "));
  return out;
}

}  // namespace irad::app
