// What the thesis says that the same grid takes, beside what it takes here (docs/method.md 10).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace irad {

struct FacetList;
struct Field;
struct Lighting;
struct MemoryReportRow;

/// M_s: the power of two at or above the number of solid voxels.
uint64_t thesisCapacity(uint64_t solidVoxels);

/// T eq. 29-31, bytes: volumes of V voxels, matrix of a capacity M_s with R entries per row.
struct ThesisMemory {
  uint64_t volumes, matrix, total;
};
ThesisMemory thesisMemory(uint64_t voxels, uint64_t solidVoxels, uint64_t rays);

/// T Table 1 for another grid, and what is here in the place of each of its buffers.
struct ThesisTable {
  struct Row {
    std::string buffer;   ///< T Table 1's name, or what this is where the thesis has no such thing
    std::string formula;  ///< of its bytes, by V, M_s and R; empty: the thesis has no such thing
    std::optional<uint64_t> thesis;
    std::vector<std::string> here;                ///< names of resources; none: there is no such thing here
    std::optional<uint64_t> predicted, measured;  ///< predicted: where it is for all of them
  };
  struct Group {
    std::string name;
    std::vector<Row> rows;
    Row sum;
  };
  Group volumes, matrix;  ///< T Table 1's; T eq. 29 and 30
  Row total;              ///< of both; T eq. 31
  Group others;           ///< what neither counts, a row per subsystem
  Row all;                ///< that is on the device
};
/// `report`: memoryReport()'s resources. R is the setting's, since without light there is no matrix to ask.
ThesisTable thesisTable(const std::vector<MemoryReportRow>& report, const FacetList& facets, const Field& field,
                        const Lighting& lighting, uint64_t rays);

/// The table's sums, as rows of the memory report.
std::vector<MemoryReportRow> thesisMemoryRows(const ThesisTable& table);

/// Where T 5.14 as printed disagrees with itself, in words, with the figures.
std::vector<std::string> thesisMisprints();

}  // namespace irad
