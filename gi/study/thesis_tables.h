// T Tables 2, 3 and 6 to 10 as published, and the same of what was measured here, beside them.
#pragma once

#include <string>
#include <vector>

#include "gi/study/named.h"
#include "renderer/base/timings.h"

namespace irad {

/// Rows of cells, the heading first.
using TextTable = std::vector<std::vector<std::string>>;
std::string csvOf(const TextTable& table);
std::string htmlOf(const TextTable& table);

/// A row of T Tables 6 to 10.
struct ThesisTime {
  int table;
  const char* stage;
  TimingStats stats;
};
const std::vector<ThesisTime>& thesisTimes();
/// The scene of T Tables 6 to 10: an experiment of the study `tables`.
const char* experimentOfTable(int table);
/// Published, measured (`here`: the experiment's times, of point 0), and the ratio of their means. Cells are empty
/// where there is no such thing.
TextTable timeTable(int table, const std::vector<TimeRow>& here);
/// T Tables 2 and 3, of the experiments' figures "extent x", …, "vertices", "triangles", "solid voxels".
TextTable extentTable(const NamedResults& results);
TextTable geometryTable(const NamedResults& results);
/// MiB that T Table 1 has for a buffer; nothing where it does not name it.
std::string publishedMebibytes(const std::string& buffer);

}  // namespace irad
