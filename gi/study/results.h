// What a study has measured: rows on disk, from which everything else (points.csv, stages.csv, plots, report) is made.
// Errors and times lie apart: the former are the same to the last digit whenever and on however many shards they are
// made.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gi/study/sweep.h"
#include "renderer/base/student.h"
#include "renderer/metrics.h"

namespace irad {

/// A picture of a point, with one seed, against the reference; and the sizes of what made it.
struct ErrorRow {
  size_t point = 0;
  uint32_t seed = 0;
  double relMse = 0;  ///< PictureMetrics::blockRelMse
  double rmse = 0, meanError = 0, psnr = 0, flip = 0;
  uint64_t facets = 0, entries = 0;
  double matrixMib = 0, deviceMib = 0;
  /// Of the facets' H against the truth of H (PairedMetrics); NaN where there is none.
  double hRelMse = std::numeric_limits<double>::quiet_NaN(), hRmse = std::numeric_limits<double>::quiet_NaN();
};
/// One stage of one call; "wall" is all of it, on the CPU's clock.
struct TimeRow {
  size_t point = 0;
  uint32_t repeat = 0;
  std::string kind, stage;
  double ms = 0;
};
/// A point that could not be computed.
struct FailureRow {
  size_t point = 0;
  std::string message;
};
/// Another renderer's picture.
struct PeerRow {
  std::string name;
  uint32_t samples = 0;
  double seconds = 0, relMse = 0, rmse = 0, meanError = 0, psnr = 0, flip = 0;
};

/// All that says which study it is: JSON text of names and values. Results of different ones do not mix. The member
/// "sweeps" holds the grids (SettingGrid::texts).
using StudyIdentity = std::string;
using GridTexts = std::vector<std::vector<std::string>>;
GridTexts gridsOf(const StudyIdentity& identity);   ///< InputError where it has none
SettingGrid gridOf(const StudyIdentity& identity);  ///< the points of these; InputError as well

struct StudyResults {
  std::vector<ErrorRow> errors;
  std::vector<TimeRow> times;
  std::vector<FailureRow> failures;
  std::vector<PeerRow> peers;

  bool hasError(size_t point, uint32_t seed) const;
  bool hasTimes(size_t point, uint32_t repeat) const;
  bool hasFailed(size_t point) const;
  bool hasPeer(const std::string& name, uint32_t samples) const;
  void sort();  ///< by point, seed, repeat; stages as they ran
};

/// A study's folder. Files are replaced whole.
class StudyFolder {
 public:
  /// Makes the folder, or goes on with what is in it. A study may get further grids: where one of the two begins with
  /// all of the other's, the longer one holds. UsageError where the folder has another study: names what differs.
  StudyFolder(std::filesystem::path path, StudyIdentity identity);
  const std::filesystem::path& path() const { return path_; }
  const StudyIdentity& identity() const { return identity_; }
  void setGrids(const GridTexts& grids);  ///< more than before
  StudyResults results;
  void save();  ///< errors.csv, times.csv, failures.csv, peers.csv

 private:
  std::filesystem::path path_;
  StudyIdentity identity_;
};

/// InputError names file, line and field of what is no such file.
StudyResults readResults(const std::filesystem::path& folder);
StudyIdentity readIdentity(const std::filesystem::path& folder);
/// The members that two identities differ in, with both values; empty: they are the same study.
std::string differences(const StudyIdentity& a, const StudyIdentity& b);
/// Adds another shard's rows. InputError where both have an error of the same point and seed and it is not the same.
void merge(StudyResults& into, const StudyResults& from, const std::string& nameOfFrom);

/// Milliseconds of one kind of work.
struct TimeSpread {
  double p5 = 0, p50 = 0, p95 = 0;
  size_t samples = 0;
};
TimeSpread spreadOf(std::vector<double> samples);

/// A point as reports have it: medians over repeats, means over seeds.
struct PointSummary {
  size_t point = 0;
  std::string label;
  std::string failure;  ///< empty: it was computed
  size_t seeds = 0;
  MeanInterval relMse, rmse, meanError, psnr, flip;
  MeanInterval hRelMse, hRmse;                                      ///< of the facets' H; NaN where it was not measured
  double facets = 0, entries = 0, matrixMib = 0, deviceMib = 0;     ///< of the first seed
  std::map<std::string, TimeSpread> gpu, wall;                      ///< by kind: "setup", "cold", "relight", "camera"
  std::map<std::string, std::map<std::string, TimeSpread>> stages;  ///< by kind and stage
  std::map<std::string, std::vector<std::string>> stagesInOrder;
  double gpuMs(const std::string& kind) const;  ///< median; NaN where it was not measured
  double firstPictureMs() const;                ///< setup + cold + camera
};
/// Of all points; `labels` by point.
std::vector<PointSummary> summarize(const StudyResults& results, const std::vector<std::string>& labels);

/// What a study weighs errors against.
struct CostKind {
  const char* name;  ///< "build", a column of points.csv
  const char* axis;  ///< "build, ms"
  const char* unit;
  double (*of)(const PointSummary&);
  bool time;
  bool ofPicture;  ///< it grows with the picture's pixels
};
const std::vector<CostKind>& costKinds();

/// `names`: of the settings swept, a column each with `values` by point.
std::string pointsCsv(const std::vector<PointSummary>& points, const std::vector<std::string>& names,
                      const std::vector<std::vector<std::string>>& values);
std::string stagesCsv(const std::vector<PointSummary>& points);

}  // namespace irad
