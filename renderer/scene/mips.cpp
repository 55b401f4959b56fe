#include "renderer/scene/mips.h"

#include <algorithm>
#include <array>
#include <bit>

#include "renderer/scene/srgb.h"

namespace irad {
namespace {

/// Texels of the level above that one texel covers along an axis, and the share of its extent that each of them is.
struct Taps {
  uint32_t first, count;
  std::array<float, 3> share;
};

/// At most two texels and a part of a third, since halves are rounded down.
std::vector<Taps> tapsOf(uint32_t above, uint32_t size) {
  std::vector<Taps> taps(size);
  for (uint32_t i = 0; i < size; ++i) {
    // In units of 1 / size of a texel of the level above, all numbers are whole.
    const uint64_t begin = uint64_t{i} * above, end = begin + above;
    Taps& t = taps[i];
    t.first = static_cast<uint32_t>(begin / size);
    t.count = 0;
    for (uint64_t at = begin; at < end; ++t.count) {
      const uint64_t next = std::min((at / size + 1) * size, end);
      t.share.at(t.count) = static_cast<float>(next - at) / static_cast<float>(above);
      at = next;
    }
  }
  return taps;
}

struct Level {
  uint32_t width, height;
  std::vector<glm::vec4> texels;  ///< linear
};

/// `texel(i)`: texel i of the level above, linear, row by row.
template <class Texel>
Level half(uint32_t width, uint32_t height, const Texel& texel) {
  Level out{std::max(width / 2, 1u), std::max(height / 2, 1u), {}};
  const std::vector<Taps> across = tapsOf(width, out.width), down = tapsOf(height, out.height);
  out.texels.reserve(size_t{out.width} * out.height);
  for (const Taps& v : down)
    for (const Taps& u : across) {
      glm::vec4 mean(0.0f);
      for (uint32_t y = 0; y < v.count; ++y) {
        const size_t row = size_t{v.first + y} * width + u.first;
        glm::vec4 along(0.0f);
        for (uint32_t x = 0; x < u.count; ++x) along += texel(row + x) * u.share[x];
        mean += along * v.share[y];
      }
      out.texels.push_back(mean);
    }
  return out;
}

}  // namespace

uint32_t mipCount(uint32_t width, uint32_t height) {
  return static_cast<uint32_t>(std::bit_width(std::max(width, height)));
}

std::vector<MipLevel> mipLevels(const SceneImage& image) {
  std::array<float, 256> plain, color;
  for (int code = 0; code < 256; ++code) {
    plain[code] = static_cast<float>(code) / 255.0f;
    color[code] = image.srgb ? linearFromSrgb(static_cast<uint8_t>(code)) : plain[code];
  }
  const auto code = [&](float value, int channel) {
    return image.srgb && channel < 3 ? srgbFromLinear(value) : static_cast<uint8_t>(value * 255.0f + 0.5f);
  };

  std::vector<MipLevel> levels;
  Level level{image.width, image.height, {}};
  for (uint32_t mip = 1; mip < mipCount(image.width, image.height); ++mip) {
    level = mip == 1 ? half(image.width, image.height,
                            [&](size_t i) {
                              const uint8_t* t = &image.rgba[4 * i];
                              return glm::vec4(color[t[0]], color[t[1]], color[t[2]], plain[t[3]]);
                            })
                     : half(level.width, level.height, [&](size_t i) { return level.texels[i]; });
    MipLevel& out = levels.emplace_back(MipLevel{level.width, level.height, {}});
    out.rgba.reserve(4 * level.texels.size());
    for (const glm::vec4& texel : level.texels)
      for (int c = 0; c < 4; ++c) out.rgba.push_back(code(texel[c], c));
  }
  return levels;
}

}  // namespace irad
