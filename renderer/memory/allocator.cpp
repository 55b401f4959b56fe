#include <unistd.h>

#include <algorithm>
#include <bit>

#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/memory/allocator_impl.h"
#include "renderer/vulkan_check.h"

namespace irad {
namespace {

constexpr uint64_t kMiB = 1024 * 1024;
constexpr uint64_t kLeastBlock = kMiB, kMostBlock = 64 * kMiB;
/// Share of a heap left to the driver and to others; a CPU device shares its memory with the whole machine.
constexpr double kUsableHeap = 0.95, kUsableRam = 0.6;
/// The share of the budget that is kept as empty blocks. On a CPU device none: memory costs little there, and what is
/// kept is missing to the rest of the machine.
constexpr uint64_t kKeptShare = 16;

std::string amount(uint64_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (bytes < 1024) return fmt::format("{} B", bytes);
  return bytes < kMiB ? fmt::format("{:.1f} KiB", value / 1024.0) : fmt::format("{:.1f} MiB", value / kMiB);
}
uint64_t alignUp(uint64_t value, uint64_t alignment) {
  return (value + alignment - 1) / alignment * alignment;
}

}  // namespace

Allocator::Impl::Impl(const Device& device) : device(device) {
  vkGetPhysicalDeviceMemoryProperties(device.physical, &memory);
  uint64_t largest = 0;
  for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
    if ((memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) && memory.memoryHeaps[i].size > largest) {
      largest = memory.memoryHeaps[i].size;
      deviceHeap = i;
    }
  physicalBytes = static_cast<uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<uint64_t>(sysconf(_SC_PAGE_SIZE));
  blockSize = std::clamp(std::bit_floor(budget() / 16), kLeastBlock, kMostBlock);
  mostKept = device.options.keptMemory.value_or(device.isCpu ? 0 : budget() / kKeptShare);
  const VkCommandPoolCreateInfo poolInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                         .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                         .queueFamilyIndex = device.queueFamily};
  vkCheck(vkCreateCommandPool(device.handle, &poolInfo, nullptr, &pool), "creating a command pool");
}

Allocator::Impl::~Impl() {
  for (const auto& [id, allocation] : live)
    tell("irad: {} ({} bytes) outlives its device\n", allocation.row.name, allocation.bytes);
  for (const auto& block : blocks) vkFreeMemory(device.handle, block->memory, nullptr);
  vkDestroyCommandPool(device.handle, pool, nullptr);
}

uint32_t Allocator::Impl::chooseType(uint32_t allowed, Access access, const std::string& name) const {
  constexpr VkMemoryPropertyFlags kHost = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  const VkMemoryPropertyFlags needed = access == Access::Device ? 0 : kHost;
  uint32_t best = UINT32_MAX;
  int bestScore = -1;
  for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
    const VkMemoryPropertyFlags flags = memory.memoryTypes[i].propertyFlags;
    if (!(allowed & (1u << i)) || (flags & needed) != needed) continue;
    if (flags & (VK_MEMORY_PROPERTY_PROTECTED_BIT | VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT)) continue;
    const bool local = flags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, cached = flags & VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    const bool host = flags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
    int score = 0;
    if (access == Access::Device)
      score = (local ? 4 : 0) + (memory.memoryTypes[i].heapIndex == deviceHeap ? 2 : 0) + (host ? 0 : 1);
    else if (access == Access::Upload)
      score = (local ? 0 : 2) + (cached ? 0 : 1);
    else
      score = (cached ? 2 : 0) + (local ? 0 : 1);
    if (score > bestScore) {
      bestScore = score;
      best = i;
    }
  }
  if (best == UINT32_MAX) throw DeviceError(fmt::format("{}: the device has no memory type for it", name));
  return best;
}

Allocator::Impl::Block* Allocator::Impl::newBlock(uint32_t type, uint64_t size, bool images, bool dedicated,
                                                  const std::string& name) {
  const VkMemoryAllocateFlagsInfo flags{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO,
                                        .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT};
  const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                  .pNext = images ? nullptr : &flags,
                                  .allocationSize = size,
                                  .memoryTypeIndex = type};
  auto block = std::make_unique<Block>();
  const bool own = memory.memoryTypes[type].heapIndex == deviceHeap;
  while (own && deviceTaken + size > budget())
    if (!dropOldest()) return nullptr;
  VkResult result;
  while ((result = vkAllocateMemory(device.handle, &info, nullptr, &block->memory)) != VK_SUCCESS) {
    if (result != VK_ERROR_OUT_OF_DEVICE_MEMORY && result != VK_ERROR_OUT_OF_HOST_MEMORY) break;
    if (!dropOldest()) return nullptr;
  }
  vkCheck(result, fmt::format("allocating {} for {}", amount(size), name));
  ++device.counters.allocations;
  if (own) deviceTaken += size;
  block->size = size;
  block->type = type;
  block->images = images;
  block->dedicated = dedicated;
  block->free[0] = size;
  if (memory.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) {
    void* mapped = nullptr;
    vkCheck(vkMapMemory(device.handle, block->memory, 0, VK_WHOLE_SIZE, 0, &mapped), "mapping memory");
    block->mapped = static_cast<std::byte*>(mapped);
  }
  device.name(VK_OBJECT_TYPE_DEVICE_MEMORY, reinterpret_cast<uint64_t>(block->memory),
              dedicated ? name : std::string(images ? "images" : "buffers"));
  blocks.push_back(std::move(block));
  return blocks.back().get();
}

