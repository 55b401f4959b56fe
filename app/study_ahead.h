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

/// How often a point is timed that others are `repeats` times. The frames of brute force are repeats of each other:
/// three relights of many say as much.
uint32_t timedRepeats(const Settings& settings, uint32_t repeats);
/// The same with one frame of brute force.
Settings withOneFrame(Settings settings);

/// Pictures that a point lacks.
struct PicturesMissing {
  double errors = 0;  ///< by seeds
  double timed = 0;   ///< repeats, with the round that warms up
  double frames = 0;  ///< of brute force, beyond one for each of these
  double all() const { return errors + timed; }
  PicturesMissing& operator+=(const PicturesMissing& other);
};
PicturesMissing picturesMissing(const StudyResults& results, size_t point, const Settings& settings, uint32_t firstSeed,
                                const StudyTask& task);

/// What a trial of one point took, of brute force with one frame; zeros: there is no memory for it, or its settings do
/// not go together.
struct PictureTrial {
  double error = 0;     ///< seconds of a seed's picture, with its metrics
  double timed = 0;     ///< seconds of a repeat
  PartSeconds parts{};  ///< of `timed`: its build
  double frame = 0;     ///< seconds of a further frame of brute force
  /// But for further frames, which other points than the one that was tried may have.
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
