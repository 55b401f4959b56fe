#include "gi/check/pictures.h"

#include <algorithm>
#include <cmath>

#include "renderer/base/error.h"

namespace irad {

Scene scaled(Scene scene, float s) {
  for (glm::vec3& p : scene.positions) p *= s;
  scene.boundsMin *= s;
  scene.boundsMax *= s;
  scene.origin *= s;
  for (Light& light : scene.lights) {
    light.position *= s;
    light.range *= s;
    if (!lightKind(light.type).has(LIGHT_DISTANT)) light.intensity *= s * s;
  }
  for (Camera& camera : scene.cameras) {
    camera.position *= s;
    camera.znear *= s;
    camera.zfar *= s;
    camera.ymag *= s;
  }
  return scene;
}

Scene permuted(Scene scene, const glm::mat3& axes) {
  const bool mirrors = glm::determinant(axes) < 0;
  for (glm::vec3& p : scene.positions) p = axes * p;
  for (glm::vec3& n : scene.normals) n = axes * n;
  for (glm::vec4& t : scene.tangents) t = glm::vec4(axes * glm::vec3(t), mirrors ? -t.w : t.w);
  if (mirrors)
    for (size_t i = 0; i < scene.indices.size(); i += 3) std::swap(scene.indices[i + 1], scene.indices[i + 2]);
  const glm::vec3 a = axes * scene.boundsMin, b = axes * scene.boundsMax;
  scene.boundsMin = glm::min(a, b);
  scene.boundsMax = glm::max(a, b);
  scene.origin = glm::dmat3(axes) * scene.origin;
  for (Light& light : scene.lights) {
    light.position = glm::dmat3(axes) * light.position;
    light.direction = axes * light.direction;
  }
  for (Camera& camera : scene.cameras) {
    camera.position = glm::dmat3(axes) * camera.position;
    glm::mat3 frame = axes * glm::mat3_cast(camera.orientation);
    if (mirrors) frame[0] = -frame[0];  // cameras are right-handed
    camera.orientation = glm::quat_cast(frame);
  }
  return scene;
}

Picture flipped(Picture picture) {
  for (auto row = picture.pixels.begin(); row != picture.pixels.end(); row += picture.size.x)
    std::reverse(row, row + picture.size.x);
  return picture;
}

PictureError compare(const Picture& picture, const Picture& reference, double factor) {
  IRAD_CHECK_OP(picture.pixels.size(), ==, reference.pixels.size());
  PictureError error;
  double sum = 0, total = 0;
  for (size_t i = 0; i < picture.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double value = picture.pixels[i][c] / factor, expected = reference.pixels[i][c];
      const double difference = std::abs(value - expected);
      sum += value;
      total += expected;
      error.mean += difference;
      error.largest = difference > error.largest || std::isnan(difference) ? difference : error.largest;
    }
  const double n = 3.0 * static_cast<double>(picture.pixels.size()), mean = total / n;
  return {error.mean / n / mean, error.largest / mean, std::abs(sum / total - 1)};
}

}  // namespace irad
