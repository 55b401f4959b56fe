// The image formats in use: names for tables and bytes for copies.
#pragma once

#include <volk.h>

#include <cstdint>

namespace irad {

enum class TexelKind { Float, Unorm, Uint, Sint, Depth };

struct FormatInfo {
  const char* name;  ///< GLSL's layout qualifier where it has one
  uint32_t bytes;    ///< per texel
  TexelKind kind;
  bool srgb = false;
};

/// A format outside the table is a broken invariant.
FormatInfo formatInfo(VkFormat format);

}  // namespace irad
