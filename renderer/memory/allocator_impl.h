// The sub-allocator: blocks per memory type, first fit by offset; buffers and optimal images never share a block, so
// bufferImageGranularity never matters. A resource of more than half a block has one to itself, which waits, once it is
// empty, for a resource of about its size: a GPU's driver takes 20 us for a MiB, and as long again to take it back.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "renderer/resources.h"

namespace irad {

struct Allocator::Impl {
  struct Block {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    uint64_t size = 0;
    uint32_t type = 0;
    bool images = false, dedicated = false;
    uint64_t emptied = 0;  ///< when its only resource went, by `emptyings`, and it was kept; 0: it is in use, or shared
    std::byte* mapped = nullptr;
    std::map<uint64_t, uint64_t> free;  ///< offset -> size; neighbours are merged
  };
  struct Allocation {
    Block* block = nullptr;
    uint64_t offset = 0, bytes = 0;
    MemoryRow row;
    bool deviceLocal = false;
  };
  /// What a new resource is given.
  struct Place {
    uint64_t id = 0;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    uint64_t offset = 0;
    void* mapped = nullptr;
  };

  explicit Impl(const Device& device);
  ~Impl();

  Place allocate(const VkMemoryRequirements& needs, MemoryRow row, Access access, bool image);
  void free(uint64_t id);
  uint64_t bytes(uint64_t id) const;
  uint64_t budget() const;
  void check(SubsystemName subsystem, const std::string& name, uint64_t bytes) const;

  /// DeviceOptions::poison: runs `record` on the device and waits.
  void runNow(const std::function<void(VkCommandBuffer)>& record);

  const Device& device;
  VkPhysicalDeviceMemoryProperties memory{};
  uint32_t deviceHeap = 0;  ///< the largest device-local heap
  uint64_t physicalBytes = 0;
  uint64_t blockSize = 0;  ///< of shared blocks

  mutable std::mutex mutex;
  std::vector<std::unique_ptr<Block>> blocks;
  std::unordered_map<uint64_t, Allocation> live;
  uint64_t nextId = 1, used = 0, peak = 0;
  uint64_t deviceUsed = 0, deviceTaken = 0;  ///< of the device's own heap: by resources, by whole blocks
  uint64_t mostKept = 0;                     ///< bytes of kept blocks
  uint64_t emptyings = 0;                    ///< so far, of dedicated blocks
  VkCommandPool pool = VK_NULL_HANDLE;

 private:
  uint32_t chooseType(uint32_t allowed, Access access, const std::string& name) const;
  Block* newBlock(uint32_t type, uint64_t size, bool images, bool dedicated, const std::string& name);
  /// The smallest kept block for so many bytes, of which it wastes no more than half; or null.
  Block* keptBlock(uint32_t type, uint64_t bytes, bool images, const std::string& name);
  /// Gives the memory of the kept block that has waited longest back to the driver; false: none is kept.
  bool dropOldest();
  void giveBack(Block& block);
  uint64_t kept() const;  ///< bytes of kept blocks
  uint64_t heapBudget() const;
  void checkRoom(SubsystemName subsystem, const std::string& name, uint64_t bytes, uint64_t gone) const;
  bool fit(Block& block, uint64_t bytes, uint64_t alignment, uint64_t& offset);
};

}  // namespace irad
