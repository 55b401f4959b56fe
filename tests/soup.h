// Small scenes for tests: triangles, quads and boxes by hand, grouped by material as the loader does.
#pragma once

#include <algorithm>
#include <vector>

#include "renderer/scene/scene.h"

namespace irad::test {

class Soup {
 public:
  uint32_t material(const Material& m) {
    scene_.materials.push_back(m);
    triangles_.emplace_back();
    return static_cast<uint32_t>(scene_.materials.size() - 1);
  }
  /// Diffuse, opaque.
  uint32_t diffuse(glm::vec3 albedo, bool doubleSided = false) {
    Material m;
    m.baseColor = glm::vec4(albedo, 1.0f);
    m.metallic = 0;
    m.doubleSided = doubleSided;
    return material(m);
  }
  int image(uint32_t width, uint32_t height, std::vector<uint8_t> rgba, bool srgb = false) {
    scene_.images.push_back({"test", width, height, srgb, std::move(rgba)});
    return static_cast<int>(scene_.images.size() - 1);
  }
  /// Counter-clockwise seen from the front.
  void triangle(uint32_t material, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec2 ua = {0, 0}, glm::vec2 ub = {1, 0},
                glm::vec2 uc = {0, 1}) {
    const glm::vec3 n = glm::cross(b - a, c - a);
    const glm::vec3 unit = glm::dot(n, n) > 0 ? glm::normalize(n) : glm::vec3(0, 0, 1);
    const glm::vec3 corners[3] = {a, b, c};
    const glm::vec2 uv[3] = {ua, ub, uc};
    for (int i = 0; i < 3; ++i) {
      triangles_.at(material).push_back(static_cast<uint32_t>(scene_.positions.size()));
      scene_.positions.push_back(corners[i]);
      scene_.normals.push_back(unit);
      scene_.tangents.emplace_back(1, 0, 0, 1);
      scene_.uv0.push_back(uv[i]);
      scene_.uv1.push_back(uv[i]);
      scene_.colors.emplace_back(1.0f);
    }
  }
  /// Parallelogram corner, corner + u, corner + u + v, corner + v; its front is along u x v; uv = (0..1, 0..1).
  void quad(uint32_t material, glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
    triangle(material, corner, corner + u, corner + u + v, {0, 0}, {1, 0}, {1, 1});
    triangle(material, corner, corner + u + v, corner + v, {0, 0}, {1, 1}, {0, 1});
  }
  /// Box with edges u, v, w (right-handed); faces point inwards or outwards.
  void box(uint32_t material, glm::vec3 corner, glm::vec3 u, glm::vec3 v, glm::vec3 w, bool inwards) {
    const glm::vec3 edges[3] = {u, v, w};
    for (int a = 0; a < 3; ++a) {
      const glm::vec3 &n = edges[a], &s = edges[(a + 1) % 3], &t = edges[(a + 2) % 3];
      if (inwards) {
        quad(material, corner, s, t);
        quad(material, corner + n, t, s);
      } else {
        quad(material, corner, t, s);
        quad(material, corner + n, s, t);
      }
    }
  }
  void box(uint32_t material, glm::vec3 lo, glm::vec3 hi, bool inwards) {
    const glm::vec3 e = hi - lo;
    box(material, lo, {e.x, 0, 0}, {0, e.y, 0}, {0, 0, e.z}, inwards);
  }
  /// Latitude-longitude sphere, faces inwards or outwards.
  void sphere(uint32_t material, glm::vec3 centre, float radius, int rings, bool inwards) {
    const auto at = [&](int ring, int sector) {
      const double theta = glm::radians(180.0) * ring / rings, phi = glm::radians(180.0) * sector / rings;
      return centre +
             radius * glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
    };
    for (int r = 0; r < rings; ++r)
      for (int s = 0; s < 2 * rings; ++s) {
        const glm::vec3 a = at(r, s), b = at(r, s + 1), c = at(r + 1, s + 1), d = at(r + 1, s);
        if (r > 0) inwards ? triangle(material, a, d, b) : triangle(material, a, b, d);
        if (r + 1 < rings) inwards ? triangle(material, b, d, c) : triangle(material, b, c, d);
      }
  }
  /// The scene with triangles grouped by material; `reversed` puts each material's triangles in opposite order.
  Scene build(bool reversed = false) const {
    Scene scene = scene_;
    if (scene.materials.empty()) scene.materials.emplace_back();
    for (uint32_t m = 0; m < triangles_.size(); ++m) {
      const auto& list = triangles_[m];
      if (list.empty()) continue;
      scene.draws.push_back({m, static_cast<uint32_t>(scene.indices.size()), static_cast<uint32_t>(list.size())});
      for (size_t t = 0; t < list.size(); t += 3) {
        const size_t from = reversed ? list.size() - 3 - t : t;
        scene.indices.insert(scene.indices.end(), list.begin() + from, list.begin() + from + 3);
      }
    }
    for (size_t i = 0; i < scene.positions.size(); ++i) {
      scene.boundsMin = i == 0 ? scene.positions[0] : glm::min(scene.boundsMin, scene.positions[i]);
      scene.boundsMax = i == 0 ? scene.positions[0] : glm::max(scene.boundsMax, scene.positions[i]);
    }
    return scene;
  }

 private:
  Scene scene_;
  std::vector<std::vector<uint32_t>> triangles_;
};

}  // namespace irad::test
