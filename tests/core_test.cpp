// The Vulkan core on the device at hand: transfers, passes with hazards, folding, raster, timers, memory, reload.
#include <chrono>

#include "renderer/base/error.h"
#include "renderer/frame/frame.h"
#include "renderer/frame/record.h"
#include "tests/test_shaders.h"

namespace irad::test::core_suite {
namespace {

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
  /// to[i] = from[i]^2 + add.
  static Pass square(Pass pass, const Buffer& from, const Buffer& to, uint32_t n, uint32_t add) {
    pass.shader(shader("square.comp")).push(SquarePush{pass.in(from), pass.out(to), n, add});
    return pass;
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
  Frame frame = context().begin();
  EXPECT_NE(frame.pass("Look").in(buffer), 0u);
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
    square(frame.pass("Square"), from, to, n, 1).dispatch(n);
  }
  frame.submitAndWait();
  EXPECT_EQ(downloadAs<uint32_t>(context(), a), std::vector<uint32_t>(n, 677));
  EXPECT_EQ(downloadAs<uint32_t>(context(), b), std::vector<uint32_t>(n, 26));
  EXPECT_EQ(device().counters.dispatches - before, 4u);
}

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
bool written(const Buffer& buffer) {
  return buffer.state().lastWrite.stages != 0 && buffer.state().readsSince.stages == 0;
}
bool read(const Buffer& buffer) {
  return (buffer.state().readsSince.stages & kCompute) != 0;
}

TEST_F(Core, PassesKeepTheHazardsOfTheAddressesThatTheyGive) {
  const uint32_t n = 64;
  const Buffer a = values("a", std::vector<uint32_t>(n, 3)), b = values("b", std::vector<uint32_t>(n, 0));
  Frame frame = context().begin();
  frame.pass("Fill").fill(a, 3);
  EXPECT_TRUE(written(a));
  square(frame.pass("Square"), a, b, n, 0).dispatch(n);
  EXPECT_TRUE(read(a));
  EXPECT_TRUE(written(b));
  EXPECT_EQ(b.state().lastWrite.stages, kCompute);
  EXPECT_FALSE(b.state().lastWrite.commutes);
  // Atomics in any order; an offset moves the address, not the buffer.
  Pass pass = frame.pass("Accumulate");
  const uint64_t to = pass.accumulate(b), behind = pass.accumulate(b, 64);
  EXPECT_EQ(behind, to + 64);
  pass.shader(shader("square.comp")).push(SquarePush{pass.in(a), to, n, 0}).dispatch(n);
  EXPECT_TRUE(b.state().lastWrite.commutes);
  // What is read and written is written.
  square(frame.pass("Square"), a, a, n, 0).dispatch(n);
  EXPECT_TRUE(written(a));
  EXPECT_EQ(frame.pass("None").inIfAny(Buffer()), 0u);
  frame.submitAndWait();
}

TEST_F(Core, RecordsBringTheBuffersThatTheyHoldTheAddressesOf) {
  const Buffer a = values("a", {1, 2, 3, 4}), out = values("out", {0, 0, 0, 0});
  Buffer held = values("held", {5, 6, 7, 8});
  RecordMaker inner(context(), "inner", Subsystem::Staging, 8);
  const Buffer table = inner.make(inner.of(held));
  RecordMaker maker(context(), "record", Subsystem::Staging, 24);
  const std::array<uint64_t, 3> addresses{maker.of(a), maker.of(table), maker.own(8)};
  const Buffer record = maker.make(addresses);
  const Buffer moved = std::move(held);
  Frame frame = context().begin();
  frame.pass("Fill").fill(a, 1);
  frame.pass("Fill").fill(moved, 2);
  // Copying the record reads none of them.
  frame.pass("Copy").copy(record, out, 16);
  EXPECT_TRUE(written(a) && written(moved));
  square(frame.pass("Square"), record, out, 4, 0).dispatch(4);
  EXPECT_TRUE(read(record) && read(a) && read(table) && read(moved));
  // A buffer that the shader writes and finds through the record.
  Pass pass = frame.pass("Square");
  pass.out(moved);
  EXPECT_EQ(addresses[2], pass.in(record, 8));
  square(pass, record, out, 4, 0).dispatch(4);
  EXPECT_TRUE(written(moved));
  frame.submitAndWait();
}

TEST_F(Core, RecordsHoldWhatTheyWereMadeOf) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::vector<uint32_t> words{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  const auto bytes = std::as_bytes(std::span(words));
  EXPECT_EQ(downloadAs<uint32_t>(context(), RecordMaker(context(), "span", Subsystem::Staging, 40).make(bytes)), words);
  // A vector's elements, not the vector.
  const std::vector<std::byte> copy(bytes.begin(), bytes.end());
  EXPECT_EQ(downloadAs<uint32_t>(context(), RecordMaker(context(), "vector", Subsystem::Staging, 40).make(copy)),
            words);
  EXPECT_EQ(downloadAs<uint32_t>(context(), RecordMaker(context(), "value", Subsystem::Staging, 4).make(7u)),
            std::vector<uint32_t>{7});
  EXPECT_DEATH(RecordMaker(context(), "short", Subsystem::Staging, 48).make(copy),
               "short: 40 bytes for a record of 48");
}

TEST_F(Core, AddressesOfOtherPassesAreRefused) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const Buffer a = values("a", std::vector<uint32_t>(64, 3)), b = values("b", std::vector<uint32_t>(64, 0));
  const auto stale = [&] {
    Frame frame = context().begin();
    const uint64_t old = frame.pass("Before").in(a);
    Pass pass = frame.pass("Square");
    pass.shader(shader("square.comp")).push(SquarePush{old, pass.out(b), 64, 0}).dispatch(64);
  };
  EXPECT_DEATH(stale(), "the address at byte 0 of what is pushed is none that the pass Square gave");
  const auto late = [&] {
    Frame frame = context().begin();
    Pass pass = square(frame.pass("Square"), a, b, 64, 0);
    pass.run([&](Commands&) { pass.in(a); });
  };
  EXPECT_DEATH(late(), "a named after the pass was recorded");
}

