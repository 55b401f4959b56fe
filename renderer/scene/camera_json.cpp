#include "renderer/scene/camera_json.h"

#include <fmt/format.h>

#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"

namespace irad {
namespace {

/// Looks from `position` at `target` with `up` upwards.
glm::quat lookAt(const JsonObject& json, glm::dvec3 position, glm::dvec3 target, glm::dvec3 up) {
  const glm::dvec3 forward = target - position;
  const glm::dvec3 side = glm::cross(forward, up);
  if (!(glm::length(forward) > 0) || !(glm::length(side) > 1e-9 * glm::length(forward) * glm::length(up)))
    json.refuse("target", "lies at the position, or along up");
  return glm::quat(glm::quatLookAt(glm::normalize(forward), glm::normalize(up)));
}

}  // namespace

std::string cameraToJson(const Camera& camera) {
  OrderedJson json;
  json["name"] = camera.name;
  json["position"] = {camera.position.x, camera.position.y, camera.position.z};
  json["orientation"] = {jsonNumber(camera.orientation.x), jsonNumber(camera.orientation.y),
                         jsonNumber(camera.orientation.z), jsonNumber(camera.orientation.w)};
  if (camera.orthographic)
    json["ymag"] = jsonNumber(camera.ymag);
  else
    json["yfov"] = jsonNumber(camera.yfov);
  if (camera.aspect > 0) json["aspect"] = jsonNumber(camera.aspect);
  json["znear"] = jsonNumber(camera.znear);
  if (camera.zfar > 0) json["zfar"] = jsonNumber(camera.zfar);
  return jsonText(json);
}

Camera cameraFromJson(std::string_view text, const std::string& label) {
  const OrderedJson parsed = parseJson(text, label);
  const JsonObject json(parsed, label,
                        {"name", "position", "orientation", "target", "up", "yfov", "ymag", "aspect", "znear", "zfar"});
  Camera camera;
  if (json.has("name")) camera.name = json.text("name");
  camera.position = json.vector<3>("position");
  if (json.has("orientation") == json.has("target")) json.refuse("orientation", "give either orientation or target");
  if (json.has("orientation")) {
    const glm::dvec4 q = json.vector<4>("orientation");
    if (!(std::abs(glm::length(q) - 1.0) < 1e-3)) json.refuse("orientation", "not a unit quaternion");
    // Bits are kept: a manifest's camera is this very rotation.
    camera.orientation =
        glm::quat(static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z));
  } else {
    const glm::dvec3 up = json.has("up") ? json.vector<3>("up") : glm::dvec3(0, 1, 0);
    camera.orientation = lookAt(json, camera.position, json.vector<3>("target"), up);
  }
  if (json.has("ymag")) {
    camera.orthographic = true;
    camera.ymag = json.positive("ymag");
  }
  if (json.has("yfov")) {
    if (camera.orthographic) json.refuse("yfov", "give either yfov or ymag");
    camera.yfov = json.positive("yfov");
    if (!(camera.yfov < 3.14159f)) json.refuse("yfov", "must be below pi (radians)");
  }
  if (json.has("aspect")) camera.aspect = json.positive("aspect");
  if (json.has("znear")) {
    const bool zero = camera.orthographic && json.number("znear") == 0;
    camera.znear = zero ? 0.0f : json.positive("znear");
  }
  if (json.has("zfar")) camera.zfar = json.positive("zfar");
  if (camera.zfar > 0 && !(camera.zfar > camera.znear)) json.refuse("zfar", "must be beyond znear");
  return camera;
}

std::vector<Camera> camerasFromJson(std::string_view text, const std::string& label) {
  const OrderedJson json = parseJson(text, label);
  if (!json.is_array()) throw UsageError(label + ": expected an array of cameras");
  std::vector<Camera> cameras;
  for (size_t i = 0; i < json.size(); ++i)
    cameras.push_back(cameraFromJson(json[i].dump(), fmt::format("{}[{}]", label, i)));
  return cameras;
}

}  // namespace irad
