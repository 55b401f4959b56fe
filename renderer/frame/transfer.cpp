// Blocking transfers through staging memory, in pieces of at most 64 MiB.
#include <algorithm>
#include <cstring>

#include "renderer/base/error.h"
#include "renderer/format.h"
#include "renderer/frame/frame_impl.h"

namespace irad {
namespace {

constexpr uint64_t kChunk = 64 * 1024 * 1024;

/// Extent of a level; depth is 1 except for volumes.
VkExtent3D extentOf(const ImageDesc& d, uint32_t mip) {
  return {std::max(d.width >> mip, 1u), std::max(d.height >> mip, 1u), d.volume ? std::max(d.depth >> mip, 1u) : 1};
}

uint64_t texelBytes(const Image& image, uint32_t mip = 0) {
  const ImageDesc& d = image.desc;
  const VkExtent3D e = extentOf(d, mip);
  return uint64_t{e.width} * e.height * e.depth * d.layers * formatInfo(d.format).bytes;
}

/// Submits, waits, and leaves the resource visible to everything, so that nothing later needs a barrier for it (the
/// textures of materials are bound without being declared).
void finish(Frame& frame, ResourceState& state) {
  everythingBarrier(frame.commands());
  frame.submitAndWait();
  state = {.defined = state.defined};
}

VkImageAspectFlags aspectOf(const FormatInfo& format) {
  return format.kind == TexelKind::Depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

/// Visits a level as pieces of whole rows (or slices, or layers) that fit in a chunk: body(piece, byte offset, bytes).
void forPieces(const Image& image, uint32_t mip,
               const std::function<void(const VkBufferImageCopy&, uint64_t, uint64_t)>& body) {
  const FormatInfo format = formatInfo(image.desc.format);
  const VkImageAspectFlags aspect = aspectOf(format);
  const VkExtent3D extent = extentOf(image.desc, mip);
  const uint64_t row = uint64_t{extent.width} * format.bytes;
  const auto rows = static_cast<uint32_t>(std::clamp<uint64_t>(kChunk / row, 1, extent.height));
  uint64_t at = 0;
  for (uint32_t layer = 0; layer < image.desc.layers; ++layer)
    for (uint32_t z = 0; z < extent.depth;) {
      // Several whole slices at once where they fit, else rows of one slice.
      const uint64_t slices = std::clamp<uint64_t>(kChunk / (row * extent.height), 1, extent.depth - z);
      for (uint32_t y = 0; y < extent.height; y += rows) {
        const uint32_t count = std::min(rows, extent.height - y);
        const uint64_t bytes = row * count * slices;
        const VkBufferImageCopy piece{.imageSubresource = {aspect, mip, layer, 1},
                                      .imageOffset = {0, static_cast<int32_t>(y), static_cast<int32_t>(z)},
                                      .imageExtent = {extent.width, count, static_cast<uint32_t>(slices)}};
        body(piece, at, bytes);
        at += bytes;
      }
      z += static_cast<uint32_t>(slices);
    }
}

}  // namespace

void upload(Context& context, const Buffer& buffer, std::span<const std::byte> bytes, uint64_t offset) {
  IRAD_CHECK(offset + bytes.size() <= buffer.bytes, "upload of {} + {} to {} of {} bytes", offset, bytes.size(),
             buffer.name, buffer.bytes);
  if (bytes.empty()) return;
  const Buffer staging(context.device, "upload", Subsystem::Staging, std::min<uint64_t>(bytes.size(), kChunk),
                       Access::Upload);
  for (uint64_t at = 0; at < bytes.size(); at += kChunk) {
    const uint64_t size = std::min<uint64_t>(kChunk, bytes.size() - at);
    std::memcpy(staging.mapped, bytes.data() + at, size);
    Frame frame = context.beginUntimed();
    frame.pass("Upload").copy(staging, buffer, size, 0, offset + at);
    finish(frame, buffer.state());
  }
}

void upload(Context& context, const Image& image, std::span<const std::byte> bytes, uint32_t mip) {
  IRAD_CHECK(mip < image.desc.mips && bytes.size() == texelBytes(image, mip),
             "upload of {} bytes to level {} of {}, which has {} levels, this of {}", bytes.size(), mip,
             image.desc.name, image.desc.mips, texelBytes(image, mip));
  const uint64_t row = uint64_t{image.desc.width} * formatInfo(image.desc.format).bytes;
  const Buffer staging(context.device, "upload", Subsystem::Staging,
                       std::min<uint64_t>(bytes.size(), std::max(kChunk, row)), Access::Upload);
  forPieces(image, mip, [&](const VkBufferImageCopy& piece, uint64_t at, uint64_t size) {
    std::memcpy(staging.mapped, bytes.data() + at, size);
    Frame frame = context.beginUntimed();
    frame.pass("Upload")
        .declare(image, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT})
        .record([&](VkCommandBuffer commands) {
          vkCmdCopyBufferToImage(commands, staging.handle, image.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &piece);
        });
    finish(frame, image.state);
  });
}

std::vector<std::byte> download(Context& context, const Buffer& buffer) {
  std::vector<std::byte> bytes(buffer.bytes);
  const Buffer staging(context.device, "download", Subsystem::Staging, std::min<uint64_t>(bytes.size(), kChunk),
                       Access::Readback);
  for (uint64_t at = 0; at < bytes.size(); at += kChunk) {
    const uint64_t size = std::min<uint64_t>(kChunk, bytes.size() - at);
    Frame frame = context.beginUntimed();
    frame.pass("Download").copy(buffer, staging, size, at, 0);
    frame.pass("Download").declare(staging, {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT}).record([](auto) {
    });
    finish(frame, buffer.state());
    std::memcpy(bytes.data() + at, staging.mapped, size);
  }
  return bytes;
}

namespace {
void copyToHost(Context& context, const Image& image, const VkBufferImageCopy& piece, const Buffer& staging) {
  Frame frame = context.beginUntimed();
  frame.pass("Download")
      .declare(image, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT})
      .declare(staging, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT})
      .record([&](VkCommandBuffer commands) {
        vkCmdCopyImageToBuffer(commands, image.handle, VK_IMAGE_LAYOUT_GENERAL, staging.handle, 1, &piece);
      });
  frame.pass("Download").declare(staging, {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT}).record([](auto) {
  });
  finish(frame, image.state);
}
}  // namespace

