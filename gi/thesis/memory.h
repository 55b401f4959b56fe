// What the thesis says that the same grid takes, beside what it takes here (docs/method.md 10).
#pragma once

#include <cstdint>
#include <vector>

namespace irad {

struct FacetList;
struct FormFactors;
struct MemoryReportRow;
struct MemoryRow;

/// T eq. 29-31, bytes: volumes of V voxels, matrix of a capacity M_s (the power of two at or above the solid voxels)
/// with R entries per row.
struct ThesisMemory {
  uint64_t volumes, matrix, total;
};
ThesisMemory thesisMemory(uint64_t voxels, uint64_t solidVoxels, uint64_t rays);
/// Its sums beside those of the resources in T Table 1's two groups: textures over the grid (the reverse map among
/// them), and the matrix with its vectors.
std::vector<MemoryReportRow> thesisMemoryRows(const std::vector<MemoryRow>& measured, const FacetList& facets,
                                              const FormFactors& matrix);

}  // namespace irad
