// The proof as text tables, Markdown and CSV.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/plan_proof.h"
#include "app/table.h"
#include "renderer/base/csv.h"
#include "renderer/base/number_text.h"

namespace irad::app {
namespace {

using Cells = std::vector<std::string>;

/// The first `words` columns to the left, the others, numbers, to the right.
std::string table(const std::vector<Cells>& rows, size_t words, bool markdown) {
  std::vector<bool> numeric(words, false);
  numeric.resize(rows[0].size(), true);
  if (!markdown) return formatTable(rows, numeric);
  std::string out;
  for (const Cells& row : rows) {
    out += fmt::format("| {} |\n", fmt::join(row, " | "));
    if (&row == &rows.front()) out += fmt::format("|{}\n", fmt::join(Cells(row.size(), "---|"), ""));
  }
  return out;
}

}  // namespace

std::string proofTables(const Proof& proof, bool markdown) {
  std::vector<Cells> cost{{"scene", "effects", "difference"}}, energy{{"scene", "effects"}},
      effects{{"scene", "not on", "state", "skip", "difference when done", "MiB not allocated"}};
  const auto tableOf = [&](size_t figure) -> auto& {
    return figure < kCostFigures ? cost : energy;
  };
  for (size_t i = 0; i < std::size(kFigures); ++i) tableOf(i)[0].push_back(kFigures[i].heading);
  for (const ProofRow& row : proof) {
    std::string difference = row.difference ? row.difference->text() : "";
    if (const auto& effect = row.effect) {
      if (!row.difference) difference = "not done: " + row.reason;
      effects.push_back({row.scene, row.name, effect->stateName(), effect->skipName(), difference,
                         mebibyteCell(effect->bytesNotAllocated)});
      continue;
    }
    cost.push_back({row.scene, row.name, difference});
    energy.push_back({row.scene, row.name});
    for (size_t i = 0; i < row.figures.size(); ++i)
      tableOf(i).back().push_back(row.figures[i] ? fmt::format("{:.{}f}", *row.figures[i], kFigures[i].decimals) : "-");
  }
  return table(cost, 3, markdown) + "\n" + table(energy, 2, markdown) + "\n" + table(effects, 5, markdown);
}

std::string proofCsv(const Proof& proof) {
  std::string header, lines;
  for (const ProofRow& row : proof) {
    Cells columns, cells;  // those that do not apply to a row are empty
    const auto cell = [&](const char* column, bool applies, const auto& value) {
      columns.push_back(column);
      cells.push_back(applies ? csvField(fmt::format("{}", value)) : "");
    };
    const bool isEffect = row.effect.has_value(), compared = row.difference.has_value();
    const EffectRow effect = row.effect.value_or(EffectRow{});
    const PictureDifference difference = row.difference.value_or(PictureDifference{});
    cell("scene", true, row.scene);
    cell("effect", true, row.name);
    cell("state", isEffect, effect.stateName());
    cell("reason", isEffect, effect.reason);
    cell("skip", isEffect, effect.skipName());
    cell("epsilon", effect.threshold, effect.epsilon);
    cell("pixels_different", compared, difference.pixels);
    cell("largest_difference", compared, difference.largest);
    cell("mean_difference", compared, difference.mean);
    cell("allowed_difference", compared, difference.allowed);
    cell("not_proven", true, row.reason);
    cell("mib_not_allocated", isEffect, fmt::format("{:.3f}", inMebibytes(effect.bytesNotAllocated)));
    for (size_t i = 0; i < std::size(kFigures); ++i) {
      const auto figure = i < row.figures.size() ? row.figures[i] : std::nullopt;
      cell(kFigures[i].column, figure.has_value(), fmt::format("{:.{}f}", figure.value_or(0), kFigures[i].csvDecimals));
    }
    header = fmt::format("{}\n", fmt::join(columns, ","));
    lines += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return header + lines;
}

}  // namespace irad::app
