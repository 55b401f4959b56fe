#include "renderer/device.h"

#include <algorithm>
#include <cctype>

#include "renderer/base/error.h"
#include "renderer/base/near_match.h"
#include "renderer/device_impl.h"
#include "renderer/vulkan_check.h"

namespace irad {
namespace {

/// Discrete before integrated before virtual before CPU.
int rank(const DeviceInfo& info) {
  const char* order[] = {"discrete", "integrated", "virtual", "cpu"};
  return static_cast<int>(std::find(std::begin(order), std::end(order), info.type) - std::begin(order));
}

uint32_t choose(const std::vector<DeviceInfo>& devices, const std::string& select) {
  const auto suitable = [](const DeviceInfo& d) { return d.missing.empty(); };
  if (select.empty()) {
    const DeviceInfo* best = nullptr;
    for (const DeviceInfo& d : devices)
      if (suitable(d) && (!best || rank(d) < rank(*best))) best = &d;
    if (!best) throw DeviceError("no suitable Vulkan device:\n" + toText(devices));
    return best->index;
  }
  const bool isIndex = std::all_of(select.begin(), select.end(), [](unsigned char c) { return std::isdigit(c); });
  for (const DeviceInfo& d : devices) {
    const bool named = isIndex ? select == std::to_string(d.index) : containsAnyCase(d.name, select);
    if (!named) continue;
    if (!suitable(d)) throw DeviceError(fmt::format("--device {}: not suitable:\n{}", select, toText({d})));
    return d.index;
  }
  throw DeviceError(fmt::format("--device {}: no such device; there are:\n{}", select, toText(devices)));
}

std::vector<DeviceInfo> describeAll(VkInstance instance, bool presentable) {
  std::vector<DeviceInfo> infos;
  for (const VkPhysicalDevice device : physicalDevices(instance))
    infos.push_back(describe(device, static_cast<uint32_t>(infos.size()), presentable));
  return infos;
}

}  // namespace

Device::Device() : impl_(std::make_unique<Impl>()) {}

std::vector<DeviceInfo> Device::list() {
  Instance instance = createInstance(nullptr, /*presentable=*/false);
  std::vector<DeviceInfo> infos = describeAll(instance.handle, /*presentable=*/false);
  destroyInstance(instance);
  return infos;
}

std::unique_ptr<Device> Device::create(const DeviceOptions& options) {
  std::unique_ptr<Device> device(new Device);
  device->options = options;
  Impl& impl = *device->impl_;
  impl.instance = createInstance(options.validate ? &impl.log : nullptr, options.presentable);
  device->instance = impl.instance.handle;
  device->debugUtils = impl.instance.debugUtils;

  // Choose.
  const std::vector<DeviceInfo> infos = describeAll(device->instance, options.presentable);
  const uint32_t index = choose(infos, options.select);
  device->info = infos[index];
  device->physical = physicalDevices(device->instance)[index];
  device->isCpu = device->info.type == "cpu";
  device->queueFamily = graphicsComputeFamily(device->physical);

  // What it can do.
  VkPhysicalDeviceMaintenance3Properties allocation{.sType =
                                                        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
  VkPhysicalDeviceSubgroupProperties subgroup{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES,
                                              .pNext = &allocation};
  VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &subgroup};
  vkGetPhysicalDeviceProperties2(device->physical, &properties);
  device->limits = properties.properties.limits;
  device->maxAllocation = allocation.maxMemoryAllocationSize;
  device->subgroupSize = subgroup.subgroupSize;
  uint32_t familyCount = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device->physical, &familyCount, nullptr);
  std::vector<VkQueueFamilyProperties> families(familyCount);
  vkGetPhysicalDeviceQueueFamilyProperties(device->physical, &familyCount, families.data());
  device->timestampBits = families[device->queueFamily].timestampValidBits;

