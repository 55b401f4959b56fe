// What every stage's product is made of, as one number each: equal numbers, equal products. A stage is due where its
// number is not the one that its product was made by, so that what was changed and changed back costs nothing. Nothing
// else decides that. (Whether settings differ at all, in what redoes no stage too, is ==.)
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "gi/settings.h"
#include "renderer/scene/scene.h"
#include "shaders/shared/scene_gpu.h"

namespace irad {

/// The number of a sequence of values, byte by byte, in order.
class Digest {
 public:
  Digest& add(std::span<const std::byte> bytes);
  template <class T>
  Digest& add(const std::vector<T>& values) {
    return add(std::as_bytes(std::span(values)));
  }
  /// For types without padding.
  template <class T>
  Digest& add(const T& value) {
    return add(std::as_bytes(std::span(&value, 1)));
  }
  /// Never 0.
  uint64_t value() const { return value_ != 0 ? value_ : 1; }

 private:
  uint64_t value_ = 0;
};

/// Keys of the part of a scene that stages read. The numbers hold within this process; another one's may differ.
struct SceneContent {
  uint64_t surfaces = 0;  ///< where surfaces are: vertices, triangles, alpha masks, which sides show
  uint64_t lights = 0;
  uint64_t sky = 0;        ///< texels of a picture of it
  uint64_t materials = 0;  ///< all there is to them, with every texel
  uint64_t emission = 0;   ///< of that what emits
  uint64_t region = 0;     ///< that has voxels
};
/// The keys of a scene's surfaces and materials, under edits too: what these leave alone is looked at once.
class SurfaceContent {
 public:
  explicit SurfaceContent(const Scene& scene);
  uint64_t surfaces(std::span<const Material> materials) const;
  uint64_t materials(std::span<const Material> materials) const;
  uint64_t emission(std::span<const Material> materials) const;

 private:
  void add(Digest& digest, const TextureUse& use) const;
  uint64_t geometry_ = 0;
  std::vector<uint64_t> images_;
};
/// Without what drawShadows fills in.
uint64_t lightContent(std::span<const GpuLight> lights);
/// The key of what shadow maps depend on: all of a light but its colour and intensity.
uint64_t shadowContent(const GpuLight& light);

/// By stage, Redo::Voxels to Redo::Scatter; 0: it has no product. Each holds the numbers of those stages before it
/// whose products it reads: rays do not ask what colour they meet, nor lights what emits, so that a stage may be due
/// while one after it is not.
struct StageKeys {
  std::array<uint64_t, static_cast<size_t>(Redo::Shade)> of{};
  uint64_t& operator[](Redo stage) { return of[static_cast<size_t>(stage)]; }
  uint64_t operator[](Redo stage) const { return of[static_cast<size_t>(stage)]; }
  /// The products of `stage` and of those that come of it are gone, or are no longer what they were made as.
  void forget(Redo stage);
};
/// `obeyed`: the settings that stages get (obeyed() of gi/plan.h).
StageKeys stageKeys(const SceneContent& content, const Settings& obeyed);
/// The first stage of which they differ; Redo::Nothing: they are the same.
Redo firstDifference(const StageKeys& made, const StageKeys& wanted);
/// The stages of which they differ.
class StagesDue {
 public:
  StagesDue() = default;
  StagesDue(const StageKeys& made, const StageKeys& wanted);
  static StagesDue from(Redo first);  ///< and all after it
  void add(Redo stage) { bits_ |= 1u << static_cast<uint32_t>(stage); }
  void add(StagesDue others) { bits_ |= others.bits_; }
  bool has(Redo stage) const { return (bits_ >> static_cast<uint32_t>(stage) & 1) != 0; }

 private:
  uint32_t bits_ = 0;
};
/// The same for one scene under two settings.
Redo firstDifference(const Settings& made, const Settings& wanted);

}  // namespace irad
