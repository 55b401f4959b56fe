#include "renderer/targets.h"

#include <algorithm>

#include "renderer/base/error.h"
#include "renderer/raster.h"
#include "shaders/shared/passes.h"
#include "shaders/shared/view.h"

namespace irad {
namespace {

constexpr VkFormat kHalf = VK_FORMAT_R16G16B16A16_SFLOAT, kFull = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkImageUsageFlags kColor = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT;

struct Optional {
  Image Targets::*image;
  uint32_t bit;
  const char* name;
  VkFormat format;
};
constexpr Optional kOptional[] = {
    {&Targets::f0, TARGET_F0, "specular reflectance", kHalf},
    {&Targets::highlight, TARGET_HIGHLIGHT, "highlights and emission", kFull},
    {&Targets::indirect, TARGET_INDIRECT, "indirect irradiance", kFull},
    {&Targets::emitted, TARGET_EMITTED, "irradiance of emitters", kFull},
    {&Targets::seen, 0, "seen share of emitters", kHalf},
    {&Targets::specular, TARGET_SPECULAR, "specular radiance", kFull},
};

const Optional& optional(Image Targets::*image) {
  const auto found =
      std::find_if(std::begin(kOptional), std::end(kOptional), [&](const Optional& o) { return o.image == image; });
  IRAD_CHECK(found != std::end(kOptional), "a target that is always there");
  return *found;
}

Image target(const Device& device, const char* name, VkFormat format, glm::uvec2 size, VkImageUsageFlags attachment) {
  ImageDesc desc;
  desc.name = name;
  desc.subsystem = Subsystem::Targets;
  desc.format = format;
  desc.width = size.x;
  desc.height = size.y;
  desc.usage =
      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | attachment;
  return Image(device, desc);
}

}  // namespace

Targets::Targets(Context& context, glm::uvec2 extent) : size(extent) {
  IRAD_CHECK(size.x > 0 && size.y > 0, "{} x {}", size.x, size.y);
  const Device& device = context.device;
  fitRaster(context, /*kernels*/ false, 0);
  normal = target(device, "normal, roughness", kHalf, size, kColor);
  geometric = target(device, "geometric normal, metallic", kHalf, size, kColor);
  albedo = target(device, "albedo, occlusion", kHalf, size, kColor);
  direct = target(device, "direct irradiance", kFull, size, kColor);
  viewRange = Buffer(device, "range of the view", Subsystem::Targets, sizeof(ViewRange));
  viewBins = Buffer(device, "histogram of the view", Subsystem::Targets, 4ull * RANGE_BINS);
  linear = target(device, "linear picture", kFull, size, kColor);
  display = target(device, "display picture", VK_FORMAT_R8G8B8A8_UNORM, size, kColor);
}

void Targets::fitRaster(Context& context, bool kernels, uint32_t triangles) {
  const Device& device = context.device;
  const VkFormat format = kernels ? VK_FORMAT_R32_SFLOAT : VK_FORMAT_D32_SFLOAT;
  if (depth.desc.format != format)
    depth = target(device, "depth", format, size,
                   kernels ? VK_IMAGE_USAGE_STORAGE_BIT : VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  if (kernels != static_cast<bool>(visible))
    visible = kernels ? Buffer(device, "visible triangles", Subsystem::Targets, 8ull * size.x * size.y) : Buffer();
  if (!kernels)
    for (Buffer* buffer : {&rasterQueue, &pixelLists, &listedPixels}) *buffer = Buffer();
  else if (!rasterQueue || rasterQueue.bytes < rasterQueueBytes(triangles))
    rasterQueue = makeRasterQueue(device, Subsystem::Targets, triangles);
}

void Targets::fitLayers(Context& context, bool wanted, bool tinted) {
  const Device& device = context.device;
  if ((wanted && tinted) != static_cast<bool>(shows))
    shows = wanted && tinted ? target(device, "what shows behind panes", kFull, size, kColor) : Image();
  if (wanted != static_cast<bool>(layers)) {
    layers = wanted ? target(device, "layers of glass", kFull, size, kColor) : Image();
    peeled = wanted ? target(device, "depth of the last layer", VK_FORMAT_R32_SFLOAT, size, VK_IMAGE_USAGE_STORAGE_BIT)
                    : Image();
  }
  const bool byKernels = wanted && visible;
  if (byKernels != static_cast<bool>(peeledVisible))
    peeledVisible =
        byKernels ? Buffer(device, "visible triangles of the last layer", Subsystem::Targets, visible.bytes) : Buffer();
}

void Targets::fit(Context& context, Image Targets::*image, bool wanted) {
  const Optional& o = optional(image);
  if (static_cast<bool>(this->*image) == wanted) return;
  this->*image = wanted ? target(context.device, o.name, o.format, size, kColor) : Image();
}

uint32_t Targets::present() const {
  uint32_t bits = 0;
  for (const Optional& o : kOptional)
    if (this->*o.image) bits |= o.bit;
  return bits;
}

const Image& Targets::bound(Image Targets::*image) const {
  if (this->*image) return this->*image;
  return optional(image).format == kHalf ? albedo : direct;
}

}  // namespace irad
