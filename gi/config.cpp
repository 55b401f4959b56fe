#include "gi/config.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "gi/manifest.h"
#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/scene/camera_json.h"
#include "renderer/scene/light_json.h"
#include "renderer/scene/material_edits.h"

namespace irad {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

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

/// A member {"path", "sha256"}. A file that was moved together with its manifest is found beside it.
std::pair<std::optional<fs::path>, std::optional<std::string>> readNamedFile(const fs::path& path, const Json& json,
                                                                             const char* name) {
  if (!json.contains(name)) return {};
  std::optional<fs::path> file;
  if (const auto text = member<std::string>(path, json[name], "path")) {
    const fs::path beside = path.parent_path() / fs::path(*text).filename();
    std::error_code ignored;  // a name that is no path at all does not exist either
    file = !fs::exists(*text, ignored) && fs::exists(beside, ignored) ? beside : fs::path(*text);
  }
  return {file, member<std::string>(path, json[name], "sha256")};
}

/// Cameras, lights or materials, by `parse`, which names the element and its field.
template <class Parse>
auto readArray(const fs::path& path, const Json& json, const char* name, Parse&& parse) {
  try {
    return parse(json.at(name).dump(), fmt::format("{}: {}", path.string(), name));
  } catch (const UsageError& error) {
    throw InputError(error.what());
  }
}

/// A newer program's file may mean other things by the names that it shares with ours.
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
  for (const Setting& known : settingTable()) unknown.erase(known.name);
  throw InputError(fmt::format(
      "{}: is of format {}, written by a newer program; this one reads up to format {}{}", path.string(), format,
      kConfigFormat, unknown.empty() ? "" : fmt::format("; settings it does not know: {}", fmt::join(unknown, ", "))));
}

}  // namespace

Config readConfigFile(const fs::path& path) {
  Json json = readJsonFile(path);
  if (!json.is_object()) throw InputError(fmt::format("{}: expected a JSON object", path.string()));
  checkFormat(path, json);
  Config config;
  config.path = path;
  if (!json.contains("settings")) {  // a plain settings file
    json.erase("format");
    config.settings = json.dump();
    return config;
  }
  config.manifest = true;
  config.settings = json["settings"].dump();
  const auto word = [&](const char* object, const char* name) {
    return json.contains(object) ? member<std::string>(path, json[object], name).value_or("") : "";
  };
  config.program = word("program", "version");
  if (const std::string commit = word("program", "commit"); !commit.empty()) config.program += ", " + commit;
  config.device = word("device", "name");
  config.driver = word("device", "driver");
  if (json.contains("other_settings")) config.otherSettings = json["other_settings"].dump();
  if (const auto time = member<std::string>(path, json, "time")) {
    config.time = timeFromText(*time);
    if (!config.time)
      throw InputError(fmt::format("{}: time: expected YYYY-MM-DDThh:mm:ssZ, not {}", path.string(), *time));
  }
  std::tie(config.scene, config.sceneSha256) = readNamedFile(path, json, "scene");
  std::tie(config.reference, config.referenceSha256) = readNamedFile(path, json, "reference");
  std::tie(config.sky, config.skySha256) = readNamedFile(path, json, "sky");
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
  if (json.contains("cameras")) config.cameras = readArray(path, json, "cameras", camerasFromJson);
  if (json.contains("lights")) config.lights = readArray(path, json, "lights", lightsFromJson);
  if (json.contains("materials")) config.materials = readArray(path, json, "materials", materialEditsFromJson);
  config.hidden.paths = member<std::vector<std::string>>(path, json, "hidden").value_or(std::vector<std::string>{});
  config.hidden.isolated = member<std::string>(path, json, "isolated").value_or("");
  return config;
}

}  // namespace irad