  // Create.
  FeatureChain features;
  chooseFeatures(device->physical, features);
  device->int64Atomics = features.v12.shaderBufferInt64Atomics;
  device->narrowGraphics = hasNarrowGraphics(device->info.name);
  device->anisotropy = features.core.features.samplerAnisotropy;
  std::vector<const char*> extensions;
  if (options.presentable) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  device->memoryBudget = hasExtension(device->physical, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
  if (device->memoryBudget) extensions.push_back(VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
  const float priority = 1.0f;
  const VkDeviceQueueCreateInfo queueInfo{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                          .queueFamilyIndex = device->queueFamily,
                                          .queueCount = 1,
                                          .pQueuePriorities = &priority};
  const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                .pNext = &features.core,
                                .queueCreateInfoCount = 1,
                                .pQueueCreateInfos = &queueInfo,
                                .enabledExtensionCount = static_cast<uint32_t>(extensions.size()),
                                .ppEnabledExtensionNames = extensions.data()};
  vkCheck(vkCreateDevice(device->physical, &info, nullptr, &device->handle),
          fmt::format("creating device {}", device->info.name));
  vkGetDeviceQueue(device->handle, device->queueFamily, 0, &device->queue);

  const VkSemaphoreTypeCreateInfo timeline{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                           .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
  const VkSemaphoreCreateInfo semaphore{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = &timeline};
  vkCheck(vkCreateSemaphore(device->handle, &semaphore, nullptr, &impl.timeline), "creating the timeline semaphore");
  device->name(VK_OBJECT_TYPE_SEMAPHORE, reinterpret_cast<uint64_t>(impl.timeline), "timeline");
  device->name(VK_OBJECT_TYPE_QUEUE, reinterpret_cast<uint64_t>(device->queue), "graphics and compute");
  device->allocator_ = std::make_unique<Allocator>(*device);
  return device;
}

Device::~Device() {
  if (handle) {
    vkDeviceWaitIdle(handle);
    // Everything has finished: run all retirements, including those that retirements add.
    for (;;) {
      std::vector<std::function<void()>> pending;
      {
        const std::lock_guard lock(impl_->mutex);
        for (auto& [value, destroy] : impl_->retired) pending.push_back(std::move(destroy));
        for (auto& destroy : impl_->retiredWhileRecording) pending.push_back(std::move(destroy));
        impl_->retired.clear();
        impl_->retiredWhileRecording.clear();
      }
      if (pending.empty()) break;
      for (auto& destroy : pending) destroy();
    }
    allocator_.reset();
    for (const auto& [desc, sampler] : impl_->samplers) vkDestroySampler(handle, sampler, nullptr);
    if (impl_->timeline) vkDestroySemaphore(handle, impl_->timeline, nullptr);
    vkDestroyDevice(handle, nullptr);
  }
  destroyInstance(impl_->instance);
}

void Device::name(VkObjectType type, uint64_t object, const std::string& name) const {
  if (!debugUtils || object == 0) return;
  const VkDebugUtilsObjectNameInfoEXT info{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                           .objectType = type,
                                           .objectHandle = object,
                                           .pObjectName = name.c_str()};
  vkSetDebugUtilsObjectNameEXT(handle, &info);
}

void Device::Impl::collect(VkDevice device) {
  uint64_t done = 0;
  if (vkGetSemaphoreCounterValue(device, timeline, &done) != VK_SUCCESS) return;  // lost: ~Device collects
  std::vector<std::function<void()>> ready;
  {
    const std::lock_guard lock(mutex);
    while (!retired.empty() && retired.front().first <= done) {
      ready.push_back(std::move(retired.front().second));
      retired.pop_front();
    }
  }
  for (auto& destroy : ready) destroy();
}

void Device::retire(std::function<void()> destroy) const {
  {
    const std::lock_guard lock(impl_->mutex);
    if (impl_->recording > 0)
      impl_->retiredWhileRecording.push_back(std::move(destroy));
    else
      impl_->retired.emplace_back(impl_->submitted, std::move(destroy));
  }
  impl_->collect(handle);
}

void Device::recordingBegan() const {
  const std::lock_guard lock(impl_->mutex);
  ++impl_->recording;
}

void Device::recordingEnded() const {
  const std::lock_guard lock(impl_->mutex);
  IRAD_CHECK_OP(impl_->recording, >, 0);
  if (--impl_->recording > 0) return;
  for (auto& destroy : impl_->retiredWhileRecording) impl_->retired.emplace_back(impl_->submitted, std::move(destroy));
  impl_->retiredWhileRecording.clear();
}

/// Counts a submission or a wait; true from the one on that DeviceOptions::loseDevice names.
bool Device::losesHere() const {
  if (++counters.exchanges == options.loseDevice) impl_->lost = true;
  return impl_->lost;
}

uint64_t Device::submit(VkCommandBuffer commands, VkSemaphore presentWait, VkSemaphore presentSignal) const {
  uint64_t value = 0;
  {
    const std::lock_guard lock(impl_->mutex);
    value = impl_->submitted + 1;
    const VkCommandBufferSubmitInfo buffer{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                           .commandBuffer = commands};
    const VkSemaphoreSubmitInfo wait{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                     .semaphore = presentWait,
                                     .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
    const VkSemaphoreSubmitInfo signals[] = {{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                              .semaphore = impl_->timeline,
                                              .value = value,
                                              .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT},
                                             {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                              .semaphore = presentSignal,
                                              .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT}};
    const VkSubmitInfo2 info{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                             .waitSemaphoreInfoCount = presentWait ? 1u : 0u,
                             .pWaitSemaphoreInfos = &wait,
                             .commandBufferInfoCount = 1,
                             .pCommandBufferInfos = &buffer,
                             .signalSemaphoreInfoCount = presentSignal ? 2u : 1u,
                             .pSignalSemaphoreInfos = signals};
    vkCheck(losesHere() ? VK_ERROR_DEVICE_LOST : vkQueueSubmit2(queue, 1, &info, VK_NULL_HANDLE),
            "submitting commands");
    impl_->submitted = value;
    ++counters.submissions;
  }
  impl_->collect(handle);
  return value;
}

void Device::wait(uint64_t value) const {
  const VkSemaphoreWaitInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                 .semaphoreCount = 1,
                                 .pSemaphores = &impl_->timeline,
                                 .pValues = &value};
  vkCheck(losesHere() ? VK_ERROR_DEVICE_LOST : vkWaitSemaphores(handle, &info, UINT64_MAX), "waiting for the device");
  impl_->collect(handle);
}

bool Device::finished(uint64_t value) const {
  uint64_t done = 0;
  vkCheck(impl_->lost ? VK_ERROR_DEVICE_LOST : vkGetSemaphoreCounterValue(handle, impl_->timeline, &done),
          "asking the device for its progress");
  return done >= value;
}

void Device::waitIdle() const {
  vkCheck(losesHere() ? VK_ERROR_DEVICE_LOST : vkDeviceWaitIdle(handle), "waiting for the device");
  impl_->collect(handle);
}

bool Device::settle() const noexcept {
  return vkDeviceWaitIdle(handle) == VK_SUCCESS && !impl_->lost;
}

std::vector<std::string> Device::validationMessages() const {
  const std::lock_guard lock(impl_->log.mutex);
  return impl_->log.messages;
}

}  // namespace irad