TEST_F(Core, CountersCountWhatIsAskedFor) {
  const uint32_t n = 64;
  const Buffer a = values("a", std::vector<uint32_t>(n, 2)), b = values("b", std::vector<uint32_t>(n, 0));
  const Buffer groups = values("groups", {0, 1, 1});
  const auto asked = [&](const std::function<void(Frame&)>& record) {
    const Counters before = context().counters();
    Frame frame = context().begin();
    record(frame);
    frame.submitAndWait();
    return context().counters().since(before);
  };
  static uint32_t repetition = 0;  // each needs pipelines of its own: a context keeps earlier ones
  repetition += 2;
  const auto squares = [&](Frame& frame, uint32_t constant) {
    return square(frame.pass("Square"), a, b, n, 1).constant(77, repetition + constant);
  };
  // Transfers are work of another kind; an indirect dispatch counts though it finds no groups, no threads do not.
  const Counters work = asked([&](Frame& frame) {
    frame.pass("Fill").fill(b, 1);
    squares(frame, 0).dispatch(n);
    squares(frame, 0).dispatchIndirect(groups);
    squares(frame, 0).dispatch(0);
  });
  EXPECT_EQ(work.dispatches, 2u);
  EXPECT_EQ(work.draws, 0u);
  EXPECT_EQ(work.submissions, 1u);
  EXPECT_EQ(work.resources(), 0u);
  // A pipeline counts when it is compiled, once per set of constants.
  EXPECT_EQ(asked([&](Frame& frame) { squares(frame, 1).dispatch(n); }).pipelines, 1u);
  EXPECT_EQ(asked([&](Frame& frame) { squares(frame, 1).dispatch(n); }).pipelines, 0u);
  // Draws, and what is made.
  const Buffer vertices = makeBuffer<glm::vec4>(context(), "vertices", Subsystem::Staging,
                                                std::vector<glm::vec4>{{-1, -1, 0, 1}, {3, -1, 0, 1}, {-1, 3, 0, 1}});
  const Counters drawn = asked([&](Frame& frame) {
    const Image image(device(), {.name = "counted",
                                 .format = VK_FORMAT_R8G8B8A8_UNORM,
                                 .width = 4,
                                 .height = 4,
                                 .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT});
    Pass pass = frame.pass("Draw");
    pass.shaders({shader("triangle.vert"), shader("white.frag")})
        .color(image, ClearColor{})
        .push(pass.in(vertices))
        .draw(3);
  });
  EXPECT_EQ(drawn.draws, 1u);
  EXPECT_EQ(drawn.dispatches, 0u);
  EXPECT_EQ(drawn.images, 1u);
  EXPECT_EQ(drawn.buffers, 0u);
}

