#include "renderer/gpu_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <iterator>

#include "renderer/base/error.h"
#include "renderer/frame/record.h"
#include "renderer/scene/material_edits.h"
#include "renderer/scene/mips.h"
#include "renderer/scene/texel_range.h"

namespace irad {
namespace {

Image uploadTexture(Context& context, const SceneImage& source, AlphaMode alpha = AlphaMode::Opaque) {
  IRAD_CHECK_OP(source.rgba.size(), ==, 4ull * source.width * source.height);
  ImageDesc desc;
  desc.name = source.name.empty() ? "texture" : source.name;
  desc.subsystem = Subsystem::Scene;
  desc.format = source.srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
  desc.width = source.width;
  desc.height = source.height;
  desc.mips = mipCount(source.width, source.height);
  desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  Image image(context.device, desc);
  upload(context, image, std::as_bytes(std::span(source.rgba)));
  uint32_t mip = 0;
  for (const MipLevel& level : mipLevels(source, alpha))
    upload(context, image, std::as_bytes(std::span(level.rgba)), ++mip);
  return image;
}

Image constantTexture(Context& context, const char* name, std::array<uint8_t, 4> texel) {
  return uploadTexture(context, SceneImage{name, 1, 1, false, {texel.begin(), texel.end()}});
}

GpuMaterial toGpu(const Material& m) {
  GpuMaterial gpu{};
  gpu.baseColor = m.baseColor;
  gpu.emission = m.emission;
  gpu.metallic = m.metallic;
  gpu.roughness = m.roughness;
  gpu.normalScale = m.normalScale;
  gpu.occlusionStrength = m.occlusionStrength;
  gpu.alphaCutoff = m.alphaCutoff;
  if (m.alpha == AlphaMode::Mask) gpu.flags |= MATERIAL_ALPHA_MASK;
  if (m.alpha == AlphaMode::Blend) {
    gpu.flags |= MATERIAL_ALPHA_MASK | MATERIAL_BLEND;
    gpu.alphaCutoff = 0.5f;  // where it is taken for a mask
  }
  gpu.transmission = m.transmission;
  if (m.transmission > 0) {
    gpu.flags |= MATERIAL_ALPHA_MASK | MATERIAL_BLEND | MATERIAL_TRANSMISSIVE;
    gpu.alphaCutoff = m.alpha == AlphaMode::Blend ? -1.0f : m.alpha == AlphaMode::Mask ? m.alphaCutoff : 0.0f;
  }
  if (m.doubleSided) gpu.flags |= MATERIAL_DOUBLE_SIDED;
  if (m.lambertian) gpu.flags |= MATERIAL_LAMBERTIAN;
  const auto uses = texturesOf(m);
  for (uint32_t i = 0; i < MATERIAL_TEXTURES; ++i) {
    const TextureUse& use = *uses[i];
    if (use.image >= 0) gpu.flags |= MATERIAL_BASE_COLOR_TEXTURE << i;
    if (use.uvSet == 1) gpu.uvSets |= 1u << i;
    const glm::mat3x2& t = use.transform;
    gpu.uvRow[2 * i] = {t[0][0], t[1][0], t[2][0]};
    gpu.uvRow[2 * i + 1] = {t[0][1], t[1][1], t[2][1]};
  }
  return gpu;
}

GpuLight toGpu(const Light& light, const glm::dvec3& origin) {
  GpuLight gpu{};
  gpu.type = static_cast<uint32_t>(light.type);
  gpu.shadowLayer = -1;
  gpu.shadowFilter = ShadowFilter::pcf;
  gpu.shadowMatrix = glm::mat4(1.0f);
  gpu.direction = {0, -1, 0};
  gpu.innerCos = 1;
  // All that are off are alike: editing one redoes nothing.
  if (!light.on) return gpu;
  gpu.position = glm::vec3(light.position - origin);
  gpu.direction = light.direction;
  gpu.range = light.range;
  gpu.intensity = light.color * light.intensity;
  gpu.innerCos = light.innerCos;
  gpu.outerCos = light.outerCos;
  gpu.size = lightKind(light.type).has(LIGHT_DISTANT) ? std::tan(0.5f * glm::radians(light.angle)) : light.radius;
  return gpu;
}

template <class T>
Buffer uploadArray(Context& context, const char* name, const std::vector<T>& values) {
  return makeBuffer(context, name, Subsystem::Scene, std::span<const T>(values));
}

}  // namespace

SceneOnDevice::SceneOnDevice(Context& context, const Scene& source) : scene(source) {
  static_assert(MATERIAL_TRANSMISSION_TEXTURE == MATERIAL_BASE_COLOR_TEXTURE << TEXTURE_TRANSMISSION);

  // Vertices and triangles.
  positions = uploadArray(context, "positions", scene.positions);
  normals = uploadArray(context, "normals", scene.normals);
  tangents = uploadArray(context, "tangents", scene.tangents);
  uv0 = uploadArray(context, "uv0", scene.uv0);
  uv1 = uploadArray(context, "uv1", scene.uv1);
  colors = uploadArray(context, "colors", scene.colors);
  indices = uploadArray(context, "indices", scene.indices);
  std::vector<uint32_t> owners(scene.triangleCount(), 0);
  for (const Draw& draw : scene.draws)
    std::fill_n(owners.begin() + draw.firstIndex / 3, draw.indexCount / 3, draw.material);
  triangleMaterials = uploadArray(context, "triangle materials", owners);

  // Materials and their textures; a material without one gets a constant (white, or the flat normal).
  materialValues = gpuMaterials(scene.materials);
  materials = uploadArray(context, "materials", materialValues);
  textures.reserve(scene.images.size() + 2);
  for (size_t i = 0; i < scene.images.size(); ++i)
    textures.push_back(uploadTexture(context, scene.images[i], alphaOf(scene, i)));
  const size_t white = textures.size();
  textures.push_back(constantTexture(context, "white", {255, 255, 255, 255}));
  const size_t flat = textures.size();
  textures.push_back(constantTexture(context, "flat normal", {128, 128, 255, 255}));
  std::vector<MaterialTextures> bound;
  for (const Material& m : fileMaterials(scene)) {
    MaterialTextures& set = bound.emplace_back();
    const auto uses = texturesOf(m);
    for (uint32_t i = 0; i < MATERIAL_TEXTURES; ++i) {
      const size_t image = uses[i]->image >= 0   ? static_cast<size_t>(uses[i]->image)
                           : i == TEXTURE_NORMAL ? flat
                                                 : white;
      set.views[i] = textures.at(image).view;
      set.samplers[i] = sampler(context.device, uses[i]->sampler);
    }
  }
  materialSets = MaterialSets(context, bound);
  surveyMaterials();

  // Lights, and the record whose address every geometry pass gets.
  setLights(context, gpuLights(scene.lights, scene.origin));
}

bool SceneOnDevice::emits(uint32_t material, const glm::vec3& factor) {
  glm::vec3 most = factor;
  if (const int image = scene.materials.at(material).emissiveTexture.image; image >= 0 && factor != glm::vec3(0)) {
    const auto [at, fresh] = brightest_.try_emplace(image);
    if (fresh) at->second = texelRange(scene.images.at(static_cast<size_t>(image))).most;
    most *= at->second;
  }
  return std::max({most.x, most.y, most.z}) > 0.0f;
}

void SceneOnDevice::surveyMaterials() {
  anyEmission = anyAlphaMask = false;
  for (const Draw& draw : scene.draws) {
    const GpuMaterial& m = materialValues.at(draw.material);
    anyEmission = anyEmission || emits(draw.material, m.emission);
    anyAlphaMask = anyAlphaMask || (m.flags & MATERIAL_ALPHA_MASK) != 0;
  }
}

void SceneOnDevice::setMaterials(Context& context, std::vector<GpuMaterial> values) {
  IRAD_CHECK_OP(values.size(), ==, materialValues.size());
  upload(context, materials, std::as_bytes(std::span<const GpuMaterial>(values)));
  materialValues = std::move(values);
  surveyMaterials();
}

void SceneOnDevice::setLights(Context& context, std::vector<GpuLight> values, const LightFilter& shines) {
  std::vector<GpuLight> some;
  std::copy_if(values.begin(), values.end(), std::back_inserter(some), shines);
  Buffer all = uploadArray(context, "lights", values), those = uploadArray(context, "shining lights", some);
  RecordMaker maker(context, "scene record", Subsystem::Scene, sizeof(GpuScene));
  GpuScene gpu{};
  gpu.positions = maker.of(positions);
  gpu.normals = maker.of(normals);
  gpu.tangents = maker.of(tangents);
  gpu.uv0 = maker.of(uv0);
  gpu.uv1 = maker.of(uv1);
  gpu.colors = maker.of(colors);
  gpu.indices = maker.of(indices);
  gpu.triangleMaterials = maker.of(triangleMaterials);
  gpu.materials = maker.of(materials);
  gpu.lights = maker.of(those);
  gpu.lightCount = static_cast<uint32_t>(some.size());
  gpu.triangleCount = scene.triangleCount();
  record = maker.make(gpu);
  lights = std::move(all);
  shiningLights = std::move(those);
  lightValues = std::move(values);
  shining = std::move(some);
}

bool hasIntensity(const GpuLight& light) {
  return std::max({light.intensity.x, light.intensity.y, light.intensity.z}) > 0.0f;
}

std::vector<GpuMaterial> gpuMaterials(const std::vector<Material>& materials) {
  std::vector<GpuMaterial> values;
  for (const Material& m : materials) values.push_back(toGpu(m));
  return values;
}

std::vector<GpuLight> gpuLights(const std::vector<Light>& lights, const glm::dvec3& origin) {
  std::vector<GpuLight> values;
  for (const Light& light : lights) values.push_back(toGpu(light, origin));
  return values;
}

}  // namespace irad
