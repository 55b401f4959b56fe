// Families of hard scenes (gi/check/families.h): sound, of the size that they were asked for, closed where they are
// meant to be, lit where they are meant to be.
#include "gi/check/families.h"

#include <algorithm>
#include <set>

#include "gi/check/check.h"
#include "gi/check/path_tracer.h"
#include "renderer/base/error.h"
#include "tests/support.h"

namespace irad::test::families_suite {
namespace {

class FamilyOf : public ::testing::TestWithParam<Family> {};

TEST_P(FamilyOf, IsSoundAndOfItsSize) {
  for (uint64_t seed = 1; seed <= 8; ++seed)
    for (const uint32_t resolution : {32u, 128u}) {
      const FamilyMember member = familyMember(GetParam(), seed, resolution);
      EXPECT_EQ(unsound(member.scene), "") << seed;
      EXPECT_GE(member.scene.cameras.size(), 2u);
      EXPECT_EQ(member.sealed.empty(), !GetParam().dark);
      const FamilyMember again = familyMember(GetParam(), seed, resolution);
      EXPECT_EQ(again.scene.positions, member.scene.positions);
      EXPECT_NE(familyMember(GetParam(), seed + 1, resolution).scene.positions, member.scene.positions);
    }
}

TEST_P(FamilyOf, IsLitOrDarkAsMeant) {
  if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  for (uint64_t seed = 1; seed <= 12; ++seed)
    for (const uint32_t resolution : {32u, 128u}) {
      FamilyMember member = familyMember(GetParam(), seed, resolution);
      const std::vector<Camera> cameras = member.scene.cameras;
      // From where the sun shines everything is bright.
      Camera outside = cameras[0];
      if (GetParam().dark) {
        const Light& sun = member.scene.lights.at(0);
        const glm::dvec3 low(member.scene.boundsMin), high(member.scene.boundsMax);
        outside.position = 0.5 * (low + high) - glm::length(high - low) * glm::dvec3(sun.direction);
        outside.orientation = glm::quatLookAt(sun.direction, glm::vec3(0.6f, 0.64f, 0.48f));
      }
      const auto tracer = makePathTracer(std::move(member.scene));
      if (GetParam().dark) {
        EXPECT_GT(tracer->render(outside, {32, 32}, {.samples = 2}).lit.pictureMean.y, 0.1) << "seed " << seed;
      }
      for (size_t c = 0; c < cameras.size(); ++c) {
        const TracedPicture p = tracer->render(cameras[c], {32, 32}, {.samples = 16});
        const double mean = p.lit.pictureMean.y;
        if (GetParam().dark)
          EXPECT_EQ(p.lit.pictureMean, glm::dvec3(0)) << "seed " << seed << ", N " << resolution << ", camera " << c;
        else
          EXPECT_GT(mean, 0) << "seed " << seed << ", N " << resolution << ", camera " << c;
      }
    }
}

TEST_P(FamilyOf, IsOpenedByItsSeedAndVoxels) {
  const std::string name = std::string("check:") + GetParam().name;
  const auto positions = [&](const std::string& more) { return openScene(name + more).positions; };
  EXPECT_EQ(positions(""), familyMember(GetParam(), 1, 64).scene.positions);
  EXPECT_EQ(positions(":3"), familyMember(GetParam(), 3, 64).scene.positions);
  EXPECT_EQ(positions(":3:32"), familyMember(GetParam(), 3, 32).scene.positions);
  const Scene scene = openScene(name + ":3:32");
  std::set<std::string> cameras;
  for (const Camera& camera : scene.cameras) EXPECT_TRUE(cameras.insert(camera.name).second) << camera.name;
  for (const char* wrong : {":", ":x", ":1:", ":1:7", ":1:1023", ":1:32:4", ":-1"})
    EXPECT_THROW((void)openScene(name + wrong), UsageError) << wrong;
}

TEST(CheckScenes, OfOneSceneHaveNoSeeds) {
  try {
    (void)openScene("check:furnace-box:2");
    FAIL() << "opened";
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "check:furnace-box:2: the case 'furnace-box' is one scene, not a family with seeds");
  }
}

INSTANTIATE_TEST_SUITE_P(Each, FamilyOf, ::testing::ValuesIn(families().begin(), families().end()),
                         [](const auto& info) {
                           std::string name = info.param.name;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace irad::test::families_suite
