#include "ui/background_reference.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/base/output_file.h"

namespace irad {
namespace {

using What = BackgroundReference::State::What;
constexpr double kSecondsBetweenPictures = 10;  ///< at least; those after 2, 4, 8, ... samples come at once

double secondsSince(std::chrono::steady_clock::time_point began) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

}  // namespace

std::filesystem::path saveReference(const std::filesystem::path& file, const TracedReference& reference,
                                    const PictureSubject& subject) {
  if (file.extension() != linearExtension() || !file.has_stem())
    throw InputError(fmt::format("the reference's name '{}' does not end in {}, as this build writes pictures",
                                 file.string(), linearExtension()));
  makeFolder(file.has_parent_path() ? file.parent_path() : std::filesystem::path("."));
  const PictureLayer layers[] = {{"", reference.mean}, {"error", reference.error}};
  return writeLayers(file.parent_path() / file.stem(), reference.size, layers, subject).front();
}

struct BackgroundReference::Shared {
  Task task;
  mutable std::mutex mutex;
  std::condition_variable changed;
  bool cancelled = false, held = false;
  State state;
  std::shared_ptr<const TracedReference> best;
  bool taken = true;

  /// Waits while it is held; false: cancelled.
  bool mayGoOn() {
    std::unique_lock lock(mutex);
    if (held && !cancelled) {
      const What before = std::exchange(state.what, What::Waiting);
      changed.wait(lock, [&] { return !held || cancelled; });
      state.what = before;
    }
    return !cancelled;
  }
  void set(const std::function<void(State&)>& change) {
    const std::lock_guard lock(mutex);
    change(state);
  }
  void publish(const TracedSums& sums) {
    const TracedPicture picture = pictureOf(sums);
    const TracedLight& light = task.indirect ? picture.indirect : picture.lit;
    auto made = std::make_shared<TracedReference>();
    made->size = picture.size;
    made->samples = picture.samples;
    made->mean = pixelsOf(light.mean), made->error = pixelsOf(light.error);
    made->halves = {pixelsOf(light.half[0]), pixelsOf(light.half[1])};
    made->noise = relativeNoise(light);
    const std::lock_guard lock(mutex);
    best = std::move(made), taken = false;
  }

  void run() {
    // The threads that it starts inherit its priority. (On Linux it is the thread's own.)
    setpriority(PRIO_PROCESS, 0, 19);
    set([](State& s) { s.what = What::Loading; });
    const std::unique_ptr<PathTracer> tracer = makePathTracer(task.scene(), task.sky);
    set([](State& s) { s.what = What::Tracing; });
    // One sample in a pass: the least that can be given up.
    const TraceOptions options{.samples = 1, .centred = true, .threads = threads()};
    TracedSums sums;
    auto shown = std::chrono::steady_clock::now();
    while (sums.samples < task.samples) {
      if (!mayGoOn()) return;
      const auto began = std::chrono::steady_clock::now();
      tracer->add(task.camera, task.size, options, sums);
      const bool power = (sums.samples & (sums.samples - 1)) == 0, last = sums.samples >= task.samples;
      if (sums.samples >= 2 && (power || last || secondsSince(shown) > kSecondsBetweenPictures)) {
        publish(sums);
        shown = std::chrono::steady_clock::now();
      }
      set([&](State& s) {
        s.samples = sums.samples;
        s.longestPass = std::max(s.longestPass, secondsSince(began));
        s.seconds += secondsSince(began);
        s.secondsLeft = s.seconds / s.samples * (s.wanted - s.samples);
      });
    }
    set([](State& s) { s.what = What::Done; });
  }
};

uint32_t BackgroundReference::threads() {
  return std::max(2u, std::thread::hardware_concurrency()) - 1;
}

BackgroundReference::~BackgroundReference() {
  retire();
  for (std::thread& thread : ending_) thread.join();
}

void BackgroundReference::retire() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->cancelled = true;
  }
  shared_->changed.notify_all();
  ending_.push_back(std::move(thread_));
  shared_.reset();
}

void BackgroundReference::start(Task task) {
  retire();
  shared_ = std::make_shared<Shared>();
  shared_->state.what = What::Loading;
  shared_->state.wanted = task.samples;
  shared_->task = std::move(task);
  thread_ = std::thread([shared = shared_] {
    try {
      shared->run();
    } catch (const std::exception& error) {
      shared->set([&](State& s) { s.what = What::Failed, s.error = error.what(); });
    }
  });
}

void BackgroundReference::cancel() {
  retire();
}

void BackgroundReference::hold(bool on) {
  if (!shared_) return;
  {
    const std::lock_guard lock(shared_->mutex);
    if (std::exchange(shared_->held, on) == on) return;
  }
  shared_->changed.notify_all();
}

BackgroundReference::State BackgroundReference::state() const {
  if (!shared_) return {};
  const std::lock_guard lock(shared_->mutex);
  return shared_->state;
}

bool BackgroundReference::atWork() const {
  const What what = state().what;
  return what == What::Loading || what == What::Tracing;
}

std::shared_ptr<const TracedReference> BackgroundReference::take() {
  if (!shared_) return nullptr;
  const std::lock_guard lock(shared_->mutex);
  return std::exchange(shared_->taken, true) ? nullptr : shared_->best;
}

}  // namespace irad
