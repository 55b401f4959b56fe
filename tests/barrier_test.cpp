// The hazard rule of renderer/barrier.h, case by case (Vulkan 1.3, chapter "Synchronization and Cache Control"); and
// how many workgroups a pass dispatches.
#include "renderer/barrier.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "renderer/frame/workgroups.h"

namespace irad::barrier_suite {
namespace {

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                kFragment = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                                kCopy = VK_PIPELINE_STAGE_2_COPY_BIT;
constexpr VkAccessFlags2 kLoad = VK_ACCESS_2_SHADER_STORAGE_READ_BIT, kStore = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                         kSampled = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, kTransfer = VK_ACCESS_2_TRANSFER_WRITE_BIT;
constexpr Use kRead{kCompute, kLoad}, kFragmentRead{kFragment, kSampled}, kCopyWrite{kCopy, kTransfer},
    kWrite{kCompute, kStore}, kReadWrite{kCompute, kLoad | kStore}, kAccumulate{kCompute, kLoad | kStore, true};

ResourceState after(std::vector<Use> uses) {
  ResourceState state;
  for (const Use& use : uses) state = advance(state, use);
  return state;
}
void expectNone(const Dependency& d) {
  EXPECT_FALSE(d.needed()) << "source stages " << d.source.stages;
}
void expectIs(const Dependency& d, const Use& source, const Use& destination) {
  EXPECT_EQ(d.source.stages, source.stages);
  EXPECT_EQ(d.source.access, source.access);
  EXPECT_EQ(d.destination.stages, destination.stages);
  EXPECT_EQ(d.destination.access, destination.access);
}

TEST(Barrier, WhatWrites) {
  EXPECT_FALSE(kRead.writes());
  EXPECT_FALSE(kFragmentRead.writes());
  EXPECT_TRUE(kWrite.writes());
  EXPECT_TRUE(kReadWrite.writes());
  EXPECT_TRUE(kCopyWrite.writes());
  EXPECT_TRUE((Use{kCompute, VK_ACCESS_2_MEMORY_WRITE_BIT}.writes()));
  EXPECT_TRUE((Use{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT}.writes()));
  EXPECT_FALSE((Use{VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT}.writes()));
}

TEST(Barrier, FirstUseNeedsNothing) {
  for (const Use& use : {kRead, kFragmentRead, kWrite, kReadWrite, kCopyWrite}) expectNone(dependency({}, use));
}

TEST(Barrier, ReadAfterRead) {
  expectNone(dependency(after({kRead}), kRead));
  expectNone(dependency(after({kRead}), kFragmentRead));
  expectNone(dependency(after({kRead, kFragmentRead}), kRead));
}

TEST(Barrier, ReadAfterWriteMakesTheWriteVisible) {
  expectIs(dependency(after({kWrite}), kRead), kWrite, kRead);
  expectIs(dependency(after({kCopyWrite}), kFragmentRead), kCopyWrite, kFragmentRead);
  // Reads of the writer's own pass need not be made available.
  expectIs(dependency(after({kReadWrite}), kRead), kWrite, kRead);
}

TEST(Barrier, SecondReaderOfTheSameKindNeedsNothing) {
  expectNone(dependency(after({kWrite, kRead}), kRead));
}

TEST(Barrier, SecondReaderElsewhereWaitsToo) {
  // The union covers every pair (stage, access), so that later readers of any pair need nothing.
  expectIs(dependency(after({kWrite, kRead}), kFragmentRead), kWrite, {kCompute | kFragment, kLoad | kSampled});
  const ResourceState both = after({kWrite, kRead, kFragmentRead});
  expectNone(dependency(both, kRead));
  expectNone(dependency(both, kFragmentRead));
  expectNone(dependency(both, {kFragment, kLoad}));
}

TEST(Barrier, WriteAfterReadIsExecutionOnly) {
  expectIs(dependency(after({kRead}), kWrite), {kCompute, 0}, kWrite);
  expectIs(dependency(after({kRead, kFragmentRead}), kCopyWrite), {kCompute | kFragment, 0}, kCopyWrite);
  expectIs(dependency(after({kWrite, kFragmentRead}), kCopyWrite), {kFragment, 0}, kCopyWrite);
}

TEST(Barrier, WriteAfterWriteIsAFullDependency) {
  expectIs(dependency(after({kWrite}), kWrite), kWrite, kWrite);
  expectIs(dependency(after({kWrite}), kCopyWrite), kWrite, kCopyWrite);
  expectIs(dependency(after({kReadWrite}), kReadWrite), kWrite, kReadWrite);
}

TEST(Barrier, ReadModifyWriteAfterAnotherReaderSeesTheWrite) {
  // The fragment stage has seen the write, compute has not: waiting for the reader alone would read stale data.
  expectIs(dependency(after({kWrite, kFragmentRead}), kReadWrite), {kCompute | kFragment, kStore}, kReadWrite);
  // Compute has seen it: execution suffices.
  expectIs(dependency(after({kWrite, kRead}), kReadWrite), {kCompute, 0}, kReadWrite);
}

TEST(Barrier, AtomicsThatCommuteNeedNothingBetweenThem) {
  expectIs(dependency(after({kCopyWrite}), kAccumulate), kCopyWrite, kAccumulate);
  expectNone(dependency(after({kCopyWrite, kAccumulate}), kAccumulate));
  expectNone(dependency(after({kCopyWrite, kAccumulate, kAccumulate}), kAccumulate));
  // But with others there is one: with other stages, with plain writes, with readers in between.
  expectIs(dependency(after({kAccumulate}), {kFragment, kLoad | kStore, true}), kWrite,
           {kFragment, kLoad | kStore, true});
  expectIs(dependency(after({kAccumulate}), kReadWrite), kWrite, kReadWrite);
  expectIs(dependency(after({kReadWrite}), kAccumulate), kWrite, kAccumulate);
  expectIs(dependency(after({kAccumulate, kAccumulate}), kRead), kWrite, kRead);
  expectIs(dependency(after({kAccumulate, kRead}), kAccumulate), {kCompute, 0}, kAccumulate);
}

TEST(Barrier, AWriteForgetsOlderReaders) {
  const ResourceState state = after({kWrite, kRead, kFragmentRead, kCopyWrite});
  EXPECT_EQ(state.lastWrite, kCopyWrite);
  EXPECT_EQ(state.readsSince, Use{});
  expectIs(dependency(state, kRead), kCopyWrite, kRead);
}

// A model that knows nothing of the rule: it replays barriers and keeps, per stage, what is visible to it and what it
// has waited for. Every sequence of four uses out of seven is checked against it.
struct Model {
  struct Event {
    Use use;
    VkPipelineStageFlags2 waitedBy = 0;  ///< stages ordered after this event
    VkPipelineStageFlags2 seenBy = 0;    ///< for writes: stages to which it is visible, any access of the union
    VkAccessFlags2 seenAs = 0;
    bool available = false;
  };
  std::vector<Event> events;

