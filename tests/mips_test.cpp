// Mip levels against means in double precision, and sRGB's codes against its formula.
#include "renderer/scene/mips.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "renderer/scene/srgb.h"

namespace irad::mips_suite {
namespace {

double decode(double s) {
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}
double encode(double c) {
  return c <= 0.0031308 ? c * 12.92 : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

TEST(Srgb, EveryCodeRoundTrips) {
  for (int code = 0; code < 256; ++code) {
    const float light = linearFromSrgb(static_cast<uint8_t>(code));
    EXPECT_NEAR(light, decode(code / 255.0), 6e-8) << code;
    EXPECT_EQ(srgbFromLinear(light), code);
  }
}

TEST(Srgb, LightGetsTheNearestCode) {
  for (int i = 0; i <= 1'000'000; ++i) {
    const float light = static_cast<float>(i) / 1e6f;
    const double exact = 255 * encode(light);
    ASSERT_NEAR(srgbFromLinear(light), exact, 0.5 + 3e-4) << light;  // its two pieces meet but for 1e-6
  }
  EXPECT_EQ(srgbFromLinear(-1.0f), 0);
  EXPECT_EQ(srgbFromLinear(1.5f), 255);
}

TEST(Mips, LevelsAreHalvesDownToOneTexel) {
  EXPECT_EQ(mipCount(1, 1), 1u);
  EXPECT_EQ(mipCount(256, 256), 9u);
  EXPECT_EQ(mipCount(3, 300), 9u);
  EXPECT_TRUE(mipLevels({"one", 1, 1, false, {1, 2, 3, 4}}).empty());
  const std::vector<MipLevel> levels = mipLevels({"", 5, 2, false, std::vector<uint8_t>(40, 7)});
  ASSERT_EQ(levels.size(), 2u);
  EXPECT_EQ(levels[0].width, 2u);
  EXPECT_EQ(levels[0].height, 1u);
  EXPECT_EQ(levels[0].rgba, std::vector<uint8_t>(8, 7));
  EXPECT_EQ(levels[1].rgba, std::vector<uint8_t>(4, 7));
}

TEST(Mips, ColoursAreAveragedAsLightAndAlphaAsItIs) {
  const std::vector<uint8_t> checker{0, 0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 0};
  EXPECT_EQ(mipLevels({"", 2, 2, true, checker}).at(0).rgba, (std::vector<uint8_t>{188, 188, 188, 128}));
  EXPECT_EQ(mipLevels({"", 2, 2, false, checker}).at(0).rgba, (std::vector<uint8_t>{128, 128, 128, 128}));
}

SceneImage masked(uint32_t edge, const std::function<std::vector<uint8_t>(uint32_t, uint32_t)>& texel) {
  SceneImage image{"", edge, edge, true, {}};
  for (uint32_t y = 0; y < edge; ++y)
    for (uint32_t x = 0; x < edge; ++x) {
      const std::vector<uint8_t> t = texel(x, y);
      image.rgba.insert(image.rgba.end(), t.begin(), t.end());
    }
  return image;
}
const std::vector<uint8_t> kLeaf{0, 90, 0, 255}, kCut{255, 255, 255, 0}, kThin{0, 90, 0, 128};

TEST(Mips, ColoursOfWhatIsCutOffDoNotGetIntoWhatIsThere) {
  const auto mip = [](std::initializer_list<std::vector<uint8_t>> texels, AlphaMode alpha) {
    return mipLevels(masked(2, [&](uint32_t x, uint32_t y) { return texels.begin()[2 * y + x]; }), alpha).at(0).rgba;
  };
  for (const AlphaMode alpha : {AlphaMode::Mask, AlphaMode::Blend}) {  // of one texel a mask's alpha is the mean, too
    EXPECT_EQ(mip({kLeaf, kCut, kCut, kCut}, alpha), (std::vector<uint8_t>{0, 90, 0, 64}));
    EXPECT_EQ(mip({kThin, kThin, kThin, kCut}, alpha), (std::vector<uint8_t>{0, 90, 0, 96}));
    EXPECT_EQ(mip({kLeaf, kLeaf, kLeaf, kLeaf}, alpha), (std::vector<uint8_t>{0, 90, 0, 255}));
    EXPECT_EQ(mip({kCut, kCut, kCut, kCut}, alpha), (std::vector<uint8_t>{255, 255, 255, 0}));
  }
  EXPECT_GT(mip({kLeaf, kCut, kCut, kCut}, AlphaMode::Opaque)[0], 200) << "its alpha says nothing";

  // Down to one texel: a single one that is there among 255.
  const SceneImage one = masked(16, [](uint32_t x, uint32_t y) { return x == 5 && y == 2 ? kLeaf : kCut; });
  EXPECT_EQ(mipLevels(one, AlphaMode::Blend).back().rgba, (std::vector<uint8_t>{1, 90, 1, 1}));
}

TEST(Mips, MasksLeaveAsMuchOfEveryLevelAsOfTheImage) {
  // Leaves as speckles that cover three tenths: no mean of four or more texels gets above a half but by chance.
  std::mt19937 random(2);
  const SceneImage image = masked(64, [&](uint32_t, uint32_t) { return random() % 10 < 3 ? kLeaf : kCut; });
  const auto left = [](const std::vector<uint8_t>& rgba, int cutoff) {
    double count = 0;
    for (size_t i = 3; i < rgba.size(); i += 4) count += rgba[i] >= cutoff;
    return count / (static_cast<double>(rgba.size()) / 4);
  };
  const double whole = left(image.rgba, 128);
  const std::vector<MipLevel> levels = mipLevels(image, AlphaMode::Mask), means = mipLevels(image, AlphaMode::Blend);
  for (const size_t level : {0, 1, 2}) {
    const auto texels = static_cast<double>(levels[level].width * levels[level].height);
    // Equal means are one step, of which a level of means of 4 texels has five.
    EXPECT_NEAR(left(levels[level].rgba, 128), whole, level == 0 ? 0.2 : 0.1 + 1 / texels) << level;
    double mean = 0;
    for (size_t i = 3; i < levels[level].rgba.size(); i += 4) mean += levels[level].rgba[i] / 255.0 / texels;
    EXPECT_NEAR(mean, whole, 0.004) << level;
  }
  EXPECT_LT(left(means[2].rgba, 128), 0.02) << "by their means they are gone";

  // What has all alphas from 0 to 1 keeps them all.
  const SceneImage slope = masked(64, [&](uint32_t, uint32_t) {
    return std::vector<uint8_t>{9, 9, 9, static_cast<uint8_t>(random() % 256)};
  });
  for (const int cutoff : {64, 128, 192})
    EXPECT_NEAR(left(mipLevels(slope, AlphaMode::Mask)[1].rgba, cutoff), left(slope.rgba, cutoff), 0.02) << cutoff;
}

TEST(Mips, AlphaCountsWhereEveryBaseColourIsMaskedOrBlended) {
  Scene scene;
  scene.images.resize(4);
  const auto add = [&](int image, AlphaMode alpha) {
    scene.materials.emplace_back().baseColorTexture.image = image;
    scene.materials.back().alpha = alpha;
  };
  add(0, AlphaMode::Mask), add(0, AlphaMode::Blend), add(1, AlphaMode::Mask), add(1, AlphaMode::Opaque);
  add(3, AlphaMode::Mask), add(3, AlphaMode::Mask);
  scene.materials.emplace_back().emissiveTexture.image = 2;
  scene.materials.back().alpha = AlphaMode::Mask;
  EXPECT_EQ(alphaOf(scene, 0), AlphaMode::Blend);
  EXPECT_EQ(alphaOf(scene, 1), AlphaMode::Opaque) << "where it is opaque all of it is seen";
  EXPECT_EQ(alphaOf(scene, 2), AlphaMode::Opaque) << "its alpha says nothing";
  EXPECT_EQ(alphaOf(scene, 3), AlphaMode::Mask);
}

/// A level in double precision: light, row by row.
struct Exact {
  uint32_t width, height;
  std::vector<glm::dvec4> texels;
};
Exact exactImage(const SceneImage& image) {
  Exact out{image.width, image.height, {}};
  for (size_t i = 0; i < image.rgba.size(); i += 4) {
    glm::dvec4& texel = out.texels.emplace_back();
    for (int c = 0; c < 4; ++c) {
      const double code = image.rgba[i + c] / 255.0;
      texel[c] = image.srgb && c < 3 ? decode(code) : code;
    }
  }
  return out;
}
/// Every texel has the weight of its part that lies in the texel below.
Exact exactHalf(const Exact& above) {
  Exact out{std::max(above.width / 2, 1u), std::max(above.height / 2, 1u), {}};
  const double stepX = double(above.width) / out.width, stepY = double(above.height) / out.height;
  const auto overlap = [](uint32_t i, double step, uint32_t texel) {
    return std::max(0.0, std::min((i + 1) * step, texel + 1.0) - std::max(i * step, double(texel)));
  };
  for (uint32_t y = 0; y < out.height; ++y)
    for (uint32_t x = 0; x < out.width; ++x) {
      glm::dvec4& sum = out.texels.emplace_back(0);
      for (uint32_t v = 0; v < above.height; ++v)
        for (uint32_t u = 0; u < above.width; ++u)
          sum += above.texels[size_t{v} * above.width + u] * overlap(x, stepX, u) * overlap(y, stepY, v);
      sum /= stepX * stepY;
    }
  return out;
}

TEST(Mips, EveryTexelIsTheMeanOfWhatItCoversRoundedOnce) {
  std::mt19937 random(1);
  for (const auto& [width, height] : {std::pair{16u, 8u}, {7u, 5u}, {1u, 23u}, {31u, 2u}, {12u, 9u}})
    for (const bool srgb : {false, true}) {
      SceneImage image{"", width, height, srgb, std::vector<uint8_t>(size_t{4} * width * height)};
      for (uint8_t& code : image.rgba) code = static_cast<uint8_t>(random());
      Exact exact = exactImage(image);
      for (const MipLevel& level : mipLevels(image)) {
        exact = exactHalf(exact);
        ASSERT_EQ(level.rgba.size(), 4 * exact.texels.size());
        for (size_t i = 0; i < level.rgba.size(); ++i) {
          const double light = exact.texels[i / 4][static_cast<int>(i % 4)];
          ASSERT_NEAR(level.rgba[i], 255 * (srgb && i % 4 < 3 ? encode(light) : light), 0.5 + 1e-3)
              << width << " x " << height << ", level of " << level.width << ", byte " << i;
        }
      }
    }
}

}  // namespace
}  // namespace irad::mips_suite
