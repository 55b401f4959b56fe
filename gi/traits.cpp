#include "gi/traits.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <span>

#include "renderer/gpu_scene.h"
#include "renderer/scene/material_edits.h"
#include "shaders/shared/emitters.h"

namespace irad {
namespace {

float largest(const glm::vec3& v) {
  return std::max({v.x, v.y, v.z});
}

/// What a texture's texels hold; 1 for a material without the texture.
using Texels = std::function<TexelRange(const TextureUse&)>;

MaterialTraits measureMaterial(const Material& m, const Texels& texels) {
  MaterialTraits t;
  // A factor of 0 settles it without a look at the texture.
  if (largest(m.emission) > 0) {
    const glm::vec3 radiance = m.emission * glm::vec3(texels(m.emissiveTexture).most);
    // A channel that luminance() weighs lightly still emits.
    if (largest(radiance) > 0) t.emission = std::max(luminance(radiance), std::numeric_limits<float>::min());
  }
  const glm::vec3 base = glm::min(glm::vec3(m.baseColor) * glm::vec3(texels(m.baseColorTexture).most), 1.0f);
  float dielectric = 1;
  if (!m.lambertian) {
    const TexelRange rough = texels(m.metallicRoughnessTexture);
    dielectric -= std::min(m.metallic * rough.least.b, 1.0f);
    // A black metal reflects as well, at grazing angles.
    t.f0 = std::max({std::numeric_limits<float>::min(), 0.04f * dielectric,
                     largest(base) * std::min(m.metallic * rough.most.b, 1.0f)});
    t.leastRoughness = std::min(m.roughness * rough.least.g, 1.0f);
  }
  t.albedo = largest(base) * dielectric;
  t.normalMap = m.normalTexture.image >= 0;
  t.evenEmission = m.emissiveTexture.image < 0 && m.alpha != AlphaMode::Mask;
  t.alphaTest = m.alpha == AlphaMode::Mask;
  t.tinted = m.transmission * texels(m.transmissionTexture).most.r * dielectric > 0;
  t.glass = t.tinted || (m.alpha == AlphaMode::Blend && m.baseColor.a * texels(m.baseColorTexture).least.a < 1);
  t.cutIfOpaque = m.alpha == AlphaMode::Blend && cutByAlpha(m);
  return t;
}

/// How far the scene's bounds are from what a light's range leaves, and the sphere around them from its cone, m.
double gapTo(const GpuLight& light, const Scene& scene) {
  if (scene.triangleCount() == 0) return std::numeric_limits<double>::infinity();
  if (lightHas(light.type, LIGHT_DISTANT)) return 0;
  const glm::dvec3 lo(scene.boundsMin), hi(scene.boundsMax), position(light.position), to = 0.5 * (lo + hi) - position;
  double gap = 0;
  if (light.range > 0) gap = glm::distance(glm::clamp(position, lo, hi), position) - double{light.range} * (1 + 1e-5);
  if (!lightHas(light.type, LIGHT_CONE)) return gap;
  const auto angle = [](double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); };
  const double distance = glm::length(to), off = angle(glm::dot(glm::dvec3(light.direction), to) / distance);
  const double beside = std::clamp(off - angle(double{light.outerCos}) - 1e-3, 0.0, 0.5 * std::numbers::pi);
  return std::max(gap, distance * std::sin(beside) - 0.5 * glm::length(hi - lo));
}

}  // namespace

LightTraits measureLight(const GpuLight& light, const Scene& scene, uint32_t resolution) {
  LightTraits t;
  t.type = static_cast<LightType>(light.type);
  t.shines = light.intensity != glm::vec3(0);  // what is no number, or negative, is left to the numerical watch
  t.cube = lightUsesCube(light.type, light.outerCos);
  t.size = light.size > 0;
  const double voxel = largest(scene.boundsMax - scene.boundsMin) / resolution, gap = gapTo(light, scene);
  if (gap > 0) t.gap = static_cast<float>(gap / voxel);
  return t;
}

void measureMaterials(const Scene& scene, const std::vector<Material>& materials, SceneTraits& traits) {
  const Texels texels = [&](const TextureUse& use) {
    if (use.image < 0) return TexelRange{glm::vec4(1), glm::vec4(1)};
    const auto [at, fresh] = traits.texels.try_emplace(use.image);
    if (fresh) at->second = texelRange(scene.images.at(static_cast<size_t>(use.image)));
    return at->second;
  };
  traits.materials.assign(materials.size(), {});
  for (const Draw& draw : scene.draws) {
    MaterialTraits& t = traits.materials.at(draw.material);
    if (t.triangles == 0) t = measureMaterial(materials.at(draw.material), texels);
    t.triangles += draw.indexCount / 3;
    if (materials.at(draw.material).alpha == AlphaMode::Blend && !t.glass)
      t.glass = std::ranges::any_of(std::span(scene.indices).subspan(draw.firstIndex, draw.indexCount),
                                    [&](uint32_t vertex) { return scene.colors[vertex].a < 1; });
    traits.emitted |= t.emission > 0;
  }
}

SceneTraits measure(const Scene& scene, uint32_t resolution) {
  SceneTraits traits;
  measureMaterials(scene, scene.materials, traits);
  for (const GpuLight& light : gpuLights(scene.lights, scene.origin))
    traits.lights.push_back(measureLight(light, scene, resolution));
  return traits;
}

}  // namespace irad
