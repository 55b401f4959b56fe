// Reads EXR files for comparisons: every channel by name, and the metrics of DESIGN.md.
#pragma once

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/glm.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace irad::test {

struct Picture {
  uint32_t width = 0, height = 0;
  std::vector<glm::vec3> pixels;  ///< top row first
  glm::dvec3 mean() const {
    glm::dvec3 sum(0.0);
    for (const glm::vec3& p : pixels) sum += glm::dvec3(p);
    return sum / static_cast<double>(pixels.size());
  }
};

/// Channels LAYER.R, LAYER.G, LAYER.B of a multilayer file; an empty layer: the first three channels.
inline Picture readExr(const std::filesystem::path& path, const std::string& layer = {}) {
  const auto in = OIIO::ImageInput::open(path.string());
  if (!in) throw std::runtime_error("cannot read " + path.string() + ": " + OIIO::geterror());
  const OIIO::ImageSpec& spec = in->spec();
  std::vector<float> all(static_cast<size_t>(spec.width) * spec.height * spec.nchannels);
  in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, all.data());
  int channel[3] = {0, 1, 2};
  if (!layer.empty())
    for (int c = 0; c < 3; ++c) {
      channel[c] = spec.channelindex(layer + "." + "RGB"[c]);
      if (channel[c] < 0) throw std::runtime_error(path.string() + " has no layer " + layer);
    }
  Picture out{static_cast<uint32_t>(spec.width), static_cast<uint32_t>(spec.height), {}};
  out.pixels.resize(static_cast<size_t>(spec.width) * spec.height);
  for (size_t i = 0; i < out.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) out.pixels[i][c] = all[i * spec.nchannels + channel[c]];
  return out;
}

/// Root of the mean of (a - b)^2, channels averaged.
inline double rmse(const Picture& a, const Picture& b) {
  double sum = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    const glm::dvec3 d = glm::dvec3(a.pixels[i]) - glm::dvec3(b.pixels[i]);
    sum += glm::dot(d, d);
  }
  return std::sqrt(sum / (3.0 * static_cast<double>(a.pixels.size())));
}

/// The largest |a - b| of any channel; NaN where any is.
inline double worstPixel(const Picture& a, const Picture& b) {
  double worst = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double d = std::abs(double(a.pixels[i][c]) - b.pixels[i][c]);
      if (std::isnan(d)) return d;
      worst = std::max(worst, d);
    }
  return worst;
}

/// Mean of (a - b)^2 / (b^2 + epsilon), channels averaged.
inline double relMse(const Picture& a, const Picture& b, double epsilon) {
  double sum = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double d = double(a.pixels[i][c]) - b.pixels[i][c];
      sum += d * d / (double(b.pixels[i][c]) * b.pixels[i][c] + epsilon);
    }
  return sum / (3.0 * static_cast<double>(a.pixels.size()));
}

}  // namespace irad::test
