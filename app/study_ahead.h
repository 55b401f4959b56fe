// About how long a study takes, before it is begun: from trials of single pictures.
#pragma once

#include <cstdint>
#include <vector>

#include "app/stage_clock.h"
#include "gi/settings.h"

namespace irad {
class SettingGrid;
struct Scene;
struct SkySettings;
struct StudyResults;
}  // namespace irad

namespace irad::app {

struct DeviceSession;
struct StudyTask;

/// Pictures that a point lacks.
struct PicturesMissing {
  double errors = 0;  ///< by seeds
  double timed = 0;   ///< repeats, with the round that warms up
  double all() const { return errors + timed; }
};
PicturesMissing picturesMissing(const StudyResults& results, size_t point, uint32_t firstSeed, const StudyTask& task);

/// What a trial of one point took; zeros: there is no memory for it, or its settings do not go together.
struct PictureTrial {
  double error = 0;     ///< seconds of a seed's picture, with its metrics
  double timed = 0;     ///< seconds of a repeat
  PartSeconds parts{};  ///< of `timed`: its build
  double of(const PicturesMissing& missing) const { return missing.errors * error + missing.timed * timed; }
};
PictureTrial tryPicture(DeviceSession& session, const Scene& scene, const Settings& settings, const StudyTask& task);

/// How many times as long as the trial of the first point each of `points` takes, by that of the last one and the
/// growth by voxels and rays that is known (BuildTimes). Where one of the two has nothing to say all are as long.
std::vector<double> pointFactors(const SettingGrid& grid, const std::vector<size_t>& points, const PictureTrial& first,
                                 const PictureTrial& last);

/// Seconds that the path tracer takes, by a trial of few samples of few pixels.
double secondsOfTracing(const Scene& scene, const SkySettings& sky, const StudyTask& task, double samples);

}  // namespace irad::app
