// Shadow maps: suns and spots in one 2D depth array, points and wide spots in a cube array. Redrawn only when a light
// or the geometry changes. The lookup (shaders/forward/shadow.glsl) is one function for pictures and for compute
// passes that gather direct light.
#pragma once

#include <array>

#include "renderer/frame/frame.h"
#include "renderer/gpu_scene.h"
#include "shaders/shared/scene_gpu.h"

namespace irad {

struct ShadowMaps {
  // D32 or R32F, reversed (1 near, 0 far). With ShadowFilter::vsm RGBA32F: that in red, and in green and blue the
  // filtered moments (raster/shadow_moments.comp).
  Image flat;                          ///< layers: sun and spot lights; empty where none shines
  Image cubes;                         ///< cube array: point lights and wide spots; empty where none shines
  VkSampler sampler = VK_NULL_HANDLE;  ///< nearest
};
/// The next two bindings of the pass: shadowFlat and shadowCubes of shaders/forward/shadow.glsl.
Pass& sampleShadows(Pass& pass, const ShadowMaps& maps);

struct ShadowNeeds {
  LightFilter shines = hasIntensity;  ///< lights that get a map
  bool alphaTest = true;              ///< DepthPass::alphaTest
  bool tinted = false;                ///< three layers for each light, or cubes: a channel's each
  bool kernels = false;               ///< who rasterizes (renderer/raster.h)
  ShadowFilter filter = ShadowFilter::pcf;
  uint32_t taps = 3;            ///< vsm: moments are means over so many texels per axis, odd
  float bleedReduction = 0.3f;  ///< GpuLight::bleedReduction
  uint32_t points = 16;         ///< GpuLight::points
};
/// Bytes that a texel of a map takes.
uint64_t shadowTexelBytes(ShadowFilter filter);
/// Which layer is each light's; -1: it has no map, and casts no shadow. Of lights that shine these are the weakest,
/// where the device has not the layers for all.
std::vector<int> shadowLayers(const Device& device, std::span<const GpuLight> lights, const ShadowNeeds& needs);
/// Draws the maps ("RE Shadow") and fills in every light's layer and matrix. `resolution`: texels per side of a flat
/// map, twice those of a cube's; where lights are too many those that take more have less. DeviceError when the device
/// has not the memory.
ShadowMaps drawShadows(Context& context, const SceneOnDevice& scene, std::vector<GpuLight>& lights, uint32_t resolution,
                       const ShadowNeeds& needs = {});
/// The same for the scene's own lights, which are uploaded again. When it throws, they and their maps stay as they
/// were.
ShadowMaps drawShadows(Context& context, SceneOnDevice& scene, uint32_t resolution, const ShadowNeeds& needs = {});
/// Fills in what drawShadows has filled in for the same lights, of which only colours, intensities and sizes have
/// changed.
void keepShadows(std::vector<GpuLight>& lights, std::span<const GpuLight> drawn);

/// Kinds of light that shine, by LightType, and what some light of them asks for.
struct LightKinds {
  std::array<bool, LIGHT_KINDS> shines{};
  bool sizes = false;    ///< penumbrae
  bool filters = false;  ///< another filter than ShadowFilter::pcf
  static constexpr LightKinds all() {
    LightKinds kinds;
    kinds.shines.fill(true);
    kinds.sizes = kinds.filters = true;
    return kinds;
  }
  bool& operator[](LightType type) { return shines.at(static_cast<size_t>(type)); }
  bool operator[](LightType type) const { return shines.at(static_cast<size_t>(type)); }
};
LightKinds kindsOf(std::span<const GpuLight> shining);
/// Sets the constants of shaders/forward/shadow.glsl, which begin at `first`, for a pass that sums up the lights
/// `shining`, none of another kind.
void specialize(Pass& pass, uint32_t first, const LightKinds& kinds, std::span<const GpuLight> shining);

}  // namespace irad