Allocator::Impl::Block* Allocator::Impl::keptBlock(uint32_t type, uint64_t bytes, bool images,
                                                   const std::string& name) {
  Block* best = nullptr;
  for (const auto& b : blocks)
    if (b->emptied > 0 && b->type == type && b->images == images && b->size >= bytes && b->size / 2 <= bytes &&
        (!best || b->size < best->size))
      best = b.get();
  if (!best) return nullptr;
  best->emptied = 0;
  device.name(VK_OBJECT_TYPE_DEVICE_MEMORY, reinterpret_cast<uint64_t>(best->memory), name);
  return best;
}

bool Allocator::Impl::dropOldest() {
  Block* oldest = nullptr;
  for (const auto& b : blocks)
    if (b->emptied > 0 && (!oldest || b->emptied < oldest->emptied)) oldest = b.get();
  if (oldest) giveBack(*oldest);
  return oldest != nullptr;
}

void Allocator::Impl::giveBack(Block& block) {
  if (memory.memoryTypes[block.type].heapIndex == deviceHeap) deviceTaken -= block.size;
  vkFreeMemory(device.handle, block.memory, nullptr);
  std::erase_if(blocks, [&](const auto& b) { return b.get() == &block; });
}

uint64_t Allocator::Impl::kept() const {
  uint64_t bytes = 0;
  for (const auto& b : blocks)
    if (b->emptied > 0) bytes += b->size;
  return bytes;
}

bool Allocator::Impl::fit(Block& block, uint64_t bytes, uint64_t alignment, uint64_t& offset) {
  for (auto it = block.free.begin(); it != block.free.end(); ++it) {
    const uint64_t begin = it->first, end = begin + it->second;
    offset = alignUp(begin, alignment);
    if (offset + bytes > end) continue;
    block.free.erase(it);
    if (offset > begin) block.free[begin] = offset - begin;
    if (offset + bytes < end) block.free[offset + bytes] = end - offset - bytes;
    return true;
  }
  return false;
}

Allocator::Impl::Place Allocator::Impl::allocate(const VkMemoryRequirements& needs, MemoryRow row, Access access,
                                                 bool image) {
  const std::lock_guard lock(mutex);
  const uint32_t type = chooseType(needs.memoryTypeBits, access, row.name);
  const bool deviceLocal = memory.memoryTypes[type].heapIndex == deviceHeap;
  if (deviceLocal) check(row.subsystem, row.name, needs.size);
  if (needs.size > device.maxAllocation)
    throw DeviceError(fmt::format("{} ({}) needs {} in one piece; the device allocates at most {} at once", row.name,
                                  row.subsystem.text, amount(needs.size), amount(device.maxAllocation)));

  // Small resources share blocks; a resource of more than half a block gets its own.
  Block* block = nullptr;
  uint64_t offset = 0;
  const bool dedicated = needs.size > blockSize / 2;
  ++(image ? device.counters.images : device.counters.buffers);
  const bool refused = device.counters.resources() == device.options.failResource;
  if (!dedicated && !refused) {
    for (const auto& candidate : blocks)
      if (!candidate->dedicated && candidate->type == type && candidate->images == image &&
          fit(*candidate, needs.size, needs.alignment, offset)) {
        block = candidate.get();
        break;
      }
    if (!block && (block = newBlock(type, blockSize, image, false, row.name)))
      IRAD_CHECK(fit(*block, needs.size, needs.alignment, offset), "{} bytes in a fresh block", needs.size);
  }
  if (!block) {
    if (!refused && dedicated) block = keptBlock(type, needs.size, image, row.name);
    if (!block && !refused) block = newBlock(type, needs.size, image, true, row.name);
    if (!block && !refused && deviceLocal) checkRoom(row.subsystem, row.name, needs.size, deviceTaken);
    if (!block)
      throw DeviceError(fmt::format("{} ({}) needs {}: the device is out of memory ({} are in use)", row.name,
                                    row.subsystem.text, amount(needs.size), amount(used)));
    IRAD_CHECK(fit(*block, needs.size, 1, offset), "{} bytes in a dedicated block", needs.size);
  }

  const uint64_t id = nextId++;
  row.bytes = needs.size;
  live[id] = {block, offset, needs.size, std::move(row), deviceLocal};
  used += needs.size;
  if (deviceLocal) deviceUsed += needs.size;
  peak = std::max(peak, used);
  return {id, block->memory, offset, block->mapped ? block->mapped + offset : nullptr};
}

