// The thesis's experiments as named studies (T 6 to 8): which cost studies a question takes, and what their results say
// to what the thesis found. Nothing here needs a device: results come from folders on disk, or from a test's hand.
#pragma once

#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "gi/study/results.h"

namespace irad {

/// How large experiments are: the thesis's values, or what two cores do in minutes.
struct StudyScale {
  const char* name;                         ///< "full", "small"
  std::vector<uint32_t> resolutions, rows;  ///< of T 7.6 and 7.7, ascending
  uint32_t voxels, rays;                    ///< T Table 5: all other experiments
  uint32_t width, height, samples;          ///< of pictures; of the path tracer per pixel
  uint32_t truthVoxels, truthRays;          ///< of truths by this program itself
  uint32_t seeds, repeats, tableRepeats;    ///< the last: of T Tables 6 to 10
  uint32_t stillFrames;                     ///< pictures of a still camera, for flicker
  std::vector<uint32_t> frames;             ///< of brute force, ascending
  bool sponzaByDefaults;                    ///< Sponza by the present defaults, too: the longest of all
  std::vector<std::string> settings;        ///< of all experiments
};
const std::vector<StudyScale>& studyScales();
/// UsageError with near matches.
const StudyScale& findScale(std::string_view name);

/// What a truth is made by. Path tracing is diffuse: where reflections are looked at it is none.
/// Cycles: a picture that is there; Blender: one that it makes (Experiment::engine). Itself: there is none, and times
/// alone are looked at.
enum class TruthKind { PathTracer, OwnSettings, Itself, Cycles, Blender };

/// One cost study: a folder below the named study's.
struct Experiment {
  std::string name{};    ///< its folder
  std::string scene{};   ///< a built-in one, or "sponza"
  std::string camera{};  ///< empty: the scene's first
  std::string view = "indirect";
  std::vector<std::string> settings{};  ///< "preset=NAME" and "name=value", in order, over those of the scale
  GridTexts grids{};                    ///< none: one point, as given
  TruthKind truth = TruthKind::PathTracer;
  std::vector<std::string> truthSettings{};  ///< of OwnSettings, over "preset=reference"
  std::string engine{};                      ///< of Blender: "CYCLES", "EEVEE"
  bool longTimes = false;                    ///< StudyScale::tableRepeats
  bool flicker = false;    ///< also pictures of a still camera, per point (gi/check/writeback_figures.h)
  bool movedRays = false;  ///< also how many rays end elsewhere than those of the first point
  bool tables = false;     ///< also what T Tables 1 to 3 list
};

// ---- Results ----

/// A point, by the settings that its experiment sweeps.
struct MeasuredPoint {
  std::map<std::string, std::string> settings;
  PointSummary summary;
};
struct ExperimentResult {
  Experiment experiment;
  std::string skipped;  ///< why there is nothing of it; empty: it was measured
  std::vector<MeasuredPoint> points;
  std::map<std::string, double> figures;  ///< what else was measured: "truth_mean", "flicker 1" (of point 1), …

  /// The mean of a point's picture, by all channels, W/(m² sr); NaN where it is not known.
  double light(const PointSummary& p) const;
};
struct NamedResults {
  std::vector<ExperimentResult> experiments;
  bool cpu = false;   ///< the device is no GPU
  bool full = false;  ///< of the thesis's size

  /// Those whose names begin with `prefix` and whose points were all computed.
  std::vector<const ExperimentResult*> measured(std::string_view prefix = "") const;
};

/// Thrown by what looks for a result that is not there; says why.
struct NotMeasured : std::runtime_error {
  using std::runtime_error::runtime_error;
};
const ExperimentResult& experimentOf(const NamedResults& results, std::string_view name);
/// The first point that has all of these values; the first of all where none are given. NotMeasured where there is
/// none, or where it has failed.
const PointSummary& pointOf(const ExperimentResult& experiment, const std::map<std::string, std::string>& settings);

// ---- What is concluded ----

enum class Judgement {
  Agrees,
  Disagrees,
  Answered,  ///< what the thesis left open, by measurement
  Open,      ///< not measured, or not to be told from the numbers
};
const char* toString(Judgement verdict);

struct Answer {
  Judgement verdict = Judgement::Open;
  std::string text;  ///< computed from results, never written ahead
};
/// Something that the thesis found, in our words.
struct Claim {
  const char* section;  ///< of the thesis: "7.6, RQ4"
  const char* said;
  Answer (*judge)(const NamedResults&);  ///< may throw NotMeasured
};
/// The judge's answer; where something is not measured, one that is open and says what.
Answer answerTo(const Claim& claim, const NamedResults& results);

struct NamedStudy {
  const char* name;  ///< "rq5"
  const char* question;
  std::vector<Claim> claims;
  std::vector<Experiment> (*experiments)(const StudyScale&);
};
/// rq1 to rq12, and `tables`.
const std::vector<NamedStudy>& namedStudies();
const NamedStudy* findNamedStudy(std::string_view name);  ///< null where there is none

// ---- For judges and their tests ----

/// Slope of log y over log x by least squares: of two points or more, NaN of fewer.
double exponentOf(const std::vector<std::pair<double, double>>& points);
enum class IntervalOrder { Less, Equal, More, Unknown };
/// By means and 95 % intervals: Equal where these overlap; Unknown where one of them is of a single seed.
IntervalOrder compare(const MeanInterval& a, const MeanInterval& b);
/// y = a + b / x by least squares.
struct NoiseFit {
  double bias = 0, slope = 0;
  double noiseShare(double x) const { return slope / x / (bias + slope / x); }
};
NoiseFit fitNoise(const std::vector<std::pair<double, double>>& points);
/// Where a parabola through the least point and its neighbours is least; the point itself at an end.
double leastAt(const std::vector<std::pair<double, double>>& points);

}  // namespace irad
