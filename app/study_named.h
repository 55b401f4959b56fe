// `irad study rq1` to `rq12`, `tables` and `thesis`: the thesis's experiments (gi/study/named.h), each a cost study in
// a folder of its own.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/study.h"

namespace irad::app {

struct NamedArguments {
  std::optional<std::string> scale, sponza;
  void declare(Options& options);
};

/// The names, "thesis" (all of them) the last.
std::vector<std::string> namedStudyNames();
std::string namedStudyHelp();  ///< a line's worth: "rq2: How does …?"

/// Measures what the folder does not have yet, writes the reports, prints the findings.
void runNamedStudy(Machine& machine, const std::string& name, const MeasureArguments& measure, const Shard& shard,
                   const NamedArguments& named);

/// Whether a folder is that of a named study.
bool isNamedStudy(const std::filesystem::path& folder);
/// Puts shards of a named study together, experiment by experiment, with its reports.
void mergeNamedStudies(const std::vector<std::filesystem::path>& shards, const std::filesystem::path& out);

}  // namespace irad::app
