#include "gi/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/base/error.h"
#include "renderer/base/json_extent.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/near_match.h"

namespace irad {
namespace {

[[noreturn]] void refuse(const Setting& setting, std::string_view given, const std::string& expected) {
  throw UsageError(fmt::format("{}: '{}' is not allowed; expected {}", setting.name, given, expected));
}

/// `kind` for messages: the "an integer" of "an integer, 1 to 4096 rays".
template <class T>
double parseNumber(const Setting& setting, std::string_view given, const char* kind) {
  const SettingRange& range = setting.range;
  T value{};
  const auto [end, error] = std::from_chars(given.data(), given.data() + given.size(), value);
  const std::string expected = fmt::format("{}, {}", kind, setting.allowed());
  if (error != std::errc{} || end != given.data() + given.size()) refuse(setting, given, expected);
  // Compares in T, so that a bound such as 1e-3 itself is allowed; NaN fails.
  if (!(value >= static_cast<T>(range.min) && value <= static_cast<T>(range.max))) refuse(setting, given, expected);
  if (range.step > 0) {
    const double steps = (static_cast<double>(value) - range.min) / range.step;
    if (steps != std::floor(steps)) refuse(setting, given, expected);
  }
  return value;
}

bool parseSwitch(const Setting& setting, std::string_view given) {
  for (const char* yes : {"true", "on", "yes", "1"})
    if (given == yes) return true;
  for (const char* no : {"false", "off", "no", "0"})
    if (given == no) return false;
  refuse(setting, given, "true or false");
}

size_t parseChoice(const Setting& setting, std::string_view given) {
  const auto found = std::find(setting.choices.begin(), setting.choices.end(), given);
  if (found != setting.choices.end()) return static_cast<size_t>(found - setting.choices.begin());
  const std::vector<std::string> all(setting.choices.begin(), setting.choices.end());
  std::string message = fmt::format("{}: unknown value '{}'; expected {}", setting.name, given, fmt::join(all, " | "));
  const std::vector<std::string> close = nearMatches(given, all);
  if (!close.empty()) message += fmt::format(" (did you mean {}?)", fmt::join(close, ", "));
  throw UsageError(message);
}

/// "x0,y0,z0,x1,y1,z1"
void assignBox(Settings& settings, std::string_view given) {
  Settings changed = settings;
  std::string_view rest = given;
  bool six = true;
  for (const char* name : {"scene.region_x0", "scene.region_y0", "scene.region_z0", "scene.region_x1",
                           "scene.region_y1", "scene.region_z1"}) {
    six = six && !rest.empty();
    if (!six) break;
    const size_t comma = rest.find(',');
    findSetting(name).assign(changed, rest.substr(0, comma));
    rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
  }
  if (!six || !rest.empty())
    throw UsageError(fmt::format("scene.region: '{}' is not allowed; expected six numbers x0,y0,z0,x1,y1,z1", given));
  changed.scene.region.mode = RegionMode::box;
  requireMatching(changed);
  settings = changed;
}

/// One of the settings by its name; "auto" as an exposure is camera.auto_exposure, six numbers as a region its box.
void assign(Settings& settings, std::string_view name, std::string_view value) {
  if (name == "camera.exposure" && value == "auto") {
    settings.camera.autoExposure = true;
    return;
  }
  if (name == "scene.region" && value.find(',') != std::string_view::npos) {
    assignBox(settings, value);
    return;
  }
  findSetting(name).assign(settings, value);
}

}  // namespace

std::string_view Setting::group() const {
  const std::string_view all = name;
  return all.substr(0, all.find('.'));
}

std::string Setting::allowed() const {
  if (kind == SettingKind::toggle) return "true | false";
  if (kind == SettingKind::choice) return fmt::format("{}", fmt::join(choices, " | "));
  const std::string unit = *range.unit ? std::string(" ") + range.unit : "";
  if (range.step == 0) return fmt::format("{} to {}{}", range.min, range.max, unit);
  std::vector<double> values;
  for (double v = range.min; v <= range.max; v += range.step) values.push_back(v);
  return fmt::format("{}{}", fmt::join(values, " | "), unit);
}

std::string Setting::text(const Settings& settings) const {
  const double value = get(settings);
  switch (kind) {
    case SettingKind::integer:
      return fmt::format("{}", static_cast<uint32_t>(value));
    case SettingKind::number:
      return fmt::format("{}", static_cast<float>(value));  // the fewest digits that read back to the same bits
    case SettingKind::toggle:
      return value != 0 ? "true" : "false";
    case SettingKind::choice:
      break;
  }
  const auto index = static_cast<size_t>(value);
  IRAD_CHECK_OP(index, <, choices.size());
  return choices[index];
}

void Setting::assign(Settings& settings, std::string_view given) const {
  switch (kind) {
    case SettingKind::integer:
      return set(settings, parseNumber<uint32_t>(*this, given, "an integer"));
    case SettingKind::number:
      return set(settings, parseNumber<float>(*this, given, "a number"));
    case SettingKind::toggle:
      return set(settings, parseSwitch(*this, given));
    case SettingKind::choice:
      return set(settings, static_cast<double>(parseChoice(*this, given)));
  }
}

const Setting& findSetting(std::string_view name) {
  for (const Setting& setting : settingTable())
    if (name == setting.name) return setting;
  std::vector<std::string> names;
  for (const Setting& setting : settingTable()) names.emplace_back(setting.name);
  throw UsageError(fmt::format("unknown setting '{}'{}", name, suggestion(name, names)));
}

void requireMatching(const Settings& settings) {
  if (const RegionSettings& r = settings.scene.region; r.mode == RegionMode::box) {
    if (!(r.x0 < r.x1 && r.y0 < r.y1 && r.z0 < r.z1))
      throw UsageError(
          fmt::format("scene.region={},{},{},{},{},{}: each of the first three has to be less than its "
                      "counterpart in the last three",
                      r.x0, r.y0, r.z0, r.x1, r.y1, r.z1));
    if (settings.matrix.gpu.hitRule == HitRule::thesis)
      throw UsageError("scene.region=box needs matrix.hit_rule=triangles");
  }
  if (settings.matrix.gpu.hitRule == HitRule::thesis) return;
  const char* alone = settings.voxel.method == VoxelMethod::raster     ? "voxel.method=raster"
                      : settings.matrix.format == MatrixFormat::padded ? "matrix.format=padded"
                      : settings.thesis.literal                        ? "thesis.literal=true"
                                                                       : nullptr;
  if (alone) throw UsageError(fmt::format("{} needs matrix.hit_rule=thesis", alone));
}

void applySetting(Settings& settings, std::string_view assignment) {
  const size_t equals = assignment.find('=');
  if (equals == std::string_view::npos) throw UsageError(fmt::format("setting '{}': expected name=value", assignment));
  assign(settings, assignment.substr(0, equals), assignment.substr(equals + 1));
}

std::string settingsToJson(const Settings& settings, int indent) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const Setting& setting : settingTable()) {
    // Numbers and switches are JSON words as they stand; parsing the shortest digits keeps 0.6 from printing as
    // 0.6000000238418579.
    if (setting.kind == SettingKind::choice)
      json[setting.name] = setting.text(settings);
    else
      json[setting.name] = nlohmann::ordered_json::parse(setting.text(settings));
  }
  return jsonText(json, indent);
}

void settingsFromJson(Settings& settings, std::string_view json) {
  if (jsonExtent(json).depth > kMaxJsonDepth) throw UsageError("settings: JSON nested too deeply");
  nlohmann::json parsed;
  try {
    parsed = nlohmann::json::parse(json);
  } catch (const nlohmann::json::exception& error) {
    throw UsageError(fmt::format("settings: not JSON: {}", jsonProblem(error)));
  }
  if (!parsed.is_object()) throw UsageError("settings: expected a JSON object of name: value");
  Settings changed = settings;  // all or nothing
  for (const auto& [name, value] : parsed.items()) {
    if (value.is_structured() || value.is_null())
      throw UsageError(fmt::format("{}: expected a number, true, false or a name, not {}", name, jsonText(value)));
    assign(changed, name, value.is_string() ? value.get<std::string>() : jsonText(value));
  }
  settings = changed;
}

}  // namespace irad
