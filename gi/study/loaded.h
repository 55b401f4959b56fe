// A study's folder as the window reads it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gi/settings.h"
#include "gi/study/results.h"
#include "renderer/scene/scene.h"

namespace irad {

/// What a stage adds to the error, of a study of attribution.
struct StageShare {
  std::string stage;  ///< or "model": what ideal stages leave
  double relMse = 0;
};

struct LoadedStudy {
  std::filesystem::path folder;
  // What it was made of; empty where the folder does not say.
  std::string scene, sceneSha256, device, view, camera;  ///< scene: its file's name; camera: JSON
  glm::uvec2 size{0};                                    ///< of its pictures
  std::vector<PointSummary> points;
  std::vector<Settings> settings;      ///< of each point
  std::vector<StageShare> stages;      ///< largest first; of attribution.csv, where there is one
  std::vector<bool> measured() const;  ///< of each point: it was computed
};
/// Reads study.json with its rows, attribution.csv, or both. InputError names file, member or line and what is wrong,
/// also where the folder holds neither.
LoadedStudy loadStudy(const std::filesystem::path& folder);

/// What of a study does not hold for a picture, in words; empty: it does, or the study does not say.
struct Misfit {
  std::string scene, camera;  ///< none of its figures are this picture's
  std::string size;           ///< its costs that grow with the picture are not (CostKind::ofPicture)
  bool usable() const { return scene.empty() && camera.empty(); }
};
Misfit misfit(const LoadedStudy& study, const std::string& sceneSha256, const Camera& camera, glm::uvec2 size);
/// None where the folder does not say, or not as cameras are written.
std::optional<Camera> cameraOf(const LoadedStudy& study);

/// Of an attribution.csv, by its columns `row` (or `stage`), `gain` (or `relmse`), what is gained where that stage
/// alone is ideal, and for the row `model` `relmse`, what is left where all are. Rows without a number are left out.
/// InputError where it has no such columns.
std::vector<StageShare> readStageShares(const std::filesystem::path& file);

}  // namespace irad
