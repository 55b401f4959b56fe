#include "renderer/scene/light_json.h"

#include <fmt/format.h>

#include <array>

#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/near_match.h"

namespace irad {
namespace {

OrderedJson vector(const glm::vec3& v) {
  return {jsonNumber(v.x), jsonNumber(v.y), jsonNumber(v.z)};
}

OrderedJson toJson(const Light& light) {
  const LightKind& kind = lightKind(light.type);
  OrderedJson json;
  json["name"] = light.name;
  json["type"] = kind.name;
  json["position"] = {light.position.x, light.position.y, light.position.z};
  if (kind.has(LIGHT_DIRECTION)) json["direction"] = vector(light.direction);
  if (!light.on) json["on"] = false;
  json["color"] = vector(light.color);
  json["intensity"] = jsonNumber(light.intensity);
  if (light.range > 0) json["range"] = jsonNumber(light.range);
  const bool distant = kind.has(LIGHT_DISTANT);
  if (const float size = distant ? light.angle : light.radius; size > 0)
    json[distant ? "angle" : "radius"] = jsonNumber(size);
  if (kind.has(LIGHT_CONE)) {
    // In double precision the way there and back ends at the same float.
    json["innerConeAngle"] = std::acos(static_cast<double>(light.innerCos));
    json["outerConeAngle"] = std::acos(static_cast<double>(light.outerCos));
  }
  return json;
}

const LightKind& kindOf(const JsonObject& json) {
  const std::string name = json.text("type");
  if (const LightKind* kind = findLightKind(name)) return *kind;
  std::vector<std::string> known;
  for (const LightKind& kind : lightKinds()) known.emplace_back(kind.name);
  json.refuse("type", fmt::format("unknown '{}'{}", name, suggestion(name, known)));
}

/// Unit vectors keep their bits.
glm::vec3 direction(const JsonObject& json) {
  const glm::dvec3 given = json.vector<3>("direction");
  const glm::vec3 kept(given);
  if (std::abs(glm::length(kept) - 1.0f) < 1e-5f) return kept;
  if (!(glm::length(given) > 0)) json.refuse("direction", "has no length");
  return glm::vec3(glm::normalize(given));
}

float coneCosine(const JsonObject& json, const char* member, double otherwise) {
  return static_cast<float>(std::cos(json.has(member) ? json.number(member) : otherwise));
}

Light fromJson(const OrderedJson& parsed, const std::string& label) {
  const JsonObject json(parsed, label,
                        {"name", "type", "on", "position", "direction", "color", "intensity", "range", "innerConeAngle",
                         "outerConeAngle", "angle", "radius"});
  Light light;
  const LightKind& kind = kindOf(json);
  light.type = kind.type;
  if (json.has("name")) light.name = json.text("name");
  if (json.has("on")) {
    const OrderedJson& on = json.at("on");
    if (!on.is_boolean()) json.refuse("on", "expected true or false", on);
    light.on = on.get<bool>();
  }
  const auto belongs = [&](const char* member, bool to) {
    if (!to && json.has(member)) json.refuse(member, fmt::format("a {} has none", json.text("type")));
    return json.has(member);
  };
  const bool aimed = kind.has(LIGHT_DIRECTION), cone = kind.has(LIGHT_CONE);
  if (!kind.has(LIGHT_DISTANT) || json.has("position")) light.position = json.vector<3>("position");
  if (belongs("direction", aimed) || aimed) light.direction = direction(json);
  if (json.has("color")) light.color = glm::vec3(json.vector<3>("color"));
  if (json.has("intensity")) light.intensity = static_cast<float>(json.number("intensity"));
  if (belongs("range", kind.has(LIGHT_RANGE))) light.range = json.positive("range");
  if (belongs("angle", kind.has(LIGHT_DISTANT))) light.angle = static_cast<float>(json.number("angle"));
  if (belongs("radius", !kind.has(LIGHT_DISTANT))) light.radius = static_cast<float>(json.number("radius"));
  belongs("innerConeAngle", cone), belongs("outerConeAngle", cone);
  if (cone) {
    constexpr double pi = 3.14159265358979323846;
    light.innerCos = coneCosine(json, "innerConeAngle", 0);
    light.outerCos = coneCosine(json, "outerConeAngle", pi / 4);
    for (const char* member : {"innerConeAngle", "outerConeAngle"})
      if (json.has(member) && !(json.number(member) >= 0 && json.number(member) <= pi))
        json.refuse(member, "expected 0 to pi (radians)", parsed.at(member));
  }
  if (const std::string problem = unsound(light); !problem.empty()) throw UsageError(label + ": " + problem);
  return light;
}

}  // namespace

std::string lightsToJson(const std::vector<Light>& lights) {
  OrderedJson json = OrderedJson::array();
  for (const Light& light : lights) json.push_back(toJson(light));
  return jsonText(json);
}

std::vector<Light> lightsFromJson(std::string_view text, const std::string& label) {
  const OrderedJson json = parseJson(text, label);
  if (!json.is_array()) throw UsageError(label + ": expected an array of lights");
  std::vector<Light> lights;
  for (size_t i = 0; i < json.size(); ++i) lights.push_back(fromJson(json[i], fmt::format("{}[{}]", label, i)));
  return lights;
}

}  // namespace irad
