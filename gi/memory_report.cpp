#include "gi/memory_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "gi/facets.h"
#include "gi/field.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/subsystems.h"
#include "renderer/base/csv.h"
#include "shaders/shared/solve.h"

namespace irad {
namespace {

constexpr const char* kEntries = "matrix entries";

bool isSegment(const FormFactors& matrix, const std::string& name) {
  return std::any_of(matrix.segments.begin(), matrix.segments.end(), [&](const Buffer& b) { return b.name == name; });
}

}  // namespace

std::vector<std::pair<std::string, uint64_t>> predictMemory(const FacetList& facets, const Field& field,
                                                            const FormFactors& matrix, const Lighting& lighting) {
  const uint64_t s = facets.count, V = facets.grid.voxels;
  std::vector<std::pair<std::string, uint64_t>> out;
  const auto buffer = [&](const Buffer& b, uint64_t bytes) {
    if (b) out.emplace_back(b.name, bytes);
  };
  const auto image = [&](const Image& i, uint64_t bytes) {
    if (i) out.emplace_back(i.desc.name, bytes);
  };
  // Facet list: packed voxel, shape word, 3 x 16-bit albedo in 8 B, fp32 emission; reverse map one word per voxel;
  // faces around, winning triangle.
  buffer(facets.voxel, 4 * s);
  buffer(facets.shape, 4 * s);
  buffer(facets.albedo, 8 * s);
  if (facets.hasEmission) buffer(facets.emission, 12 * s);
  buffer(facets.reverse, 4 * V);
  buffer(facets.around, 4 * s);
  buffer(facets.triangle, 4 * s);
  buffer(facets.record, sizeof(FacetArrays));
  // Fields: one byte per voxel each; JFA seeds one word.
  buffer(field.chebyshev, (V + 3) / 4 * 4);
  image(field.jfaDistance, V);
  image(field.jfaSeeds, 4 * V);
  // csr: 4 B per distinct column. padded: 8 B for each of R places of a power of two of rows (T Fig. 7).
  const uint64_t capacity = std::bit_ceil(std::max<uint64_t>(1, matrix.rows));
  out.emplace_back(kEntries,
                   matrix.format == MatrixFormat::csr ? 4 * matrix.stats.entries : 8 * matrix.rays * capacity);
  buffer(matrix.rowStart, 4 * uint64_t{matrix.rows});
  buffer(matrix.rowInfo, 8 * uint64_t{matrix.rows});
  buffer(matrix.record, FormFactors::kSegmentTable + 8 * std::max<uint64_t>(1, matrix.segments.size()));
  // Light: one fp32 vec4 per facet in each array; the thesis's volume holds half-precision RGBA.
  for (const Buffer* b : {&lighting.direct, &lighting.emitted, &lighting.indirect, &lighting.radiosity,
                          &lighting.radiosityNext, &lighting.blurred, &lighting.blurredEmitted})
    buffer(*b, 16 * s);
  buffer(lighting.correction, 16 * s);
  buffer(lighting.rowSum, 4 * s);
  buffer(lighting.residual, sizeof(SolveResidual));
  buffer(lighting.blurChange, sizeof(uint32_t));
  image(lighting.volume, 8 * V);
  return out;
}

ThesisMemory thesisMemory(uint64_t voxels, uint64_t solidVoxels, uint64_t rays) {
  const uint64_t capacity = std::bit_ceil(std::max<uint64_t>(1, solidVoxels));
  ThesisMemory out{};
  out.volumes = 36 * voxels;                     // T eq. 29
  out.matrix = capacity * (84 + 8 * rays) + 16;  // T eq. 30
  out.total = out.volumes + out.matrix;          // T eq. 31
  return out;
}

std::vector<MemoryReportRow> memoryReport(const std::vector<MemoryRow>& measured, const FacetList& facets,
                                          const Field& field, const FormFactors& matrix, const Lighting& lighting) {
  const auto predictions = predictMemory(facets, field, matrix, lighting);
  const auto known = [&](const std::string& name) -> std::optional<uint64_t> {
    for (const auto& [resource, bytes] : predictions)
      if (resource == name) return bytes;
    return std::nullopt;
  };
  // What other images should take follows from their extent and format.
  const auto predicted = [&](const MemoryRow& row) {
    return row.texelBytes != 0 && !known(row.name) ? row.texelBytes : known(row.name);
  };

  using Kind = MemoryReportRow::Kind;
  std::vector<MemoryReportRow> rows;
  uint64_t entries = 0, total = 0, volumes = 0, matrixBytes = 0;
  std::vector<std::pair<SubsystemName, uint64_t>> subtotals;
  for (const MemoryRow& row : measured) {
    total += row.bytes;
    auto subtotal = std::find_if(subtotals.begin(), subtotals.end(), [&](auto& s) { return s.first == row.subsystem; });
    if (subtotal == subtotals.end()) subtotal = subtotals.insert(subtotals.end(), {row.subsystem, 0});
    subtotal->second += row.bytes;

    // T Table 1's two groups: textures over the grid (the reverse map among them), and the matrix with its vectors.
    const bool reverse = facets.reverse && row.name == facets.reverse.name;
    const auto isOf = [&](std::initializer_list<SubsystemName> group) {
      return std::find(group.begin(), group.end(), row.subsystem) != group.end();
    };
    if (isOf({Subsystem::Voxels, Subsystem::Field, Subsystem::Volumes})) volumes += row.bytes;
    if (isOf({Subsystem::Facets, Subsystem::Matrix, Subsystem::Solver})) (reverse ? volumes : matrixBytes) += row.bytes;

    if (row.subsystem == Subsystem::Matrix && isSegment(matrix, row.name))
      entries += row.bytes;
    else
      rows.push_back({row.name, row.subsystem.text, row.format, row.bytes, predicted(row)});
  }
  rows.insert(rows.begin(), {kEntries, Subsystem::Matrix.text, fmt::format("{} segments", matrix.segments.size()),
                             entries, known(kEntries)});

  for (const auto& [subsystem, bytes] : subtotals)
    rows.push_back({"subtotal", subsystem.text, "", bytes, std::nullopt, Kind::Subtotal});
  rows.push_back({"total", "all", "", total, std::nullopt, Kind::Sum});
  const ThesisMemory thesis = thesisMemory(facets.grid.voxels, facets.solidVoxels, matrix.rays);
  rows.push_back({"volumes (formula of the thesis)", "gi", "", volumes, thesis.volumes, Kind::Sum});
  rows.push_back({"matrix and list (formula of the thesis)", "gi", "", matrixBytes, thesis.matrix, Kind::Sum});
  rows.push_back({"all of gi (formula of the thesis)", "gi", "", volumes + matrixBytes, thesis.total, Kind::Sum});
  return rows;
}

std::string memoryCsv(const std::vector<MemoryReportRow>& rows) {
  std::string out = "name,subsystem,format,measured_bytes,predicted_bytes\n";
  const auto number = [](const std::optional<uint64_t>& bytes) {
    return bytes ? std::to_string(*bytes) : std::string();
  };
  for (const MemoryReportRow& row : rows)
    out += fmt::format("{},{},{},{},{}\n", csvField(row.name), csvField(row.subsystem), csvField(row.format),
                       number(row.measured), number(row.predicted));
  return out;
}

}  // namespace irad
