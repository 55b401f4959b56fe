#include "gi/memory_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "gi/facets.h"
#include "gi/field.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/pipeline.h"
#include "gi/settings.h"
#include "gi/subsystems.h"
#include "gi/thesis/memory.h"
#include "gi/thesis/padded_rows.h"
#include "renderer/base/csv.h"
#include "shaders/shared/solve.h"
#include "shaders/shared/surface.h"

namespace irad {
namespace {

bool isSegment(const FormFactors& matrix, const std::string& name) {
  return std::any_of(matrix.segments.begin(), matrix.segments.end(), [&](const Buffer& b) { return b.name == name; });
}

}  // namespace

MemoryCounts memoryCounts(const FacetList& facets, const FormFactors& matrix) {
  return {facets.count, facets.grid.voxels, matrix.rows, matrix.rays, matrix.stats.entries};
}

std::vector<std::pair<std::string, uint64_t>> predictMemory(const FacetList& facets, const Field& field,
                                                            const FormFactors& matrix, const Lighting& lighting,
                                                            const MemoryCounts& counts) {
  const uint64_t s = counts.facets, V = counts.voxels;
  std::vector<std::pair<std::string, uint64_t>> out;
  const auto buffer = [&](const Buffer& b, uint64_t bytes) {
    if (b) out.emplace_back(b.name, bytes);
  };
  const auto image = [&](const Image& i, uint64_t bytes) {
    if (i) out.emplace_back(i.desc.name, bytes);
  };
  // Facet list: packed voxel, shape word, 3 x 16-bit albedo in 8 B, fp32 emission, area, with rule `thesis` a triangle;
  // reverse map one word per voxel. Of the true surface what there is per facet: surfels, masks of links, first piece.
  buffer(facets.voxel, 4 * s);
  buffer(facets.shape, 4 * s);
  buffer(facets.albedo, 8 * s);
  buffer(facets.emission, facets.hasEmission ? 12 * s : 0);
  buffer(facets.reverse, 4 * V);
  buffer(facets.triangle, 4 * s);
  buffer(facets.area, 4 * s);
  buffer(facets.surface.surfels, 4 * SURFEL_WORDS * s);
  buffer(facets.surface.linkMasks, 4 * s);
  buffer(facets.surface.firstLinks, 4 * (s + 1));
  buffer(facets.surface.firstPiece, 4 * (s + 1));
  // Nothing but these arrays knows how many triangles, pieces, cuts and links there are: what was asked for, as many
  // per facet where those are more or fewer.
  for (const Buffer* b :
       {&facets.surface.corners, &facets.surface.pieces, &facets.surface.boxes, &facets.surface.groups,
        &facets.surface.sides, &facets.surface.cuts, &facets.surface.wideSides, &facets.surface.links})
    buffer(*b, s == facets.count || facets.count == 0 ? b->bytes : b->bytes * s / facets.count);
  buffer(facets.surface.record, sizeof(SurfaceArrays));
  buffer(facets.record, sizeof(FacetArrays));
  out.emplace_back("Grid", sizeof(Grid));  // the pipeline's
  // Fields: one byte per voxel each; JFA seeds one word.
  buffer(field.chebyshev, (V + 3) / 4 * 4);
  image(field.jumpFlood.distance, V);
  image(field.jumpFlood.seeds, 4 * V);
  // csr: 4 B per distinct column. Padded rows have no starts.
  out.emplace_back(kMatrixEntries,
                   matrix.format == MatrixFormat::csr ? 4 * counts.entries : paddedBytes(counts.rows, counts.rays));
  buffer(matrix.rowStart, matrix.format == MatrixFormat::csr ? 4 * counts.rows : 0);
  buffer(matrix.rowInfo, 8 * counts.rows);
  buffer(matrix.rowSky, 4 * counts.rows);
  buffer(matrix.record, FormFactors::kSegmentTable + 8 * std::max<uint64_t>(1, matrix.segments.size()));
  // Light: one fp32 vec4 per facet in each array; the thesis's volume holds half-precision RGBA.
  for (const Buffer* b : {&lighting.direct, &lighting.emitted, &lighting.indirect, &lighting.radiosity,
                          &lighting.radiosityNext, &lighting.blurred, &lighting.blurredEmitted})
    buffer(*b, 16 * s);
  for (const Buffer& b : lighting.history) buffer(b, 16 * s);
  const FrameMean& frames = lighting.frameMean;
  for (const Buffer* b : {&frames.next, &frames.standardError, &frames.held, &frames.heldEmitted}) buffer(*b, 16 * s);
  buffer(lighting.frameMean.hits, lighting.frameMean.hits.bytes);  // a chunk's size is the device's
  buffer(lighting.sums,
         sizeof(glm::vec4) * SOLVE_SUMS *
             std::min<uint64_t>((s + SOLVE_SUMS_FACETS - 1) / SOLVE_SUMS_FACETS, SOLVE_SUMS_INVOCATIONS));
  buffer(lighting.correction, 16 * s);
  buffer(lighting.sky, 16 * s);
  const Writeback& written = lighting.writeback;
  buffer(written.used, 16 * s);
  buffer(written.drawn, 16 * s);
  buffer(written.pixels, 4 * s);
  buffer(written.writers, 4 * s);
  buffer(written.sums, 12 * WRITEBACK_PARTS * s);
  buffer(written.counts, sizeof(WritebackCounts));
  buffer(lighting.rowSum, 4 * s);
  buffer(lighting.residual, sizeof(SolveResidual) * SOLVE_RESIDUALS);
  buffer(lighting.blurChange, sizeof(uint32_t));
  image(lighting.volume.image, 8 * V);
  buffer(lighting.volume.clamped, sizeof(uint32_t));
  return out;
}

std::vector<MemoryReportRow> memoryReport(const std::vector<MemoryRow>& measured, const FacetList& facets,
                                          const Field& field, const FormFactors& matrix, const Lighting& lighting,
                                          uint64_t rays) {
  const auto predictions = predictMemory(facets, field, matrix, lighting, memoryCounts(facets, matrix));
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
  uint64_t entries = 0, total = 0;
  std::vector<std::pair<SubsystemName, uint64_t>> subtotals;
  for (const MemoryRow& row : measured) {
    total += row.bytes;
    auto subtotal = std::find_if(subtotals.begin(), subtotals.end(), [&](auto& s) { return s.first == row.subsystem; });
    if (subtotal == subtotals.end()) subtotal = subtotals.insert(subtotals.end(), {row.subsystem, 0});
    subtotal->second += row.bytes;

    if (row.subsystem == Subsystem::Matrix && isSegment(matrix, row.name))
      entries += row.bytes;
    else
      rows.push_back({row.name, row.subsystem.text, row.format, row.bytes, predicted(row)});
  }
  rows.insert(rows.begin(), {kMatrixEntries, Subsystem::Matrix.text, fmt::format("{} segments", matrix.segments.size()),
                             entries, known(kMatrixEntries)});

  const ThesisTable thesis = thesisTable(rows, facets, field, lighting, rays);
  for (const auto& [subsystem, bytes] : subtotals)
    rows.push_back({"subtotal", subsystem.text, "", bytes, std::nullopt, Kind::Subtotal});
  rows.push_back({"total", "all", "", total, std::nullopt, Kind::Sum});
  std::ranges::copy(thesisMemoryRows(thesis), std::back_inserter(rows));
  return rows;
}

std::vector<MemoryReportRow> memoryReport(const std::vector<MemoryRow>& measured, const Pipeline& p) {
  return memoryReport(measured, p.facets(), p.field(), p.matrix(), p.lighting(), p.settings().matrix.gpu.rays);
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
