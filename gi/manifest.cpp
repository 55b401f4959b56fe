#include "gi/manifest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <ctime>
#include <nlohmann/json.hpp>

#include "gi/check/check.h"
#include "gi/picture.h"
#include "gi/region.h"
#include "renderer/base/json_reader.h"
#include "renderer/scene/camera_json.h"
#include "renderer/scene/light_json.h"
#include "renderer/scene/material_edits.h"
#include "renderer/scene/sky_image.h"

namespace irad {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

/// What the command line takes for the scene, in any folder.
std::string sceneArgument(const Scene& scene) {
  return isCheckScene(scene.path) ? scene.path.string() : fs::absolute(scene.path).lexically_normal().string();
}

/// Quoted for a POSIX shell where needed.
std::string shellQuote(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                          "0123456789_-+=.,:/@%") == std::string::npos;
  if (plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

std::string timeText(int64_t seconds) {
  const auto time = static_cast<std::time_t>(seconds);
  std::tm utc{};
  char text[64] = "";
  if (gmtime_r(&time, &utc)) std::strftime(text, sizeof(text), "%FT%TZ", &utc);
  return text;
}

std::optional<int64_t> timeFromText(const std::string& text) {
  std::tm utc{};
  const char* end = strptime(text.c_str(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  if (end != text.c_str() + text.size()) return std::nullopt;
  const int64_t seconds = timegm(&utc);  // of February 30 it makes March 2
  return timeText(seconds) == text ? std::optional(seconds) : std::nullopt;
}

std::string settingsFile(const Settings& settings) {
  Json json{{"format", kConfigFormat}};
  json.update(Json::parse(settingsToJson(settings)));
  return jsonText(json, 2);
}

std::string Manifest::commandLine() const {
  std::vector<std::string> words{"irad", subcommand, sceneArgument(*scene), "--no-sidecar"};
  if (scene->lights != scene->fileLights) words.insert(words.end(), {"--lights", lightsToJson(scene->lights)});
  if (!scene->materialEdits.empty())
    words.insert(words.end(), {"--materials", materialEditsToJson(scene->materialEdits)});
  for (const std::string& path : scene->hidden.paths) words.insert(words.end(), {"--hide", path});
  if (!scene->hidden.isolated.empty()) words.insert(words.end(), {"--isolate", scene->hidden.isolated});
  if (device) words.insert(words.end(), {"--device", device->name});
  if (size) words.insert(words.end(), {"--size", fmt::format("{}x{}", size->x, size->y)});
  for (const Camera& camera : cameras) words.insert(words.end(), {"--camera", cameraToJson(camera)});
  for (const std::string& view : views) words.insert(words.end(), {"--view", view});
  if (frames && *frames != 1) words.insert(words.end(), {"--frames", std::to_string(*frames)});
  const Settings usual = defaultSettings(cpuDevice);
  const Settings used = withRegionOf(*scene, *settings);
  for (const Setting& setting : settingTable())
    if (setting.get(used) != setting.get(usual))
      words.insert(words.end(), {"--set", fmt::format("{}={}", setting.name, setting.text(used))});
  if (reference) words.insert(words.end(), {"--reference", reference->path.string()});
  if (scene->sky) words.insert(words.end(), {"--sky", scene->sky->path.string()});
  words.insert(words.end(), arguments.begin(), arguments.end());
  for (std::string& word : words) word = shellQuote(word);
  return fmt::format("{}", fmt::join(words, " "));
}

std::string Manifest::toJson() const {
  Json json;
  json["format"] = kConfigFormat;
  json["program"] = {{"name", "irad"}, {"version", program.version}, {"commit", program.commit}};
  if (time) json["time"] = timeText(*time);
  json["command"] = commandLine();
  if (device)
    json["device"] = {{"name", device->name},
                      {"type", device->type},
                      {"driver", device->driver},
                      {"api", device->apiVersion},
                      {"memory_bytes", device->memoryBytes}};
  json["scene"] = {{"path", sceneArgument(*scene)}, {"sha256", scene->sha256}};
  json["settings"] = Json::parse(settingsToJson(withRegionOf(*scene, *settings)));
  json["seed"] = settings->matrix.gpu.seed;
  if (size) json["size"] = {size->x, size->y};
  if (frames) json["frames"] = *frames;
  if (!cameras.empty()) {
    json["cameras"] = Json::array();
    for (const Camera& camera : cameras) json["cameras"].push_back(Json::parse(cameraToJson(camera)));
  }
  json["lights"] = Json::parse(lightsToJson(scene->lights));
  if (!scene->materialEdits.empty()) json["materials"] = Json::parse(materialEditsToJson(scene->materialEdits));
  if (!scene->hidden.paths.empty()) json["hidden"] = scene->hidden.paths;
  if (!scene->hidden.isolated.empty()) json["isolated"] = scene->hidden.isolated;
  if (!views.empty()) json["views"] = views;
  if (!viewRanges.empty()) json["view_ranges"] = Json::parse(fmt::format("[{}]", fmt::join(viewRanges, ",")));
  if (reference) json["reference"] = {{"path", reference->path.string()}, {"sha256", reference->sha256}};
  if (scene->sky) json["sky"] = {{"path", scene->sky->path.string()}, {"sha256", scene->sky->sha256}};
  if (!shaders.empty()) json["shaders"] = shaders;
  for (const auto& [name, text] : details) json[name] = Json::parse(text);
  json["files"] = files;
  json["warnings"] = scene->warnings;
  return jsonText(json, 2) + "\n";
}

}  // namespace irad
