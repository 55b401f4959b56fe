// Reads EXR files for comparisons: every channel by name, and the metrics.
#pragma once

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <filesystem>
#include <glm/glm.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "renderer/metrics.h"

namespace irad::test {

struct ExrPicture {
  uint32_t width = 0, height = 0;
  std::vector<glm::vec3> pixels;  ///< top row first
  glm::dvec3 mean() const {
    glm::dvec3 sum(0.0);
    for (const glm::vec3& p : pixels) sum += glm::dvec3(p);
    return sum / static_cast<double>(pixels.size());
  }
};

/// Channels LAYER.R, LAYER.G, LAYER.B of a multilayer file; an empty layer: the first three channels.
inline ExrPicture readExr(const std::filesystem::path& path, const std::string& layer = {}) {
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
  ExrPicture out{static_cast<uint32_t>(spec.width), static_cast<uint32_t>(spec.height), {}};
  out.pixels.resize(static_cast<size_t>(spec.width) * spec.height);
  for (size_t i = 0; i < out.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) out.pixels[i][c] = all[i * spec.nchannels + channel[c]];
  return out;
}

/// renderer/metrics.h; where anything is not finite there is nothing to compare: all NaN.
inline Metrics metrics(const ExrPicture& a, const ExrPicture& b) {
  const auto four = [](const ExrPicture& p) {
    std::vector<glm::vec4> out;
    for (const glm::vec3& c : p.pixels) out.emplace_back(c, 1);
    return out;
  };
  Metrics m = measure(four(a), four(b));
  if (m.leftOut > 0) m.rmse = m.relMse = m.psnr = m.meanError = m.largest = std::nan("");
  return m;
}

}  // namespace irad::test
