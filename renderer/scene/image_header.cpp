#include "renderer/scene/image_header.h"

#include <cstring>

#include "renderer/scene/gltf_document.h"

namespace irad {
namespace {

class Bytes {
 public:
  explicit Bytes(std::span<const uint8_t> bytes) : bytes_(bytes) {}
  bool has(size_t at, size_t count) const { return at <= bytes_.size() && count <= bytes_.size() - at; }
  bool starts(size_t at, std::string_view magic) const {
    return has(at, magic.size()) && std::memcmp(bytes_.data() + at, magic.data(), magic.size()) == 0;
  }
  uint32_t big(size_t at, size_t count) const {
    uint32_t value = 0;
    for (size_t i = 0; i < count; ++i) value = value << 8 | bytes_[at + i];
    return value;
  }
  uint32_t little(size_t at, size_t count) const {
    uint32_t value = 0;
    for (size_t i = count; i-- > 0;) value = value << 8 | bytes_[at + i];
    return value;
  }

 private:
  std::span<const uint8_t> bytes_;
};

using Header = std::optional<ImageHeader>;

/// PNG (third edition) 11.2.1: IHDR comes first. An interlaced image is held whole in its own depth, three channels of
/// 8 bits before they become four.
Header png(const Bytes& b) {
  if (!b.has(0, 29) || !b.starts(12, "IHDR")) return {};
  const bool deep = b.big(24, 1) == 16, interlaced = b.big(28, 1) != 0;
  return ImageHeader{"png", b.big(16, 4), b.big(20, 4), 3 + (interlaced ? deep ? 8u : 4u : 0u)};
}

/// ITU T.81 B.1.1, B.2.2: the frame header (SOF) among the marker segments. A file of several scans is held whole as
/// 16-bit coefficients.
Header jpeg(const Bytes& b) {
  for (size_t at = 2; b.has(at, 2);) {
    const uint32_t marker = b.big(at + 1, 1);
    if (b.big(at, 1) != 0xFF || marker == 0xFF || marker == 0) {  // stray and fill bytes are skipped, as decoders do
      ++at;
      continue;
    }
    if (marker >= 0xD0 && marker <= 0xD8) {  // without a length
      at += 2;
      continue;
    }
    if (marker == 0xD9 || marker == 0xDA || !b.has(at, 4)) return {};
    const bool frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (frame)
      return b.has(at, 10) ? Header({"jpeg", b.big(at + 7, 2), b.big(at + 5, 2), 3 + 2 * b.big(at + 9, 1)}) : Header();
    at += 2 + b.big(at + 2, 2);
  }
  return {};
}

/// RFC 9649 2.7, RFC 6386 9.1. The library keeps two canvases and the frame.
Header webp(const Bytes& b) {
  constexpr uint32_t kScratch = 12;
  if (!b.has(0, 30)) return {};
  if (b.starts(12, "VP8X")) return ImageHeader{"webp", b.little(24, 3) + 1, b.little(27, 3) + 1, kScratch};
  if (b.starts(12, "VP8L")) {
    const uint32_t bits = b.little(21, 4);
    return ImageHeader{"webp", (bits & 0x3FFF) + 1, (bits >> 14 & 0x3FFF) + 1, kScratch};
  }
  if (b.starts(12, "VP8 ")) return ImageHeader{"webp", b.little(26, 2) & 0x3FFF, b.little(28, 2) & 0x3FFF, kScratch};
  return {};
}

}  // namespace

Header readImageHeader(std::span<const uint8_t> bytes) {
  const Bytes b(bytes);
  if (b.starts(0, "\x89PNG\r\n\x1a\n")) return png(b);
  if (b.starts(0, "\xff\xd8\xff")) return jpeg(b);
  if (b.starts(0, "RIFF") && b.starts(8, "WEBP")) return webp(b);
  return {};
}

std::string imageTooLarge(const ImageHeader& h) {
  if (h.width < 1 || h.height < 1 || h.width > gltf::kMaxImageExtent || h.height > gltf::kMaxImageExtent)
    return fmt::format("is {} x {} pixels; at most {} a side are accepted", h.width, h.height, gltf::kMaxImageExtent);
  if (h.scratchBytes() > gltf::kMaxImageScratch)
    return fmt::format("is {} x {} pixels and needs {} MiB to decode; {} MiB are accepted", h.width, h.height,
                       h.scratchBytes() >> 20, gltf::kMaxImageScratch >> 20);
  return "";
}

}  // namespace irad
