#include "renderer/resources.h"

#include <cstring>
#include <limits>
#include <tuple>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/format.h"
#include "renderer/memory/allocator_impl.h"
#include "renderer/vulkan_check.h"

namespace irad {
namespace {

constexpr Use kEverything{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                          VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
constexpr uint32_t kPoison = 0xFFFFFFFFu;  // a NaN as float, the greatest value as uint

VkImageAspectFlags aspect(VkFormat format) {
  return formatInfo(format).kind == TexelKind::Depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

/// A barrier after everything before and before everything after, with an optional layout transition.
void fullBarrier(VkCommandBuffer commands, VkImage image, VkImageAspectFlags imageAspect) {
  const VkMemoryBarrier2 memory{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                .srcStageMask = kEverything.stages,
                                .srcAccessMask = kEverything.access,
                                .dstStageMask = kEverything.stages,
                                .dstAccessMask = kEverything.access};
  const VkImageMemoryBarrier2 transition{
      .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
      .dstStageMask = kEverything.stages,
      .dstAccessMask = kEverything.access,
      .oldLayout = VK_IMAGE_LAYOUT_UNDEFINED,
      .newLayout = VK_IMAGE_LAYOUT_GENERAL,
      .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .image = image,
      .subresourceRange = {imageAspect, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS}};
  const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                              .memoryBarrierCount = 1,
                              .pMemoryBarriers = &memory,
                              .imageMemoryBarrierCount = image ? 1u : 0u,
                              .pImageMemoryBarriers = &transition};
  vkCmdPipelineBarrier2(commands, &info);
}

/// Move assignment, given the members as a tuple of references. What `to` held is freed now, not with `from`.
template <class Resource, class Members>
Resource& take(Resource& to, Resource& from, Members members) noexcept {
  if (&to == &from) return to;
  Resource old;
  auto mine = members(to), given = members(from), none = members(old);
  mine.swap(given);
  given.swap(none);
  return to;
}

}  // namespace

// --- Buffer ---

// The constructors delegate, so that what they have made so far is destroyed when a later step throws.

Buffer::Buffer(const Device& device, std::string resourceName, SubsystemName subsystem, uint64_t size, Access access)
    : Buffer() {
  bytes = size == 0 ? 16 : size;
  name = std::move(resourceName);
  device_ = &device;
  Allocator::Impl& allocator = *device.memory().impl_;
  if (access == Access::Device) device.memory().check(subsystem, name, bytes);
  const uint64_t allocated = (bytes + 15) / 16 * 16;  // whole words, so that fills reach the end
  const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                .size = allocated,
                                .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                         VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                                         VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                                         VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT};
  vkCheck(vkCreateBuffer(device.handle, &info, nullptr, &handle), fmt::format("creating buffer {}", name));
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device.handle, handle, &needs);
  const Allocator::Impl::Place place = allocator.allocate(needs, {name, subsystem, "buffer", 0}, access, false);
  allocation_ = place.id;
  if (access != Access::Device || device.isCpu) mapped = place.mapped;
  vkCheck(vkBindBufferMemory(device.handle, handle, place.memory, place.offset), "binding buffer memory");
  const VkBufferDeviceAddressInfo addressInfo{.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, .buffer = handle};
  place_ = std::make_shared<BufferPlace>();
  place_->address = vkGetBufferDeviceAddress(device.handle, &addressInfo);
  device.name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<uint64_t>(handle), name);

  if (!device.options.poison) return;
  if (mapped)
    std::memset(mapped, 0xFF, bytes);
  else
    allocator.runNow([&](VkCommandBuffer commands) {
      vkCmdFillBuffer(commands, handle, 0, VK_WHOLE_SIZE, kPoison);
      fullBarrier(commands, VK_NULL_HANDLE, 0);
    });
}

Buffer::~Buffer() {
  if (!handle) return;
  device_->retire(
      [device = device_->handle, allocator = device_->memory().impl_.get(), handle = handle, allocation = allocation_] {
        vkDestroyBuffer(device, handle, nullptr);
        if (allocation) allocator->free(allocation);
      });
}

Buffer::Buffer(Buffer&& other) noexcept {
  *this = std::move(other);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  return take(*this, other, [](Buffer& b) {
    return std::tie(b.handle, b.bytes, b.mapped, b.name, b.place_, b.device_, b.allocation_);
  });
}

// --- Image ---

