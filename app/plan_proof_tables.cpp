// The proof as text tables, Markdown and CSV.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/plan_proof.h"
#include "app/table.h"
#include "renderer/csv.h"

namespace irad::app {
namespace {

using Cells = std::vector<std::string>;

constexpr const char* kForced = "all forced on";
constexpr const char* kPlanned = "as planned";
constexpr std::array kMoves{"idle", "camera", "light"};

std::string fixed(double value, int digits) {
  return fmt::format("{:.{}f}", value, digits);
}
std::string mebibytes(uint64_t bytes, int digits) {
  return fixed(static_cast<double>(bytes) / (1 << 20), digits);
}
std::string stateName(const EffectRow& row) {
  return EnumNames<EffectState>::names.at(static_cast<size_t>(row.state));
}
std::string skipName(const EffectRow& row) {
  return EnumNames<Skip>::names.at(static_cast<size_t>(row.skip));
}

std::vector<Cells> costRows(const std::vector<SceneProof>& proofs) {
  std::vector<Cells> rows{{"scene", "effects", "difference", "rebuild ms", "relight ms", "frame ms", "MiB",
                           "dispatches", "draws", "instructions"}};
  for (const SceneProof& p : proofs) {
    const auto add = [&](const char* effects, const std::string& difference, const EffectsCost& c) {
      rows.push_back({p.scene, effects, difference, fixed(c.rebuildMs, 2), fixed(c.relightMs, 2), fixed(c.frameMs, 2),
                      mebibytes(c.bytes, 1), std::to_string(c.dispatches), std::to_string(c.draws),
                      std::to_string(c.instructions)});
    };
    add(kForced, describe(p.all), p.forced);
    add(kPlanned, "", p.planned);
  }
  return rows;
}

std::vector<Cells> energyRows(const std::vector<SceneProof>& proofs) {
  std::vector<Cells> rows{{"scene", "effects"}};
  for (const char* move : kMoves)
    for (const char* what : {"ms/s", "dispatches/s", "draws/s"}) rows[0].push_back(fmt::format("{} {}", move, what));
  for (const SceneProof& p : proofs)
    for (const auto& [effects, cost] : {std::pair{kForced, &p.forced}, std::pair{kPlanned, &p.planned}}) {
      Cells& row = rows.emplace_back(Cells{p.scene, effects});
      for (const std::optional<Energy>& e : cost->energy) {
        row.push_back(e ? fixed(e->gpuMs, 2) : "-");
        row.push_back(e ? fixed(e->dispatches, 0) : "-");
        row.push_back(e ? fixed(e->draws, 0) : "-");
      }
    }
  return rows;
}

std::vector<Cells> effectRows(const std::vector<SceneProof>& proofs) {
  std::vector<Cells> rows{{"scene", "not on", "state", "skip", "difference when done", "MiB not allocated"}};
  for (const SceneProof& p : proofs)
    for (const EffectProof& e : p.effects)
      rows.push_back({p.scene, effectInfo(e.row.effect).name, stateName(e.row), skipName(e.row),
                      e.difference ? describe(*e.difference) : fmt::format("not done: {}", e.reason),
                      e.row.bytesNotAllocated > 0 ? mebibytes(e.row.bytesNotAllocated, 2) : "-"});
  return rows;
}

std::string textTable(const std::vector<Cells>& rows, size_t words, size_t numbers) {
  std::vector<bool> numeric(rows[0].size(), false);
  std::fill_n(numeric.begin() + static_cast<ptrdiff_t>(words), numbers, true);
  return formatTable(rows, numeric);
}

std::string markdown(const std::vector<Cells>& rows) {
  std::string out;
  for (const Cells& row : rows) {
    out += fmt::format("| {} |\n", fmt::join(row, " | "));
    if (&row == &rows.front()) {
      out += '|';
      for (size_t c = 0; c < row.size(); ++c) out += "---|";
      out += '\n';
    }
  }
  return out;
}

/// Columns of the CSV; what a row has nothing of is empty.
constexpr const char* kColumns =
    "scene,effect,state,reason,skip,epsilon,pixels_different,largest_difference,mean_difference,allowed_difference,"
    "not_proven,mib_not_allocated,rebuild_ms,relight_ms,frame_ms,mib,dispatches,draws,instructions,"
    "idle_ms_per_s,idle_dispatches_per_s,idle_draws_per_s,camera_ms_per_s,camera_dispatches_per_s,camera_draws_per_s,"
    "light_ms_per_s,light_dispatches_per_s,light_draws_per_s";

/// pixels_different to allowed_difference.
Cells differenceCells(const std::optional<PictureDifference>& d) {
  if (!d) return Cells(4);
  return {std::to_string(d->pixels), fmt::format("{}", d->largest), fmt::format("{}", d->mean),
          fmt::format("{}", d->allowed)};
}

Cells setCells(const std::string& scene, const char* effects, const std::optional<PictureDifference>& difference,
               const EffectsCost& c) {
  Cells row{scene, effects, "", "", "", ""};
  const auto append = [&](const Cells& cells) { row.insert(row.end(), cells.begin(), cells.end()); };
  append(differenceCells(difference));
  append({"", "", fixed(c.rebuildMs, 4), fixed(c.relightMs, 4), fixed(c.frameMs, 4), mebibytes(c.bytes, 3),
          std::to_string(c.dispatches), std::to_string(c.draws), std::to_string(c.instructions)});
  for (const std::optional<Energy>& e : c.energy)
    append(e ? Cells{fixed(e->gpuMs, 3), fixed(e->dispatches, 1), fixed(e->draws, 1)} : Cells(3));
  return row;
}

Cells effectCells(const std::string& scene, const EffectProof& e) {
  Cells row{scene,
            effectInfo(e.row.effect).name,
            stateName(e.row),
            e.row.reason,
            skipName(e.row),
            e.row.skip == Skip::threshold ? fmt::format("{}", e.row.epsilon) : ""};
  const Cells difference = differenceCells(e.difference);
  row.insert(row.end(), difference.begin(), difference.end());
  row.push_back(e.reason);
  row.push_back(mebibytes(e.row.bytesNotAllocated, 3));
  row.resize(csvFields(kColumns).size());
  return row;
}

std::string csvLine(Cells cells) {
  for (std::string& cell : cells) cell = csvField(cell);
  return fmt::format("{}\n", fmt::join(cells, ","));
}

}  // namespace

std::string proofTable(const std::vector<SceneProof>& proofs) {
  return textTable(costRows(proofs), 3, 7) + "\n" + textTable(energyRows(proofs), 2, 9) + "\n" +
         textTable(effectRows(proofs), 5, 1);
}

std::string proofMarkdown(const std::vector<SceneProof>& proofs) {
  return markdown(costRows(proofs)) + "\n" + markdown(energyRows(proofs)) + "\n" + markdown(effectRows(proofs));
}

std::string proofCsv(const std::vector<SceneProof>& proofs) {
  std::string out = fmt::format("{}\n", kColumns);
  for (const SceneProof& p : proofs) {
    out += csvLine(setCells(p.scene, kForced, p.all, p.forced));
    out += csvLine(setCells(p.scene, kPlanned, {}, p.planned));
    for (const EffectProof& e : p.effects) out += csvLine(effectCells(p.scene, e));
  }
  return out;
}

}  // namespace irad::app
