// Set 1 of the passes that draw materials.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "renderer/frame/context.h"
#include "shaders/shared/scene_gpu.h"

namespace irad {

/// What a material's set 1 holds, in the order of Context::materialLayout.
struct MaterialTextures {
  std::array<VkImageView, MATERIAL_TEXTURES> views{};
  std::array<VkSampler, MATERIAL_TEXTURES> samplers{};
};

/// The descriptor sets of a scene's materials and the pool they come from.
class MaterialSets {
 public:
  MaterialSets() = default;
  MaterialSets(const Context& context, std::span<const MaterialTextures> materials);
  VkDescriptorSet at(size_t material) const { return sets_.at(material); }

 private:
  struct Retire {
    const Device* device;
    void operator()(VkDescriptorPool pool) const;
  };
  std::unique_ptr<std::remove_pointer_t<VkDescriptorPool>, Retire> pool_;
  std::vector<VkDescriptorSet> sets_;
};

}  // namespace irad
