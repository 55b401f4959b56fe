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

/// Bytes that the formulas give for the stages' resources, by resource name; memoryReport() predicts other images from
/// their extent and format. Units: s facets, V voxels (padding included), R rays, E matrix entries.
std::vector<std::pair<std::string, uint64_t>> predictMemory(const FacetList& facets, const Field& field,
                                                            const FormFactors& matrix, const Lighting& lighting);

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
