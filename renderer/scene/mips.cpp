#include "renderer/scene/mips.h"

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

#include "renderer/scene/material_edits.h"
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

/// How the alphas of an image are spread.
class AlphaSpread {
 public:
  explicit AlphaSpread(std::vector<float> alphas) : alphas_(std::move(alphas)), sums_(alphas_.size() + 1) {
    std::ranges::sort(alphas_);
    std::partial_sum(alphas_.begin(), alphas_.end(), sums_.begin() + 1, std::plus<double>());
  }
  /// The alphas of a level, spread alike: the texels of the least mean get the mean of as large a share of the image's
  /// least ones, and so on; those of equal means the mean of what is theirs together.
  std::vector<float> of(const Level& level) const {
    const size_t count = level.texels.size();
    std::vector<size_t> order(count);
    std::iota(order.begin(), order.end(), size_t{0});
    std::ranges::stable_sort(order, {}, [&](size_t i) { return level.texels[i].a; });
    const auto placeOf = [&](size_t texels) {
      return static_cast<double>(texels) / static_cast<double>(count) * static_cast<double>(alphas_.size());
    };
    std::vector<float> out(count);
    for (size_t first = 0; first < count;) {
      size_t end = first + 1;
      while (end < count && level.texels[order[end]].a == level.texels[order[first]].a) ++end;
      const auto mean =
          static_cast<float>((sumOfLeast(placeOf(end)) - sumOfLeast(placeOf(first))) / placeOf(end - first));
      for (; first < end; ++first) out[order[first]] = mean;
    }
    return out;
  }

 private:
  double sumOfLeast(double count) const {
    const size_t whole = std::min(static_cast<size_t>(count), alphas_.size() - 1);
    return sums_[whole] + (count - static_cast<double>(whole)) * double{alphas_[whole]};
  }
  std::vector<float> alphas_;  ///< ascending
  std::vector<double> sums_;   ///< of the first ones
};

}  // namespace

uint32_t mipCount(uint32_t width, uint32_t height) {
  return static_cast<uint32_t>(std::bit_width(std::max(width, height)));
}

std::vector<MipLevel> mipLevels(const SceneImage& image, AlphaMode alpha) {
  std::array<float, 256> plain, color;
  for (int code = 0; code < 256; ++code) {
    plain[code] = static_cast<float>(code) / 255.0f;
    color[code] = image.srgb ? linearFromSrgb(static_cast<uint8_t>(code)) : plain[code];
  }
  const auto code = [&](float value, int channel) {
    return image.srgb && channel < 3 ? srgbFromLinear(value) : static_cast<uint8_t>(value * 255.0f + 0.5f);
  };
  // Far less than the least alpha there is, so that a colour is left where all of it is 0.
  constexpr float kNothingThere = 1e-6f;
  const auto texel = [&](size_t i) {
    const uint8_t* t = &image.rgba[4 * i];
    return glm::vec4(color[t[0]], color[t[1]], color[t[2]], plain[t[3]]);
  };
  const auto weighted = [&](size_t i) {
    const glm::vec4 t = texel(i);
    const float weight = std::max(t.a, kNothingThere);
    return glm::vec4(glm::vec3(t) * weight, weight);
  };
  const auto below = [](const Level& above) {
    return half(above.width, above.height, [&](size_t i) { return above.texels[i]; });
  };

  std::optional<AlphaSpread> spread;
  if (alpha == AlphaMode::Mask) {
    std::vector<float> alphas;
    for (size_t i = 3; i < image.rgba.size(); i += 4) alphas.push_back(plain[image.rgba[i]]);
    spread.emplace(std::move(alphas));
  }
  const bool covered = alpha != AlphaMode::Opaque;
  std::vector<MipLevel> levels;
  Level level, colors;  // `colors`: times their weight, and it
  for (uint32_t mip = 1; mip < mipCount(image.width, image.height); ++mip) {
    level = mip == 1 ? half(image.width, image.height, texel) : below(level);
    if (covered) colors = mip == 1 ? half(image.width, image.height, weighted) : below(colors);
    MipLevel& out = levels.emplace_back(MipLevel{level.width, level.height, {}});
    out.rgba.reserve(4 * level.texels.size());
    const std::vector<float> alphas = spread ? spread->of(level) : std::vector<float>();
    for (size_t i = 0; i < level.texels.size(); ++i) {
      glm::vec4 t = level.texels[i];
      if (covered) t = glm::vec4(glm::vec3(colors.texels[i]) / colors.texels[i].a, spread ? alphas[i] : t.a);
      for (int c = 0; c < 4; ++c) out.rgba.push_back(code(t[c], c));
    }
  }
  return levels;
}

AlphaMode alphaOf(const Scene& scene, size_t image) {
  std::optional<AlphaMode> found;
  for (const Material& material : fileMaterials(scene)) {
    if (material.baseColorTexture.image != static_cast<int>(image)) continue;
    if (material.alpha == AlphaMode::Opaque) return AlphaMode::Opaque;
    found = found.value_or(material.alpha) == material.alpha ? material.alpha : AlphaMode::Blend;
  }
  return found.value_or(AlphaMode::Opaque);
}

}  // namespace irad
