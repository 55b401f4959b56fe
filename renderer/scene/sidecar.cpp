#include "renderer/scene/sidecar.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/output_file.h"
#include "renderer/scene/camera_json.h"
#include "renderer/scene/light_json.h"
#include "renderer/scene/material_edits.h"

namespace irad {
namespace fs = std::filesystem;
namespace {

/// Checked first: unknown members written by a newer program are no mistakes.
void checkFormat(const OrderedJson& json, const std::string& file) {
  if (!json.is_object() || !json.contains("format")) throw UsageError(file + ": format is missing");
  const OrderedJson& format = json["format"];
  if (!format.is_number_unsigned() || format.get<uint64_t>() < 1)
    throw UsageError(fmt::format("{}: format: expected a whole number from 1, not {}", file, jsonText(format)));
  if (format.get<uint64_t>() > kSidecarFormat)
    throw UsageError(fmt::format("{}: is of format {}, written by a newer program; this one reads up to format {}",
                                 file, format.get<uint64_t>(), kSidecarFormat));
}

HiddenNodes readHidden(const JsonObject& json) {
  HiddenNodes hidden;
  if (json.has("isolated")) hidden.isolated = json.text("isolated");
  if (!json.has("hidden")) return hidden;
  const OrderedJson& paths = json.at("hidden");
  if (!paths.is_array()) json.refuse("hidden", "expected an array of nodes' paths", paths);
  for (const OrderedJson& path : paths) {
    if (!path.is_string()) json.refuse("hidden", "expected the path of a node", path);
    hidden.paths.push_back(path.get<std::string>());
  }
  std::ranges::sort(hidden.paths);
  hidden.paths.erase(std::unique(hidden.paths.begin(), hidden.paths.end()), hidden.paths.end());
  return hidden;
}

RegionBox readRegion(const OrderedJson& region, const std::string& label) {
  const JsonObject json(region, label, {"least", "largest"});
  const RegionBox box{glm::vec3(json.vector<3>("least")), glm::vec3(json.vector<3>("largest"))};
  for (int axis = 0; axis < 3; ++axis)
    if (!(box.least[axis] < box.largest[axis])) json.refuse("largest", "each has to be more than its least");
  return box;
}

Sidecar parse(const OrderedJson& parsed, const std::string& file) {
  checkFormat(parsed, file);
  const JsonObject json(parsed, file,
                        {"format", "scene_sha256", "lights", "materials", "hidden", "isolated", "cameras", "region"});
  Sidecar sidecar;
  if (json.has("scene_sha256")) sidecar.sceneSha256 = json.text("scene_sha256");
  if (json.has("lights")) sidecar.lights = lightsFromJson(json.at("lights").dump(), file + ": lights");
  if (json.has("materials"))
    sidecar.materials = materialEditsFromJson(json.at("materials").dump(), file + ": materials");
  sidecar.hidden = readHidden(json);
  if (json.has("cameras")) sidecar.bookmarks = camerasFromJson(json.at("cameras").dump(), file + ": cameras");
  if (json.has("region")) sidecar.region = readRegion(json.at("region"), file + ": region");
  std::set<std::string> names;
  for (size_t i = 0; i < sidecar.bookmarks.size(); ++i) {
    const std::string& name = sidecar.bookmarks[i].name;
    const char* wrong = name.empty() ? "a bookmark needs one" : !names.insert(name).second ? "is taken" : nullptr;
    if (wrong) throw UsageError(fmt::format("{}: cameras[{}]: name '{}': {}", file, i, name, wrong));
  }
  return sidecar;
}

}  // namespace

std::vector<Camera> allCameras(const Scene& scene) {
  std::vector<Camera> cameras = scene.cameras;
  cameras.insert(cameras.end(), scene.bookmarks.begin(), scene.bookmarks.end());
  return cameras;
}

fs::path sidecarPath(const fs::path& scene) {
  fs::path path = scene;
  path += kSidecarExtension;
  return path;
}

Sidecar readSidecar(const fs::path& path) {
  try {
    return parse(readJsonFile(path), path.string());
  } catch (const UsageError& error) {
    throw InputError(error.what());
  }
}

std::string sidecarToJson(const Sidecar& sidecar) {
  OrderedJson json;
  json["format"] = kSidecarFormat;
  if (!sidecar.sceneSha256.empty()) json["scene_sha256"] = sidecar.sceneSha256;
  if (sidecar.lights) json["lights"] = OrderedJson::parse(lightsToJson(*sidecar.lights));
  if (!sidecar.materials.empty()) json["materials"] = OrderedJson::parse(materialEditsToJson(sidecar.materials));
  if (!sidecar.hidden.paths.empty()) json["hidden"] = sidecar.hidden.paths;
  if (!sidecar.hidden.isolated.empty()) json["isolated"] = sidecar.hidden.isolated;
  json["cameras"] = OrderedJson::array();
  for (const Camera& camera : sidecar.bookmarks) json["cameras"].push_back(OrderedJson::parse(cameraToJson(camera)));
  if (const auto& region = sidecar.region) {
    const auto list = [](const glm::vec3& v) {  // 0.1, not 0.10000000149011612
      return OrderedJson::parse(fmt::format("[{},{},{}]", v.x, v.y, v.z));
    };
    json["region"] = {{"least", list(region->least)}, {"largest", list(region->largest)}};
  }
  return jsonText(json, 2);
}

Sidecar sidecarFromJson(std::string_view json, const std::string& label) {
  return parse(parseJson(json, label), label);
}

void writeSidecar(const fs::path& path, const Sidecar& sidecar) {
  writeFile(path, sidecarToJson(sidecar) + "\n");
}

void takeSidecar(Scene& scene) {
  const fs::path path = sidecarPath(scene.path);
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return;
  Sidecar sidecar = readSidecar(path);
  scene.sidecar = path;
  if (sidecar.lights) replaceLights(scene, std::move(*sidecar.lights));
  replaceMaterialEdits(scene, std::move(sidecar.materials));
  scene.hidden = std::move(sidecar.hidden);
  scene.bookmarks = std::move(sidecar.bookmarks);
  scene.region = sidecar.region;
  if (!sidecar.sceneSha256.empty() && sidecar.sceneSha256 != scene.sha256)
    scene.warnings.push_back(
        fmt::format("{} has changed since {} was saved", scene.path.filename().string(), path.filename().string()));
}

std::string sidecarNote(const Scene& scene) {
  std::vector<std::string> what;
  if (scene.lights != scene.fileLights) what.emplace_back("lights");
  if (!scene.materialEdits.empty()) what.emplace_back("materials");
  if (!scene.hidden.empty()) what.emplace_back("hidden objects");
  if (!scene.bookmarks.empty()) what.emplace_back("cameras");
  if (scene.region) what.emplace_back("region");
  if (what.empty()) what.emplace_back("nothing");
  return fmt::format("{} of {}", fmt::join(what, " and "), scene.sidecar.filename().string());
}

}  // namespace irad
