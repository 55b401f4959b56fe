// What follows failures on the device: no memory at any one resource, a budget that does not suffice, a lost device.
#include <fmt/format.h>

#include <set>

#include "gi/check/scenes.h"
#include "gi/pipeline.h"
#include "renderer/base/error.h"
#include "renderer/targets.h"
#include "tests/support.h"

namespace irad::test::faults_suite {
namespace {

Settings small(uint32_t resolution, const char* preset = "balanced") {
  Settings s = defaultSettings(/*cpuDevice=*/true);
  applyPreset(s, preset, /*cpuDevice=*/true);
  s.voxel.resolution = resolution;
  s.matrix.gpu.rays = 16;
  s.light.shadowResolution = 64;
  return s;
}

Settings framewise(uint32_t resolution) {
  Settings s = small(resolution);
  s.solver.method = SolverMethod::bruteForce;
  s.solver.frames = 2;
  return s;
}

/// Of few triangles: it is built hundreds of times.
const Scene& room() {
  static const Scene scene = mixedRoom();
  return scene;
}

using Pixels = std::vector<std::byte>;

Pixels draw(Context& context, Pipeline& pipeline, View view = VIEW_LIT) {
  Targets targets(context, {24, 24});
  Frame frame = context.begin();
  pipeline.render(frame, pipeline.scene().cameras.at(0), view, targets);
  frame.submitAndWait();
  return download(context, targets.linear);
}

/// A picture from nothing: every allocation that a run makes.
Pixels fresh(Context& context, const Settings& settings) {
  Pipeline pipeline(context, room(), settings);
  pipeline.prepare();
  return draw(context, pipeline);
}

/// Ends what a test has armed, whatever becomes of it.
struct Disarm {
  ~Disarm() { gpu().device->options.failResource = 0; }
};

/// The message of the DeviceError that `act` ends in where the n-th resource from here finds no memory; empty: it never
/// came to that resource.
template <class Act>
std::string withoutMemoryAt(uint64_t n, Act&& act) {
  const Device& device = *gpu().device;
  gpu().device->options.failResource = device.counters.resources() + n;
  const Disarm disarm;
  std::string message;
  try {
    act();
  } catch (const DeviceError& error) {
    EXPECT_EQ(error.exitStatus, 4);
    message = error.what();
  }
  const bool reached = device.counters.resources() >= device.options.failResource;
  EXPECT_EQ(reached, !message.empty()) << "resource " << n << ": the failure was swallowed";
  return message;
}

void expectNamed(const std::string& message) {
  // "NAME (SUBSYSTEM) needs SIZE: the device is out of memory (...)"
  const size_t needs = message.find(") needs ");
  EXPECT_NE(needs, std::string::npos) << message;
  EXPECT_NE(message.find("B: the device is out of memory", needs), std::string::npos) << message;
}

/// Bytes of everything but what a context keeps for its next frames.
uint64_t held() {
  gpu().device->waitIdle();
  { gpu().context->begin().submitAndWait(); }  // collects what finished frames have retired
  uint64_t bytes = 0;
  for (const MemoryRow& row : gpu().device->memory().rows())
    if (row.subsystem != Subsystem::Staging) bytes += row.bytes;
  return bytes;
}

class NoMemory : public GpuTest {
 protected:
  /// Runs without memory at each resource in turn; the subsystems that they belong to.
  std::set<std::string> everyResource(const Settings& settings) {
    const Pixels expected = fresh(context(), settings);
    const uint64_t before = held();
    std::set<std::string> subsystems;
    for (uint64_t n = 1;; ++n) {
      Pixels pixels;
      const std::string message = withoutMemoryAt(n, [&] { pixels = fresh(context(), settings); });
      EXPECT_EQ(held(), before) << "after resource " << n << ": " << message;
      if (message.empty()) {
        EXPECT_TRUE(pixels == expected);
        std::printf("%u resources\n", static_cast<uint32_t>(n - 1));
        return subsystems;
      }
      expectNamed(message);
      const size_t end = message.find(") needs"), begin = message.rfind('(', end) + 1;
      subsystems.insert(message.substr(begin, end - begin));
    }
  }
};

TEST_F(NoMemory, AtAnyResourceOfARunIsAnErrorThatLeavesNothing) {
  Settings ours = small(8), thesis = small(8, "thesis");
  ours.writeback.mode = WritebackMode::compute;
  ours.sky.source = SkySource::preetham;
  thesis.writeback.mode = WritebackMode::mask;
  std::set<std::string> subsystems = everyResource(ours);
  subsystems.merge(everyResource(thesis));
  subsystems.merge(everyResource(framewise(8)));
  EXPECT_EQ(subsystems, (std::set<std::string>{"facets", "field", "matrix", "scene", "shadow", "solver", "specular",
                                               "staging", "targets", "volumes", "voxels", "writeback"}));
  // With the context goes what it kept.
  gpu().context.reset();
  gpu().device->waitIdle();
  EXPECT_EQ(gpu().device->memory().used(), 0u);
}

TEST_F(NoMemory, InARebuildKeepsThePictureAndTheNextRebuildSucceeds) {
  const Pixels pictures[] = {fresh(context(), small(8)), fresh(context(), small(10))};
  ASSERT_FALSE(pictures[0] == pictures[1]);
  Pipeline pipeline(context(), room(), small(8));
  pipeline.prepare();
  int shown = 0;
  uint64_t n = 1;
  for (;; ++n) {
    pipeline.set(small(shown == 0 ? 10 : 8));
    const std::string message = withoutMemoryAt(n, [&] { pipeline.prepare(); });
    if (message.empty()) break;
    expectNamed(message);
    ASSERT_FALSE(pipeline.asleep()) << "resource " << n;
    draw(context(), pipeline, VIEW_ROW_OCCUPANCY);  // of a matrix that may be gone: an empty picture
    ASSERT_TRUE(draw(context(), pipeline) == pictures[shown]) << "after resource " << n << ": " << message;
    pipeline.prepare();
    shown = 1 - shown;
    ASSERT_TRUE(draw(context(), pipeline) == pictures[shown]) << "after resource " << n << ": " << message;
  }
  EXPECT_GT(n, 30u);
  EXPECT_TRUE(draw(context(), pipeline) == pictures[1 - shown]);
}

TEST_F(NoMemory, InAnotherMethodCanBeTakenBack) {
  Pipeline pipeline(context(), room(), small(12));
  pipeline.prepare();
  const Pixels before = draw(context(), pipeline);
  uint64_t n = 1;
  for (;; ++n) {
    pipeline.set(framewise(12));
    const std::string message = withoutMemoryAt(n, [&] { pipeline.prepare(); });
    if (message.empty()) break;
    expectNamed(message);
    draw(context(), pipeline);
    pipeline.set(small(12));
    pipeline.darken();
    pipeline.prepare();
    ASSERT_TRUE(draw(context(), pipeline) == before) << "after resource " << n << ": " << message;
  }
  EXPECT_GT(n, 4u);
  EXPECT_TRUE(draw(context(), pipeline) == fresh(context(), framewise(12)));
}

/// Under a list that stays: what shadow maps, a new matrix and a relight allocate.
TEST_F(NoMemory, InNewShadowsAndNewRaysCanBeTakenBack) {
  Settings settings[] = {small(12), small(12)};
  settings[1].light.shadowResolution = 128;
  settings[1].light.shadowFilter = ShadowFilter::vsm;
  settings[1].matrix.gpu.rays = 24;
  Pipeline pipeline(context(), room(), settings[0]);
  pipeline.prepare();
  const Pixels before = draw(context(), pipeline);
  uint64_t n = 1;
  for (;; ++n) {
    pipeline.set(settings[1]);
    const std::string message = withoutMemoryAt(n, [&] { pipeline.prepare(); });
    if (message.empty()) break;
    expectNamed(message);
    pipeline.set(settings[0]);
    pipeline.invalidate(Redo::Voxels);
    pipeline.prepare();
    ASSERT_TRUE(draw(context(), pipeline) == before) << "after resource " << n << ": " << message;
  }
  EXPECT_GT(n, 10u);
}

/// Budgets from too small for anything to large enough: an error that says what is left, or the right picture.
TEST_F(NoMemory, ABudgetIsKeptOrRefused) {
  const Pixels expected = fresh(context(), small(12));
  uint64_t taken = 0;
  int refusals = 0;
  for (uint64_t mib = 1; taken == 0; ++mib) {
    ASSERT_LE(mib, 256u);
    const auto device = Device::create({.validate = true, .memoryBudget = mib << 20});
    {
      ShaderLibrary shaders;
      Timings timings;
      Context own(*device, shaders, timings);
      try {
        EXPECT_TRUE(fresh(own, small(12)) == expected) << mib << " MiB";
        taken = device->memory().peak();
        EXPECT_LE(taken, mib << 20);
      } catch (const DeviceError& error) {
        ++refusals;
        const std::string free = fmt::format(" of {}.0 MiB are free", mib);
        EXPECT_NE(std::string(error.what()).find(free), std::string::npos) << error.what();
      }
    }
    device->waitIdle();
    EXPECT_EQ(device->memory().used(), 0u);
    for (const std::string& text : device->validationMessages()) ADD_FAILURE() << mib << " MiB: " << text;
  }
  EXPECT_GE(refusals, 1);
}

// A device stays lost, so each loss takes one of its own.
TEST(LostDevice, IsAnErrorInWordsWhereverItHappens) {
  uint32_t losses = 0;
  for (uint64_t n = 1; n < 1000; n = n * 2 + 1) {
    const auto device = Device::create({.validate = true, .loseDevice = n});
    std::string message;
    {
      ShaderLibrary shaders;
      Timings timings;
      Context context(*device, shaders, timings);
      try {
        fresh(context, small(12));
      } catch (const WorkError& error) {
        EXPECT_EQ(error.exitStatus, 1);
        message = error.what();
      }
      if (device->counters.exchanges < n) {
        EXPECT_EQ(message, "");
        break;
      }
      ++losses;
      EXPECT_NE(message.find("the device was lost"), std::string::npos) << "at exchange " << n << ": " << message;
      EXPECT_THROW(context.begin().submitAndWait(), WorkError) << "it stays lost";
    }
    EXPECT_FALSE(device->settle());
    EXPECT_EQ(device->memory().used(), 0u) << "at exchange " << n;
    for (const std::string& text : device->validationMessages()) ADD_FAILURE() << "at exchange " << n << ": " << text;
  }
  EXPECT_GE(losses, 6u);
}

}  // namespace
}  // namespace irad::test::faults_suite
