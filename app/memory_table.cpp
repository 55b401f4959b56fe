#include "app/memory_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "renderer/base/number_text.h"

namespace irad::app {
namespace {

using Cells = std::vector<std::string>;
using BytesText = std::string (*)(uint64_t);

Cells cellsOf(const std::string& group, const ThesisTable::Row& row, BytesText text) {
  Cells cells{group, row.buffer, row.formula};
  for (const auto& bytes : {row.thesis, row.predicted, row.measured}) cells.push_back(bytes ? text(*bytes) : "");
  cells.push_back(fmt::format("{}", fmt::join(row.here, "; ")));
  return cells;
}

}  // namespace

std::string mebibyteNumber(uint64_t bytes) {
  return fmt::format("{:.3f}", inMebibytes(bytes));
}

std::string byteNumber(uint64_t bytes) {
  return std::to_string(bytes);
}

std::vector<Cells> memoryCells(const ThesisTable& table, const char* unit, BytesText text) {
  std::vector<Cells> cells{{"subsystem", "buffer", "formula"}};
  for (const char* column : {"thesis", "predicted", "measured"}) cells[0].push_back(fmt::format("{}_{}", column, unit));
  cells[0].emplace_back("here");
  const auto addGroup = [&](const ThesisTable::Group& group) {
    for (const ThesisTable::Row& row : group.rows) cells.push_back(cellsOf(group.name, row, text));
    cells.push_back(cellsOf(group.name, group.sum, text));
  };
  addGroup(table.volumes);
  addGroup(table.matrix);
  cells.push_back(cellsOf("GI", table.total, text));
  addGroup(table.others);
  cells.push_back(cellsOf("All", table.all, text));
  return cells;
}

}  // namespace irad::app
