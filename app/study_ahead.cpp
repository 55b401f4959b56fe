#include "app/study_ahead.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/bench.h"
#include "app/device_session.h"
#include "app/interrupts.h"
#include "app/study_run.h"
#include "gi/check/path_tracer.h"
#include "gi/sky.h"
#include "renderer/base/error.h"

namespace irad::app {
namespace {

using Clock = std::chrono::steady_clock;

/// Of brute force, beyond the first.
double furtherFrames(const Settings& settings) {
  return settings.solver.method == SolverMethod::bruteForce ? settings.solver.frames - 1.0 : 0;
}

}  // namespace

uint32_t timedRepeats(const Settings& settings, uint32_t repeats) {
  constexpr uint32_t kLeast = 3;
  if (furtherFrames(settings) == 0) return repeats;
  const uint32_t frames = settings.solver.frames;
  return std::min(repeats, std::max(kLeast, (repeats + frames - 1) / frames));
}

Settings withOneFrame(Settings settings) {
  if (settings.solver.method == SolverMethod::bruteForce) settings.solver.frames = 1;
  return settings;
}

PicturesMissing& PicturesMissing::operator+=(const PicturesMissing& other) {
  errors += other.errors, timed += other.timed, frames += other.frames;
  return *this;
}

PicturesMissing picturesMissing(const StudyResults& results, size_t point, const Settings& settings, uint32_t firstSeed,
                                const StudyTask& task) {
  PicturesMissing out;
  if (results.hasFailed(point)) return out;
  const uint32_t repeats = timedRepeats(settings, task.repeats);
  for (uint32_t i = 0; i < task.seeds; ++i) out.errors += results.hasError(point, firstSeed + i) ? 0 : 1;
  for (uint32_t i = 0; i < repeats; ++i) out.timed += results.hasTimes(point, i) ? 0 : 1;
  out.frames = furtherFrames(settings) * out.all();
  if (out.timed > 0) ++out.timed;
  return out;
}

PictureTrial tryPicture(DeviceSession& session, const Scene& scene, const Settings& wanted, const StudyTask& task) {
  PictureTrial out;
  const Settings settings = withOneFrame(wanted);
  try {
    Bench bench(*session.context, scene, settings, task.size, task.view.view, task.camera);
    const Progress watch = [](const char*, float) { return throwIfStopped(), true; };
    bench.watch(watch);
    bench.prepare();  // which compiles, too
    bench.cameraFrame();
    StageClock clock(watch);
    Clock::time_point began = Clock::now();
    bench.watch(clock.progress());
    bench.rebuild();
    out.parts = clock.finish();
    bench.watch(watch);
    bench.relight(), bench.cameraFrame();
    out.timed = secondsSince(began);
    Settings other = settings;
    ++other.matrix.gpu.seed;
    began = Clock::now();
    bench.pipeline().set(other);
    bench.prepare();
    const View view = task.view.view;
    const LinearPixels pixels = bench.pictures({&view, 1});
    measurePicture(task.size, pixels, pixels, {}, std::exp2(settings.camera.exposureEv));
    out.error = secondsSince(began);
    if (furtherFrames(wanted) > 0) {
      ++other.solver.frames;
      began = Clock::now();
      bench.pipeline().set(other);
      bench.prepare();
      out.frame = secondsSince(began);
    }
  } catch (const DeviceError&) {
    out = {};  // the point itself will be a row that says so
  } catch (const UsageError&) {
    out = {};
  }
  session.device->waitIdle();
  session.timings.reset();
  return out;
}

std::vector<double> pointFactors(const SettingGrid& grid, const std::vector<size_t>& points, const PictureTrial& first,
                                 const PictureTrial& last) {
  std::vector<double> out(points.size(), 1);
  const auto model = [&](const PictureTrial& trial, size_t tried, size_t point) {
    double seconds = trial.timed;
    for (size_t i = 0; i < BuildTimes::kParts; ++i)
      seconds += trial.parts[i] *
                 (BuildTimes::growth(static_cast<BuildTimes::Part>(i), grid.settings(tried), grid.settings(point)) - 1);
    return seconds;
  };
  if (first.timed > 0 && last.timed > 0) {
    // What the growth that is known does not say: how far it goes between the two that were tried.
    const double known = model(first, points.front(), points.back()) / first.timed, real = last.timed / first.timed;
    const bool tells = std::abs(std::log(known)) > 0.1;
    const double power = tells ? std::clamp(std::log(real) / std::log(known), 0.0, 4.0) : 1;
    for (size_t i = 0; i < points.size(); ++i)
      out[i] = tells ? std::pow(model(first, points.front(), points[i]) / first.timed, power) : 0.5 * (1 + real);
  } else if (last.timed > 0) {
    // Nothing is known of the first.
    for (size_t i = 0; i < points.size(); ++i) out[i] = model(last, points.back(), points[i]) / last.timed;
  }
  return out;
}

double secondsOfTracing(const Scene& scene, const SkySettings& sky, const StudyTask& task, double samples) {
  constexpr double kLong = 0.2;  // s: by then the threads' start no longer counts
  const glm::uvec2 some = glm::max(task.size / 8u, glm::min(task.size, glm::uvec2(16)));
  const Clock::time_point began = Clock::now();
  const auto tracer = makePathTracer(scene, makeSky(sky, skyInputs(scene, scene.lights)));
  const double build = secondsSince(began);
  const Clock::time_point built = Clock::now();
  TracedSums sums;
  do {
    throwIfStopped();
    tracer->add(task.camera, some, {.samples = std::max(2u, sums.samples), .seed = 1, .centred = true}, sums);
  } while (secondsSince(built) < kLong);
  const double ofSample = secondsSince(built) / (double{1} * some.x * some.y * sums.samples);
  return build + ofSample * samples * task.size.x * task.size.y;
}

}  // namespace irad::app
