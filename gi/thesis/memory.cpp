#include "gi/thesis/memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <functional>

#include "gi/facets.h"
#include "gi/field.h"
#include "gi/lighting.h"
#include "gi/memory_report.h"
#include "gi/subsystems.h"
#include "renderer/base/number_text.h"

namespace irad {
namespace {

using Row = ThesisTable::Row;
using Group = ThesisTable::Group;
using IsHere = std::function<bool(const MemoryReportRow&)>;

/// A row, and which resources belong to it if they belong to none before it.
struct Line {
  Row row;
  IsHere isHere;
};

IsHere named(std::vector<std::string> names) {
  return [names = std::move(names)](const MemoryReportRow& resource) {
    return std::find(names.begin(), names.end(), resource.name) != names.end();
  };
}

IsHere of(std::vector<SubsystemName> subsystems) {
  return [subsystems = std::move(subsystems)](const MemoryReportRow& resource) {
    return std::any_of(subsystems.begin(), subsystems.end(),
                       [&](const SubsystemName& subsystem) { return resource.subsystem == subsystem.text; });
  };
}

const IsHere kNothing = [](const MemoryReportRow&) { return false; };

/// Adds to what a row has here; nothing but the first makes a prediction out of none.
void add(Row& row, std::optional<uint64_t> predicted, std::optional<uint64_t> measured) {
  if (!row.measured)
    row.predicted = predicted;
  else
    row.predicted = row.predicted && predicted ? std::optional(*row.predicted + *predicted) : std::nullopt;
  row.measured = row.measured.value_or(0) + measured.value_or(0);
}

Row sumOf(std::string buffer, std::string formula, const std::vector<Row>& rows) {
  Row sum{std::move(buffer), std::move(formula), std::nullopt};
  for (const Row& row : rows) {
    if (row.thesis) sum.thesis = sum.thesis.value_or(0) + *row.thesis;
    if (row.measured) add(sum, row.predicted, row.measured);
  }
  return sum;
}

bool take(std::vector<Line>& lines, const MemoryReportRow& resource) {
  const auto line = std::find_if(lines.begin(), lines.end(), [&](const Line& l) { return l.isHere(resource); });
  if (line == lines.end()) return false;
  line->row.here.push_back(resource.name);
  add(line->row, resource.predicted, resource.measured);
  return true;
}

/// Rows that neither side has anything for are left out.
std::vector<Row> rowsOf(const std::vector<Line>& lines) {
  std::vector<Row> rows;
  for (const Line& line : lines)
    if (line.row.thesis || line.row.measured) rows.push_back(line.row);
  return rows;
}

}  // namespace

uint64_t thesisCapacity(uint64_t solidVoxels) {
  return std::bit_ceil(std::max<uint64_t>(1, solidVoxels));
}

ThesisMemory thesisMemory(uint64_t voxels, uint64_t solidVoxels, uint64_t rays) {
  ThesisMemory out{};
  out.volumes = 36 * voxels;                                        // T eq. 29
  out.matrix = thesisCapacity(solidVoxels) * (84 + 8 * rays) + 16;  // T eq. 30
  out.total = out.volumes + out.matrix;                             // T eq. 31
  return out;
}

ThesisTable thesisTable(const std::vector<MemoryReportRow>& report, const FacetList& facets, const Field& field,
                        const Lighting& lighting, uint64_t rays) {
  const uint64_t V = facets.grid.voxels, M = thesisCapacity(facets.solidVoxels), R = rays;
  // The thesis's voxels hold what facets hold here. It floods jumps in two volumes; here one holds what comes of them.
  std::vector<Line> volumes{
      {{"voxelAlbedo", "4 V", 4 * V}, kNothing},
      {{"voxelRadiance", "8 V", 8 * V}, named({lighting.volume.image.desc.name})},
      {{"voxelRadiancePong", "8 V", 8 * V}, kNothing},
      {{"jfaScratch0", "4 V", 4 * V}, named({field.jumpFlood.seeds.desc.name})},
      {{"jfaWork0", "8 V", 8 * V}, named({field.jumpFlood.distance.desc.name, field.chebyshev.name})},
      {{"reverseMap", "4 V", 4 * V}, named({facets.reverse.name})},
      {{"(the grid, counters)", "", std::nullopt}, of({Subsystem::Voxels, Subsystem::Field, Subsystem::Volumes})},
  };
  // Its emissionBuf is what the lights give (T 5.7): D.
  std::vector<Line> matrix{
      {{"solidList", "32 M_s + 16", 32 * M + 16},
       named({facets.voxel.name, facets.shape.name, facets.albedo.name, facets.emission.name, facets.triangle.name,
              facets.area.name, facets.record.name})},
      {{"matrixHits", "8 R M_s", 8 * R * M}, named({kMatrixEntries})},
      {{"rowCounts", "4 M_s", 4 * M}, of({Subsystem::Matrix})},
      {{"radianceXBuf", "16 M_s", 16 * M}, named({lighting.radiosity.name})},
      {{"(its pair, in eq. 30 alone)", "16 M_s", 16 * M}, named({lighting.radiosityNext.name})},
      {{"emissionBuf", "16 M_s", 16 * M}, named({lighting.direct.name})},
      {{"(surface that rays meet)", "", std::nullopt}, of({Subsystem::Facets})},
      {{"(other light, solver)", "", std::nullopt}, of({Subsystem::Solver})},
  };
  ThesisTable table;
  table.others.name = "Others";
  for (const MemoryReportRow& resource : report) {
    if (resource.kind != MemoryReportRow::Kind::Resource || take(volumes, resource) || take(matrix, resource)) continue;
    std::vector<Row>& others = table.others.rows;
    auto row = std::find_if(others.begin(), others.end(), [&](const Row& r) { return r.buffer == resource.subsystem; });
    if (row == others.end()) row = others.insert(row, {resource.subsystem, "", std::nullopt});
    add(*row, resource.predicted, resource.measured);
  }
  table.volumes = {"Voxel volumes", rowsOf(volumes), {}};
  table.volumes.sum = sumOf("subtotal", "eq. 29: 36 V", table.volumes.rows);
  table.matrix = {"Matrix GI", rowsOf(matrix), {}};
  table.matrix.sum = sumOf("subtotal", "eq. 30: M_s (84 + 8 R) + 16", table.matrix.rows);
  table.total = sumOf("total", "eq. 31", {table.volumes.sum, table.matrix.sum});
  table.others.sum = sumOf("subtotal", "", table.others.rows);
  table.all = sumOf("total", "", {table.total, table.others.sum});
  table.all.thesis.reset();  // it has no figure for the others
  return table;
}

std::vector<MemoryReportRow> thesisMemoryRows(const ThesisTable& table) {
  constexpr auto kSum = MemoryReportRow::Kind::Sum;
  const auto measured = [](const Row& row) { return row.measured.value_or(0); };
  return {
      {"volumes (formula of the thesis)", "gi", "", measured(table.volumes.sum), table.volumes.sum.thesis, kSum},
      {"matrix and list (formula of the thesis)", "gi", "", measured(table.matrix.sum), table.matrix.sum.thesis, kSum},
      {"all of gi (formula of the thesis)", "gi", "", measured(table.total), table.total.thesis, kSum}};
}

std::vector<std::string> thesisMisprints() {
  // Its Sponza: N = 256, maxHitsPerRow = 384.
  constexpr uint64_t kVoxels = 256 * 107 * 157, kSolid = 441'511, kPrintedCapacity = 1 << 20, kRays = 384;
  // T Table 1, MiB. (It says MB.)
  constexpr double kWideTexture = 32.83, kVolumes = 147.72, kMatrix = 3140.00, kTotal = 3287.72;
  const ThesisMemory formula = thesisMemory(kVoxels, kPrintedCapacity, kRays),
                     defined = thesisMemory(kVoxels, kSolid, kRays);
  const double volumes = inMebibytes(formula.volumes), matrix = inMebibytes(formula.matrix),
               total = inMebibytes(formula.total), hits = inMebibytes(8 * kRays * kPrintedCapacity);
  return {
      fmt::format("Section 5.14 of the thesis speaks of seven textures; it names six, and eq. 29 counts six (3 x 8 + 3 "
                  "x 4 = 36 B)."),
      fmt::format("Table 1 has {:.2f} MiB for a texture of 8 B; 8 V is {:.2f}. Hence its volumes are {:.2f} MiB, "
                  "those of eq. 29 {:.2f}.",
                  kWideTexture, inMebibytes(8 * kVoxels), kVolumes, volumes),
      fmt::format("It speaks of six buffers of the matrix, and eq. 30 counts three vec4 arrays (84 = 32 + 4 + 3 x "
                  "16); Table 1 lists five with two: {:.2f} MiB instead of {:.2f}.",
                  kMatrix, matrix),
      fmt::format("It has eq. 31 \"yield\" {:.2f} MiB, the sum of Table 1; it yields {:.2f}, {:.2f} more.", kTotal,
                  total, total - kTotal),
      fmt::format("M_s is 2^20 there, but by its definition 2^{} for {} solid voxels: eq. 31 yields {:.2f} MiB.",
                  std::bit_width(thesisCapacity(kSolid)) - 1, kSolid, inMebibytes(defined.total)),
      fmt::format("97 % \"of total\" is the entries' share of eq. 30 ({:.1f} %); of eq. 31 they are {:.1f} %, and the "
                  "whole of eq. 30 is {:.1f} %.",
                  100 * hits / matrix, 100 * hits / total, 100 * matrix / total),
  };
}

}  // namespace irad
