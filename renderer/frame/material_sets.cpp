#include "renderer/frame/material_sets.h"

#include "renderer/pipeline_build.h"
#include "renderer/vulkan_check.h"

namespace irad {

MaterialSets::MaterialSets(const Context& context, std::span<const MaterialTextures> materials) {
  if (materials.empty()) return;
  const VkDevice device = context.device.handle;
  const auto count = static_cast<uint32_t>(materials.size());
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, count * MATERIAL_TEXTURES};
  const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                        .maxSets = count,
                                        .poolSizeCount = 1,
                                        .pPoolSizes = &size};
  VkDescriptorPool pool = VK_NULL_HANDLE;
  vkCheck(vkCreateDescriptorPool(device, &info, nullptr, &pool), "creating a material descriptor pool");
  pool_ = {pool, Retire{&context.device}};
  const std::vector<VkDescriptorSetLayout> layouts(count, context.materialLayout());
  const VkDescriptorSetAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                             .descriptorPool = pool,
                                             .descriptorSetCount = count,
                                             .pSetLayouts = layouts.data()};
  sets_.resize(count);
  vkCheck(vkAllocateDescriptorSets(device, &allocate, sets_.data()), "allocating the materials' descriptor sets");
  for (uint32_t m = 0; m < count; ++m) {
    VkDescriptorImageInfo images[MATERIAL_TEXTURES];
    VkWriteDescriptorSet writes[MATERIAL_TEXTURES];
    for (uint32_t i = 0; i < MATERIAL_TEXTURES; ++i) {
      images[i] = {materials[m].samplers[i], materials[m].views[i], VK_IMAGE_LAYOUT_GENERAL};
      writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                   .dstSet = sets_[m],
                   .dstBinding = i,
                   .descriptorCount = 1,
                   .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                   .pImageInfo = &images[i]};
    }
    vkUpdateDescriptorSets(device, MATERIAL_TEXTURES, writes, 0, nullptr);
  }
}

void MaterialSets::Retire::operator()(VkDescriptorPool pool) const {
  device->retire([handle = device->handle, pool] { vkDestroyDescriptorPool(handle, pool, nullptr); });
}

}  // namespace irad
