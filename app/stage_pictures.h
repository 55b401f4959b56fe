// The pictures by which `irad study attribution` splits an error: one or several stages made ideal, seed by seed.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/study_run.h"
#include "gi/check/exact_solve.h"
#include "gi/study/attribution.h"
#include "gi/study/attribution_time.h"

namespace irad {
struct SeenPoint;
}

namespace irad::app {

/// How far a study goes.
struct AttributionTask {
  double finer = 2;
  uint32_t gatherRays = 256;
};

class StagePictures {
 public:
  /// Prepares the picture as it is, to see which stages there are.
  StagePictures(DeviceSession& session, StudyRun& run, const AttributionTask& task);

  const std::map<ErrorStage, StagePresence>& presence() const { return presence_; }

  /// Makes a few of those that are due, and tells from their times what the others and the study's repeats will take.
  WorkAhead tryFew();
  /// Makes those that the folder does not have yet.
  void measure();
  /// Those of a set of ideal stages, by seed.
  std::map<uint32_t, LinearPixels> read(const Ideals& ideals) const;
  /// Of so many seeds those that pictures have whose builds take many times as long.
  static uint32_t fewOf(uint32_t seeds);

 private:
  struct Due {
    uint32_t seed;
    Ideals ideals;
  };
  const Settings& asGiven() const { return run_.grid().base(); }
  bool is(const char* view) const { return std::string_view(run_.task().view.name) == view; }
  uint32_t rays() const { return asGiven().matrix.gpu.rays; }
  uint32_t finerResolution() const;
  uint32_t manyRays() const;
  uint32_t largestShadowMap() const;
  uint32_t manyPoints() const;
  void have(ErrorStage stage, std::string words) { presence_[stage] = {true, std::move(words)}; }
  void lack(ErrorStage stage, std::string words) { presence_[stage] = {false, std::move(words)}; }
  void judge();
  Settings settingsFor(const Ideals& ideals) const;
  uint32_t fewSeeds() const { return fewOf(run_.task().seeds); }
  std::vector<uint32_t> seedsOf(const Ideals& ideals) const;
  std::filesystem::path stemOf(const Ideals& ideals, uint32_t seed) const;
  std::filesystem::path fileOf(const Ideals& ideals, uint32_t seed) const;
  std::filesystem::path secondsFolder() const { return run_.task().out / "seconds"; }
  /// What it took, by which a study that goes on tells how long it will take.
  std::filesystem::path timeFileOf(const Ideals& ideals, uint32_t seed) const;
  std::vector<Due> due() const;
  std::vector<double> secondsOf(const std::vector<Due>& due) const;
  bool measureAll();
  bool make(const Due& due, bool fromVoxelsOn);
  bool dismiss(const Ideals& ideals, const std::string& why);
  LinearPixels drawn(View view) { return run_.bench().picturesAsLit({&view, 1}); }
  LinearPixels picture(const Ideals& ideals, uint32_t seed, PictureTime& time);
  void replaceLookup(const Settings& settings, const std::vector<glm::dvec3>& h, const std::vector<glm::dvec3>& b,
                     uint32_t seed, LinearPixels& pixels);
  std::vector<std::optional<SeenPoint>> seenPoints();

  DeviceSession& session_;
  StudyRun& run_;
  AttributionTask task_;
  std::filesystem::path folder_;
  uint32_t facets_ = 0;  ///< of the picture as it is
  bool tinted_ = false;
  std::map<ErrorStage, StagePresence> presence_;
  std::optional<AttributionTimes> times_;
  struct Exact {
    Due of;
    ExactLight light;
  };
  std::optional<Exact> exact_;  ///< the last one: two pictures in a row often have the same
};

}  // namespace irad::app
