#include "gi/stage_keys.h"

#include <algorithm>
#include <functional>
#include <string_view>
#include <tuple>

#include "renderer/scene/material_edits.h"

namespace irad {
namespace {

void addUse(Digest& digest, const TextureUse& use) {
  digest.add(use.image).add(use.uvSet).add(use.transform);
  const SamplerDesc& s = use.sampler;
  digest.add(s.u).add(s.v).add(s.linearMag).add(s.linearMin).add(s.mips).add(s.linearMips);
  digest.add(s.anisotropic);
}

void addMaterial(Digest& digest, const Material& m) {
  digest.add(m.baseColor).add(m.metallic).add(m.roughness).add(m.emission);
  digest.add(m.normalScale).add(m.occlusionStrength).add(m.alphaCutoff).add(m.alpha);
  digest.add(m.doubleSided).add(m.lambertian).add(m.transmission);
  for (const TextureUse* use : texturesOf(m)) addUse(digest, *use);
}

}  // namespace

Digest& Digest::add(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  // Order counts: 2^64 over the golden ratio keeps (a, b) and (b, a) apart, as do the shifts.
  value_ ^= std::hash<std::string_view>()(text) + 0x9e3779b97f4a7c15ull + (value_ << 6) + (value_ >> 2);
  return *this;
}

SurfaceContent::SurfaceContent(const Scene& scene) {
  Digest digest;
  digest.add(scene.origin).add(scene.boundsMin).add(scene.boundsMax);
  digest.add(scene.positions).add(scene.normals).add(scene.tangents);
  digest.add(scene.uv0).add(scene.uv1).add(scene.colors).add(scene.indices).add(scene.draws);
  geometry_ = digest.value();
  for (const SceneImage& image : scene.images)
    images_.push_back(Digest().add(image.width).add(image.height).add(image.srgb).add(image.rgba).value());
}

/// With its texels.
void SurfaceContent::add(Digest& digest, const TextureUse& use) const {
  addUse(digest, use);
  if (use.image >= 0) digest.add(images_.at(static_cast<size_t>(use.image)));
}

uint64_t SurfaceContent::surfaces(std::span<const Material> materials) const {
  Digest digest;
  digest.add(geometry_);
  for (const Material& m : materials) {
    const bool tinted = m.transmission > 0, holes = cutByAlpha(m) || m.alpha == AlphaMode::Blend || tinted;
    digest.add(m.doubleSided).add(holes);
    if (!holes) continue;
    if (tinted) {
      digest.add(m.transmission).add(m.baseColor).add(m.lambertian).add(m.metallic);
      add(digest, m.transmissionTexture);
      add(digest, m.metallicRoughnessTexture);
    }
    digest.add(m.alpha).add(m.alphaCutoff).add(m.baseColor.a);
    add(digest, m.baseColorTexture);
  }
  return digest.value();
}

uint64_t SurfaceContent::materials(std::span<const Material> materials) const {
  Digest digest;
  digest.add(images_);
  for (const Material& m : materials) addMaterial(digest, m);
  return digest.value();
}

uint64_t SurfaceContent::emission(std::span<const Material> materials) const {
  Digest digest;
  for (size_t i = 0; i < materials.size(); ++i) {
    const Material& m = materials[i];
    if (m.emission == glm::vec3(0)) continue;
    digest.add(i).add(m.emission);
    add(digest, m.emissiveTexture);
  }
  return digest.value();
}

uint64_t shadowContent(const GpuLight& light) {
  // The map of a distant light has room for its penumbrae.
  const float size = lightHas(light.type, LIGHT_DISTANT) ? light.size : 0.0f;
  return Digest()
      .add(light.type)
      .add(light.position)
      .add(light.direction)
      .add(light.range)
      .add(light.outerCos)
      .add(size)
      .value();
}

uint64_t lightContent(std::span<const GpuLight> lights) {
  Digest digest;
  for (const GpuLight& light : lights)
    digest.add(shadowContent(light)).add(light.intensity).add(light.innerCos).add(light.size);
  return digest.value();
}

namespace {

constexpr std::array kStages{Redo::Voxels,   Redo::Field,  Redo::Matrix, Redo::Materials,
                             Redo::Emission, Redo::Gather, Redo::Solve,  Redo::Scatter};

/// The stages before `stage` whose products it reads.
std::span<const Redo> readBy(Redo stage) {
  static constexpr Redo kVoxels[]{Redo::Voxels}, kField[]{Redo::Field}, kMatrix[]{Redo::Matrix},
      kLight[]{Redo::Materials, Redo::Emission, Redo::Gather}, kSolve[]{Redo::Solve};
  switch (stage) {
    case Redo::Field:
    case Redo::Materials:
      return kVoxels;
    case Redo::Matrix:
      return kField;
    case Redo::Emission:  // and M: SceneContent::emission with the settings of Redo::Materials
    case Redo::Gather:
      return kMatrix;
    case Redo::Solve:
      return kLight;
    case Redo::Scatter:
      return kSolve;
    default:
      return {};
  }
}

}  // namespace

void StageKeys::forget(Redo stage) {
  static_assert(kStages.size() == std::tuple_size_v<decltype(of)>);
  (*this)[stage] = 0;
  for (const Redo later : kStages)
    if (later > stage && std::ranges::any_of(readBy(later), [&](Redo read) { return (*this)[read] == 0; }))
      (*this)[later] = 0;
}

StageKeys stageKeys(const SceneContent& content, const Settings& obeyed) {
  // Each stage reads its own settings,
  std::array<Digest, static_cast<size_t>(Redo::Nothing) + 1> own;
  for (const Setting& setting : settingTable()) own[static_cast<size_t>(setting.redo)].add(setting.get(obeyed));
  // a part of the scene, and what stages before it have made.
  StageKeys keys;
  for (const Redo stage : kStages) {
    Digest digest;
    for (const Redo read : readBy(stage)) digest.add(keys[read]);
    if (stage == Redo::Voxels) digest.add(content.surfaces).add(content.region);
    if (stage == Redo::Materials) digest.add(content.materials);
    if (stage == Redo::Emission) digest.add(content.emission).add(own[static_cast<size_t>(Redo::Materials)].value());
    if (stage == Redo::Gather) digest.add(content.lights).add(content.sky);
    keys[stage] = digest.add(own[static_cast<size_t>(stage)].value()).value();
  }
  return keys;
}

StagesDue::StagesDue(const StageKeys& made, const StageKeys& wanted) {
  for (const Redo stage : kStages)
    if (made[stage] != wanted[stage]) add(stage);
}

StagesDue StagesDue::from(Redo first) {
  StagesDue due;
  for (const Redo stage : kStages)
    if (stage >= first) due.add(stage);
  return due;
}

Redo firstDifference(const StageKeys& made, const StageKeys& wanted) {
  for (const Redo stage : kStages)
    if (made[stage] != wanted[stage]) return stage;
  return Redo::Nothing;
}

Redo firstDifference(const Settings& made, const Settings& wanted) {
  return firstDifference(stageKeys({}, made), stageKeys({}, wanted));
}

}  // namespace irad
