// The reference that is traced beside the window: the same picture as in one go, cancelled, held, failed.
#include <gtest/gtest.h>

#if IRAD_UI

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "gi/check/check.h"
#include "renderer/base/error.h"
#include "tests/support.h"
#include "ui/background_reference.h"

namespace irad::test::background_reference_suite {
namespace {

using What = BackgroundReference::State::What;

class TracedBeside : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!hasPathTracer()) GTEST_SKIP() << "built without IRAD_EMBREE";
  }
  static BackgroundReference::Task task(uint32_t samples, bool indirect = true) {
    const auto scene = [] { return openScene(assets() / "box.glb"); };
    return {
        .scene = scene, .camera = scene().cameras.at(0), .size = {24, 16}, .indirect = indirect, .samples = samples};
  }
  static bool until(const std::function<bool()>& holds) {
    for (int i = 0; i < 3000; ++i, usleep(10'000))
      if (holds()) return true;
    return false;
  }
};

TEST_F(TracedBeside, IsThePictureOfOneGoToTheBit) {
  for (const bool indirect : {true, false}) {
    const BackgroundReference::Task wanted = task(12, indirect);
    BackgroundReference reference;
    reference.start(wanted);
    ASSERT_TRUE(until([&] { return reference.state().what == What::Done; })) << reference.state().error;
    EXPECT_EQ(reference.state().samples, 12u);
    const auto picture = reference.take();
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->samples, 12u);
    EXPECT_FALSE(reference.take()) << "there is no better one";
    const TracedPicture whole =
        makePathTracer(wanted.scene())->render(wanted.camera, wanted.size, {.samples = 12, .centred = true});
    const TracedLight& light = indirect ? whole.indirect : whole.lit;
    for (size_t i = 0; i < light.mean.size(); ++i) {
      ASSERT_EQ(glm::vec3(picture->mean[i]), glm::vec3(light.mean[i]));
      ASSERT_EQ(glm::vec3(picture->halves[1][i]), glm::vec3(light.half[1][i]));
      ASSERT_EQ(glm::vec3(picture->error[i]), glm::vec3(light.error[i]));
    }
    EXPECT_GT(picture->noise, 0);
  }
}

/// The lowest priority of any thread of this process: their field `nice`.
int nicest() {
  int most = -20;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task")) {
    const std::string stat = slurp(entry.path() / "stat");
    std::istringstream fields(stat.substr(stat.rfind(')') + 2));
    std::string field;
    for (int i = 3; i <= 19; ++i) fields >> field;
    if (!field.empty()) most = std::max(most, std::stoi(field));
  }
  return most;
}

TEST_F(TracedBeside, GetsBetterAtTheLowestPriorityUntilItIsCancelled) {
  BackgroundReference reference;
  reference.start(task(10'000'000));
  uint32_t samples = 0;
  for (int pictures = 0; pictures < 3; ++pictures) {
    std::shared_ptr<const TracedReference> better;
    ASSERT_TRUE(until([&] { return (better = reference.take()) != nullptr; }));
    EXPECT_GT(better->samples, samples);
    samples = better->samples;
  }
  EXPECT_TRUE(reference.atWork());
  EXPECT_GT(reference.state().secondsLeft, 0);
  EXPECT_EQ(nicest(), 19);
  reference.cancel();
  EXPECT_EQ(reference.state().what, What::Idle);
  EXPECT_FALSE(reference.take());
  EXPECT_TRUE(until([&] { return nicest() < 19; })) << "the thread does not end";
}

TEST_F(TracedBeside, IsHeldAndGoesOn) {
  BackgroundReference reference;
  reference.start(task(10'000'000));
  ASSERT_TRUE(until([&] { return reference.state().samples > 2; }));
  reference.hold(true);
  ASSERT_TRUE(until([&] { return reference.state().what == What::Waiting; }));
  EXPECT_FALSE(reference.atWork());
  const uint32_t samples = reference.state().samples;
  usleep(200'000);
  EXPECT_EQ(reference.state().samples, samples);
  reference.hold(false);
  EXPECT_TRUE(until([&] { return reference.state().samples > samples; }));
  reference.hold(true);  // and it ends all the same
}

TEST_F(TracedBeside, SaysWhyItFailed) {
  BackgroundReference reference;
  BackgroundReference::Task wanted = task(4);
  wanted.scene = []() -> Scene { throw InputError("a.glb: has changed"); };
  reference.start(wanted);
  ASSERT_TRUE(until([&] { return reference.state().what == What::Failed; }));
  EXPECT_EQ(reference.state().error, "a.glb: has changed");
  EXPECT_FALSE(reference.atWork());
}

}  // namespace
}  // namespace irad::test::background_reference_suite

#else

TEST(BackgroundReference, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_UI";
}

#endif
