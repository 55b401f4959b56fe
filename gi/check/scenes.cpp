#include "gi/check/scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "renderer/base/error.h"

namespace irad {

uint32_t SceneBuilder::material(glm::vec3 albedo, glm::vec3 exitance, bool doubleSided) {
  Material m;
  m.name = fmt::format("material {}", scene_.materials.size());
  m.baseColor = glm::vec4(albedo, 1.0f);
  m.metallic = 0.0f;
  m.emission = exitance / std::numbers::pi_v<float>;
  m.doubleSided = doubleSided;
  scene_.materials.push_back(m);
  corners_.emplace_back();
  return static_cast<uint32_t>(scene_.materials.size() - 1);
}

void SceneBuilder::triangle(uint32_t material, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  IRAD_CHECK_OP(material, <, corners_.size());
  corners_[material].insert(corners_[material].end(), {a, b, c});
}

void SceneBuilder::quad(uint32_t material, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d, uint32_t n) {
  const auto at = [&](uint32_t i, uint32_t j) {
    const float u = static_cast<float>(i) / static_cast<float>(n), v = static_cast<float>(j) / static_cast<float>(n);
    return glm::mix(glm::mix(a, b, u), glm::mix(d, c, u), v);
  };
  for (uint32_t j = 0; j < n; ++j)
    for (uint32_t i = 0; i < n; ++i) {
      triangle(material, at(i, j), at(i + 1, j), at(i + 1, j + 1));
      triangle(material, at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
}

void SceneBuilder::box(const std::vector<uint32_t>& materials, glm::vec3 lo, glm::vec3 hi, bool inward,
                       const glm::mat3& rotation) {
  IRAD_CHECK_OP(materials.size(), ==, 6u);
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const auto corner = [&](int i, int j) {
        glm::vec3 p;
        p[axis] = side ? hi[axis] : lo[axis];
        p[u] = i ? hi[u] : lo[u];
        p[v] = j ? hi[v] : lo[v];
        return rotation * p;
      };
      // (0,0) (1,0) (1,1) (0,1) turns counter-clockwise about +axis: outward on the upper side.
      const bool turn = (side == 1) == inward;
      if (turn)
        quad(materials[2 * axis + side], corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0));
      else
        quad(materials[2 * axis + side], corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1));
    }
}

void SceneBuilder::sphere(uint32_t material, glm::vec3 centre, float radius, bool inward, uint32_t rings) {
  zone(material, centre, radius, inward, rings, 0, rings);
}

void SceneBuilder::zone(uint32_t material, glm::vec3 centre, float radius, bool inward, uint32_t rings, uint32_t first,
                        uint32_t last) {
  const uint32_t sectors = 2 * rings;
  const auto at = [&](uint32_t i, uint32_t j) {
    const double theta = std::numbers::pi * j / rings, phi = 2 * std::numbers::pi * (i % sectors) / sectors;
    return centre +
           radius * glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
  };
  for (uint32_t j = first; j < last; ++j)
    for (uint32_t i = 0; i < sectors; ++i) {
      std::array<glm::vec3, 4> q{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};  // outward
      if (inward) std::swap(q[1], q[3]);
      // At the poles one half of each square has no area.
      const bool top = j == 0, bottom = j + 1 == rings;
      if (inward ? !bottom : !top) triangle(material, q[0], q[1], q[2]);
      if (inward ? !top : !bottom) triangle(material, q[0], q[2], q[3]);
    }
}

void SceneBuilder::sun(glm::vec3 direction, float lux) {
  scene_.lights.push_back(
      {.name = "sun", .type = LightType::Sun, .direction = glm::normalize(direction), .intensity = lux});
}

void SceneBuilder::point(glm::dvec3 position, float candela) {
  scene_.lights.push_back({.name = "point", .type = LightType::Point, .position = position, .intensity = candela});
}

void SceneBuilder::camera(glm::dvec3 position, glm::dvec3 target) {
  const glm::dvec3 way = glm::normalize(target - position);
  const glm::dvec3 up = std::abs(way.y) > 0.99 ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0);
  const size_t before = scene_.cameras.size();
  scene_.cameras.push_back({.name = before == 0 ? "front" : fmt::format("front {}", before + 1),
                            .position = position,
                            .orientation = glm::quatLookAt(glm::vec3(way), glm::vec3(up))});
}

