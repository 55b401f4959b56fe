#include "ui/preferences.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/output_file.h"
#include "ui/setting_rows.h"

namespace irad {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFormat = 1;
constexpr size_t kMostRecent = 8;
constexpr float kLargest = 4000;  ///< of a remembered size, units

struct Member {
  const char* name;
  float PanelSizes::*size;
};
constexpr Member kSizes[] = {
    {"left", &PanelSizes::left}, {"right", &PanelSizes::right}, {"bottom", &PanelSizes::bottom}};

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& member, const Json& value,
                       const char* wanted) {
  throw InputError(fmt::format("{}: {} is {}; it must be {}", file.string(), member, jsonText(value), wanted));
}

std::vector<std::string> strings(const std::filesystem::path& file, const Json& json, const char* member) {
  std::vector<std::string> out;
  if (!json.contains(member)) return out;
  if (!json[member].is_array()) fail(file, member, json[member], "a list of strings");
  for (const Json& entry : json[member]) {
    if (!entry.is_string()) fail(file, member, entry, "a string");
    out.push_back(entry);
  }
  return out;
}

}  // namespace

std::set<std::string> Preferences::foldedAtFirst() {
  std::set<std::string> titles{"Accuracy", "Cameras", "History", "Lights",   "Materials",
                               "Objects",  "Scene",   "Timings", kEffectsOff};
  for (const std::string& group : settingGroups()) titles.insert("Settings/" + group);
  return titles;
}

Folding Preferences::folding() const {
  return {folded.contains(kLeftColumn), folded.contains(kRightColumn), folded.contains("Timings")};
}

void Preferences::resetLayout() {
  sizes = {};
  scale = 0;
  folded = Preferences().folded;
}

void Preferences::opened(const std::filesystem::path& scene) {
  const std::filesystem::path path = std::filesystem::absolute(scene).lexically_normal();
  std::erase(recent, path);
  recent.insert(recent.begin(), path);
  if (recent.size() > kMostRecent) recent.resize(kMostRecent);
}

std::filesystem::path preferencesFile() {
  const auto folder = [](const char* variable) {
    const char* value = std::getenv(variable);
    const std::filesystem::path path = value ? value : "";
    return path.is_absolute() ? path : std::filesystem::path();  // relative: ignored, as specified
  };
  if (const auto config = folder("XDG_CONFIG_HOME"); !config.empty()) return config / "irad" / "window.json";
  if (const auto home = folder("HOME"); !home.empty()) return home / ".config" / "irad" / "window.json";
  return {};
}

Preferences readPreferences(const std::filesystem::path& file) {
  Preferences preferences;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return preferences;
  const Json json = readJsonFile(file);
  if (!json.is_object()) fail(file, "the file", json, "an object");
  if (json.value("format", Json()) != kFormat) fail(file, "format", json.value("format", Json()), "1");
  for (const Member& member : kSizes) {
    if (!json.contains(member.name)) continue;
    const Json& size = json[member.name];
    if (!size.is_number() || !(size >= 0) || !(size <= kLargest)) fail(file, member.name, size, "from 0 to 4000");
    preferences.sizes.*member.size = size;
  }
  if (json.contains("scale")) {
    const Json& scale = json["scale"];
    const bool chosen = scale.is_number() && scale >= Preferences::kSmallest && scale <= Preferences::kLargest;
    if (!chosen && scale != 0) fail(file, "scale", scale, "0, or from 0.75 to 3");
    preferences.scale = scale;
  }
  if (json.contains("apply_by_hand")) {
    if (!json["apply_by_hand"].is_boolean()) fail(file, "apply_by_hand", json["apply_by_hand"], "true or false");
    preferences.applyByHand = json["apply_by_hand"];
  }
  preferences.folded.clear();
  for (const std::string& title : strings(file, json, "folded")) preferences.folded.insert(title);
  for (const std::string& path : strings(file, json, "recent")) preferences.recent.emplace_back(path);
  preferences.recent.resize(std::min(preferences.recent.size(), kMostRecent));
  return preferences;
}

void writePreferences(const std::filesystem::path& file, const Preferences& preferences) {
  Json json;
  json["format"] = kFormat;
  for (const Member& member : kSizes) json[member.name] = preferences.sizes.*member.size;
  json["scale"] = preferences.scale;
  json["apply_by_hand"] = preferences.applyByHand;
  json["folded"] = preferences.folded;
  json["recent"] = Json::array();
  for (const std::filesystem::path& path : preferences.recent) json["recent"].push_back(path.string());
  makeFolder(file.parent_path());
  writeFile(file, jsonText(json, 2) + "\n");
}

}  // namespace irad
