// A study's results for people: plots as SVG, one HTML file that needs nothing but itself.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gi/study/attribution.h"
#include "gi/study/results.h"
#include "gi/study/sweep.h"

namespace irad {

/// What a report says beside the figures.
struct ReportNotes {
  std::string title;               ///< "Cost of accuracy: box"
  std::vector<std::string> facts;  ///< device, camera, reference, …: a line each
  glm::uvec2 pictureSize{0};
  glm::uvec2 cropAt{0}, cropSize{0};  ///< where the pictures are compared side by side
  std::vector<std::string> warnings;
};

/// notes.json of a study's folder; nothing where there is none, InputError where it is no such file.
ReportNotes readNotes(const std::filesystem::path& folder);

/// A sentence per plot and for the point `given` (that of the settings as they are, where the grid has it), from the
/// numbers.
std::vector<std::string> findings(const std::vector<PointSummary>& points, const std::vector<PeerRow>& peers,
                                  std::optional<size_t> given);

/// A point whose error was split among the stages.
struct SplitPoint {
  size_t point = 0;
  Attribution split;
};
/// The points on the front of error against first pictures, cheapest first.
std::vector<size_t> frontOfFirstPictures(const std::vector<PointSummary>& points);

/// points.csv, stages.csv, error-against-COST.svg, stages.svg, of points that were split split-errors.svg and
/// split-times.svg, report.html; from the folder's pictures/ the crops.
void writeReport(const std::filesystem::path& folder, const SettingGrid& grid, const StudyResults& results,
                 const ReportNotes& notes, const std::vector<SplitPoint>& splits = {});

/// Names within pictures/, without extension.
std::string pictureName(size_t point);
std::string pictureName(const std::string& peer, uint32_t samples);
inline constexpr const char* kReferenceName = "reference";

}  // namespace irad