Scene SceneBuilder::finish(std::string name) {
  Scene scene = std::move(scene_);
  scene_ = Scene{};
  scene.path = name;
  scene.boundsMin = glm::vec3(std::numeric_limits<float>::max());
  scene.boundsMax = -scene.boundsMin;
  for (uint32_t m = 0; m < corners_.size(); ++m) {
    if (corners_[m].empty()) continue;
    const auto first = static_cast<uint32_t>(scene.positions.size());
    for (size_t i = 0; i < corners_[m].size(); i += 3) {
      const glm::vec3 &a = corners_[m][i], &b = corners_[m][i + 1], &c = corners_[m][i + 2];
      const glm::vec3 cross = glm::cross(b - a, c - a);
      const bool area = glm::dot(cross, cross) > 0;  // without one any frame will do
      const glm::vec3 n = area ? glm::normalize(cross) : glm::vec3(0, 0, 1);
      const glm::vec3 t = area ? glm::normalize(b - a) : glm::vec3(1, 0, 0);
      for (const glm::vec3& p : {a, b, c}) {
        scene.indices.push_back(static_cast<uint32_t>(scene.positions.size()));
        scene.positions.push_back(p);
        scene.normals.push_back(n);
        scene.tangents.emplace_back(t, 1.0f);
        scene.uv0.emplace_back(0.0f);
        scene.uv1.emplace_back(0.0f);
        scene.colors.emplace_back(1.0f);
        scene.boundsMin = glm::min(scene.boundsMin, p);
        scene.boundsMax = glm::max(scene.boundsMax, p);
      }
    }
    scene.draws.push_back({m, first, static_cast<uint32_t>(scene.positions.size()) - first});
  }
  corners_.clear();
  const glm::vec3 centre = 0.5f * (scene.boundsMin + scene.boundsMax);
  if (scene.cameras.empty()) scene.cameras.push_back({.name = "front", .position = glm::dvec3(centre)});
  return scene;
}

void reverseTriangles(Scene& scene) {
  const auto count = static_cast<uint32_t>(scene.indices.size());
  std::reverse(scene.indices.begin(), scene.indices.end());
  for (uint32_t i = 0; i < count; i += 3) std::swap(scene.indices[i], scene.indices[i + 2]);  // winding as it was
  for (Draw& draw : scene.draws) draw.firstIndex = count - draw.firstIndex - draw.indexCount;
  std::reverse(scene.draws.begin(), scene.draws.end());
}

Scene furnaceBox(float rho) {
  SceneBuilder b;
  const uint32_t m = b.material(glm::vec3(rho), glm::vec3(1.0f));
  b.box({m, m, m, m, m, m}, glm::vec3(-0.5f), glm::vec3(0.5f), /*inward=*/true);
  return b.finish("furnace-box");
}

namespace {
glm::mat3 turned(float degrees) {
  return glm::mat3(glm::rotate(glm::mat4(1.0f), glm::radians(degrees), glm::normalize(glm::vec3(1, 2, 3))));
}
}  // namespace

Scene furnaceTilted(float rho) {
  SceneBuilder b;
  const uint32_t m = b.material(glm::vec3(rho), glm::vec3(1.0f));
  b.box({m, m, m, m, m, m}, glm::vec3(-0.5f), glm::vec3(0.5f), /*inward=*/true, turned(31));
  return b.finish("furnace-tilted");
}

Scene furnaceInner(float rho) {
  SceneBuilder b;
  const uint32_t m = b.material(glm::vec3(rho), glm::vec3(1.0f));
  b.box({m, m, m, m, m, m}, glm::vec3(-0.5f), glm::vec3(0.5f), /*inward=*/true, turned(31));
  b.box({m, m, m, m, m, m}, glm::vec3(-0.2f), glm::vec3(0.2f), /*inward=*/false, turned(-17));
  b.camera(glm::dvec3(turned(31) * glm::vec3(0.4f, 0.35f, 0.45f)), glm::dvec3(0));
  return b.finish("furnace-inner");
}

Scene sphereCap() {
  // Archimedes: the zone above y = .5 has a quarter of the area; that is 60 of 180 degrees.
  SceneBuilder b;
  const uint32_t lamp = b.material(glm::vec3(0.8f), glm::vec3(1.0f)), rest = b.material(glm::vec3(0.8f));
  b.zone(lamp, glm::vec3(0.0f), 1.0f, /*inward=*/true, 60, 0, 20);
  b.zone(rest, glm::vec3(0.0f), 1.0f, /*inward=*/true, 60, 20, 60);
  return b.finish("sphere-cap");
}

Scene furnaceSphere(float rho) {
  SceneBuilder b;
  b.sphere(b.material(glm::vec3(rho), glm::vec3(1.0f)), glm::vec3(0.0f), 1.0f, /*inward=*/true);
  return b.finish("furnace-sphere");
}

Scene unitCube(float rho) {
  SceneBuilder b;
  std::vector<uint32_t> walls;
  for (int i = 0; i < 6; ++i) walls.push_back(b.material(glm::vec3(rho)));
  b.box(walls, glm::vec3(-0.5f), glm::vec3(0.5f), /*inward=*/true);
  return b.finish("unit-cube");
}

namespace {
Scene facingSquares(const char* name, float distance, float rho0, float rho1) {
  SceneBuilder b;
  const uint32_t floor = b.material(glm::vec3(rho0), glm::vec3(1.0f));
  const uint32_t ceiling = b.material(glm::vec3(rho1));
  const float h = 0.5f, y = distance / 2;
  b.quad(floor, {-h, -y, h}, {h, -y, h}, {h, -y, -h}, {-h, -y, -h});
  b.quad(ceiling, {-h, y, -h}, {h, y, -h}, {h, y, h}, {-h, y, h});
  return b.finish(name);
}
}  // namespace

