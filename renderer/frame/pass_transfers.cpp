// Passes without a shader: fills, clears, copies.
#include "renderer/base/error.h"
#include "renderer/frame/pass_state.h"

namespace irad {

void Pass::updateBytes(const Buffer& buffer, const void* bytes, size_t size) {
  IRAD_CHECK_OP(size, <=, buffer.bytes);
  declare(buffer, kClear);
  record([&](VkCommandBuffer commands) { vkCmdUpdateBuffer(commands, buffer.handle, 0, size, bytes); });
}

void Pass::fill(const Buffer& buffer, uint32_t word) {
  declare(buffer, kClear);
  record(
      [&](VkCommandBuffer commands) { vkCmdFillBuffer(commands, buffer.handle, 0, (buffer.bytes + 3) / 4 * 4, word); });
}

void Pass::clear(const Image& image, ClearColor value) {
  declare(image, kClear);
  record([&](VkCommandBuffer commands) {
    const VkImageSubresourceRange range{aspect(image), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
    if (formatInfo(image.desc.format).kind == TexelKind::Depth) {
      const VkClearDepthStencilValue depth{value.r, 0};
      vkCmdClearDepthStencilImage(commands, image.handle, VK_IMAGE_LAYOUT_GENERAL, &depth, 1, &range);
      return;
    }
    const VkClearColorValue color{.float32 = {value.r, value.g, value.b, value.a}};
    vkCmdClearColorImage(commands, image.handle, VK_IMAGE_LAYOUT_GENERAL, &color, 1, &range);
  });
}

void Pass::clear(const Image& image, glm::uvec4 value) {
  declare(image, kClear);
  record([&](VkCommandBuffer commands) {
    const VkImageSubresourceRange range{aspect(image), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
    const VkClearColorValue color{.uint32 = {value.x, value.y, value.z, value.w}};
    vkCmdClearColorImage(commands, image.handle, VK_IMAGE_LAYOUT_GENERAL, &color, 1, &range);
  });
}

void Pass::copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t fromOffset, uint64_t toOffset) {
  IRAD_CHECK(fromOffset + bytes <= from.bytes && toOffset + bytes <= to.bytes, "{}: {} bytes from {} + {} to {} + {}",
             stage_, bytes, from.name, fromOffset, to.name, toOffset);
  declare(from, kCopyFrom);
  declare(to, kCopyTo);
  record([&](VkCommandBuffer commands) {
    const VkBufferCopy region{fromOffset, toOffset, bytes};
    if (bytes > 0) vkCmdCopyBuffer(commands, from.handle, to.handle, 1, &region);
  });
}

namespace {

VkBufferImageCopy wholeImage(const Image& image, const Buffer& buffer) {
  const ImageDesc& d = image.desc;
  const uint64_t bytes =
      uint64_t{d.width} * d.height * (d.volume ? d.depth : 1) * d.layers * formatInfo(d.format).bytes;
  IRAD_CHECK(bytes <= buffer.bytes, "{} is {} bytes, {} holds {}", d.name, bytes, buffer.name, buffer.bytes);
  return {.imageSubresource = {aspect(image), 0, 0, d.layers},
          .imageExtent = {d.width, d.height, d.volume ? d.depth : 1}};
}

}  // namespace

void Pass::copy(const Image& from, const Buffer& to) {
  declare(from, kCopyFrom);
  declare(to, kCopyTo);
  record([&](VkCommandBuffer commands) {
    const VkBufferImageCopy region = wholeImage(from, to);
    vkCmdCopyImageToBuffer(commands, from.handle, VK_IMAGE_LAYOUT_GENERAL, to.handle, 1, &region);
  });
}

void Pass::copy(const Buffer& from, const Image& to) {
  declare(from, kCopyFrom);
  declare(to, kCopyTo);
  record([&](VkCommandBuffer commands) {
    const VkBufferImageCopy region = wholeImage(to, from);
    vkCmdCopyBufferToImage(commands, from.handle, to.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
  });
}

}  // namespace irad
