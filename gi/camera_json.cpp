#include "gi/camera_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "gi/near_match.h"
#include "renderer/error.h"
#include "renderer/json_extent.h"

namespace irad {
namespace {

using Json = nlohmann::ordered_json;

/// The float's fewest digits that read back to the same bits, as a JSON number.
Json number(float value) {
  return Json::parse(fmt::format("{}", value));
}

const std::vector<std::string> fields{"name", "position", "orientation", "target", "up",
                                      "yfov", "ymag",     "aspect",      "znear",  "zfar"};

/// Coordinates and lengths: fp32, and so are their squares.
double number(const Json& value, const std::string& field) {
  if (!value.is_number() || !(std::abs(value.get<double>()) <= kMaxCoordinate))
    throw UsageError(
        fmt::format("camera: {}: expected a number up to {}, not {}", field, kMaxCoordinate, value.dump()));
  return value.get<double>();
}

template <int n>
glm::vec<n, double> vector(const Json& value, const std::string& field) {
  if (!value.is_array() || value.size() != n)
    throw UsageError(fmt::format("camera: {}: expected {} numbers, not {}", field, n, value.dump()));
  glm::vec<n, double> out;
  for (int i = 0; i < n; ++i) out[i] = number(value[static_cast<size_t>(i)], field);
  return out;
}

float positive(const Json& value, const std::string& field) {
  const double v = number(value, field);
  if (!(v >= 1 / kMaxCoordinate))
    throw UsageError(fmt::format("camera: {}: must be at least {}, not {}", field, 1 / kMaxCoordinate, v));
  return static_cast<float>(v);
}

/// Looks from `position` at `target` with `up` upwards.
glm::quat lookAt(glm::dvec3 position, glm::dvec3 target, glm::dvec3 up) {
  const glm::dvec3 forward = target - position;
  const glm::dvec3 side = glm::cross(forward, up);
  if (!(glm::length(forward) > 0) || !(glm::length(side) > 1e-9 * glm::length(forward) * glm::length(up)))
    throw UsageError("camera: target: lies at the position, or along up");
  return glm::quat(glm::quatLookAt(glm::normalize(forward), glm::normalize(up)));
}

}  // namespace

std::string cameraToJson(const Camera& camera) {
  Json json;
  json["name"] = camera.name;
  json["position"] = {camera.position.x, camera.position.y, camera.position.z};
  json["orientation"] = {number(camera.orientation.x), number(camera.orientation.y), number(camera.orientation.z),
                         number(camera.orientation.w)};
  if (camera.orthographic)
    json["ymag"] = number(camera.ymag);
  else
    json["yfov"] = number(camera.yfov);
  if (camera.aspect > 0) json["aspect"] = number(camera.aspect);
  json["znear"] = number(camera.znear);
  if (camera.zfar > 0) json["zfar"] = number(camera.zfar);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Camera cameraFromJson(std::string_view text) {
  if (jsonExtent(text).depth > kMaxJsonDepth) throw UsageError("camera: JSON nested too deeply");
  Json json;
  try {
    json = Json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    throw UsageError(fmt::format("camera: not JSON: {}", error.what()));
  }
  if (!json.is_object()) throw UsageError("camera: expected a JSON object");
  for (const auto& [name, value] : json.items())
    if (std::find(fields.begin(), fields.end(), name) == fields.end())
      throw UsageError(fmt::format("camera: unknown field '{}'{}", name, suggestion(name, fields)));

  Camera camera;
  if (json.contains("name")) {
    if (!json["name"].is_string()) throw UsageError("camera: name: expected a string");
    camera.name = json["name"];
  }
  if (!json.contains("position")) throw UsageError("camera: position is missing");
  camera.position = vector<3>(json["position"], "position");
  if (json.contains("orientation") == json.contains("target"))
    throw UsageError("camera: give either orientation or target");
  if (json.contains("orientation")) {
    const glm::dvec4 q = vector<4>(json["orientation"], "orientation");
    if (!(std::abs(glm::length(q) - 1.0) < 1e-3)) throw UsageError("camera: orientation: not a unit quaternion");
    // Bits are kept: a manifest's camera is this very rotation.
    camera.orientation =
        glm::quat(static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z));
  } else {
    const glm::dvec3 up = json.contains("up") ? vector<3>(json["up"], "up") : glm::dvec3(0, 1, 0);
    camera.orientation = lookAt(camera.position, vector<3>(json["target"], "target"), up);
  }
  if (json.contains("ymag")) {
    camera.orthographic = true;
    camera.ymag = positive(json["ymag"], "ymag");
  }
  if (json.contains("yfov")) {
    if (camera.orthographic) throw UsageError("camera: give either yfov or ymag");
    camera.yfov = positive(json["yfov"], "yfov");
    if (!(camera.yfov < 3.14159f)) throw UsageError("camera: yfov: must be below pi (radians)");
  }
  if (json.contains("aspect")) camera.aspect = positive(json["aspect"], "aspect");
  if (json.contains("znear")) {
    const bool zero = camera.orthographic && number(json["znear"], "znear") == 0;
    camera.znear = zero ? 0.0f : positive(json["znear"], "znear");
  }
  if (json.contains("zfar")) camera.zfar = positive(json["zfar"], "zfar");
  if (camera.zfar > 0 && !(camera.zfar > camera.znear)) throw UsageError("camera: zfar: must be beyond znear");
  return camera;
}

}  // namespace irad
