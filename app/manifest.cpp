#include "app/manifest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "app/camera_json.h"
#include "app/version.h"
#include "renderer/error.h"

namespace irad::app {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

std::string readWhole(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in || fs::is_directory(path)) throw InputError(fmt::format("{}: cannot be read", path.string()));
  return {std::istreambuf_iterator<char>(in), {}};
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

}  // namespace

Config readConfigFile(const fs::path& path) {
  Json json;
  try {
    json = Json::parse(readWhole(path));
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: not JSON: {}", path.string(), error.what()));
  }
  if (!json.is_object()) throw InputError(fmt::format("{}: expected a JSON object", path.string()));
  Config config;
  config.path = path;
  if (!json.contains("settings")) {  // a plain settings file
    config.settings = json.dump();
    return config;
  }
  config.settings = json["settings"].dump();
  if (json.contains("scene")) {
    const auto scene = member<std::string>(path, json["scene"], "path");
    if (scene) {
      // A manifest that travelled together with its scene still finds it.
      const fs::path beside = path.parent_path() / fs::path(*scene).filename();
      config.scene = !fs::exists(*scene) && fs::exists(beside) ? beside : fs::path(*scene);
    }
    config.sceneSha256 = member<std::string>(path, json["scene"], "sha256");
  }
  if (const auto size = member<std::vector<uint32_t>>(path, json, "size")) {
    if (size->size() != 2 || !(*size)[0] || !(*size)[1] || (*size)[0] > 16384 || (*size)[1] > 16384)
      throw InputError(fmt::format("{}: size: expected [width, height], 1 to 16384", path.string()));
    config.size = glm::uvec2((*size)[0], (*size)[1]);
  }
  config.frames = member<uint32_t>(path, json, "frames");
  if (config.frames && *config.frames == 0) throw InputError(fmt::format("{}: frames: must not be 0", path.string()));
  config.views = member<std::vector<std::string>>(path, json, "views").value_or(std::vector<std::string>{});
  config.cameras = readCameras(path, json);
  return config;
}

std::string shellQuote(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                          "0123456789_-+=.,:/@%") == std::string::npos;
  if (plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string Manifest::commandLine() const {
  std::vector<std::string> words{"irad", subcommand, fs::absolute(scene->path).lexically_normal().string()};
  if (device) words.insert(words.end(), {"--device", device->name});
  if (size) words.insert(words.end(), {"--size", fmt::format("{}x{}", size->x, size->y)});
  for (const Camera& camera : cameras) words.insert(words.end(), {"--camera", cameraToJson(camera)});
  for (const std::string& view : views) words.insert(words.end(), {"--view", view});
  if (frames && *frames != 1) words.insert(words.end(), {"--frames", std::to_string(*frames)});
  const std::vector<SettingInfo> usual = settingInfos(defaultSettings(cpuDevice)), now = settingInfos(*settings);
  for (size_t i = 0; i < now.size(); ++i)
    if (now[i].value != usual[i].value)
      words.insert(words.end(), {"--set", fmt::format("{}={}", now[i].meta.name, now[i].value)});
  words.insert(words.end(), arguments.begin(), arguments.end());
  for (std::string& word : words) word = shellQuote(word);
  return fmt::format("{}", fmt::join(words, " "));
}

std::string Manifest::toJson() const {
  Json json;
  json["program"] = {{"name", "irad"}, {"version", versionNumber()}, {"commit", versionCommit()}};
  json["command"] = commandLine();
  if (device)
    json["device"] = {{"name", device->name},
                      {"type", device->type},
                      {"driver", device->driver},
                      {"api", device->apiVersion},
                      {"memory_bytes", device->memoryBytes}};
  json["scene"] = {{"path", fs::absolute(scene->path).lexically_normal().string()}, {"sha256", scene->sha256}};
  json["settings"] = Json::parse(settingsToJson(*settings));
  json["seed"] = settings->matrix.gpu.seed;
  if (size) json["size"] = {size->x, size->y};
  if (frames) json["frames"] = *frames;
  if (!cameras.empty()) {
    json["cameras"] = Json::array();
    for (const Camera& camera : cameras) json["cameras"].push_back(Json::parse(cameraToJson(camera)));
  }
  if (!views.empty()) json["views"] = views;
  for (const auto& [name, text] : details) json[name] = Json::parse(text);
  json["files"] = files;
  json["warnings"] = scene->warnings;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace irad::app
