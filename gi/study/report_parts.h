// What reports of studies are put together from, as HTML and SVG.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gi/study/report.h"

namespace irad {

/// The kinds of work whose stages are timed (PointSummary::stages), with the axis of their plot and their name in a
/// sentence.
struct TimeKind {
  const char *kind, *axis, *name;
};
inline constexpr TimeKind kTimeKinds[] = {
    {"setup", "build, ms", "Build"}, {"relight", "relight, ms", "Relight"}, {"camera", "frame, ms", "Frame"}};
/// Part of a picture of the folder, at least twice as large, with its caption; empty where the picture is not there.
std::string reportCrop(const std::filesystem::path& folder, const std::string& name, const std::string& caption,
                       const ReportNotes& notes);
/// Error against one cost, with the front.
std::string errorPlot(const CostKind& cost, const std::vector<PointSummary>& points, const std::vector<PeerRow>& peers,
                      std::optional<size_t> given);
/// What it shows, in words.
std::string errorFinding(const CostKind& cost, const std::vector<PointSummary>& points,
                         const std::vector<PeerRow>& peers, std::optional<size_t> given);
/// Milliseconds of the stages of these points in one kind of work.
std::string stagePlot(const std::string& title, const std::string& kind, const std::vector<PointSummary>& points,
                      const std::vector<size_t>& chosen);
/// What it shows: how long `name` takes at the cheapest and the dearest of the points, and which stage takes most of
/// it.
std::string stageFinding(const std::string& name, const std::string& kind, const std::vector<PointSummary>& points,
                         const std::vector<size_t>& chosen);
/// Errors and costs of all points, under headings.
std::string pointTables(const std::vector<PointSummary>& points, std::optional<size_t> given);

}  // namespace irad