std::vector<std::byte> download(Context& context, const Image& image) {
  std::vector<std::byte> bytes(texelBytes(image));
  const uint64_t row = uint64_t{image.desc.width} * formatInfo(image.desc.format).bytes;
  const Buffer staging(context.device, "download", Subsystem::Staging,
                       std::min<uint64_t>(bytes.size(), std::max(kChunk, row)), Access::Readback);
  forPieces(image, 0, [&](const VkBufferImageCopy& piece, uint64_t at, uint64_t size) {
    copyToHost(context, image, piece, staging);
    std::memcpy(bytes.data() + at, staging.mapped, size);
  });
  return bytes;
}

std::vector<std::byte> downloadTexel(Context& context, const Image& image, glm::uvec2 texel) {
  const FormatInfo format = formatInfo(image.desc.format);
  IRAD_CHECK(texel.x < image.desc.width && texel.y < image.desc.height, "texel {}, {} of {}, {} x {}", texel.x, texel.y,
             image.desc.name, image.desc.width, image.desc.height);
  const Buffer staging(context.device, "download", Subsystem::Staging, format.bytes, Access::Readback);
  copyToHost(context, image,
             {.imageSubresource = {aspectOf(format), 0, 0, 1},
              .imageOffset = {static_cast<int32_t>(texel.x), static_cast<int32_t>(texel.y), 0},
              .imageExtent = {1, 1, 1}},
             staging);
  const auto* bytes = static_cast<const std::byte*>(staging.mapped);
  return {bytes, bytes + format.bytes};
}

}  // namespace irad