void Allocator::Impl::free(uint64_t id) {
  const std::lock_guard lock(mutex);
  const auto it = live.find(id);
  IRAD_CHECK(it != live.end(), "allocation {} is not live", id);
  const Allocation allocation = std::move(it->second);
  live.erase(it);
  used -= allocation.bytes;
  if (allocation.deviceLocal) deviceUsed -= allocation.bytes;

  // Return the range and merge it with its free neighbours.
  Block& block = *allocation.block;
  auto here = block.free.emplace(allocation.offset, allocation.bytes).first;
  if (const auto next = std::next(here); next != block.free.end() && here->first + here->second == next->first) {
    here->second += next->second;
    block.free.erase(next);
  }
  if (here != block.free.begin()) {
    const auto previous = std::prev(here);
    if (previous->first + previous->second == here->first) {
      previous->second += here->second;
      block.free.erase(here);
      here = previous;
    }
  }
  if (here->second != block.size) return;
  if (block.dedicated) {
    block.emptied = ++emptyings;
    while (kept() > mostKept) dropOldest();
    return;
  }
  // An empty shared block goes back, except the last one of its kind.
  const auto alike = [&](const auto& b) { return !b->dedicated && b->type == block.type && b->images == block.images; };
  if (std::count_if(blocks.begin(), blocks.end(), alike) > 1) giveBack(block);
}

uint64_t Allocator::Impl::bytes(uint64_t id) const {
  const std::lock_guard lock(mutex);
  const auto it = live.find(id);
  return it == live.end() ? 0 : it->second.bytes;
}

uint64_t Allocator::Impl::budget() const {
  const uint64_t wanted = device.options.memoryBudget, usable = heapBudget();
  return wanted > 0 ? std::min(wanted, usable) : usable;
}

uint64_t Allocator::Impl::heapBudget() const {
  const uint64_t heap = memory.memoryHeaps[deviceHeap].size;
  if (device.isCpu) return std::min(heap, static_cast<uint64_t>(kUsableRam * static_cast<double>(physicalBytes)));
  const auto usable = static_cast<uint64_t>(kUsableHeap * static_cast<double>(heap));
  if (!device.memoryBudget) return usable;
  VkPhysicalDeviceMemoryBudgetPropertiesEXT budget{.sType =
                                                       VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT};
  VkPhysicalDeviceMemoryProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_PROPERTIES_2,
                                               .pNext = &budget};
  vkGetPhysicalDeviceMemoryProperties2(device.physical, &properties);
  return std::min(usable, static_cast<uint64_t>(budget.heapBudget[deviceHeap]));
}

void Allocator::Impl::check(SubsystemName subsystem, const std::string& name, uint64_t bytes) const {
  checkRoom(subsystem, name, bytes, deviceUsed);
}

void Allocator::Impl::checkRoom(SubsystemName subsystem, const std::string& name, uint64_t bytes, uint64_t gone) const {
  const uint64_t all = budget();
  const uint64_t free = all > gone ? all - gone : 0;
  if (bytes > free)
    throw DeviceError(fmt::format("{} ({}) needs {}, {} of {} are free", name, subsystem.text, amount(bytes),
                                  amount(free), amount(all)));
}

void Allocator::Impl::runNow(const std::function<void(VkCommandBuffer)>& record) {
  const VkCommandBufferAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                             .commandPool = pool,
                                             .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                             .commandBufferCount = 1};
  VkCommandBuffer commands = VK_NULL_HANDLE;
  vkCheck(vkAllocateCommandBuffers(device.handle, &allocate, &commands), "allocating a command buffer");
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  vkCheck(vkBeginCommandBuffer(commands, &begin), "beginning a command buffer");
  record(commands);
  vkCheck(vkEndCommandBuffer(commands), "ending a command buffer");
  device.wait(device.submit(commands));
  vkFreeCommandBuffers(device.handle, pool, 1, &commands);
}

Allocator::Allocator(const Device& device) : impl_(std::make_unique<Impl>(device)) {}
Allocator::~Allocator() = default;

std::vector<MemoryRow> Allocator::rows() const {
  std::vector<std::pair<uint64_t, MemoryRow>> byId;
  {
    const std::lock_guard lock(impl_->mutex);
    for (const auto& [id, allocation] : impl_->live) byId.emplace_back(id, allocation.row);
  }
  std::sort(byId.begin(), byId.end(), [](const auto& a, const auto& b) {
    return a.second.bytes != b.second.bytes ? a.second.bytes > b.second.bytes : a.first < b.first;
  });
  std::vector<MemoryRow> rows;
  for (auto& [id, row] : byId) rows.push_back(std::move(row));
  return rows;
}

uint64_t Allocator::used() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->used;
}
uint64_t Allocator::peak() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->peak;
}
void Allocator::forgetPeak() {
  const std::lock_guard lock(impl_->mutex);
  impl_->peak = impl_->used;
}
uint64_t Allocator::budget() const {
  return impl_->budget();
}
void Allocator::check(SubsystemName subsystem, const std::string& name, uint64_t bytes) const {
  const std::lock_guard lock(impl_->mutex);
  impl_->check(subsystem, name, bytes);
}

}  // namespace irad