namespace {

VkImageViewType viewType(const ImageDesc& d) {
  if (d.volume) return VK_IMAGE_VIEW_TYPE_3D;
  if (d.cube) return VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
  return d.array || d.layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
}

std::string describe(const ImageDesc& d) {
  std::string text = fmt::format("{} {}x{}", formatInfo(d.format).name, d.width, d.height);
  if (d.volume) text += fmt::format("x{}", d.depth);
  if (d.layers > 1) text += fmt::format(" {} layers", d.layers);
  if (d.mips > 1) text += fmt::format(" {} mips", d.mips);
  return text;
}

/// All layers and mips.
uint64_t countTexels(const ImageDesc& d) {
  uint64_t texels = 0;
  for (uint32_t mip = 0; mip < d.mips; ++mip)
    texels += uint64_t{std::max(1u, d.width >> mip)} * std::max(1u, d.height >> mip) * std::max(1u, d.depth >> mip);
  return texels * d.layers;
}

VkImageView makeView(const Device& device, const ImageDesc& d, VkImage image, VkFormat format, VkImageViewType type,
                     VkImageSubresourceRange range, const std::string& name) {
  // A view in another format of the same image must not claim usages that this format lacks.
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(device.physical, format, &properties);
  VkImageUsageFlags usage = d.usage;
  if (!(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT)) usage &= ~VK_IMAGE_USAGE_STORAGE_BIT;
  if (!(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT)) usage &= ~VK_IMAGE_USAGE_SAMPLED_BIT;
  if (!(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT))
    usage &= ~VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  const VkImageViewUsageCreateInfo usageInfo{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_USAGE_CREATE_INFO, .usage = usage};
  const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                   .pNext = &usageInfo,
                                   .image = image,
                                   .viewType = type,
                                   .format = format,
                                   .subresourceRange = range};
  VkImageView view = VK_NULL_HANDLE;
  vkCheck(vkCreateImageView(device.handle, &info, nullptr, &view), fmt::format("creating a view of {}", name));
  device.name(VK_OBJECT_TYPE_IMAGE_VIEW, reinterpret_cast<uint64_t>(view), name);
  return view;
}

/// Throws DeviceError in words if the device cannot make such an image.
void checkLimits(const Device& device, const VkImageCreateInfo& info, const ImageDesc& d) {
  VkImageFormatProperties can;
  const VkResult result = vkGetPhysicalDeviceImageFormatProperties(device.physical, info.format, info.imageType,
                                                                   info.tiling, info.usage, info.flags, &can);
  if (result == VK_ERROR_FORMAT_NOT_SUPPORTED)
    throw DeviceError(
        fmt::format("{}: the device has no {} image with usage {:#x}", d.name, formatInfo(d.format).name, info.usage));
  vkCheck(result, fmt::format("asking for the limits of {}", d.name));
  if (d.width > can.maxExtent.width || d.height > can.maxExtent.height || info.extent.depth > can.maxExtent.depth ||
      d.layers > can.maxArrayLayers)
    throw DeviceError(fmt::format("{}: {} exceeds the device's {}x{}x{}, {} layers", d.name, describe(d),
                                  can.maxExtent.width, can.maxExtent.height, can.maxExtent.depth, can.maxArrayLayers));
}

/// DeviceOptions::poison: NaN where the format has one, else the greatest value; depth 0, so that nothing passes.
void poison(VkCommandBuffer commands, VkImage image, const ImageDesc& d) {
  const VkImageSubresourceRange range{aspect(d.format), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
  fullBarrier(commands, image, range.aspectMask);
  if (!(d.usage & VK_IMAGE_USAGE_TRANSFER_DST_BIT)) return;
  const FormatInfo format = formatInfo(d.format);
  if (format.kind == TexelKind::Depth) {
    const VkClearDepthStencilValue depth{};
    vkCmdClearDepthStencilImage(commands, image, VK_IMAGE_LAYOUT_GENERAL, &depth, 1, &range);
  } else {
    VkClearColorValue value;
    for (int i = 0; i < 4; ++i)
      if (format.kind == TexelKind::Float)
        value.float32[i] = std::numeric_limits<float>::quiet_NaN();
      else if (format.kind == TexelKind::Unorm)
        value.float32[i] = 1.0f;
      else
        value.uint32[i] = kPoison >> (format.kind == TexelKind::Sint ? 1 : 0);
    vkCmdClearColorImage(commands, image, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &range);
  }
  fullBarrier(commands, VK_NULL_HANDLE, 0);
}

}  // namespace

