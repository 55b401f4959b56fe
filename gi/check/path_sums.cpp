// Sums of the path tracer's samples: what they say, in every build.
#include <cmath>

#include "gi/check/path_tracer.h"
#include "renderer/base/error.h"

namespace irad {
namespace {

TracedLight lightOf(const TracedSums::Light& sums, uint32_t samples) {
  const double n = samples, odd = samples / 2, even = n - odd;
  const size_t pixels = sums.squares.size();
  TracedLight light;
  light.mean.resize(pixels);
  light.error.resize(pixels);
  for (auto& half : light.half) half.resize(pixels);
  glm::dvec3 sum(0), variance(0);
  for (size_t i = 0; i < pixels; ++i) {
    const glm::dvec3 mean = (sums.half[0][i] + sums.half[1][i]) / n;
    const glm::dvec3 ofMean = glm::max(sums.squares[i] / n - mean * mean, 0.0) / (n - 1);
    light.mean[i] = mean;
    light.half[0][i] = sums.half[0][i] / even;
    light.half[1][i] = sums.half[1][i] / odd;
    light.error[i] = glm::sqrt(ofMean);
    sum += mean;
    variance += ofMean;
  }
  light.pictureMean = sum / static_cast<double>(pixels);
  light.pictureError = glm::sqrt(variance) / static_cast<double>(pixels);
  return light;
}

}  // namespace

TracedPicture pictureOf(const TracedSums& sums) {
  IRAD_CHECK(sums.samples > 1, "{} samples have no standard error", sums.samples);
  TracedPicture picture{.size = sums.size,
                        .samples = sums.samples,
                        .lit = lightOf(sums.lit, sums.samples),
                        .indirect = lightOf(sums.indirect, sums.samples),
                        .specular = {},
                        .bounces = {},
                        .rays = sums.rays,
                        .seconds = sums.seconds};
  if (!sums.specular.squares.empty()) picture.specular = lightOf(sums.specular, sums.samples);
  for (const TracedSums::Light& light : sums.bounces) picture.bounces.push_back(lightOf(light, sums.samples));
  return picture;
}

TracedPicture PathTracer::render(const Camera& camera, glm::uvec2 size, const TraceOptions& options) const {
  TracedSums sums;
  add(camera, size, options, sums);
  return pictureOf(sums);
}

std::vector<glm::vec4> pixelsOf(const std::vector<glm::dvec3>& light) {
  std::vector<glm::vec4> out;
  out.reserve(light.size());
  for (const glm::dvec3& value : light) out.emplace_back(glm::vec3(value), 1.0f);
  return out;
}

double relativeNoise(const TracedLight& light) {
  const glm::dvec3& m = light.pictureMean;
  const double mean = (m.x + m.y + m.z) / 3, epsilon = 0.01 * mean * mean;
  if (!(mean > 0)) return 0;
  double sum = 0;
  for (size_t i = 0; i < light.mean.size(); ++i)
    for (int c = 0; c < 3; ++c)
      sum += light.error[i][c] * light.error[i][c] / (light.mean[i][c] * light.mean[i][c] + epsilon);
  return std::sqrt(sum / (3.0 * static_cast<double>(light.mean.size())));
}

}  // namespace irad
