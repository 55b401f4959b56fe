#include "app/config.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "app/version.h"
#include "gi/camera_json.h"
#include "gi/manifest.h"
#include "renderer/error.h"
#include "renderer/json_extent.h"

namespace irad::app {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMaxConfigBytes = 16 << 20;

/// Of a file or a pipe; never more than it may be.
std::string readWhole(const fs::path& path) {
  std::error_code error;
  std::ifstream in(path, std::ios::binary);
  if (!in || fs::is_directory(path, error)) throw InputError(fmt::format("{}: cannot be read", path.string()));
  std::string text;
  for (char part[65536]; in.read(part, sizeof part), in.gcount() > 0;) {
    text.append(part, static_cast<size_t>(in.gcount()));
    if (text.size() > kMaxConfigBytes)
      throw InputError(fmt::format("{}: more than {} MiB", path.string(), kMaxConfigBytes >> 20));
  }
  return text;
}

/// Integers of JSON convert silently: -1, 2.5 and 1e30 would all become some uint32_t.
uint32_t whole(const fs::path& path, const Json& json, const char* name, uint32_t max) {
  if (!json.is_number_unsigned() || json.get<uint64_t>() < 1 || json.get<uint64_t>() > max)
    throw InputError(
        fmt::format("{}: {}: expected a whole number, 1 to {}, not {}", path.string(), name, max, json.dump()));
  return json.get<uint32_t>();
}

template <class T>
std::optional<T> member(const fs::path& path, const Json& json, const char* name) {
  if (!json.contains(name)) return std::nullopt;
  try {
    return json.at(name).get<T>();
  } catch (const nlohmann::json::exception&) {
    throw InputError(fmt::format("{}: {}: unexpected value {}", path.string(), name, json.at(name).dump()));
  }
}

std::vector<Camera> readCameras(const fs::path& path, const Json& json) {
  std::vector<Camera> cameras;
  if (!json.contains("cameras")) return cameras;
  for (const Json& camera : json["cameras"]) try {
      cameras.push_back(cameraFromJson(camera.dump()));
    } catch (const UsageError& error) {
      throw InputError(fmt::format("{}: cameras: {}", path.string(), error.what()));
    }
  return cameras;
}

/// A file of a newer program may mean other things by the names it shares with ours.
void checkFormat(const fs::path& path, const Json& json) {
  if (!json.contains("format")) return;
  if (!json["format"].is_number_unsigned())
    throw InputError(fmt::format("{}: format: unexpected value {}", path.string(), json["format"].dump()));
  const auto format = json["format"].get<uint64_t>();
  if (format <= kConfigFormat) return;
  std::set<std::string> unknown;
  const Json& settings = json.contains("settings") ? json["settings"] : json;
  if (settings.is_object())
    for (const auto& [name, value] : settings.items()) unknown.insert(name);
  unknown.erase("format");
  for (const SettingInfo& known : settingInfos(Settings{})) unknown.erase(known.meta.name);
  throw InputError(
      fmt::format("{}: is of format {}, written by a newer program; irad {} reads up to format {}{}", path.string(),
                  format, versionNumber(), kConfigFormat,
                  unknown.empty() ? "" : fmt::format("; settings it does not know: {}", fmt::join(unknown, ", "))));
}

}  // namespace

Config readConfigFile(const fs::path& path) {
  const std::string text = readWhole(path);
  if (jsonExtent(text).depth > kMaxJsonDepth)
    throw InputError(fmt::format("{}: JSON nested too deeply", path.string()));
  Json json;
  try {
    json = Json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: not JSON: {}", path.string(), error.what()));
  }
  if (!json.is_object()) throw InputError(fmt::format("{}: expected a JSON object", path.string()));
  checkFormat(path, json);
  Config config;
  config.path = path;
  if (!json.contains("settings")) {  // a plain settings file
    json.erase("format");
    config.settings = json.dump();
    return config;
  }
  config.settings = json["settings"].dump();
  if (json.contains("scene")) {
    const auto scene = member<std::string>(path, json["scene"], "path");
    if (scene) {
      // A manifest that travelled together with its scene still finds it.
      const fs::path beside = path.parent_path() / fs::path(*scene).filename();
      std::error_code ignored;  // a name that is no path at all does not exist either
      config.scene = !fs::exists(*scene, ignored) && fs::exists(beside, ignored) ? beside : fs::path(*scene);
    }
    config.sceneSha256 = member<std::string>(path, json["scene"], "sha256");
  }
  if (json.contains("size")) {
    const Json& size = json["size"];
    if (!size.is_array() || size.size() != 2)
      throw InputError(fmt::format("{}: size: expected [width, height], not {}", path.string(), size.dump()));
    config.size =
        glm::uvec2(whole(path, size[0], "size", kMaxPictureSide), whole(path, size[1], "size", kMaxPictureSide));
  }
  if (json.contains("frames")) config.frames = whole(path, json["frames"], "frames", kMaxFrames);
  config.views = member<std::vector<std::string>>(path, json, "views").value_or(std::vector<std::string>{});
  config.shaders = member<std::vector<std::string>>(path, json, "shaders").value_or(std::vector<std::string>{});
  config.cameras = readCameras(path, json);
  return config;
}

}  // namespace irad::app
