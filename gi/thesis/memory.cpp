#include "gi/thesis/memory.h"

#include <algorithm>
#include <bit>
#include <initializer_list>

#include "gi/facets.h"
#include "gi/matrix.h"
#include "gi/memory_report.h"
#include "gi/subsystems.h"

namespace irad {

ThesisMemory thesisMemory(uint64_t voxels, uint64_t solidVoxels, uint64_t rays) {
  const uint64_t capacity = std::bit_ceil(std::max<uint64_t>(1, solidVoxels));
  ThesisMemory out{};
  out.volumes = 36 * voxels;                     // T eq. 29
  out.matrix = capacity * (84 + 8 * rays) + 16;  // T eq. 30
  out.total = out.volumes + out.matrix;          // T eq. 31
  return out;
}

std::vector<MemoryReportRow> thesisMemoryRows(const std::vector<MemoryRow>& measured, const FacetList& facets,
                                              const FormFactors& matrix) {
  uint64_t volumes = 0, matrixBytes = 0;
  for (const MemoryRow& row : measured) {
    const bool reverse = facets.reverse && row.name == facets.reverse.name;
    const auto isOf = [&](std::initializer_list<SubsystemName> group) {
      return std::find(group.begin(), group.end(), row.subsystem) != group.end();
    };
    if (isOf({Subsystem::Voxels, Subsystem::Field, Subsystem::Volumes})) volumes += row.bytes;
    if (isOf({Subsystem::Facets, Subsystem::Matrix, Subsystem::Solver})) (reverse ? volumes : matrixBytes) += row.bytes;
  }
  const ThesisMemory thesis = thesisMemory(facets.grid.voxels, facets.solidVoxels, matrix.rays);
  constexpr auto kSum = MemoryReportRow::Kind::Sum;
  return {{"volumes (formula of the thesis)", "gi", "", volumes, thesis.volumes, kSum},
          {"matrix and list (formula of the thesis)", "gi", "", matrixBytes, thesis.matrix, kSum},
          {"all of gi (formula of the thesis)", "gi", "", volumes + matrixBytes, thesis.total, kSum}};
}

}  // namespace irad
