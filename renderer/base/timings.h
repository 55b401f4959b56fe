// GPU and CPU milliseconds per stage: samples, statistics (the columns of T Tables 6-10), CSV.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace irad {

struct TimingStats {
  double mean = 0, min = 0, max = 0, std = 0, p50 = 0, p95 = 0, p99 = 0;  ///< ms; percentiles by nearest rank
  uint64_t samples = 0;
};
TimingStats statistics(std::vector<double> milliseconds);

/// Which work a sample comes from. Setup: one-time work, a rebuild. Frame: whatever a frame does. For a bench's frames
/// more is known: the relight after a rebuild, whose solver starts from nothing (Cold), a relight after a light has
/// moved, a picture alone (Camera).
enum class WorkKind { Setup, Frame, Cold, Relight, Camera };
inline constexpr std::array kWorkKinds{"setup", "frame", "cold", "relight", "camera"};
inline const char* toString(WorkKind kind) {
  return kWorkKinds.at(static_cast<size_t>(kind));
}

/// One group of passes: a frame, or a rebuild.
struct FrameSample {
  /// Passes of one stage that followed each other; ms on the device's clock, whose zero is arbitrary.
  struct Span {
    std::string stage;
    double began, ended;
  };
  uint64_t frame = 0;
  std::string of;  ///< set-up work: what was set up (Timings::about())
  WorkKind kind = WorkKind::Frame;
  double began = 0;                                    ///< ms since the Timings were made, on the CPU's clock
  double cpuMs = 0;                                    ///< from there until its work was handed over, or done
  std::vector<std::pair<std::string, double>> stages;  ///< sum of a stage's passes, ms, in order of appearance
  std::vector<Span> spans;                             ///< where passes say when they ran

  double gpuMs() const;  ///< of all stages
  /// Adds another group's work to this one's.
  void add(const FrameSample& other);
};

/// All samples of one stage in one kind of work, ms, in order.
struct StageSamples {
  WorkKind kind;
  std::string stage;  ///< a name of docs/method.md 11
  std::vector<double> ms;
};
/// In order of first appearance, over the set-up groups and the last `window` others.
std::vector<StageSamples> stageSamples(const std::deque<FrameSample>& frames, size_t window = SIZE_MAX);

class Timings {
 public:
  using Clock = std::chrono::steady_clock;

  /// Keeps the last `window` groups of per-frame work, and as many of set-up work.
  explicit Timings(size_t window = SIZE_MAX) : window_(window) {}
  /// Adds one pass's time. Passes of the same stage within one sample group (frame) are summed by `endFrame`.
  /// `began`: on the device's clock, ms.
  void add(std::string_view stage, double gpuMs, std::optional<double> began = std::nullopt);
  /// Closes the group: each stage seen since the last call gets one sample. `setup`: the group is one-time work (a
  /// rebuild), listed apart from per-frame stages.
  void endFrame(uint64_t frame, bool setup, double cpuMs, Clock::time_point ended = Clock::now());
  /// What is set up from now on, in words for a table: scene and resolution.
  void about(std::string subject) { subject_ = std::move(subject); }
  void forget();  ///< drops what was added since the last group: the work was given up
  void reset();

  const std::deque<FrameSample>& frames() const { return frames_; }
  uint64_t recorded() const { return recorded_; }  ///< groups ever closed: goes on growing when frames() is full
  double now() const;                              ///< ms, on the clock of FrameSample::began

  struct Row {
    WorkKind kind;
    std::string stage;
    TimingStats stats;
  };
  std::vector<Row> rows() const;  ///< in order of first appearance

 private:
  size_t window_;
  Clock::time_point made_ = Clock::now();
  FrameSample open_;
  std::string subject_;
  std::deque<FrameSample> frames_;
  std::array<size_t, 2> kept_{};  ///< of frames_: set-up, others
  uint64_t recorded_ = 0;
};

std::vector<Timings::Row> timingRows(std::vector<StageSamples> samples);
/// subsystem,kind,mean_ms,min_ms,max_ms,std_ms,p50_ms,p95_ms,p99_ms,samples
void writeCsv(std::ostream& out, const std::vector<Timings::Row>& rows);

}  // namespace irad
