// One experiment of a named study: a cost study in its folder, and what else it measures, in figures.csv beside it.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/study.h"
#include "gi/study/named.h"
#include "gi/study/thesis_tables.h"

namespace irad::app {

/// ../shared, or $IRAD_SHARED.
std::filesystem::path sharedFolder();
/// --sponza, or where it lies by default; nothing where it is not there. InputError where a file that was given is not.
std::optional<std::filesystem::path> findSponza(const std::optional<std::string>& given);

/// What experiments come to, before any of them is begun.
struct ExperimentsAhead {
  size_t experiments = 0, points = 0;  ///< that can be measured here, of this shard
  double pictures = 0;                 ///< that their folders lack
  size_t asking = 0;                   ///< experiments whose truth is computed
  size_t truths = 0, missing = 0;      ///< different ones among these truths; those that are not there yet
  double seconds = 0;                  ///< of pictures and truths that are missing, about, by trials in each scene
};

class ExperimentRunner {
 public:
  /// `truths`: the folder of those that its experiments compute and share.
  ExperimentRunner(DeviceSession& session, const MeasureArguments& measure, const StudyScale& scale,
                   std::optional<std::filesystem::path> sponza, Shard shard, uint32_t seeds, uint32_t repeats,
                   std::filesystem::path truths);
  /// How many pictures it is, about; 0 where it is skipped. UsageError where settings do not go together.
  double pictures(const Experiment& e) const;
  /// Loads all scenes and tries a picture and some samples in each where there is work in it.
  ExperimentsAhead ahead(std::vector<std::pair<Experiment, std::filesystem::path>> experiments);
  /// Measures what the folder does not have yet. What cannot be measured here is a file that says why (skipped.txt);
  /// of an experiment that has no point in this shard there is nothing. `who`: "rq6 box-thesis".
  void run(const Experiment& e, const std::filesystem::path& folder, const std::string& who);

 private:
  Settings base(const Experiment& e) const;
  std::string whyNot(const Experiment& e) const;
  const Scene& sceneOf(const Experiment& e);
  SettingGrid gridOf(const Experiment& e) const;
  uint32_t repeatsOf(const Experiment& e) const {
    return e.longTimes ? std::max(repeats_, scale_.tableRepeats) : repeats_;
  }
  StudyTask taskOf(const Experiment& e, const Scene& scene, const std::filesystem::path& folder);
  void measureFigures(const Experiment& e, const StudyRun& run, const StudyTask& task);
  void measureTables(const Scene& scene, const Settings& settings, const std::filesystem::path& folder,
                     std::map<std::string, double>& figures);

  DeviceSession& session_;
  const MeasureArguments& measure_;
  const StudyScale& scale_;
  std::optional<std::filesystem::path> sponza_;
  Shard shard_;
  uint32_t seeds_, repeats_;
  SharedTruths truths_;
  std::string loaded_;  ///< what scene_ is
  std::optional<Scene> scene_;
  std::string sceneContent_;
};

// ---- What lies in an experiment's folder beside a cost study ----

std::string readSkipped(const std::filesystem::path& folder);                    ///< empty: it is not skipped
std::map<std::string, double> readFigures(const std::filesystem::path& folder);  ///< InputError names file and line
/// T Table 1: as published, by its formulas, and measured; empty where it was not made.
TextTable readMemoryTable(const std::filesystem::path& folder);
/// Puts an experiment's shards together. What is in none of them is skipped.
void mergeExperiment(const std::vector<std::filesystem::path>& shards, const std::filesystem::path& out);

}  // namespace irad::app
