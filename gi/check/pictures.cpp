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
    light.radius *= s;
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

CheckPicture flipped(CheckPicture picture) {
  for (auto row = picture.pixels.begin(); row != picture.pixels.end(); row += picture.size.x)
    std::reverse(row, row + picture.size.x);
  return picture;
}

double meanOf(const CheckPicture& picture) {
  double sum = 0;
  for (const glm::vec4& p : picture.pixels) sum += double{p.r} + double{p.g} + double{p.b};
  return sum / (3.0 * static_cast<double>(picture.pixels.size()));
}

PictureError compare(const CheckPicture& picture, const CheckPicture& reference, double factor) {
  IRAD_CHECK_OP(picture.pixels.size(), ==, reference.pixels.size());
  PictureError error;
  for (size_t i = 0; i < picture.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double difference = std::abs(picture.pixels[i][c] / factor - reference.pixels[i][c]);
      error.mean += difference;
      error.largest = difference > error.largest || std::isnan(difference) ? difference : error.largest;
    }
  const double n = 3.0 * static_cast<double>(picture.pixels.size()), mean = meanOf(reference);
  return {error.mean / n / mean, error.largest / mean, std::abs(meanOf(picture) / factor / mean - 1)};
}

namespace {
glm::dvec3 blockMean(auto&& value, glm::uvec2 at, uint32_t width) {
  constexpr uint32_t kBlock = 4;
  glm::dvec3 sum(0);
  for (uint32_t y = 0; y < kBlock; ++y)
    for (uint32_t x = 0; x < kBlock; ++x) sum += value(size_t{at.y * kBlock + y} * width + at.x * kBlock + x);
  return sum / double{kBlock * kBlock};
}
}  // namespace

TruthError compare(const CheckPicture& picture, const TracedLight& truth) {
  IRAD_CHECK_OP(picture.pixels.size(), ==, truth.mean.size());
  const auto mean = [](const glm::dvec3& v) { return (v.x + v.y + v.z) / 3; };
  glm::dvec3 sum(0);
  for (const glm::vec4& p : picture.pixels) sum += glm::dvec3(p);
  const double expected = mean(truth.pictureMean), eps = 0.01 * expected * expected;
  TruthError error{.ratio = mean(sum) / static_cast<double>(picture.pixels.size()) / expected,
                   .uncertainty = mean(truth.pictureError) / expected};
  const glm::uvec2 blocks = picture.size / 4u;
  for (uint32_t y = 0; y < blocks.y; ++y)
    for (uint32_t x = 0; x < blocks.x; ++x) {
      const auto of = [&](auto&& value) { return blockMean(value, {x, y}, picture.size.x); };
      const glm::dvec3 ours = of([&](size_t i) { return glm::dvec3(picture.pixels[i]); }),
                       first = of([&](size_t i) { return truth.half[0][i]; }),
                       second = of([&](size_t i) { return truth.half[1][i]; }), middle = 0.5 * (first + second);
      error.relMse += mean((ours - first) * (ours - second) / (middle * middle + eps));
    }
  error.relMse /= double{1} * blocks.x * blocks.y;
  return error;
}

}  // namespace irad
