#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/frame/frame_impl.h"
#include "renderer/frame/pipeline_wait.h"
#include "renderer/vulkan_check.h"

namespace irad {
namespace {

constexpr size_t kFramesInFlight = 2;
constexpr size_t kSlots = kFramesInFlight + 1;
constexpr uint64_t kStagingKept = 4 * 1024 * 1024;  // larger readback chunks go back when their frame is done

}  // namespace

Context::Context(const Device& device, ShaderLibrary& shaders, Timings& timings,
                 std::shared_ptr<PipelineCache> pipelines)
    : device(device), shaders(shaders), timings(timings) {
  if (pipelines)
    pipelines->handOver();
  else
    pipelines = std::make_shared<PipelineCache>(device, shaders);
  impl = std::make_unique<Impl>(device, std::move(pipelines));
}

Context::~Context() {
  if (!device.settle()) return;  // the loss was reported where it was met
  try {
    impl->collect(timings);
  } catch (const Error& error) {
    tell("irad: {}\n", error.what());
  }
}

Context::Impl::~Impl() {
  for (auto& slot : inFlight) destroy(*slot);
  for (auto& slot : idle) destroy(*slot);
}

VkDescriptorSetLayout Context::materialLayout() const {
  return impl->pipelines->materialLayout();
}

std::vector<PipelineUse> Context::pipelinesUsed() {
  return impl->pipelines->takeUsed();
}

void Context::bridgeVariants(bool on, std::function<void()> beforeCompile) {
  impl->pipelines->bridge = on;
  impl->pipelines->beforeCompile = std::move(beforeCompile);
}

std::shared_ptr<PipelineCache> Context::pipelines() const {
  return impl->pipelines;
}

size_t Context::variantsCompiling() const {
  return impl->pipelines->compiling();
}

double pipelineWaitMs(const Context& context) {
  return context.impl->pipelines->waitedMs();
}

const Image& Context::Impl::placeholder(bool cube) {
  Image& image = placeholders[cube ? 1 : 0];
  if (!image)
    image = Image(device, {.name = cube ? "no shadow cubes" : "no shadow maps",
                           .subsystem = Subsystem::Shadow,
                           .format = VK_FORMAT_D32_SFLOAT,
                           .layers = cube ? 6u : 1u,
                           .cube = cube,
                           .array = !cube,
                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
  return image;
}

std::unique_ptr<FrameSlot> Context::Impl::takeSlot(Timings& timings) {
  if (slots >= kSlots) {
    while (idle.empty() && !inFlight.empty()) {
      device.wait(inFlight.front()->timelineValue);
      collect(timings);
    }
    if (!idle.empty()) {
      std::unique_ptr<FrameSlot> slot = std::move(idle.front());
      idle.pop_front();
      return slot;
    }
  }
  auto slot = std::make_unique<FrameSlot>();
  const VkCommandPoolCreateInfo poolInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                         .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                         .queueFamilyIndex = device.queueFamily};
  vkCheck(vkCreateCommandPool(device.handle, &poolInfo, nullptr, &slot->pool), "creating a command pool");
  const VkCommandBufferAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                             .commandPool = slot->pool,
                                             .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                             .commandBufferCount = 1};
  vkCheck(vkAllocateCommandBuffers(device.handle, &allocate, &slot->commands), "allocating a command buffer");
  ++slots;
  return slot;
}

void Context::Impl::collect(Timings& timings) {
  while (!inFlight.empty() && device.finished(inFlight.front()->timelineValue)) {
    // Out of the queue first: a callback may begin a frame of its own.
    std::unique_ptr<FrameSlot> slot = std::move(inFlight.front());
    inFlight.pop_front();
    deliver(*slot, timings);
    reset(*slot);
    idle.push_back(std::move(slot));
  }
}

void Context::Impl::deliver(FrameSlot& slot, Timings& timings) {
  const std::vector<std::string> timers = std::move(slot.timers);
  slot.timers.clear();
  if (device.timestampBits > 0) {
    const uint64_t mask = device.timestampBits >= 64 ? ~uint64_t{0} : (uint64_t{1} << device.timestampBits) - 1;
    for (size_t i = 0; i < timers.size(); ++i) {
      uint64_t ticks[2] = {};
      const uint32_t first = 2 * static_cast<uint32_t>(i % FrameSlot::kTimersPerPool);
      vkCheck(
          vkGetQueryPoolResults(device.handle, slot.queryPools[i / FrameSlot::kTimersPerPool], first, 2, sizeof(ticks),
                                ticks, sizeof(uint64_t), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "reading timestamps");
      const uint64_t elapsed = ((ticks[1] & mask) - (ticks[0] & mask)) & mask;  // wraps around once at most
      const double tick = device.limits.timestampPeriod * 1e-6;                 // ms
      timings.add(timers[i], static_cast<double>(elapsed) * tick, static_cast<double>(ticks[0] & mask) * tick);
    }
  } else if (timers.size() == 1 && slot.awaited) {
    // No timestamps: the wall clock of a frame of one stage, which somebody has waited for, is an upper bound.
    const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - slot.submitted;
    timings.add(timers.front(), wall.count());
  }
  if (slot.sample) {
    const std::chrono::duration<double, std::milli> cpu = slot.submitted - slot.sample->began;
    timings.endFrame(slot.sample->frame, /*setup=*/false, cpu.count(), slot.submitted);
  }
  const std::vector<FrameSlot::Readback> readbacks = std::move(slot.readbacks);
  slot.readbacks.clear();
  for (const FrameSlot::Readback& r : readbacks) r.done({reinterpret_cast<const uint8_t*>(r.bytes), r.size});
}

void Context::Impl::reset(FrameSlot& slot) {
  vkCheck(vkResetCommandPool(device.handle, slot.pool, 0), "resetting a command pool");
  for (const VkDescriptorPool pool : slot.descriptorPools) vkResetDescriptorPool(device.handle, pool, 0);
  slot.descriptorPool = 0;
  slot.timers.clear();
  slot.readbacks.clear();
  slot.sample.reset();
  slot.awaited = false;
  std::erase_if(slot.staging, [](const FrameSlot::Chunk& chunk) { return chunk.buffer.bytes > kStagingKept; });
  for (FrameSlot::Chunk& chunk : slot.staging) chunk.used = 0;
  slot.filledUsed = 0;
}

void Context::Impl::destroy(FrameSlot& slot) {
  --slots;
  slot.staging.clear();
  slot.filled.clear();
  device.retire(
      [device = device.handle, pool = slot.pool, descriptorPools = slot.descriptorPools, queryPools = slot.queryPools] {
        for (const VkDescriptorPool p : descriptorPools) vkDestroyDescriptorPool(device, p, nullptr);
        for (const VkQueryPool p : queryPools) vkDestroyQueryPool(device, p, nullptr);
        vkDestroyCommandPool(device, pool, nullptr);
      });
}

void Context::collect() {
  impl->collect(timings);
  impl->pipelines->collect();  // frames that are untimed go on without begin()
}

void Context::finish() {
  if (!impl->inFlight.empty()) device.wait(impl->inFlight.back()->timelineValue);
  collect();
}

Frame Context::begin(uint64_t frameIndex) {
  impl->collect(timings);
  impl->pipelines->collect();
  while (impl->inFlight.size() >= kFramesInFlight) {
    device.wait(impl->inFlight.front()->timelineValue);
    impl->collect(timings);
  }
  Frame frame = beginUntimed();
  frame.impl_->timed = true;
  device.name(VK_OBJECT_TYPE_COMMAND_BUFFER, reinterpret_cast<uint64_t>(frame.commands()),
              fmt::format("frame {}", frameIndex));
  return frame;
}

Frame Context::beginUntimed() {
  Frame frame;
  frame.impl_ = std::make_unique<Frame::Impl>();
  frame.impl_->context = this;
  frame.impl_->slot = impl->takeSlot(timings);
  frame.impl_->timed = false;
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  vkCheck(vkBeginCommandBuffer(frame.commands(), &begin), "beginning a command buffer");
  device.recordingBegan();
  return frame;
}

}  // namespace irad
