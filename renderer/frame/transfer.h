// Buffers and images from and to host memory.
#pragma once

#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "renderer/frame/context.h"
#include "renderer/resources.h"

namespace irad {

// Blocking transfers for set-up, tests and exports. They run at once: before what an open frame has recorded.
void upload(Context& context, const Buffer& buffer, std::span<const std::byte> bytes, uint64_t offset = 0);
void upload(Context& context, const Image& image, std::span<const std::byte> bytes, uint32_t mip = 0);  ///< all layers
std::vector<std::byte> download(Context& context, const Buffer& buffer);
std::vector<std::byte> download(Context& context, const Image& image);  ///< mip 0, all layers, tightly packed
/// One texel of a 2D image, from its top left.
std::vector<std::byte> downloadTexel(Context& context, const Image& image, glm::uvec2 texel);

template <class T>
Buffer makeBuffer(Context& context, std::string name, SubsystemName subsystem, std::span<const T> values) {
  Buffer buffer(context.device, std::move(name), subsystem, values.size_bytes());
  if (!values.empty()) upload(context, buffer, std::as_bytes(values));
  return buffer;
}
template <class T>
std::vector<T> downloadAs(Context& context, const Buffer& buffer) {
  const std::vector<std::byte> bytes = download(context, buffer);
  std::vector<T> out(bytes.size() / sizeof(T));
  std::memcpy(out.data(), bytes.data(), out.size() * sizeof(T));
  return out;
}

}  // namespace irad
