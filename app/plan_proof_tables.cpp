// The proof as text tables, Markdown and CSV.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/plan_proof.h"
#include "app/table.h"
#include "gi/plan.h"
#include "renderer/base/csv.h"

namespace irad::app {
namespace {

using Cells = std::vector<std::string>;

std::string mebibytes(const EffectRow& row, int decimals) {
  return fmt::format("{:.{}f}", static_cast<double>(row.bytesNotAllocated) / (1 << 20), decimals);
}

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
                         effect->bytesNotAllocated > 0 ? mebibytes(*effect, 2) : "-"});
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
  std::string out =
      "scene,effect,state,reason,skip,epsilon,pixels_different,largest_difference,mean_difference,allowed_difference,"
      "not_proven,mib_not_allocated";
  for (const Figure& figure : kFigures) out += fmt::format(",{}", figure.column);
  out += '\n';
  // Cells that do not apply to a row are empty.
  for (const ProofRow& row : proof) {
    Cells cells{row.scene, row.name};
    cells.resize(12);
    if (const auto& e = row.effect) {
      std::ranges::copy(Cells{e->stateName(), e->reason, e->skipName()}, &cells[2]);
      if (e->threshold) cells[5] = fmt::format("{}", e->epsilon);
      cells[10] = row.reason;
      cells[11] = mebibytes(*e, 3);
    }
    if (const auto& d = row.difference) {
      cells[6] = fmt::format("{}", d->pixels);
      cells[7] = fmt::format("{}", d->largest);
      cells[8] = fmt::format("{}", d->mean);
      cells[9] = fmt::format("{}", d->allowed);
    }
    for (size_t i = 0; i < std::size(kFigures); ++i)
      cells.push_back(i < row.figures.size() && row.figures[i]
                          ? fmt::format("{:.{}f}", *row.figures[i], kFigures[i].csvDecimals)
                          : "");
    for (std::string& cell : cells) cell = csvField(cell);
    out += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return out;
}

}  // namespace irad::app