TEST_F(Core, TimersAreSane) {
  const uint32_t n = 4 << 20;
  const Buffer a = values("a", std::vector<uint32_t>(n, 3)), b = values("b", std::vector<uint32_t>(n, 0));
  gpu().timings.reset();
  const auto start = std::chrono::steady_clock::now();
  Frame frame = context().begin();
  for (const char* stage : {"One", "Two", "Two"}) square(frame.pass(stage), a, b, n, 0).dispatch(n);
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
  // The device did little else, so most of the wall clock time belongs to the passes (n is large).
  EXPECT_GT(stages[0].second + stages[1].second, 0.3 * wall);
}

TEST_F(Core, SampledFramesAreSamplesWhoeverCollectsThem) {
  const Buffer a(device(), "a", Subsystem::Staging, 64);
  context().finish();
  gpu().timings.reset();
  const auto began = std::chrono::steady_clock::now();
  const auto submit = [&](uint64_t index) {
    Frame frame = context().begin();
    frame.pass(fmt::format("Fill {}", index)).fill(a, 1);
    frame.sampled(index, began);
    frame.submit();
  };
  // Several in flight, a blocking transfer and a frame of somebody else's group in between.
  for (uint64_t i = 0; i < 4; ++i) submit(i);
  (void)download(context(), a);
  submit(4);
  Frame other = context().begin();
  other.pass("Other").fill(a, 2);
  other.submitAndWait();
  gpu().timings.endFrame(100, /*setup=*/true, 1.0);
  submit(5);
  context().finish();
  const auto& frames = gpu().timings.frames();
  ASSERT_EQ(frames.size(), 7u);
  const uint64_t expected[] = {0, 1, 2, 3, 4, 100, 5};
  for (size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].frame, expected[i]);
    ASSERT_EQ(frames[i].stages.size(), 1u);
    EXPECT_EQ(frames[i].stages[0].first, expected[i] == 100 ? "Other" : fmt::format("Fill {}", expected[i]));
    EXPECT_GT(frames[i].cpuMs, 0.0);
  }
}

TEST_F(Core, MoreTimersThanAPoolHolds) {
  const Buffer a(device(), "a", Subsystem::Staging, 64);
  gpu().timings.reset();
  Frame frame = context().begin();
  for (int i = 0; i < 300; ++i) frame.pass(fmt::format("Fill {}", i)).fill(a, i);
  frame.submitAndWait();
  gpu().timings.endFrame(0, true, 1.0);
  EXPECT_EQ(gpu().timings.frames().at(0).stages.size(), 300u);
  EXPECT_EQ(downloadAs<uint32_t>(context(), a)[15], 299u);
}

/// How often each of `count` indices is met by workgroups of `size`, which is a specialization constant.
std::vector<uint32_t> hits(Context& context, const std::string& shader, uint32_t size, uint32_t count) {
  struct Push {
    uint64_t hits;
    uint32_t count;
  };
  const Buffer hits(context.device, "hits", Subsystem::Staging, count * 4ull);
  Frame frame = context.begin();
  frame.pass("Fill").fill(hits, 0);
  Pass pass = frame.pass("Hit");
  pass.shader(shader).constant(0, size).push(Push{pass.out(hits), count}).dispatch(count);
  frame.submitAndWait();
  return downloadAs<uint32_t>(context, hits);
}

TEST_F(Core, FoldedDispatchHitsEveryIndexOnce) {
  // Workgroups of one: 70,001 of them exceed the 65,535 that every device has in x.
  for (const auto& [size, threads] : {std::pair{1u, 70001u}, {8u, 70001u}, {64u, 4194303u + 64u}})
    EXPECT_TRUE(hits(context(), shader("hit.comp"), size, threads) == std::vector<uint32_t>(threads, 1))
        << size << " " << threads;
}

TEST_F(Core, ConstantsAreTheSameSetBeforehandAndByTheDriver) {
  for (const bool beforehand : {true, false}) {
    const auto device = Device::create({.validate = true});
    device->isCpu = beforehand;
    Timings timings;
    Context own(*device, *gpu().shaders, timings);
    // Were it another size, indices would be hit more or less than once.
    for (const uint32_t size : {1u, 16u, 64u})
      EXPECT_TRUE(hits(own, shader("hit.comp"), size, 1000) == std::vector<uint32_t>(1000, 1))
          << size << " " << beforehand;
    EXPECT_TRUE(device->validationMessages().empty());
  }
}

