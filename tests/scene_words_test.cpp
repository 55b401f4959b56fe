// What commands say of scenes that do not look as one expects: all metal, a name that is no UTF-8, a whole that keeps
// its voxels.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "renderer/base/image_io.h"
#include "tests/scene_files.h"

namespace irad::scene_words_suite {
namespace {

using test::contains;
using test::runIrad;
using test::RunResult;

/// A room of 10 m and in it a box of .2 m, of metal or diffuse.
std::string thingInARoom(const std::filesystem::path& folder, bool metal) {
  test::GltfFile file = test::triangleFile();
  std::vector<float> corners;
  for (const float half : {5.0f, 0.1f})
    for (const size_t axis : {0, 1, 2})
      for (const float side : {-half, half})
        for (const auto& [u, v] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}}) {
          float at[3];
          at[axis] = side, at[(axis + 1) % 3] = half * static_cast<float>(u),
          at[(axis + 2) % 3] = half * static_cast<float>(v);
          corners.insert(corners.end(), at, at + 3);
        }
  file.attributes()["POSITION"] = file.vec3(corners);
  file.primitive()["material"] = 0;
  file.json["materials"] = {
      {{"doubleSided", true}, {"pbrMetallicRoughness", {{"metallicFactor", metal ? 1 : 0}, {"roughnessFactor", 0.5}}}}};
  return file.write(folder, metal ? "metal.gltf" : "diffuse.gltf").string();
}

const std::vector<std::string> kSmall{"--set", "voxel.resolution=8", "--set", "matrix.rays=8"};

/// In a file whose name Linux allows and JSON does not: what is written is JSON all the same.
TEST(SceneWords, MetalThatNothingLightsAndANameThatIsNoUtf8AreSaid) {
  test::TemporaryFolder folder;
  const std::string scene = (folder.path / "n\xFF.gltf").string(), out = (folder.path / "out").string(),
                    words = "The one material is not diffuse: metal shows what is around it";
  std::filesystem::rename(thingInARoom(folder.path, /*metal=*/true), scene);
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), kSmall.begin(), kSmall.end());
    return runIrad(arguments);
  };
  const RunResult table = run({"plan", scene});
  EXPECT_EQ(table.status, 0) << table.err;
  EXPECT_TRUE(contains(table.out, words)) << table.out;
  const RunResult json = run({"plan", scene, "--json"});
  EXPECT_EQ(json.status, 0) << json.err;
  const auto said = nlohmann::json::parse(json.out);
  EXPECT_TRUE(said["scene"].get<std::string>().ends_with("n\uFFFD.gltf")) << said["scene"];
  EXPECT_TRUE(contains(said["nothing_diffuse"].dump(), words)) << said["nothing_diffuse"];

  const std::filesystem::path truth =
      writeLinear(folder.path / "truth", glm::uvec2(32, 24), std::vector<glm::vec4>(32 * 24));
  const RunResult studied = run({"study", "cost", scene, "--sweep", "matrix.rays=4", "--reference", truth.string(),
                                 "--inject", "oom=1", "--out", out});
  EXPECT_EQ(studied.status, 4) << studied.err;  // when it has said in JSON what it is about

#ifdef IRAD_OIIO
  const RunResult drawn = run({"render", scene, "--size", "640x120", "--out", out});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_TRUE(contains(drawn.err, words)) << drawn.err;
  // The sun's highlights are in both; the tone curve brightens nothing.
  const auto bright = [&](const char* file) {
    return std::ranges::count_if(readLinear(out + file).pixels, [](const glm::vec4& p) { return p.y > 0.1f; });
  };
  EXPECT_GT(bright("/lit.png"), bright("/lit.exr") + 200) << "no words in the picture";
#endif
}

TEST(SceneWords, TheLineOfTheRegionSaysWhyItIsTheWhole) {
  test::TemporaryFolder folder;
  std::vector<std::string> arguments{"plan", thingInARoom(folder.path, /*metal=*/false)};
  arguments.insert(arguments.end(), kSmall.begin(), kSmall.end());
  const RunResult result = runIrad(arguments);
  EXPECT_TRUE(contains(result.err,
                       "scene.region: whole, since 50 % of the light outside of "
                       "-0.3,-0.3,-0.3,0.3,0.3,0.3, the part with its detail"))
      << result.err;
}

}  // namespace
}  // namespace irad::scene_words_suite