Scene parallelSquares(float distance) {
  return facingSquares("parallel-squares", distance, 0.0f, 0.0f);
}
Scene plates(float gap, float rho0, float rho1) {
  return facingSquares("plates", gap, rho0, rho1);
}

Scene furnishedRoom() {
  SceneBuilder b;
  const uint32_t m = b.material(glm::vec3(0.5f));
  const uint32_t shelf = b.material(glm::vec3(0.5f), glm::vec3(0.0f), /*doubleSided=*/true);
  b.box({m, m, m, m, m, m}, glm::vec3(-1, -0.7f, -1), glm::vec3(1, 0.7f, 1), /*inward=*/true);
  const glm::mat3 turn(glm::rotate(glm::mat4(1.0f), 0.6f, glm::normalize(glm::vec3(1, 2, 3))));
  b.box({m, m, m, m, m, m}, glm::vec3(0.2f, -0.3f, 0), glm::vec3(0.6f, 0.2f, 0.5f), /*inward=*/false, turn);
  b.sphere(m, glm::vec3(-0.45f, -0.2f, -0.3f), 0.35f, /*inward=*/false, 24);
  b.quad(shelf, {-0.9f, 0.31f, 0.8f}, {0.1f, 0.31f, 0.8f}, {0.1f, 0.31f, 0.3f}, {-0.9f, 0.31f, 0.3f});
  return b.finish("furnished-room");
}

SceneBuilder lampRoom() {
  SceneBuilder b;
  const uint32_t m = b.material(glm::vec3(0.7f, 0.5f, 0.2f)), lamp = b.material(glm::vec3(0.1f), glm::vec3(3, 2, 1));
  b.box({m, m, m, lamp, m, m}, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
  b.sphere(m, glm::vec3(-0.3f, -0.4f, 0.1f), 0.45f, /*inward=*/false, 24);
  return b;
}

Scene mixedRoom() {
  SceneBuilder b = lampRoom();
  const uint32_t metal = b.material(glm::vec3(0.9f));
  b.edit(metal).metallic = 1;
  b.edit(metal).roughness = 0.2f;
  b.sphere(metal, glm::vec3(0.5f, -0.6f, -0.2f), 0.3f, /*inward=*/false, 24);
  b.point({0.2, 0.3, 0.1}, 5);
  b.sun(glm::vec3(0.3f, -1, 0.2f), 2);
  b.camera({0, 0, 0.9}, {0, -0.2, -1});
  return b.finish("mixed room");
}

SceneBuilder stillLife(float light) {
  SceneBuilder b;
  const uint32_t white = b.material(glm::vec3(0.7f)), red = b.material({0.7f, 0.2f, 0.15f}),
                 green = b.material({0.2f, 0.6f, 0.2f}), lamp = b.material(glm::vec3(0.1f), light * glm::vec3(20.0f)),
                 glossy = b.material({0.9f, 0.8f, 0.6f});
  b.edit(glossy).metallic = 1.0f;
  b.edit(glossy).roughness = 0.3f;
  const glm::vec3 lo(-1, 0, -0.75f), hi(1, 1.25f, 0.5f);
  b.quad(white, {lo.x, lo.y, hi.z}, {hi.x, lo.y, hi.z}, {hi.x, lo.y, lo.z}, {lo.x, lo.y, lo.z});  // floor
  b.quad(white, {lo.x, hi.y, lo.z}, {hi.x, hi.y, lo.z}, {hi.x, hi.y, hi.z}, {lo.x, hi.y, hi.z});  // ceiling
  b.quad(white, {lo.x, lo.y, lo.z}, {hi.x, lo.y, lo.z}, {hi.x, hi.y, lo.z}, {lo.x, hi.y, lo.z});  // back
  b.quad(red, {lo.x, lo.y, hi.z}, {lo.x, lo.y, lo.z}, {lo.x, hi.y, lo.z}, {lo.x, hi.y, hi.z});
  b.quad(green, {hi.x, lo.y, lo.z}, {hi.x, lo.y, hi.z}, {hi.x, hi.y, hi.z}, {hi.x, hi.y, lo.z});
  b.quad(lamp, {-0.25f, 1.125f, -0.375f}, {0.25f, 1.125f, -0.375f}, {0.25f, 1.125f, 0}, {-0.25f, 1.125f, 0});
  const glm::mat3 turn(glm::rotate(glm::mat4(1.0f), glm::radians(20.0f), glm::vec3(0, 1, 0)));
  b.box(std::vector<uint32_t>(6, white), {-0.6f, 0, -0.6f}, {-0.1f, 0.5f, -0.1f}, /*inward=*/false, turn);
  b.sphere(glossy, {0.45f, 0.3f, -0.1f}, 0.25f, /*inward=*/false, 32);
  b.point({-0.5, 0.875, 0.25}, light * 0.3f);
  b.camera({0.25, 0.75, 2.25}, {0, 0.5, 0});
  return b;
}

Scene stillScene() {
  return stillLife().finish("still life");
}

glm::dvec3 noLight(const glm::dvec3&, const glm::dvec3&) {
  return glm::dvec3(0);
}

}  // namespace irad
