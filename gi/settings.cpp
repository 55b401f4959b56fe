#include "gi/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/error.h"
#include "renderer/json_extent.h"
#include "renderer/near_match.h"

namespace irad {
namespace {

// A setting's value as text and back: one overload per kind of member that visit() hands out. Floats print with the
// fewest digits that read back to the same bits.
std::string text(uint32_t value) {
  return fmt::format("{}", value);
}
std::string text(float value) {
  return fmt::format("{}", value);
}
std::string text(bool value) {
  return value ? "true" : "false";
}
std::string text(BoolRef ref) {
  return text(ref.value != 0);
}
template <class E>
std::string text(EnumRef<E> ref) {
  return EnumNames<E>::names.at(ref.value);
}
template <class E>
requires std::is_enum_v<E> std::string text(E value) {
  return EnumNames<E>::names.at(static_cast<size_t>(value));
}

std::string describeRange(const Meta& meta) {
  const std::string unit = *meta.unit ? std::string(" ") + meta.unit : "";
  if (meta.step > 0) {
    std::vector<double> values;
    for (double v = meta.min; v <= meta.max; v += meta.step) values.push_back(v);
    return fmt::format("{}{}", fmt::join(values, " | "), unit);
  }
  return fmt::format("{} to {}{}", meta.min, meta.max, unit);
}

[[noreturn]] void refuse(const Meta& meta, std::string_view given, const std::string& expected) {
  throw UsageError(fmt::format("{}: '{}' is not allowed; expected {}", meta.name, given, expected));
}

/// "kind, range" for messages: "an integer, 1 to 4096 rays".
template <class T>
T parseNumber(const Meta& meta, std::string_view given, const char* kind) {
  T value{};
  const auto [end, error] = std::from_chars(given.data(), given.data() + given.size(), value);
  const std::string expected = fmt::format("{}, {}", kind, describeRange(meta));
  if (error != std::errc{} || end != given.data() + given.size()) refuse(meta, given, expected);
  // The comparison in T, so that a bound such as 1e-3 itself is allowed; NaN fails it.
  if (!(value >= static_cast<T>(meta.min) && value <= static_cast<T>(meta.max))) refuse(meta, given, expected);
  if (meta.step > 0) {
    const double steps = (static_cast<double>(value) - meta.min) / meta.step;
    if (steps != std::floor(steps)) refuse(meta, given, expected);
  }
  return value;
}

bool parseSwitch(const Meta& meta, std::string_view given) {
  for (const char* yes : {"true", "on", "yes", "1"})
    if (given == yes) return true;
  for (const char* no : {"false", "off", "no", "0"})
    if (given == no) return false;
  refuse(meta, given, "true or false");
}

template <class E>
uint32_t parseChoice(const Meta& meta, std::string_view given) {
  const auto& names = EnumNames<E>::names;
  for (size_t i = 0; i < names.size(); ++i)
    if (given == names[i]) return static_cast<uint32_t>(i);
  const std::vector<std::string> all(names.begin(), names.end());
  std::string message = fmt::format("{}: unknown value '{}'; expected {}", meta.name, given, fmt::join(all, " | "));
  const std::vector<std::string> close = nearMatches(given, all);
  if (!close.empty()) message += fmt::format(" (did you mean {}?)", fmt::join(close, ", "));
  throw UsageError(message);
}

void assign(uint32_t& to, const Meta& meta, std::string_view given) {
  to = parseNumber<uint32_t>(meta, given, "an integer");
}
void assign(float& to, const Meta& meta, std::string_view given) {
  to = parseNumber<float>(meta, given, "a number");
}
void assign(bool& to, const Meta& meta, std::string_view given) {
  to = parseSwitch(meta, given);
}
void assign(BoolRef to, const Meta& meta, std::string_view given) {
  to.value = parseSwitch(meta, given) ? 1 : 0;
}
template <class E>
void assign(EnumRef<E> to, const Meta& meta, std::string_view given) {
  to.value = parseChoice<E>(meta, given);
}
template <class E>
requires std::is_enum_v<E>
void assign(E& to, const Meta& meta, std::string_view given) {
  to = static_cast<E>(parseChoice<E>(meta, given));
}

// What settingInfos() says of each kind of member.
void describe(uint32_t, SettingInfo& info) {
  info.kind = "integer";
}
void describe(float, SettingInfo& info) {
  info.kind = "number";
}
void describe(bool, SettingInfo& info) {
  info.kind = "switch";
}
void describe(BoolRef, SettingInfo& info) {
  info.kind = "switch";
}
template <class E>
void describeChoice(SettingInfo& info) {
  info.kind = "choice";
  info.choices.assign(EnumNames<E>::names.begin(), EnumNames<E>::names.end());
}
template <class E>
void describe(EnumRef<E>, SettingInfo& info) {
  describeChoice<E>(info);
}
template <class E>
requires std::is_enum_v<E>
void describe(E, SettingInfo& info) {
  describeChoice<E>(info);
}

std::vector<std::string> settingNames() {
  std::vector<std::string> names;
  Settings settings;
  visit(settings, [&](auto&&, const Meta& meta) { names.emplace_back(meta.name); });
  return names;
}

/// Sets one setting by name; the value is text as --set takes it.
void setByName(Settings& settings, std::string_view name, std::string_view value) {
  bool found = false;
  visit(settings, [&](auto&& member, const Meta& meta) {
    if (name != meta.name) return;
    found = true;
    assign(member, meta, value);
  });
  if (!found) throw UsageError(fmt::format("unknown setting '{}'{}", name, suggestion(name, settingNames())));
}

}  // namespace

std::string SettingInfo::range() const {
  if (kind == "switch") return "true | false";
  if (kind == "choice") return fmt::format("{}", fmt::join(choices, " | "));
  return describeRange(meta);
}

void applySetting(Settings& settings, std::string_view assignment) {
  const size_t equals = assignment.find('=');
  if (equals == std::string_view::npos) throw UsageError(fmt::format("setting '{}': expected name=value", assignment));
  setByName(settings, assignment.substr(0, equals), assignment.substr(equals + 1));
}

std::string settingValue(const Settings& settings, std::string_view name) {
  Settings copy = settings;
  std::string value;
  bool found = false;
  visit(copy, [&](auto&& member, const Meta& meta) {
    if (name != meta.name) return;
    found = true;
    value = text(member);
  });
  if (!found) throw UsageError(fmt::format("unknown setting '{}'{}", name, suggestion(name, settingNames())));
  return value;
}

std::vector<SettingInfo> settingInfos(const Settings& settings) {
  Settings copy = settings;
  std::vector<SettingInfo> infos;
  visit(copy, [&](auto&& member, const Meta& meta) {
    SettingInfo info{meta, {}, {}, text(member)};
    describe(member, info);
    infos.push_back(std::move(info));
  });
  return infos;
}

Redo difference(const Settings& a, const Settings& b) {
  const std::vector<SettingInfo> before = settingInfos(a), after = settingInfos(b);
  Redo first = Redo::Nothing;
  for (size_t i = 0; i < before.size(); ++i)
    if (before[i].value != after[i].value) first = std::min(first, after[i].meta.redo);
  return first;
}

std::string settingsToJson(const Settings& settings, int indent) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const SettingInfo& info : settingInfos(settings)) {
    // Numbers and switches are JSON words as they stand; parsing the shortest digits keeps 0.6 from printing as
    // 0.6000000238418579.
    if (info.kind == "choice")
      json[info.meta.name] = info.value;
    else
      json[info.meta.name] = nlohmann::ordered_json::parse(info.value);
  }
  return json.dump(indent);
}

void settingsFromJson(Settings& settings, std::string_view json) {
  if (jsonExtent(json).depth > kMaxJsonDepth) throw UsageError("settings: JSON nested too deeply");
  nlohmann::json parsed;
  try {
    parsed = nlohmann::json::parse(json);
  } catch (const nlohmann::json::exception& error) {
    throw UsageError(fmt::format("settings: not JSON: {}", error.what()));
  }
  if (!parsed.is_object()) throw UsageError("settings: expected a JSON object of name: value");
  Settings changed = settings;  // all or nothing
  for (const auto& [name, value] : parsed.items()) {
    if (value.is_structured() || value.is_null())
      throw UsageError(fmt::format("{}: expected a number, true, false or a name, not {}", name, value.dump()));
    setByName(changed, name, value.is_string() ? value.get<std::string>() : value.dump());
  }
  settings = changed;
}

}  // namespace irad