  void barrier(const Dependency& d) {
    if (!d.needed()) return;
    for (Event& e : events) {
      // In the first scope directly, or through a chain of earlier barriers.
      if (!((e.use.stages | e.waitedBy) & d.source.stages)) continue;
      e.waitedBy |= d.destination.stages;
      const bool direct = (e.use.stages & d.source.stages) && (e.use.access & d.source.access);
      e.available |= direct;
      if (e.use.writes() && e.available && d.source.access != 0) {
        e.seenBy |= d.destination.stages;
        e.seenAs |= d.destination.access;
      }
    }
  }
  bool safe(const Use& next) const {
    for (const Event& e : events) {
      if ((!e.use.writes() && !next.writes()) || (e.use.commutes && next.commutes && e.use.stages == next.stages))
        continue;
      if ((next.stages & ~e.waitedBy) != 0) return false;  // not even ordered
      if (!e.use.writes()) continue;
      if (next.writes() && !e.available) return false;
      const VkAccessFlags2 reads = next.access & (kLoad | kSampled);
      if (reads && newest(e) && ((next.stages & ~e.seenBy) || (reads & ~e.seenAs))) return false;
    }
    return true;
  }
  /// No write after this one has to wait for it.
  bool newest(const Event& e) const {
    return std::none_of(&e + 1, events.data() + events.size(), [&](const Event& later) {
      return later.use.writes() && !(e.use.commutes && later.use.commutes && e.use.stages == later.use.stages);
    });
  }
};

TEST(Barrier, EverySequenceOfFourUsesIsSafe) {
  const Use uses[] = {kRead, kFragmentRead, kWrite, kReadWrite, kAccumulate, kCopyWrite, {kFragment, kLoad | kStore}};
  int sequences = 0, needed = 0;
  for (const Use& a : uses)
    for (const Use& b : uses)
      for (const Use& c : uses)
        for (const Use& d : uses) {
          ++sequences;
          Model model;
          ResourceState state;
          for (const Use& use : {a, b, c, d}) {
            const Dependency dep = dependency(state, use);
            needed += dep.needed();
            // Never a barrier where the model is already safe and nothing was written or read before.
            model.barrier(dep);
            ASSERT_TRUE(model.safe(use)) << "sequence " << sequences;
            state = advance(state, use);
            model.events.push_back({use});
          }
        }
  EXPECT_EQ(sequences, 2401);
  EXPECT_GT(needed, 0);
}

TEST(Barrier, TheModelNoticesAMissingBarrier) {
  Model model;
  model.events.push_back({kWrite});
  EXPECT_FALSE(model.safe(kRead));
  EXPECT_FALSE(model.safe(kWrite));
  model.barrier({{kCompute, 0}, {kCompute, 0}});  // execution only
  EXPECT_FALSE(model.safe(kRead));
}

TEST(Workgroups, OfAPictureCoverItsEdges) {
  const glm::uvec2 size(33, 16);
  EXPECT_EQ(workgroupsFor(size, {8, 8, 1}), glm::uvec3(5, 2, 1));
  EXPECT_EQ(workgroupsFor(size, {16, 4, 1}), glm::uvec3(3, 4, 1));
  // One-dimensional workgroups take squares.
  EXPECT_EQ(workgroupsFor(size, {64, 1, 1}), glm::uvec3(5, 2, 1));
  EXPECT_EQ(workgroupsFor(size, {256, 1, 1}), glm::uvec3(3, 1, 1));
  EXPECT_EQ(workgroupsFor(glm::uvec2(0, 5), {8, 8, 1}), glm::uvec3(0, 1, 1));
  EXPECT_DEATH(workgroupsFor(size, {128, 1, 1}), "workgroups of 128 x 1 x 1");
}

TEST(Workgroups, OfManyInvocationsAreFolded) {
  EXPECT_EQ(workgroupsFor(uint64_t{0}, {64, 1, 1}, 65535), glm::uvec3(0, 1, 1));
  EXPECT_EQ(workgroupsFor(uint64_t{65}, {64, 1, 1}, 65535), glm::uvec3(2, 1, 1));
  EXPECT_EQ(workgroupsFor(uint64_t{65536}, {1, 1, 1}, 65535), glm::uvec3(32768, 2, 1));
  EXPECT_EQ(foldedWorkgroups(65535, 65535), glm::uvec3(65535, 1, 1));
  EXPECT_EQ(foldedWorkgroups(3 * 65535 + 1, 65535), glm::uvec3(49152, 4, 1));
  EXPECT_DEATH(workgroupsFor(uint64_t{64}, {8, 8, 1}, 65535), "workgroups of 8 x 8 x 1");
}

}  // namespace
}  // namespace irad::barrier_suite
