// Legends: what they say, drawn into pictures, and `irad render --legend` and `--inspect`.
#include "gi/legend.h"

#include <gtest/gtest.h>

#if IRAD_OIIO

#include <nlohmann/json.hpp>

#include "gi/views/views.h"
#include "renderer/base/image_io.h"
#include "shaders/shared/color_map.h"
#include "tests/exr.h"
#include "tests/support.h"

namespace irad::test::legend_suite {
namespace {

TEST(Legend, SaysWhatTheColoursStandFor) {
  ViewRange range{};
  range.low = 0;
  range.high = 4;
  range.nan = 1234;
  range.negative = 2;
  const Legend legend = makeLegend({"Irradiance", "W/m^2"}, COLOR_MAP_HEAT, range);
  EXPECT_EQ(legend.title, "Irradiance (W/m\u00B2)");
  EXPECT_EQ(legend.marks, "1,234 NaN (red), 2 negative (blue)");
  std::vector<std::string> labels;
  for (const Legend::Tick& tick : legend.ticks) {
    labels.push_back(tick.label);
    EXPECT_FLOAT_EQ(tick.at, std::stof(tick.label) / 4);
  }
  EXPECT_EQ(labels, (std::vector<std::string>{"0", "1", "2", "3", "4"}));

  range = {};
  range.low = range.high = 7;
  const Legend one = makeLegend({"Facets", ""}, COLOR_MAP_GREY, range);
  EXPECT_EQ(one.title, "Facets");
  ASSERT_EQ(one.ticks.size(), 1u);
  EXPECT_EQ(one.ticks[0].label, "7");
  EXPECT_FLOAT_EQ(one.ticks[0].at, 0.5f);
}

TEST(Legend, IsDrawnIntoTheCorner) {
  constexpr glm::uvec2 kSize{480, 360};
  constexpr glm::u8vec4 kGround{0, 200, 0, 255};
  ViewRange range{};
  range.high = 1;
  std::vector<glm::u8vec4> pixels(size_t{kSize.x} * kSize.y, kGround);
  const Legend legend = makeLegend({"Depth", "m"}, COLOR_MAP_VIOLET_YELLOW, range);
  drawLegend(legend, kSize, pixels);
  // 280 wide and 14 from the edges, a padding of 7: nothing else is touched.
  size_t ink = 0;
  for (uint32_t y = 0; y < kSize.y; ++y)
    for (uint32_t x = 0; x < kSize.x; ++x) {
      const glm::u8vec4 p = pixels[y * kSize.x + x];
      const bool inside = x >= 480 - 14 - 7 - 280 - 7 && x < 480 - 14 && y >= 360 - 14 - 14 - 56 && y < 360 - 14;
      ASSERT_EQ(p != kGround, inside) << x << ", " << y;
      ink += inside && y < 360 - 14 - 7 - 56 + 19 && p.x > 60;
    }
  EXPECT_GT(ink, 50u) << "no title: its line is as dark as the ground";
  // The bar is the map from end to end.
  const uint32_t y = 360 - 14 - 7 - 56 + 19 + 7, left = 480 - 14 - 7 - 280;
  for (const uint32_t x : {0u, 70u, 140u, 279u}) {
    const glm::vec3 color = encodeSrgb(colorMap(legend.map, (static_cast<float>(x) + 0.5f) / 280));
    EXPECT_EQ(pixels[y * kSize.x + left + x], glm::u8vec4(color * 255.0f + 0.5f, 255)) << x;
  }
  // Where there is no room, nothing.
  std::vector<glm::u8vec4> small(100 * 80, kGround);
  drawLegend(legend, {100, 80}, small);
  EXPECT_EQ(small, std::vector<glm::u8vec4>(100 * 80, kGround));
}

TEST(Legend, RenderDrawsItIntoPicturesWithARangeOnly) {
  const TemporaryFolder folder;
  const auto render = [&](const char* name, std::vector<std::string> more) {
    std::vector<std::string> command{"render",    "box",
                                     "--out",     (folder.path / name).string(),
                                     "--size",    "320x240",
                                     "--view",    "direct,depth,matrix-row",
                                     "--inspect", "6,1,12",
                                     "--set",     "voxel.resolution=16",
                                     "--set",     "matrix.rays=32",
                                     "--set",     "specular.mode=off"};
    command.insert(command.end(), more.begin(), more.end());
    const RunResult run = runIrad(command);
    EXPECT_EQ(run.status, 0) << run.err;
    return contents(folder.path / name);
  };
  auto without = render("without", {}), with = render("with", {"--legend"});
  for (const char* same : {"direct.png", "direct.exr", "depth.exr", "matrix-row.exr"})
    EXPECT_EQ(without[same], with[same]) << same;
  for (const char* other : {"depth.png", "matrix-row.png"}) EXPECT_NE(without[other], with[other]) << other;

  // The row that --inspect asks for: in the manifest, and in the picture, F being hits of 32 rays.
  const auto manifest = nlohmann::json::parse(with["manifest.json"]);
  EXPECT_GT(manifest["settings"]["view.facet"], 0);
  const ExrPicture row = readExr(folder.path / "with/matrix-row.exr");
  float largest = 0;
  for (const glm::vec3& p : row.pixels) largest = std::max(largest, p.x);
  EXPECT_GT(largest, 0.5 / 32);
  EXPECT_LE(largest, 1);
  const RunResult replay = runIrad({"render", "--config", (folder.path / "without/manifest.json").string(), "--out",
                                    (folder.path / "again").string()});
  ASSERT_EQ(replay.status, 0) << replay.err;
  EXPECT_EQ(contents(folder.path / "again")["matrix-row.png"], without["matrix-row.png"]);

  const RunResult empty = runIrad({"render", "box", "--out", (folder.path / "empty").string(), "--inspect", "8,8,8",
                                   "--set", "voxel.resolution=16", "--set", "matrix.rays=32"});
  EXPECT_EQ(empty.status, 2);
  EXPECT_TRUE(contains(empty.err, "the nearest solid voxel is")) << empty.err;
}

}  // namespace
}  // namespace irad::test::legend_suite

#else

TEST(Legend, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_OIIO";
}

#endif