Image::Image(const Device& device, const ImageDesc& wanted) : Image() {
  desc = wanted;
  device_ = &device;
  const FormatInfo format = formatInfo(desc.format);
  if (desc.depth > 1) desc.volume = true;
  IRAD_CHECK(desc.width > 0 && desc.height > 0 && desc.depth > 0 && desc.layers > 0 && desc.mips > 0, "{}: {}",
             desc.name, describe(desc));
  IRAD_CHECK(!desc.cube || desc.layers % 6 == 0, "{}: a cube of {} layers", desc.name, desc.layers);
  if (format.kind == TexelKind::Depth) desc.usage |= VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  if (format.kind == TexelKind::Depth || (format.srgb && desc.aliasFormat == VK_FORMAT_UNDEFINED))
    desc.usage &= ~static_cast<VkImageUsageFlags>(VK_IMAGE_USAGE_STORAGE_BIT);

  const bool alias = desc.aliasFormat != VK_FORMAT_UNDEFINED;
  VkImageCreateFlags flags = 0;
  if (alias) flags |= VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_EXTENDED_USAGE_BIT;
  if (desc.cube) flags |= VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
  const VkImageCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                               .flags = flags,
                               .imageType = desc.volume ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D,
                               .format = desc.format,
                               .extent = {desc.width, desc.height, desc.volume ? desc.depth : 1},
                               .mipLevels = desc.mips,
                               .arrayLayers = desc.layers,
                               .samples = VK_SAMPLE_COUNT_1_BIT,
                               .tiling = VK_IMAGE_TILING_OPTIMAL,
                               .usage = desc.usage,
                               .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED};
  checkLimits(device, info, desc);
  const uint64_t texelBytes = countTexels(desc) * format.bytes;
  device.memory().check(desc.subsystem, desc.name, texelBytes);
  vkCheck(vkCreateImage(device.handle, &info, nullptr, &handle), fmt::format("creating image {}", desc.name));
  Allocator::Impl& allocator = *device.memory().impl_;
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device.handle, handle, &needs);
  const Allocator::Impl::Place place =
      allocator.allocate(needs, {desc.name, desc.subsystem, describe(desc), 0, texelBytes}, Access::Device, true);
  allocation_ = place.id;
  vkCheck(vkBindImageMemory(device.handle, handle, place.memory, place.offset), "binding image memory");
  device.name(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(handle), desc.name);

  constexpr VkImageUsageFlags kViewable = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                          VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                          VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  constexpr VkImageUsageFlags kTarget =
      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  const VkImageSubresourceRange all{aspect(desc.format), 0, desc.mips, 0, desc.layers};
  if (desc.usage & kViewable) view = makeView(device, desc, handle, desc.format, viewType(desc), all, desc.name);
  if (alias) aliasView = makeView(device, desc, handle, desc.aliasFormat, viewType(desc), all, desc.name + " (alias)");
  if ((desc.usage & kTarget) && !desc.volume && (desc.layers > 1 || desc.mips > 1 || desc.cube || desc.array))
    for (uint32_t layer = 0; layer < desc.layers; ++layer)
      layerViews.push_back(makeView(device, desc, handle, desc.format, VK_IMAGE_VIEW_TYPE_2D,
                                    {aspect(desc.format), 0, 1, layer, 1},
                                    fmt::format("{} layer {}", desc.name, layer)));
  if (device.options.poison) {
    allocator.runNow([&](VkCommandBuffer commands) { poison(commands, handle, desc); });
    state.defined = true;
  }
}

Image::~Image() {
  if (!handle) return;
  std::vector<VkImageView> views = std::move(layerViews);
  if (view) views.push_back(view);
  if (aliasView) views.push_back(aliasView);
  device_->retire([device = device_->handle, allocator = device_->memory().impl_.get(), handle = handle,
                   allocation = allocation_, views = std::move(views)] {
    for (const VkImageView v : views) vkDestroyImageView(device, v, nullptr);
    vkDestroyImage(device, handle, nullptr);
    if (allocation) allocator->free(allocation);
  });
}

Image::Image(Image&& other) noexcept {
  *this = std::move(other);
}

Image& Image::operator=(Image&& other) noexcept {
  return take(*this, other, [](Image& i) {
    return std::tie(i.handle, i.view, i.aliasView, i.layerViews, i.desc, i.state, i.device_, i.allocation_);
  });
}

uint64_t Image::bytes() const {
  return handle ? device_->memory().impl_->bytes(allocation_) : 0;
}

}  // namespace irad
