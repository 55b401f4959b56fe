#include "gi/stage_keys.h"

#include <functional>
#include <string_view>

namespace irad {
namespace {

void add(Digest& digest, const TextureUse& use) {
  digest.add(use.image).add(use.uvSet).add(use.transform);
  const SamplerDesc& s = use.sampler;
  digest.add(s.u).add(s.v).add(s.linearMag).add(s.linearMin).add(s.mips).add(s.linearMips);
  digest.add(s.anisotropic);
}

void add(Digest& digest, const Material& m) {
  digest.add(m.baseColor).add(m.metallic).add(m.roughness).add(m.emission);
  digest.add(m.normalScale).add(m.occlusionStrength).add(m.alphaCutoff).add(m.alpha);
  digest.add(m.doubleSided).add(m.lambertian);
  for (const TextureUse* use :
       {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.occlusionTexture, &m.emissiveTexture})
    add(digest, *use);
}

}  // namespace

Digest& Digest::add(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  // Order counts: 2^64 over the golden ratio keeps (a, b) and (b, a) apart, as do the shifts.
  value_ ^= std::hash<std::string_view>()(text) + 0x9e3779b97f4a7c15ull + (value_ << 6) + (value_ >> 2);
  return *this;
}

uint64_t surfaceContent(const Scene& scene) {
  Digest digest;
  digest.add(scene.origin).add(scene.boundsMin).add(scene.boundsMax);
  digest.add(scene.positions).add(scene.normals).add(scene.tangents);
  digest.add(scene.uv0).add(scene.uv1).add(scene.colors).add(scene.indices).add(scene.draws);
  for (const Material& m : scene.materials) add(digest, m);
  for (const SceneImage& image : scene.images)
    digest.add(image.width).add(image.height).add(image.srgb).add(image.rgba);
  return digest.value();
}

uint64_t shadowContent(const GpuLight& light) {
  return Digest().add(light.type).add(light.position).add(light.direction).add(light.range).add(light.outerCos).value();
}

uint64_t lightContent(std::span<const GpuLight> lights) {
  Digest digest;
  for (const GpuLight& light : lights)
    digest.add(shadowContent(light)).add(light.intensity).add(light.innerCos).add(light.size);
  return digest.value();
}

void StageKeys::forget(Redo from) {
  for (size_t stage = static_cast<size_t>(from); stage < of.size(); ++stage) of[stage] = 0;
}

StageKeys stageKeys(const SceneContent& content, const Settings& obeyed) {
  // Each stage reads its own settings,
  std::array<Digest, static_cast<size_t>(Redo::Nothing) + 1> own;
  for (const Setting& setting : settingTable()) own[static_cast<size_t>(setting.redo)].add(setting.get(obeyed));
  // a part of the scene, and what the stage before it has made.
  StageKeys keys;
  Digest chain;
  for (size_t stage = 0; stage < keys.of.size(); ++stage) {
    if (stage == static_cast<size_t>(Redo::Voxels)) chain.add(content.surfaces);
    if (stage == static_cast<size_t>(Redo::Gather)) chain.add(content.lights).add(content.sky);
    keys.of[stage] = chain.add(own[stage].value()).value();
  }
  return keys;
}

Redo firstDifference(const StageKeys& made, const StageKeys& wanted) {
  for (size_t stage = 0; stage < made.of.size(); ++stage)
    if (made.of[stage] != wanted.of[stage]) return static_cast<Redo>(stage);
  return Redo::Nothing;
}

Redo firstDifference(const Settings& made, const Settings& wanted) {
  return firstDifference(stageKeys({}, made), stageKeys({}, wanted));
}

}  // namespace irad
