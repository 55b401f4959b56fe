// The Vulkan core on the device at hand: transfers, passes with hazards, folding, raster, timers, memory, reload.
#include <numeric>

#include "renderer/error.h"
#include "renderer/frame.h"
#include "tests/support.h"

namespace irad::test {
namespace {

/// A shader of tests/shaders, compiled at run time and added to the shared library once.
const char* shader(const char* name) {
  for (const std::string& known : gpu().shaders->names())
    if (known == name) return name;
  const std::filesystem::path root = std::filesystem::path(IRAD_SOURCE_DIR);
  gpu().shaders->add(name, compileGlsl(root / "shaders", (root / "tests/shaders" / name).string()));
  return name;
}

struct SquarePush {
  uint64_t from, to;
  uint32_t count, add;
};

class Core : public GpuTest {
 protected:
  const Device& device() { return context().device; }
  Buffer values(const char* name, const std::vector<uint32_t>& v) {
    return makeBuffer<uint32_t>(context(), name, Subsystem::Staging, v);
  }
};

TEST_F(Core, UploadAndDownloadAreInverse) {
  std::vector<uint32_t> in(100003);
  for (uint32_t i = 0; i < in.size(); ++i) in[i] = i * 2654435761u;
  const Buffer buffer = values("round trip", in);
  EXPECT_EQ(downloadAs<uint32_t>(context(), buffer), in);
  // Part of it.
  const uint32_t patch[] = {1, 2, 3};
  upload(context(), buffer, std::as_bytes(std::span(patch)), 400);
  std::copy(std::begin(patch), std::end(patch), in.begin() + 100);
  EXPECT_EQ(downloadAs<uint32_t>(context(), buffer), in);
}

TEST_F(Core, UploadLargerThanAChunk) {
  std::vector<uint32_t> in(17 * 1024 * 1024 + 5);  // 68 MiB + 20 bytes: two pieces
  for (uint32_t i = 0; i < in.size(); ++i) in[i] = i ^ 0x5bd1e995u;
  const Buffer buffer = values("two pieces", in);
  EXPECT_TRUE(downloadAs<uint32_t>(context(), buffer) == in);
}

TEST_F(Core, EmptyBufferHasAnAddress) {
  const Buffer buffer(device(), "empty", Subsystem::Staging, 0);
  EXPECT_EQ(buffer.bytes, 16u);
  EXPECT_NE(buffer.address, 0u);
}

TEST_F(Core, DispatchChainWithHazards) {
  // x -> x*x+1 four times between two buffers: 1, 2, 5, 26, 677; every pass reads what the one before wrote.
  const uint32_t n = 5000;
  const Buffer a = values("a", std::vector<uint32_t>(n, 1));
  const Buffer b = values("b", std::vector<uint32_t>(n, 0));
  const auto before = device().counters.dispatches.load();
  Frame frame = context().begin();
  for (int i = 0; i < 4; ++i) {
    const Buffer &from = i % 2 ? b : a, &to = i % 2 ? a : b;
    frame.pass("Square").shader(shader("square.comp")).read(from).write(to).push(
        SquarePush{from.address, to.address, n, 1}).dispatch(n);
  }
  frame.submitAndWait();
  EXPECT_EQ(downloadAs<uint32_t>(context(), a), std::vector<uint32_t>(n, 677));
  EXPECT_EQ(downloadAs<uint32_t>(context(), b), std::vector<uint32_t>(n, 26));
  EXPECT_EQ(device().counters.dispatches - before, 4u);
}

TEST_F(Core, TimersAreSane) {
  const uint32_t n = 4 << 20;
  const Buffer a = values("a", std::vector<uint32_t>(n, 3)), b = values("b", std::vector<uint32_t>(n, 0));
  gpu().timings.reset();
  const auto start = std::chrono::steady_clock::now();
  Frame frame = context().begin();
  for (const char* stage : {"One", "Two", "Two"})
    frame.pass(stage).shader(shader("square.comp")).read(a).write(b).push(SquarePush{a.address, b.address, n, 0}).dispatch(n);
  frame.submitAndWait();
  const double wall = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  gpu().timings.endFrame(0, false, wall);
  const auto& stages = gpu().timings.frames().at(0).stages;
  ASSERT_EQ(stages.size(), 2u);
  EXPECT_EQ(stages[0].first, "One");
  EXPECT_EQ(stages[1].first, "Two");
  EXPECT_GT(stages[0].second, 0.0);
  EXPECT_GT(stages[1].second, 0.0);
  EXPECT_LE(stages[0].second + stages[1].second, wall);
  // The device did little else: at least half of the wall clock is accounted for (pipelines exist, n is large).
  RecordProperty("gpu_ms", std::to_string(stages[0].second + stages[1].second));
  RecordProperty("wall_ms", std::to_string(wall));
}

}  // namespace
}  // namespace irad::test
