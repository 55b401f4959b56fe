// What a context keeps between frames and what a frame holds while it is recorded. Private to renderer/.
#pragma once

#include <chrono>
#include <deque>

#include "renderer/frame/frame.h"
#include "renderer/pipeline_cache.h"

namespace irad {

/// Everything one submission needs; reused when the device has finished with it.
struct FrameSlot {
  static constexpr uint32_t kTimersPerPool = 128;

  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  std::vector<VkDescriptorPool> descriptorPools;
  size_t descriptorPool = 0;  ///< the one in use

  std::vector<VkQueryPool> queryPools;  ///< 2 queries per timer
  std::vector<std::string> timers;      ///< the stage of timer i
  bool timing = false;                  ///< the last one runs

  struct Chunk {
    Buffer buffer;
    uint64_t used = 0;
  };
  std::vector<Chunk> staging;  ///< readback memory
  std::deque<Buffer> filled;   ///< Frame::hostFilled()
  size_t filledUsed = 0;       ///< by the frame of now: the first so many
  struct Readback {
    const std::byte* bytes;
    uint64_t size;
    std::function<void(std::span<const uint8_t>)> done;
  };
  std::vector<Readback> readbacks;

  struct Sample {
    uint64_t frame;
    std::chrono::steady_clock::time_point began;
  };
  std::optional<Sample> sample;  ///< a group of its own in the timing table

  uint64_t timelineValue = 0;
  std::chrono::steady_clock::time_point submitted;
  bool awaited = false;  ///< submitAndWait() waits for it: its wall clock may stand in for timestamps
};

struct Context::Impl {
  Impl(const Device& device, std::shared_ptr<PipelineCache> pipelines)
      : device(device), pipelines(std::move(pipelines)) {}
  ~Impl();

  const Device& device;
  std::shared_ptr<PipelineCache> pipelines;
  std::array<Image, 2> placeholders;
  size_t slots = 0;                                 ///< of frames recorded, in flight or idle
  std::deque<std::unique_ptr<FrameSlot>> idle;      ///< the one that ended first, first
  std::deque<std::unique_ptr<FrameSlot>> inFlight;  ///< in order of submission

  /// The first few are made, then they take turns: which slot a frame has, and so what memory it takes, does not hang
  /// on how fast the device is.
  std::unique_ptr<FrameSlot> takeSlot(Timings& timings);
  /// One texel of depth, for Pass::sampleDepth. Nobody reads it.
  const Image& placeholder(bool cube);
  /// Delivers the readbacks and times of finished frames, in order of submission.
  void collect(Timings& timings);
  void deliver(FrameSlot& slot, Timings& timings);
  void reset(FrameSlot& slot);
  void destroy(FrameSlot& slot);
};

struct Frame::Impl {
  Context* context = nullptr;
  std::unique_ptr<FrameSlot> slot;  ///< null once submitted
  bool timed = true;                ///< false: blocking transfers, which are no stage of the method

  VkDescriptorSet allocateSet(VkDescriptorSetLayout layout);
  /// Memory the device copies into and the host reads after the frame.
  std::pair<const Buffer*, uint64_t> stage(uint64_t bytes, const std::byte*& mapped);
  void beginLabel(const std::string& name);
  void endLabel();
  /// Successive passes of one stage share a timer: timestamps between them would keep them from overlapping.
  void startTimer(const std::string& stage);
  void stopTimer();  ///< where one runs
  void submit(VkSemaphore presentWait, VkSemaphore presentSignal, bool awaited);
};

/// One command that makes everything before visible to everything after.
void everythingBarrier(VkCommandBuffer commands);

}  // namespace irad
