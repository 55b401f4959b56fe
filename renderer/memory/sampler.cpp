#include <algorithm>

#include "renderer/device_impl.h"
#include "renderer/vulkan_check.h"

namespace irad {
namespace {

VkSamplerAddressMode address(Wrap wrap) {
  switch (wrap) {
    case Wrap::Mirror:
      return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    case Wrap::Clamp:
      return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    default:
      return VK_SAMPLER_ADDRESS_MODE_REPEAT;
  }
}
VkFilter filter(bool linear) {
  return linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
}

}  // namespace

VkSampler sampler(const Device& device, const SamplerDesc& desc) {
  const std::lock_guard lock(device.impl_->samplerMutex);
  for (const auto& [known, sampler] : device.impl_->samplers)
    if (known == desc) return sampler;
  // Anisotropic filtering replaces the filters asked for, so it is used only where all of them are linear.
  const bool anisotropic = desc.anisotropic && device.anisotropy && desc.linearMag && desc.linearMin;
  const VkSamplerCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
      .magFilter = filter(desc.linearMag),
      .minFilter = filter(desc.linearMin),
      .mipmapMode = desc.linearMips ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST,
      .addressModeU = address(desc.u),
      .addressModeV = address(desc.v),
      .addressModeW =
          desc.u == Wrap::Clamp && desc.v == Wrap::Clamp ? VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE : address(desc.u),
      .anisotropyEnable = anisotropic ? VK_TRUE : VK_FALSE,
      .maxAnisotropy = anisotropic ? std::min(8.0f, device.limits.maxSamplerAnisotropy) : 1.0f,
      .maxLod = desc.mips ? VK_LOD_CLAMP_NONE : 0.0f};
  VkSampler sampler = VK_NULL_HANDLE;
  vkCheck(vkCreateSampler(device.handle, &info, nullptr, &sampler), "creating a sampler");
  device.impl_->samplers.emplace_back(desc, sampler);
  return sampler;
}

VkSampler pointSampler(const Device& device) {
  SamplerDesc nearest{Wrap::Clamp, Wrap::Clamp, /*linearMag*/ false, /*linearMin*/ false, /*mips*/ false};
  nearest.linearMips = false;
  return sampler(device, nearest);
}

}  // namespace irad
