// Size and cost of an encoded image from its first bytes, before any library allocates for it: decoders take the size
// that a file states at its word, and 200 bytes may state gigabytes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace irad {

struct ImageHeader {
  const char* format = nullptr;  ///< "png", "jpeg", "webp": by content; a file's MIME type and name may lie
  uint32_t width = 0, height = 0;
  uint32_t scratch = 0;  ///< bytes per pixel that decoding holds beside the result, at most

  uint64_t resultBytes() const { return uint64_t{4} * width * height; }  ///< RGBA, 8 bits per channel
  uint64_t scratchBytes() const { return uint64_t{scratch} * width * height; }
};

/// nullopt where the bytes are neither PNG, JPEG nor WebP, or end before the size is stated.
std::optional<ImageHeader> readImageHeader(std::span<const uint8_t> bytes);

/// Why an image of this size is not decoded, in words; empty where it is.
std::string imageTooLarge(const ImageHeader& header);

}  // namespace irad
