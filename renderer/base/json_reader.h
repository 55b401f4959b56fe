// JSON that people write and programs exchange (cameras, lights, sidecars, manifests): parsed with limits, its members
// checked as they are taken, so that every refusal names the file or object, the member and its value.
#pragma once

#include <cmath>
#include <filesystem>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace irad {

using OrderedJson = nlohmann::ordered_json;

/// Takes at most 16 MiB and kMaxJsonDepth; InputError names the file and says what is wrong with it.
OrderedJson readJsonFile(const std::filesystem::path& path);
/// UsageError "LABEL: not JSON ...", also where it is nested too deeply.
OrderedJson parseJson(std::string_view text, const std::string& label);

/// As text to be printed or written. Names of files, of devices and whatever else was never read as JSON may hold bytes
/// that are no UTF-8, at which dump() throws: they become U+FFFD.
template <class Json>
std::string jsonText(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// The float's fewest digits that read back to the same bits.
OrderedJson jsonNumber(float value);

/// A JSON object whose members are read one by one. Refusals are UsageErrors "LABEL: MEMBER: ...".
class JsonObject {
 public:
  /// Refuses anything but an object, and members that are not `known`. `json` must outlive this.
  JsonObject(const OrderedJson& json, std::string label, const std::vector<std::string>& known);

  bool has(const char* member) const { return json_.contains(member); }
  const OrderedJson& at(const char* member) const;  ///< refused when missing
  std::string text(const char* member) const;
  /// Coordinates, lengths and intensities: up to kMaxCoordinate either way, so that fp32 holds their squares.
  double number(const char* member) const;
  float positive(const char* member) const;
  template <int n>
  glm::vec<n, double> vector(const char* member) const {
    const OrderedJson& value = at(member);
    if (!value.is_array() || value.size() != n) refuse(member, "expected " + std::to_string(n) + " numbers", value);
    glm::vec<n, double> out;
    for (int i = 0; i < n; ++i) out[i] = number(member, value[static_cast<size_t>(i)]);
    return out;
  }

  [[noreturn]] void refuse(const char* member, const std::string& why) const;
  [[noreturn]] void refuse(const char* member, const std::string& expected, const OrderedJson& value) const;

 private:
  double number(const char* member, const OrderedJson& value) const;
  const OrderedJson& json_;
  std::string label_;
};

}  // namespace irad
