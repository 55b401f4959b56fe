// What a file leaves open: a camera that sees everything, or stands inside, and a sun where nothing shines.
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "renderer/scene/gltf_document.h"
#include "renderer/scene/viewpoint.h"

namespace irad {
namespace {

constexpr const char* kNoLight = "no light in ";  // begins the warning of a default sun

bool emits(const Scene& scene) {
  for (const Draw& draw : scene.draws)
    if (const glm::vec3& e = scene.materials[draw.material].emission; std::max({e.x, e.y, e.z}) > 0.0f) return true;
  return false;
}

/// Looks along `forward`, which is not vertical.
glm::quat facing(const glm::dvec3& forward) {
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), -forward));
  return glm::quat(glm::quat_cast(glm::dmat3(right, glm::cross(-forward, right), -forward)));
}

Camera insideCamera(const Scene& scene, const Viewpoint& stand) {
  Camera camera;
  camera.yfov = static_cast<float>(std::numbers::pi / 3.0);
  camera.position = scene.origin + stand.position;
  camera.orientation = facing(stand.forward);
  camera.znear = static_cast<float>(0.02 * stand.clearance);
  return camera;
}

/// Around the bounding sphere, from above along a diagonal; the sphere fits the smaller side of any landscape view.
Camera outsideCamera(const Scene& scene) {
  const double radius = std::max(0.5 * glm::length(glm::dvec3(scene.boundsMax - scene.boundsMin)), 1e-6);
  Camera camera;
  camera.yfov = static_cast<float>(std::numbers::pi / 4.0);
  const double distance = 1.02 * radius / std::sin(0.5 * camera.yfov);
  const glm::dvec3 back = glm::normalize(glm::dvec3(0.6, 0.45, 0.8));
  camera.position = scene.origin + 0.5 * glm::dvec3(scene.boundsMin + scene.boundsMax) + back * distance;
  camera.orientation = facing(-back);
  camera.znear = static_cast<float>(std::max(0.01 * radius, distance - 1.5 * radius));
  return camera;
}

}  // namespace

void addDefaults(Scene& scene) {
  const std::string file = scene.path.filename().string();
  if (scene.lights.empty() && !emits(scene)) {
    Light sun;
    sun.name = "default sun";
    sun.direction = glm::normalize(glm::vec3(-0.35f, -0.85f, -0.4f));
    sun.intensity = std::numbers::pi_v<float>;  // lux: a white surface facing it has radiance 1
    scene.lights.push_back(sun);
    scene.defaultLight = true;
    scene.warnings.push_back(fmt::format("{}{} and nothing that emits: a default sun is used", kNoLight, file));
  }
  if (scene.cameras.empty()) {
    const std::optional<Viewpoint> inside = viewpointInside(scene);
    Camera& camera = scene.cameras.emplace_back(inside ? insideCamera(scene, *inside) : outsideCamera(scene));
    camera.name = "fitted";
    scene.defaultCamera = true;
    scene.warnings.push_back(fmt::format(
        "no camera in {}: a fitted one is used{}", file,
        inside ? fmt::format(", which stands inside: {:.0f} % of the surface face inwards", 100 * inside->facing)
               : ""));
  }
}

void replaceLights(Scene& scene, std::vector<Light> lights) {
  if (lights == scene.lights) return;
  scene.lights = std::move(lights);
  if (!scene.defaultLight) return;
  scene.defaultLight = false;
  std::erase_if(scene.warnings, [](const std::string& warning) { return warning.starts_with(kNoLight); });
}

}  // namespace irad
