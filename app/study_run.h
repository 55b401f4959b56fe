// What all studies are made by: pictures of one camera over a grid of settings, their errors against one truth, their
// times and memory, in a folder that can be gone on with.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/bench.h"
#include "app/device_session.h"
#include "app/facet_truth.h"
#include "gi/check/path_tracer.h"
#include "gi/picture.h"
#include "gi/study/report.h"
#include "gi/study/results.h"
#include "gi/study/sweep.h"
#include "gi/study/truths.h"
#include "gi/views/views.h"

namespace irad::app {

using LinearPixels = std::vector<glm::vec4>;

/// Where the truth comes from: one of these.
struct TruthSource {
  std::optional<ReferencePicture> file, secondFile;  ///< the second: of independent noise
  std::optional<uint32_t> samples;                   ///< of the path tracer, even: its two halves
  std::optional<Settings> settings;                  ///< the program's own pictures by these, of two seeds
  std::string name() const;                          ///< for identities: hashes of files, or what is computed
};

/// A folder of truths that several studies of a run share, and who was the first to use which.
struct SharedTruths {
  std::filesystem::path folder;
  std::string user;                          ///< the study at work, for people
  std::map<std::string, std::string> users;  ///< by TruthRecipe::name()
};

struct StudyTask {
  std::string study = "cost";  ///< its name, in the identity
  std::filesystem::path out;
  Camera camera;
  glm::uvec2 size{0};
  ViewInfo view{};
  TruthSource truth;
  SharedTruths* sharedTruths = nullptr;  ///< null: what is computed lies in out/truths
  uint32_t seeds = 4, repeats = 30;
  Shard shard;
  std::vector<uint32_t> peerSamples;  ///< of the path tracer as a peer, even; empty: none
  std::optional<uint64_t> facetRays;  ///< of the truth of the facets' H; none: H is not held against one
};

/// What pictures are held against: one picture, or two with independent noise.
struct Truth {
  glm::uvec2 size{0};
  LinearPixels first, second;  ///< second: empty where there is one
  std::string what;            ///< for the identity and the report
  LinearPixels mean() const;
};

/// What a task's truth is computed from, in this scene; none where it is a file.
std::optional<TruthRecipe> truthRecipe(const DeviceSession& session, const StudyTask& task, const Scene& scene,
                                       const std::string& sceneContent, const SkySettings& sky);

/// UsageError where the path tracer, which is diffuse, makes no truth of this view, or is not there.
void requirePathTracer(const ViewInfo& view, const Settings& settings);

class StudyRun;
/// Pictures that a study is still to make.
struct WorkAhead {
  double pictures = 0, seconds = 0;
  double tracing = 0;  ///< seconds of what the path tracer makes
  double all() const { return seconds + tracing; }
};
/// Of a study that makes its pictures itself: asked before the truth is made, when the run's folder and bench are
/// there.
using PicturesOfItsOwn = std::function<WorkAhead(StudyRun&)>;

class StudyRun {
 public:
  /// Opens the folder, says what is ahead and makes the truth, where the shard has a point. The scene as
  /// DeviceSession::load gave it with grid.base(). UsageError where sizes do not fit, or the folder holds another
  /// study.
  StudyRun(DeviceSession& session, Scene scene, SettingGrid grid, StudyTask task, const PicturesOfItsOwn& own = {});
  /// Measures what the folder does not have yet; notes.json is written at the end.
  void measure();
  /// Further seeds and repeats of one point, after those of measure().
  void measureMore(size_t point, uint32_t seeds, uint32_t repeats);
  void measureTimesOnly();  ///< of measure(): for studies whose errors are made elsewhere, before this
  /// Adds the combinations of these sweeps, for the next measure().
  void extend(const std::vector<std::string>& sweeps);

  const SettingGrid& grid() const { return grid_; }
  const StudyResults& results() const { return folder_->results; }
  std::vector<PointSummary> points() const { return summarize(folder_->results, grid_.labels()); }
  const Truth& truth() const { return truth_; }
  const StudyTask& task() const { return task_; }
  Bench& bench() { return *bench_; }  ///< for pictures of other settings, before measure()
  double tryRepeat(size_t point);     ///< seconds of one, by a trial
  WorkAhead picturesAhead() { return picturesAhead(ownPoints()); }  ///< of measure(), by a trial
  /// What was to come of pictures and truths when the study was opened.
  const WorkAhead& ahead() const { return ahead_; }
  ReportNotes notes() const;

 private:
  void announce(const PicturesOfItsOwn& own);  ///< what is ahead, before it begins
  WorkAhead picturesAhead(const std::vector<size_t>& points);
  bool needsTruth() const;
  void makeTruth();
  void makeHalves(const TruthStore& store, const TruthRecipe& recipe);
  /// Of a light solved from the dark, which `whileLit` may look at.
  LinearPixels picture(const Settings& settings, const std::function<void()>& whileLit = {});
  /// `afterPass`: between two passes, the last included.
  TracedPicture trace(const char* what, uint32_t samples, uint64_t seed, TracedSums sums = {},
                      const std::function<void(const TracedSums&)>& afterPass = {});
  const TracedLight& lightOf(const TracedPicture& picture) const;
  StudyIdentity identity() const;
  void progress(const char* what, size_t done, size_t all);  ///< with the time left, as if each took as long
  std::vector<size_t> ownPoints() const;
  void fail(size_t point, const char* message);
  template <class Act>
  bool attempt(size_t point, Act&& act);
  void measureErrors(const std::vector<size_t>& points, uint32_t seeds);
  void measureError(size_t point, const Settings& settings, bool keepPicture);
  void measureFacets(const Settings& settings, const std::vector<glm::vec4>& h, ErrorRow& row);
  void measureOwnTimes();
  void measureTimes(const std::vector<size_t>& points, const std::function<uint32_t(size_t)>& repeatsOf);
  void measurePeers();

  DeviceSession& session_;
  Scene scene_;
  std::string sceneContent_;
  SettingGrid grid_;
  StudyTask task_;
  Truth truth_;
  float exposure_ = 1;
  std::optional<StudyFolder> folder_;
  std::optional<Bench> bench_;
  std::unique_ptr<PathTracer> tracer_;
  std::optional<FacetTruths> facetTruths_;
  WorkAhead ahead_;
  std::chrono::steady_clock::time_point stepBegan_;
};

/// A picture as a screen shows it without a tone curve, which is what FLIP compares.
void writeAsShown(const std::filesystem::path& stem, glm::uvec2 size, const LinearPixels& linear, float exposure);

/// Writes the report, prints the table and the findings.
void finishStudy(const std::filesystem::path& out, const SettingGrid& grid, const StudyResults& results,
                 const ReportNotes& notes, const std::vector<SplitPoint>& splits = {});

}  // namespace irad::app
