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

/// Keys of the part of a scene that stages read. The numbers hold within this process; another one's may differ.
struct SceneContent {
  uint64_t surfaces = 0;  ///< vertices, triangles, materials, every texel
  uint64_t lights = 0;
  uint64_t sky = 0;  ///< texels of a picture of it
};
uint64_t surfaceContent(const Scene& scene);
/// Without what drawShadows fills in.
uint64_t lightContent(std::span<const GpuLight> lights);
/// The key of what shadow maps depend on: all of a light but its colour and intensity.
uint64_t shadowContent(const GpuLight& light);

/// By stage, Redo::Voxels to Redo::Scatter; 0: it has no product. Each holds the number of the stage before it.
struct StageKeys {
  std::array<uint64_t, static_cast<size_t>(Redo::Shade)> of{};
  /// The products of `from` and of the stages after it are gone, or are no longer what they were made as.
  void forget(Redo from);
};
/// `obeyed`: the settings that stages get (obeyed() of gi/plan.h).
StageKeys stageKeys(const SceneContent& content, const Settings& obeyed);
/// The first stage of which they differ; Redo::Nothing: they are the same.
Redo firstDifference(const StageKeys& made, const StageKeys& wanted);
/// The same for one scene under two settings.
Redo firstDifference(const Settings& made, const Settings& wanted);

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

}  // namespace irad
