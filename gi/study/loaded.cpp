#include "gi/study/loaded.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "gi/picture.h"
#include "gi/study/sweep.h"
#include "renderer/base/csv.h"
#include "renderer/base/error.h"
#include "renderer/scene/camera_json.h"

namespace irad {
namespace {

namespace fs = std::filesystem;

std::string member(const nlohmann::ordered_json& json, const char* name) {
  if (!json.contains(name)) return "";
  return json.at(name).is_string() ? json.at(name).get<std::string>() : json.at(name).dump();
}

glm::uvec2 sizeOf(const nlohmann::ordered_json& json) {
  if (!json.contains("size") || !json["size"].is_array() || json["size"].size() != 2) return glm::uvec2(0);
  const auto& size = json["size"];
  return size[0].is_number_unsigned() && size[1].is_number_unsigned() ? glm::uvec2(size[0], size[1]) : glm::uvec2(0);
}

void readPoints(LoadedStudy& study, const StudyIdentity& identity) {
  const SettingGrid grid = gridOf(identity);
  for (size_t point = 0; point < grid.size(); ++point) study.settings.push_back(grid.settings(point));
  study.points = summarize(readResults(study.folder), grid.labels());
}

}  // namespace

std::vector<bool> LoadedStudy::measured() const {
  std::vector<bool> out;
  for (const PointSummary& p : points) out.push_back(p.failure.empty() && std::isfinite(p.relMse.mean));
  return out;
}

std::optional<Camera> cameraOf(const LoadedStudy& study) {
  if (study.camera.empty()) return std::nullopt;
  try {
    return cameraFromJson(study.camera);
  } catch (const UsageError&) {
    return std::nullopt;
  }
}

Misfit misfit(const LoadedStudy& study, const std::string& sceneSha256, const Camera& camera, glm::uvec2 size) {
  Misfit out;
  if (!study.sceneSha256.empty() && study.sceneSha256 != sceneSha256) out.scene = study.scene;
  if (const std::optional<Camera> of = cameraOf(study))
    out.camera = otherCamera(of, camera);
  else if (!study.camera.empty())
    out.camera = "study.json does not say it as cameras are written";
  if (study.size != glm::uvec2(0) && study.size != size)
    out.size = fmt::format("{} \u00D7 {} pixels, not {} \u00D7 {}", study.size.x, study.size.y, size.x, size.y);
  return out;
}

std::vector<StageShare> readStageShares(const fs::path& file) {
  std::ifstream in(file);
  if (!in) throw InputError(fmt::format("{}: cannot be read", file.string()));
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> head = csvFields(line);
  const auto column = [&](std::initializer_list<const char*> names) {
    for (const char* name : names)
      if (const auto found = std::ranges::find(head, name); found != head.end())
        return static_cast<size_t>(found - head.begin());
    throw InputError(fmt::format("{}: no column '{}' in '{}'", file.string(), *names.begin(), line));
  };
  const size_t name = column({"row", "stage"}), relMse = column({"relmse"}), gain = column({"gain", "relmse"});
  std::vector<StageShare> out;
  while (std::getline(in, line)) {
    const std::vector<std::string> fields = csvFields(line);
    if (fields.size() <= std::max({name, relMse, gain})) continue;
    const std::string& stage = fields[name];
    // Sums, remainders and the parts of a part ("rays.bias") are no stages.
    if (stage == "picture" || stage == "other" || stage == "rest" || stage.find('.') != std::string::npos) continue;
    const std::string& text = fields[stage == "model" ? relMse : gain];
    StageShare share{stage, 0};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), share.relMse);
    if (error == std::errc{} && end == text.data() + text.size() && std::isfinite(share.relMse)) out.push_back(share);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const StageShare& a, const StageShare& b) { return a.relMse > b.relMse; });
  return out;
}

LoadedStudy loadStudy(const fs::path& folder) {
  LoadedStudy study;
  study.folder = folder;
  std::error_code ignored;
  const fs::path attribution = folder / "attribution.csv";
  const bool shares = fs::exists(attribution, ignored);
  if (!shares || fs::exists(folder / "study.json", ignored)) {
    const StudyIdentity identity = readIdentity(folder);
    const auto json = nlohmann::ordered_json::parse(identity);
    study.scene = member(json, "scene"), study.sceneSha256 = member(json, "scene_sha256");
    study.device = member(json, "device"), study.view = member(json, "view"), study.camera = member(json, "camera");
    study.size = sizeOf(json);
    if (!shares || !member(json, "study").starts_with("attribution")) readPoints(study, identity);
  }
  if (shares) study.stages = readStageShares(attribution);
  return study;
}

}  // namespace irad
