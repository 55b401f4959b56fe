// Reports of named studies: a page for each question, and one for all of them.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "gi/study/named.h"
#include "gi/study/thesis_tables.h"

namespace irad {

/// section,the thesis,here,verdict: a row per claim.
TextTable findingsTable(const NamedStudy& study, const NamedResults& results);

struct NamedReport {
  const NamedStudy* study = nullptr;
  NamedResults results;
  std::vector<std::string> facts;                           ///< device, scale, command: a line each
  std::vector<std::pair<std::string, TextTable>> tables{};  ///< with their headings
};
/// findings.csv, a CSV per table, report.html, with the plots and pictures of the experiments' folders below `folder`.
void writeNamedReport(const std::filesystem::path& folder, const NamedReport& report);
/// The same of all questions at once: their findings and tables; pictures are on each one's own page, in the folder of
/// its name.
void writeThesisReport(const std::filesystem::path& folder, const std::vector<NamedReport>& reports);

}  // namespace irad
