#include "renderer/format.h"

#include "renderer/base/error.h"

namespace irad {

FormatInfo formatInfo(VkFormat format) {
  using enum TexelKind;
  switch (format) {
    case VK_FORMAT_R8_UNORM:
      return {"r8", 1, Unorm};
    case VK_FORMAT_R8G8_UNORM:
      return {"rg8", 2, Unorm};
    case VK_FORMAT_R8G8B8A8_UNORM:
      return {"rgba8", 4, Unorm};
    case VK_FORMAT_R8G8B8A8_SNORM:
      return {"rgba8_snorm", 4, Unorm};
    case VK_FORMAT_R8G8B8A8_SRGB:
      return {"srgb8_alpha8", 4, Unorm, true};
    case VK_FORMAT_B8G8R8A8_UNORM:
      return {"bgra8", 4, Unorm};
    case VK_FORMAT_B8G8R8A8_SRGB:
      return {"bgra8_srgb", 4, Unorm, true};
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
      return {"rgb10_a2", 4, Unorm};
    case VK_FORMAT_R16_UNORM:
      return {"r16", 2, Unorm};
    case VK_FORMAT_R16G16_UNORM:
      return {"rg16", 4, Unorm};
    case VK_FORMAT_R16G16B16A16_UNORM:
      return {"rgba16", 8, Unorm};
    case VK_FORMAT_R16G16_SNORM:
      return {"rg16_snorm", 4, Unorm};
    case VK_FORMAT_R16_SFLOAT:
      return {"r16f", 2, Float};
    case VK_FORMAT_R16G16_SFLOAT:
      return {"rg16f", 4, Float};
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return {"rgba16f", 8, Float};
    case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
      return {"r11f_g11f_b10f", 4, Float};
    case VK_FORMAT_R32_SFLOAT:
      return {"r32f", 4, Float};
    case VK_FORMAT_R32G32_SFLOAT:
      return {"rg32f", 8, Float};
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return {"rgba32f", 16, Float};
    case VK_FORMAT_R8_UINT:
      return {"r8ui", 1, Uint};
    case VK_FORMAT_R8G8_UINT:
      return {"rg8ui", 2, Uint};
    case VK_FORMAT_R8G8B8A8_UINT:
      return {"rgba8ui", 4, Uint};
    case VK_FORMAT_R16_UINT:
      return {"r16ui", 2, Uint};
    case VK_FORMAT_R16G16_UINT:
      return {"rg16ui", 4, Uint};
    case VK_FORMAT_R16G16B16A16_UINT:
      return {"rgba16ui", 8, Uint};
    case VK_FORMAT_R32_UINT:
      return {"r32ui", 4, Uint};
    case VK_FORMAT_R32G32_UINT:
      return {"rg32ui", 8, Uint};
    case VK_FORMAT_R32G32B32A32_UINT:
      return {"rgba32ui", 16, Uint};
    case VK_FORMAT_R8_SINT:
      return {"r8i", 1, Sint};
    case VK_FORMAT_R16_SINT:
      return {"r16i", 2, Sint};
    case VK_FORMAT_R32_SINT:
      return {"r32i", 4, Sint};
    case VK_FORMAT_R64_UINT:
      return {"r64ui", 8, Uint};
    case VK_FORMAT_D16_UNORM:
      return {"d16", 2, Depth};
    case VK_FORMAT_D32_SFLOAT:
      return {"d32f", 4, Depth};
    default:
      invariantFailed(__FILE__, __LINE__, fmt::format("VkFormat {} is not in the table", static_cast<int>(format)));
  }
}

}  // namespace irad
