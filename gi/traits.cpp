#include "gi/traits.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "renderer/gpu_scene.h"
#include "renderer/scene/texel_range.h"
#include "shaders/shared/emitters.h"
#include "shaders/shared/voxelize.h"

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
  if (m.lambertian) {
    t.albedo = largest(base);
  } else {
    const TexelRange rough = texels(m.metallicRoughnessTexture);
    t.albedo = largest(base) * (1 - std::min(m.metallic * rough.least.b, 1.0f));
    // A black metal reflects as well, at grazing angles.
    const float least = std::numeric_limits<float>::min();
    t.f0 = std::max({least, 0.04f * (1 - std::min(m.metallic * rough.least.b, 1.0f)),
                     largest(base) * std::min(m.metallic * rough.most.b, 1.0f)});
    t.leastRoughness = std::min(m.roughness * rough.least.g, 1.0f);
  }
  t.normalMap = m.normalTexture.image >= 0;
  t.alphaTest = m.alpha == AlphaMode::Mask || (m.alpha == AlphaMode::Blend && m.baseColorTexture.image >= 0);
  return t;
}

/// Whether every pair of faces is nearer than ELSEWHERE_COSINE: all lie within half that angle about their mean.
bool allFaceOneWay(const Scene& scene) {
  for (const Draw& draw : scene.draws)
    if (scene.materials.at(draw.material).doubleSided) return false;
  std::vector<glm::dvec3> normals;
  glm::dvec3 mean(0);
  for (size_t i = 0; i + 2 < scene.indices.size(); i += 3) {
    const glm::dvec3 a = scene.positions[scene.indices[i]], b = scene.positions[scene.indices[i + 1]],
                     c = scene.positions[scene.indices[i + 2]];
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const double area = glm::length(n);
    if (!(area > 0)) return false;  // it may face anywhere
    normals.push_back(n / area);
    mean += normals.back();
  }
  if (normals.empty()) return true;
  const double length = glm::length(mean);
  if (!(length > 0)) return false;
  const double half = std::cos(0.5 * std::acos(double{ELSEWHERE_COSINE})) + 1e-3;  // rounding on the device
  return std::all_of(normals.begin(), normals.end(),
                     [&](const glm::dvec3& n) { return glm::dot(n, mean / length) > half; });
}

/// Whether a light's cone meets the sphere around the bounds.
bool coneReaches(const GpuLight& light, const glm::dvec3& centre, double radius) {
  const glm::dvec3 to = centre - glm::dvec3(light.position);
  const double distance = glm::length(to);
  if (!(distance > radius)) return true;
  const double off = std::acos(std::clamp(glm::dot(glm::dvec3(light.direction), to) / distance, -1.0, 1.0));
  const double outer = std::acos(std::clamp(double{light.outerCos}, -1.0, 1.0));
  return off - std::asin(radius / distance) <= outer + 1e-3;
}

bool reachesBounds(const GpuLight& light, const Scene& scene, double margin) {
  if (scene.triangleCount() == 0) return false;
  if (lightHas(light.type, LIGHT_DISTANT)) return true;
  const glm::dvec3 lo = glm::dvec3(scene.boundsMin) - margin, hi = glm::dvec3(scene.boundsMax) + margin;
  const glm::dvec3 position(light.position);
  const double distance = glm::distance(glm::clamp(position, lo, hi), position);
  if (light.range > 0 && !(distance <= double{light.range} * (1 + 1e-5))) return false;
  return !lightHas(light.type, LIGHT_CONE) || coneReaches(light, 0.5 * (lo + hi), 0.5 * glm::length(hi - lo));
}

}  // namespace

LightTraits measureLight(const GpuLight& light, const Scene& scene, uint32_t resolution) {
  LightTraits t;
  t.type = static_cast<LightType>(light.type);
  t.shines = light.intensity != glm::vec3(0);  // what is no number, or negative, is left to the numerical watch
  const double voxel = largest(scene.boundsMax - scene.boundsMin) / resolution;
  t.reaches = reachesBounds(light, scene, 2 * voxel);
  t.nears = t.reaches || reachesBounds(light, scene, 4 * voxel);
  t.cube = lightUsesCube(light.type, light.outerCos);
  return t;
}

SceneTraits measure(const Scene& scene, uint32_t resolution) {
  SceneTraits traits;
  traits.facesOneWay = allFaceOneWay(scene);
  std::map<int, TexelRange> images;  // each is read once
  const Texels texels = [&](const TextureUse& use) {
    if (use.image < 0) return TexelRange{glm::vec4(1), glm::vec4(1)};
    const auto [at, fresh] = images.try_emplace(use.image);
    if (fresh) at->second = texelRange(scene.images.at(static_cast<size_t>(use.image)));
    return at->second;
  };
  traits.materials.resize(scene.materials.size());
  for (const Draw& draw : scene.draws) {
    MaterialTraits& t = traits.materials.at(draw.material);
    if (t.triangles == 0) t = measureMaterial(scene.materials.at(draw.material), texels);
    t.triangles += draw.indexCount / 3;
  }
  for (const GpuLight& light : gpuLights(scene.lights, scene.origin))
    traits.lights.push_back(measureLight(light, scene, resolution));
  return traits;
}

}  // namespace irad
