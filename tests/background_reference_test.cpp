// The reference that is traced beside the window: the same picture as in one go, cancelled, held, failed.
#include <gtest/gtest.h>

#if IRAD_UI

#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <memory>

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

TEST_F(TracedBeside, GetsBetterAtTheLowestPriorityUntilItIsCancelled) {
  BackgroundReference reference;
  BackgroundReference::Task wanted = task(10'000'000);
  const auto priority = std::make_shared<std::atomic<int>>(0);  // the thread owns one of it with its task
  wanted.scene = [priority, scene = wanted.scene] {
    *priority = getpriority(PRIO_PROCESS, 0);
    return scene();
  };
  reference.start(std::move(wanted));
  uint32_t samples = 0;
  for (int pictures = 0; pictures < 3; ++pictures) {
    std::shared_ptr<const TracedReference> better;
    ASSERT_TRUE(until([&] { return (better = reference.take()) != nullptr; }));
    EXPECT_GT(better->samples, samples);
    samples = better->samples;
  }
  EXPECT_TRUE(reference.atWork());
  EXPECT_GT(reference.state().secondsLeft, 0);
  EXPECT_EQ(*priority, 19);
  EXPECT_GT(priority.use_count(), 1);
  reference.cancel();
  EXPECT_EQ(reference.state().what, What::Idle);
  EXPECT_FALSE(reference.take());
  EXPECT_TRUE(until([&] { return priority.use_count() == 1; })) << "the thread does not end";
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
