// The built-in scenes of assets/: sizes and counts by the thesis's Tables 2 and 3, cameras, lights, and that the
// scripts beside them make these very files. Their pictures are the suite images'.
#include <algorithm>
#include <cstdio>
#include <set>

#include "app/arguments.h"
#include "renderer/scene/scene.h"
#include "tests/support.h"

namespace irad::test::built_in_suite {
namespace {

struct Expected {
  const char* name;
  glm::dvec3 extents;   ///< m, T Table 2
  double triangles;     ///< T Table 3
  double howFar = 0.1;  ///< the count's distance from it
};
constexpr Expected kScenes[] = {{"box", {10.65, 10.65, 10.65}, 5022, 0.11},
                                {"box-hard", {10.65, 10.65, 10.65}, 5022, 0.11},
                                {"park", {45.52, 27.44, 45.52}, 3820},
                                {"arena", {304.56, 79.18, 543.48}, 5187}};

TEST(BuiltIn, ScenesAreOfTheThesissSizes) {
  for (const Expected& expected : kScenes) {
    SCOPED_TRACE(expected.name);
    const Scene scene = loadScene(app::findScene(expected.name, {}, std::nullopt));
    const glm::dvec3 extents = glm::dvec3(scene.boundsMax) - glm::dvec3(scene.boundsMin);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(extents[axis], expected.extents[axis], 0.005) << "axis " << axis;
    EXPECT_NEAR(scene.triangleCount() / expected.triangles, 1, expected.howFar) << scene.triangleCount();
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    EXPECT_FALSE(scene.defaultLight || scene.defaultCamera);
    std::set<std::string> cameras;
    for (const Camera& camera : scene.cameras) cameras.insert(camera.name);
    EXPECT_EQ(cameras.size(), 2u);
    EXPECT_TRUE(cameras.contains("main"));
  }
}

TEST(BuiltIn, EverySceneOfTheFolderIsFoundByItsNameAndSmall) {
  const std::vector<std::string> names = app::builtInScenes();
  for (const Expected& expected : kScenes) EXPECT_TRUE(std::ranges::count(names, expected.name)) << expected.name;
  for (const std::string& name : names) {
    const std::filesystem::path path = app::findScene(name, {}, std::nullopt);
    EXPECT_EQ(path.filename(), name + ".glb");
    EXPECT_LT(std::filesystem::file_size(path), 1'000'000u) << path;
  }
}

TEST(BuiltIn, ScriptsMakeTheFiles) {
  if (runProgram("/usr/bin/env", {"python3", "--version"}).status != 0) GTEST_SKIP() << "python3 is not installed";
  for (const char* script : {"make_box.py", "make_park.py", "make_arena.py"}) {
    const RunResult run = runProgram("/usr/bin/env", {"python3", "-B", (assets() / script).string(), "--check"});
    EXPECT_EQ(run.status, 0) << script << ": " << run.err;
    std::printf("%s", run.out.c_str());
  }
}

}  // namespace
}  // namespace irad::test::built_in_suite
