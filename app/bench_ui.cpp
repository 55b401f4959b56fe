#include "app/bench_ui.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "renderer/base/console.h"
#include "renderer/base/error.h"

#if IRAD_UI
#include "app/view_command.h"
#include "renderer/base/timings.h"
#endif

namespace irad::app {

#if IRAD_UI
namespace {

/// The least median of so many samples in a row. What else runs on the machine only adds to a thread's processor time
/// (caches, the other thread of a core, time stolen from a virtual machine), and comes and goes.
double quietestMedian(std::span<const double> ms, size_t row) {
  double least = statistics({ms.begin(), ms.end()}).p50;
  for (size_t i = 0; i + row <= ms.size(); ++i)
    least = std::min(
        least, statistics({ms.begin() + static_cast<ptrdiff_t>(i), ms.begin() + static_cast<ptrdiff_t>(i + row)}).p50);
  return least;
}

}  // namespace

void measureUi(Machine& machine, const std::optional<std::string>& scene, const std::optional<std::string>& view,
               const PictureArguments& picture, const SettingArguments& settings, const SceneArguments& sceneOptions,
               const DeviceArguments& device) {
  constexpr double kMark = 1;  // ms
  constexpr size_t kRow = 20;
  const Config config = settings.readConfig();
  std::vector<double> ms;
  WindowOptions options;
  options.scene = findScene(scene, config, "box");
  options.builtIn = builtInFolders();
  if (picture.size) options.size = parseSize(*picture.size);
  options.view = findViews({view.value_or("lit")}).at(0).view;
  options.measuredFrames = picture.resolveFrames({}, 300);
  options.uiMilliseconds = &ms;
  openWindow(machine, options, config, settings, sceneOptions, device);
  const TimingStats s = statistics(ms);
  print("UI, CPU ms per frame, window of {} x {}, {} frames\n", options.size.x, options.size.y, s.samples);
  print("p50 {:.3f}  mean {:.3f}  p95 {:.3f}  p99 {:.3f}  max {:.3f}\n", s.p50, s.mean, s.p95, s.p99, s.max);
  const double quiet = quietestMedian(ms, kRow);
  print("p50 of the quietest {} frames in a row {:.3f}; mark: < {} ms: {}\n", kRow, quiet, kMark,
        quiet < kMark ? "held" : "missed");
}

#else

void measureUi(Machine&, const std::optional<std::string>&, const std::optional<std::string>&, const PictureArguments&,
               const SettingArguments&, const SceneArguments&, const DeviceArguments&) {
  throw UsageError("--ui: this program was built without its window (IRAD_UI=OFF)");
}

#endif

}  // namespace irad::app
