#include "renderer/scene/sidecar.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

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
    throw UsageError(fmt::format("{}: format: expected a whole number from 1, not {}", file, format.dump()));
  if (format.get<uint64_t>() > kSidecarFormat)
    throw UsageError(fmt::format("{}: is of format {}, written by a newer program; this one reads up to format {}",
                                 file, format.get<uint64_t>(), kSidecarFormat));
}

Sidecar parse(const OrderedJson& parsed, const std::string& file) {
  checkFormat(parsed, file);
  const JsonObject json(parsed, file, {"format", "scene_sha256", "lights", "materials", "cameras"});
  Sidecar sidecar;
  if (json.has("scene_sha256")) sidecar.sceneSha256 = json.text("scene_sha256");
  if (json.has("lights")) sidecar.lights = lightsFromJson(json.at("lights").dump(), file + ": lights");
  if (json.has("materials"))
    sidecar.materials = materialEditsFromJson(json.at("materials").dump(), file + ": materials");
  if (json.has("cameras")) sidecar.bookmarks = camerasFromJson(json.at("cameras").dump(), file + ": cameras");
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

void writeSidecar(const fs::path& path, const Sidecar& sidecar) {
  OrderedJson json;
  json["format"] = kSidecarFormat;
  if (!sidecar.sceneSha256.empty()) json["scene_sha256"] = sidecar.sceneSha256;
  if (sidecar.lights) json["lights"] = OrderedJson::parse(lightsToJson(*sidecar.lights));
  if (!sidecar.materials.empty()) json["materials"] = OrderedJson::parse(materialEditsToJson(sidecar.materials));
  json["cameras"] = OrderedJson::array();
  for (const Camera& camera : sidecar.bookmarks) json["cameras"].push_back(OrderedJson::parse(cameraToJson(camera)));
  writeFile(path, json.dump(2) + "\n");
}

void takeSidecar(Scene& scene) {
  const fs::path path = sidecarPath(scene.path);
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return;
  Sidecar sidecar = readSidecar(path);
  scene.sidecar = path;
  if (sidecar.lights) replaceLights(scene, std::move(*sidecar.lights));
  replaceMaterialEdits(scene, std::move(sidecar.materials));
  scene.bookmarks = std::move(sidecar.bookmarks);
  if (!sidecar.sceneSha256.empty() && sidecar.sceneSha256 != scene.sha256)
    scene.warnings.push_back(
        fmt::format("{} has changed since {} was saved", scene.path.filename().string(), path.filename().string()));
}

std::string sidecarNote(const Scene& scene) {
  std::vector<std::string> what;
  if (scene.lights != scene.fileLights) what.emplace_back("lights");
  if (!scene.materialEdits.empty()) what.emplace_back("materials");
  if (!scene.bookmarks.empty()) what.emplace_back("cameras");
  if (what.empty()) what.emplace_back("nothing");
  return fmt::format("{} of {}", fmt::join(what, " and "), scene.sidecar.filename().string());
}

}  // namespace irad