TEST_F(Core, IndirectDispatchReadsItsArguments) {
  const uint32_t n = 1000;
  const Buffer a = values("a", std::vector<uint32_t>(n, 5)), b = values("b", std::vector<uint32_t>(n, 0));
  const Buffer arguments = values("arguments", {9, 9, 9, 2, 1, 1});
  Frame frame = context().begin();
  square(frame.pass("Square"), a, b, n, 0).dispatchIndirect(arguments, 12);
  frame.submitAndWait();
  std::vector<uint32_t> expected(n, 0);
  std::fill_n(expected.begin(), 128, 25);  // two workgroups of 64
  EXPECT_EQ(downloadAs<uint32_t>(context(), b), expected);
}

TEST_F(Core, FillCopyAndReadback) {
  const Buffer a(device(), "a", Subsystem::Staging, 400), b = values("b", std::vector<uint32_t>(100, 7));
  std::vector<uint32_t> seen;
  {
    Frame frame = context().begin();
    frame.pass("Fill").fill(a, 0xabcdef01u);
    frame.pass("Copy").copy(a, b, 40, 0, 80);
    frame.readback(b, 72, 16, [&](std::span<const uint8_t> bytes) {
      seen.resize(bytes.size() / 4);
      std::memcpy(seen.data(), bytes.data(), bytes.size());
    });
    frame.pass("Fill").fill(b, 0);  // after the readback: not seen by it
    frame.submit();
  }
  EXPECT_TRUE(seen.empty());  // deferred
  device().waitIdle();
  context().begin().submitAndWait();  // delivers what has finished
  EXPECT_EQ(seen, (std::vector<uint32_t>{7, 7, 0xabcdef01u, 0xabcdef01u}));
  EXPECT_EQ(downloadAs<uint32_t>(context(), b), std::vector<uint32_t>(100, 0));
}

TEST_F(Core, ResourcesLiveUntilTheDeviceIsDone) {
  const uint64_t before = device().memory().used();
  {
    Frame frame = context().begin();
    Buffer a(device(), "short-lived", Subsystem::Staging, 1 << 20);
    frame.pass("Fill").fill(a, 1);
    a = Buffer(device(), "second", Subsystem::Staging, 1 << 20);  // the first is retired, not freed
    frame.pass("Fill").fill(a, 2);
    EXPECT_GE(device().memory().used(), before + (2u << 20));
    Buffer moved = std::move(a);
    EXPECT_FALSE(a);
    EXPECT_TRUE(moved);
    EXPECT_EQ(moved.name, "second");
    frame.submitAndWait();
  }
  device().waitIdle();
  EXPECT_EQ(device().memory().used(), before);
}

TEST_F(Core, NoGrowthOverManyFrames) {
  const auto frame = [&] {
    Buffer a(device(), "scratch", Subsystem::Staging, 3 << 20);
    const Image image(device(), {.name = "scratch image", .format = VK_FORMAT_R32_SFLOAT, .width = 64, .height = 64});
    Frame f = context().begin();
    f.pass("Fill").fill(a, 1);
    f.pass("Clear").clear(image, ClearColor{1, 2, 3, 4});
    f.readback(a, 0, 64, [](auto) {});
    f.submit();
  };
  // At most four in flight, as here at first: on a busy machine they would otherwise pile up.
  const auto fourFrames = [&] {
    for (int i = 0; i < 4; ++i) frame();
    context().finish();
  };
  fourFrames();
  const uint64_t used = device().memory().used(), allocations = device().counters.allocations;
  for (int i = 0; i < 13; ++i) fourFrames();
  EXPECT_EQ(device().memory().used(), used);
  EXPECT_EQ(device().counters.allocations, allocations);
}

TEST_F(Core, DroppedFrameLeavesStatesTrue) {
  const Image image(device(), {.name = "dropped", .format = VK_FORMAT_R32_UINT, .width = 4, .height = 4});
  {
    Frame frame = context().begin();
    frame.pass("Clear").clear(image, glm::uvec4(11));
    bool called = false;
    Buffer b(device(), "b", Subsystem::Staging, 16);
    frame.readback(b, 0, 16, [&](auto) { called = true; });
    EXPECT_FALSE(called);
  }
  // Had the transition not run, the layer would complain about the layout here.
  const std::vector<std::byte> bytes = download(context(), image);
  EXPECT_EQ(bytes.size(), 64u);
  EXPECT_EQ(static_cast<int>(bytes[60]), 11);
}

