#include "renderer/base/json_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "renderer/base/error.h"
#include "renderer/base/json_extent.h"
#include "renderer/base/limits.h"
#include "renderer/base/near_match.h"

namespace irad {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMaxFileBytes = 16 << 20;

/// The text of a file or a pipe; reads no more than the limit.
std::string readWhole(const fs::path& path) {
  std::error_code error;
  std::ifstream in(path, std::ios::binary);
  if (!in || fs::is_directory(path, error)) throw InputError(fmt::format("{}: cannot be read", path.string()));
  std::string text;
  for (char part[65536]; in.read(part, sizeof part), in.gcount() > 0;) {
    text.append(part, static_cast<size_t>(in.gcount()));
    if (text.size() > kMaxFileBytes)
      throw InputError(fmt::format("{}: more than {} MiB", path.string(), kMaxFileBytes >> 20));
  }
  return text;
}

}  // namespace

OrderedJson readJsonFile(const fs::path& path) {
  try {
    return parseJson(readWhole(path), path.string());
  } catch (const UsageError& error) {
    throw InputError(error.what());
  }
}

OrderedJson parseJson(std::string_view text, const std::string& label) {
  if (jsonExtent(text).depth > kMaxJsonDepth) throw UsageError(label + ": JSON nested too deeply");
  try {
    return OrderedJson::parse(text);
  } catch (const nlohmann::json::exception& error) {
    throw UsageError(fmt::format("{}: not JSON: {}", label, jsonProblem(error)));
  }
}

OrderedJson jsonNumber(float value) {
  return OrderedJson::parse(fmt::format("{}", value));
}

JsonObject::JsonObject(const OrderedJson& json, std::string label, const std::vector<std::string>& known)
    : json_(json), label_(std::move(label)) {
  if (!json.is_object()) throw UsageError(label_ + ": expected a JSON object");
  for (const auto& [name, value] : json.items())
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw UsageError(fmt::format("{}: unknown field '{}'{}", label_, name, suggestion(name, known)));
}

const OrderedJson& JsonObject::at(const char* member) const {
  if (!has(member)) throw UsageError(fmt::format("{}: {} is missing", label_, member));
  return json_.at(member);
}

std::string JsonObject::text(const char* member) const {
  const OrderedJson& value = at(member);
  if (!value.is_string()) refuse(member, "expected a string", value);
  return value;
}

double JsonObject::number(const char* member) const {
  return number(member, at(member));
}

double JsonObject::number(const char* member, const OrderedJson& value) const {
  if (!value.is_number() || !(std::abs(value.get<double>()) <= kMaxCoordinate))
    refuse(member, fmt::format("expected a number up to {:g}", kMaxCoordinate), value);
  return value.get<double>();
}

float JsonObject::positive(const char* member) const {
  const double value = number(member);
  if (!(value >= 1 / kMaxCoordinate))
    refuse(member, fmt::format("must be at least {}, not {}", 1 / kMaxCoordinate, value));
  return static_cast<float>(value);
}

void JsonObject::refuse(const char* member, const std::string& why) const {
  throw UsageError(fmt::format("{}: {}: {}", label_, member, why));
}

void JsonObject::refuse(const char* member, const std::string& expected, const OrderedJson& value) const {
  refuse(member, fmt::format("{}, not {}", expected, jsonText(value)));
}

}  // namespace irad
