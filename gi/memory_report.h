// docs/method.md 10: every resource's size as the allocator measured it, beside what its formula predicts, per
// subsystem; and T eq. 29-31 for the same grid.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace irad {

struct FacetList;
struct Field;
struct FormFactors;
struct Lighting;
struct MemoryRow;
class Pipeline;

struct MemoryReportRow {
  std::string name, subsystem, format;
  std::optional<uint64_t> measured, predicted;  ///< bytes
  enum class Kind { Resource, Subtotal, Sum } kind = Kind::Resource;
};

/// The matrix's segments, as one resource.
inline constexpr const char* kMatrixEntries = "matrix entries";

/// What the formulas count.
struct MemoryCounts {
  uint64_t facets = 0, voxels = 0;           ///< s; V, padding included
  uint64_t rows = 0, rays = 0, entries = 0;  ///< of the matrix; 0 where there is none
};
MemoryCounts memoryCounts(const FacetList& facets, const FormFactors& matrix);

/// Bytes that the formulas give for the stages' resources, by resource name; memoryReport() predicts other images from
/// their extent and format. `counts`: of these products, or of others like them, of another size.
std::vector<std::pair<std::string, uint64_t>> predictMemory(const FacetList& facets, const Field& field,
                                                            const FormFactors& matrix, const Lighting& lighting,
                                                            const MemoryCounts& counts);

/// Resources (the matrix's segments as one row), subtotals per subsystem, the total, and T eq. 29-31 beside what the GI
/// subsystems take, for R = `rays` (the setting: without light there is no matrix).
std::vector<MemoryReportRow> memoryReport(const std::vector<MemoryRow>& measured, const FacetList& facets,
                                          const Field& field, const FormFactors& matrix, const Lighting& lighting,
                                          uint64_t rays);
/// The same of what a pipeline has built.
std::vector<MemoryReportRow> memoryReport(const std::vector<MemoryRow>& measured, const Pipeline& pipeline);

/// name,subsystem,format,measured_bytes,predicted_bytes
std::string memoryCsv(const std::vector<MemoryReportRow>& rows);

}  // namespace irad
