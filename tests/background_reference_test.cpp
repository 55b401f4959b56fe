// The reference that is traced beside the window: the same picture as in one go, cancelled, held, failed, saved; and
// what it takes of the window's thread.
#include "tests/gi_fixture.h"

#if IRAD_UI

#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <memory>

#include "gi/check/check.h"
#include "gi/lighting.h"
#include "gi/picture.h"
#include "renderer/base/error.h"
#include "renderer/scene/camera_json.h"
#include "ui/background_reference.h"
#include "ui/session.h"
#ifdef IRAD_OIIO
#include "tests/exr.h"
#endif

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

TEST_F(TracedBeside, IsSavedAsReferencesAre) {
  BackgroundReference reference;
  reference.start(task(4));
  ASSERT_TRUE(until([&] { return reference.state().what == What::Done; }));
  const auto picture = reference.take();
  ASSERT_TRUE(picture);
  const TemporaryFolder folder;
  const std::filesystem::path to = folder.path / "new folder" / (std::string("a.b") + linearExtension());
  const PictureSubject subject{cameraToJson(task(4).camera), "indirect"};
  EXPECT_EQ(saveReference(to, *picture, subject), to);
  const ReferencePicture read = readReference(to);
  ASSERT_EQ(read.picture.size, picture->size);
  for (size_t i = 0; i < picture->mean.size(); ++i)
    ASSERT_EQ(glm::vec3(read.picture.pixels[i]), glm::vec3(picture->mean[i]));
#ifdef IRAD_OIIO
  EXPECT_EQ(read.of, View{VIEW_INDIRECT});
  EXPECT_EQ(otherCamera(read.camera, task(4).camera), "");
  ASSERT_TRUE(read.camera);
  const ExrPicture error = readExr(to, "error");
  for (size_t i = 0; i < picture->error.size(); ++i) ASSERT_EQ(error.pixels[i], glm::vec3(picture->error[i]));
#endif
  EXPECT_THROW(saveReference(folder.path / "a.png", *picture, subject), InputError);
  EXPECT_THROW(saveReference(to / "a" / to.filename(), *picture, subject), WorkError) << "a file is no folder";
}

// ---- What it takes of the window's own thread ----

double threadSeconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

/// The window's own work for the panel Accuracy, frame after frame, on this thread.
class BesideTheWindow : public GiTest {
 protected:
  void SetUp() override {
    if (!hasPathTracer()) GTEST_SKIP() << "built without IRAD_EMBREE";
    GiTest::SetUp();
    session_ = std::make_unique<Session>(context());
    session_->edited = at(12, 16);
    Scene scene = openScene(assets() / "box.glb");
    const Camera camera = scene.cameras.at(0);
    session_->pipeline = std::make_unique<Pipeline>(context(), std::move(scene), session_->edited);
    session_->pipeline->prepare();
    session_->built = Built{.solve = session_->pipeline->lighting().report};
    session_->startAt(camera);
    session_->shown = camera;
    session_->view = VIEW_INDIRECT;
    session_->targets = Targets(context(), {192, 144});
    Frame frame = context().begin();
    session_->pipeline->render(frame, session_->shown, session_->view, session_->targets);
    frame.submitAndWait();
    session_->viewDirty = false;
    session_->accuracy.open = true;
  }
  /// One frame's; its seconds of this thread's own processor time, whatever else runs on the machine.
  double serve() {
    const double began = threadSeconds();
    session_->accuracy.serve(*session_);
    const double spent = threadSeconds() - began;
    context().begin().submitAndWait();  // readbacks come with frames
    usleep(500);
    return spent;
  }
  std::unique_ptr<Session> session_;
};

TEST_F(BesideTheWindow, TracingTakesNothingOfItsThread) {
  std::vector<double> without, with;
  for (int i = 0; i < 100; ++i) without.push_back(serve());
  session_->accuracy.samples = 1'000'000;
  session_->accuracy.wantReference = true;
  // How often the window got to do its work while a pass was in hand: not once, if a lock were held during passes, and
  // seldom if they ran on this thread.
  std::vector<double> calls;
  uint32_t samples = 0;
  double now = 0;
  for (int i = 0; i < 200'000 && calls.size() < 4; ++i) {
    with.push_back(serve());
    const BackgroundReference::State state = session_->accuracy.tracing();
    ASSERT_NE(state.what, What::Failed) << state.error;
    if (state.what != What::Tracing) continue;
    ++now;
    if (state.samples == samples) continue;
    if (samples > 0) calls.push_back(now);
    samples = state.samples, now = 0;
  }
  ASSERT_EQ(calls.size(), 4u) << "no samples";
  EXPECT_GE(median(calls), 4) << "frames in a pass";
  ASSERT_TRUE(session_->accuracy.traced()) << "nothing was taken";
  EXPECT_LT(median(with), median(without) + 2e-4);
  // Taking a picture is a copy of it and of its place on the device.
  EXPECT_LT(*std::ranges::max_element(with), .05);
  session_->accuracy.cancelReference = true;
  serve();
  EXPECT_FALSE(session_->accuracy.tracingNow());
}

}  // namespace
}  // namespace irad::test::background_reference_suite

#else

TEST(BackgroundReference, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_UI";
}

#endif