TEST_F(Core, MemoryRowsAndBudget) {
  constexpr SubsystemName kMatrix{"matrix"};  // as a layer above declares it
  Allocator& memory = device().memory();
  const Buffer a(device(), "row of this test", kMatrix, 5000);
  const Image b(device(), {.name = "volume of this test",
                           .subsystem = Subsystem::Targets,
                           .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                           .width = 32,
                           .height = 32,
                           .depth = 32});
  bool buffer = false, image = false;
  uint64_t sum = 0, last = ~0ull;
  for (const MemoryRow& row : memory.rows()) {
    EXPECT_LE(row.bytes, last);
    last = row.bytes;
    sum += row.bytes;
    buffer |= row.name == "row of this test" && row.subsystem == kMatrix && row.bytes >= 5000;
    image |= row.name == "volume of this test" && row.format == "rgba16f 32x32x32" && row.bytes == b.bytes();
  }
  EXPECT_TRUE(buffer && image);
  EXPECT_EQ(sum, memory.used());
  EXPECT_GE(memory.peak(), memory.used());
  EXPECT_GE(b.bytes(), 32u * 32 * 32 * 8);

  const uint64_t used = memory.used(), allocations = device().counters.allocations;
  try {
    const Buffer huge(device(), "a matrix too far", kMatrix, memory.budget() + 1);
    FAIL() << "no refusal";
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find("a matrix too far (matrix) needs"), std::string::npos) << error.what();
    EXPECT_EQ(error.exitStatus, 4);
  }
  EXPECT_EQ(memory.used(), used);
  EXPECT_EQ(device().counters.allocations, allocations);
  EXPECT_THROW(Image(device(), {.name = "wide", .format = VK_FORMAT_R8_UNORM, .width = 1u << 20}), DeviceError);
}

TEST_F(Core, FreedMemoryWaitsForWhatIsMadeNext) {
  // Blocks of 4 MiB, so what is larger than 2 MiB has one to itself.
  const auto device = Device::create({.validate = true, .memoryBudget = 64 << 20, .keptMemory = 24 << 20});
  const auto allocations = [&] { return device->counters.allocations.load(); };
  const auto buffer = [&](uint64_t mib) { return Buffer(*device, "of a moment", Subsystem::Staging, mib << 20); };
  const auto costs = [&](const std::function<void()>& make) {
    const uint64_t before = allocations();
    make();
    return allocations() - before;
  };
  EXPECT_EQ(costs([&] { buffer(10); }), 1u);
  for (const uint64_t mib : {10, 5, 8}) EXPECT_EQ(costs([&] { buffer(mib); }), 0u) << mib;
  EXPECT_EQ(costs([&] { buffer(4); }), 1u) << "half of the memory would be wasted";
  EXPECT_EQ(costs([&] { buffer(11); }), 1u) << "does not fit";
  // 10 + 4 + 11 MiB are more than 24: the oldest has gone.
  EXPECT_EQ(costs([&] { const Buffer a = buffer(11), b = buffer(4); }), 0u);
  EXPECT_EQ(costs([&] { const Buffer a = buffer(11), b = buffer(10); }), 1u);
  EXPECT_EQ(device->memory().used(), 0u);
  // What waits is nothing that is missing.
  EXPECT_NO_THROW(buffer(60));
  EXPECT_NO_THROW(buffer(60));
  EXPECT_TRUE(device->validationMessages().empty());
}

TEST_F(Core, ConfusedBindingsAreReportedWithBothSides) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const Image image(device(), {.name = "target", .format = VK_FORMAT_R32_SFLOAT, .width = 8, .height = 8});
  EXPECT_DEATH(context().begin().pass("Image").shader(shader("image.comp")).write(image).push(0).dispatch(8),
               "names 1 images, image.comp declares 2");
  EXPECT_DEATH(context().begin().pass("Image").shader(shader("image.comp")).write(image, image).push(0).dispatch(8),
               "source is a sampler in image.comp, but the pass gives target as a storage image");
  EXPECT_DEATH(context().begin().pass("Square").shader(shader("square.comp")).push(uint64_t{0}).dispatch(1),
               "8 bytes pushed, the shader's block has 24");
}

}  // namespace
}  // namespace irad::test::core_suite
