// What a pass gathers before it is recorded. Private to renderer/.
#pragma once

#include "renderer/format.h"
#include "renderer/frame/frame_impl.h"

namespace irad {

inline constexpr VkAccessFlags2 kStorageRead = VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
inline constexpr VkAccessFlags2 kStorageWrite =
    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
inline constexpr Use kColorTarget{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                  VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
inline constexpr VkPipelineStageFlags2 kDepthStages =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
inline constexpr Use kDepthRead{kDepthStages, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT};
inline constexpr Use kDepthWrite{
    kDepthStages, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
/// Fills, updates and clears; layers and drivers differ on which of the two stages a fill belongs to.
inline constexpr Use kClear{VK_PIPELINE_STAGE_2_CLEAR_BIT | VK_PIPELINE_STAGE_2_COPY_BIT,
                            VK_ACCESS_2_TRANSFER_WRITE_BIT};
inline constexpr Use kCopyFrom{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
inline constexpr Use kCopyTo{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
inline constexpr Use kIndexInput{VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT};
inline constexpr Use kIndirect{VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT};

inline VkImageAspectFlags aspect(const Image& image) {
  return formatInfo(image.desc.format).kind == TexelKind::Depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

struct Pass::State {
  PipelineRequest pipeline;

  struct BufferUse {
    BufferPlace* place;
    bool write, commutes;
  };
  struct Bound {
    const Image* image;
    bool write, alias;
    VkSampler sampler;                ///< null: a storage image
    const Buffer* uniform = nullptr;  ///< in place of an image
  };
  struct Declared {
    ResourceState* state;
    const Image* image;  ///< null: a buffer
    Use use;
  };
  std::vector<BufferUse> buffers;
  std::vector<uint64_t> addresses;  ///< that the pass gave out
  bool recorded = false;
  std::vector<Bound> bound;  ///< binding 0, 1, 2 ... of set 0
  std::vector<Declared> declared;

  struct Color {
    const Image* image;  ///< null: the output is dropped
    std::optional<ClearColor> clear;
  };
  std::vector<Color> colors;
  const Buffer* indices = nullptr;
  const Image* depth = nullptr;
  std::optional<float> depthClear;
  int depthLayer = 0;
  uint32_t width = 0, height = 0;
  float biasConstant = 0, biasSlope = 0;

  /// Adds a use, merged with earlier ones of the same resource.
  void add(ResourceState& state, const Image* image, const Use& use) {
    for (Declared& d : declared)
      if (d.state == &state) {
        d.use.stages |= use.stages;
        d.use.access |= use.access;
        d.use.commutes &= use.commutes;
        return;
      }
    declared.push_back({&state, image, use});
  }
  void use(BufferPlace& place, bool write, bool commutes) {
    buffers.push_back({&place, write, commutes});
    addresses.push_back(place.address);
    for (const auto& held : place.holds) use(*held, /*write*/ false, /*commutes*/ false);
  }
  /// What in(), out(), read() and their like have named, turned into uses at these stages.
  void resolveUses(VkPipelineStageFlags2 stages) {
    for (const BufferUse& b : buffers)
      add(b.place->state, nullptr, {stages, b.write ? kStorageWrite : kStorageRead, b.commutes});
    for (const Bound& i : bound) {
      if (i.uniform) {
        add(i.uniform->state(), nullptr, {stages, VK_ACCESS_2_UNIFORM_READ_BIT});
        continue;
      }
      const VkAccessFlags2 storage = i.write ? kStorageWrite : kStorageRead;
      add(i.image->state, i.image, {stages, i.sampler ? VK_ACCESS_2_SHADER_SAMPLED_READ_BIT : storage});
    }
    for (const Color& c : colors)
      if (c.image) add(c.image->state, c.image, kColorTarget);
    if (depth) add(depth->state, depth, pipeline.raster.depthWrite || depthClear ? kDepthWrite : kDepthRead);
  }
};

}  // namespace irad
