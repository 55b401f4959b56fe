// The forward pass: depth prepass, then one pass over the materials that writes what every picture is composed from.
// Direct light comes from the shadow-mapped lights, indirect diffuse light from the facets (or the thesis's volume).
#pragma once

#include "renderer/frame.h"
#include "renderer/gpu_scene.h"
#include "renderer/shadow.h"
#include "shaders/shared/facets.h"
#include "shaders/shared/gi_params.h"
#include "shaders/shared/grid.h"

namespace irad {

/// Per-pixel results of the forward pass. fp32 where light is held, so that emission from 1e-6 to 1e6 survives. Between
/// the fragment stage and forward/indirect.comp, `indirect` holds the local position and `emitted` the lookup's normal.
struct Targets {
  Targets() = default;
  Targets(Context& context, glm::uvec2 size);
  glm::uvec2 size{0};
  Image depth;       ///< D32, 1 = nothing
  Image normal;      ///< RGBA16F: shading normal xyz, roughness
  Image geometric;   ///< RGBA16F: geometric normal xyz (towards the viewer), metallic
  Image albedo;      ///< RGBA16F: diffuse albedo (base colour x (1 - metallic)), occlusion
  Image f0;          ///< RGBA16F: specular reflectance at normal incidence; w: 1 = has a specular lobe
  Image direct;      ///< RGBA32F: direct irradiance D, W/m^2 (sun, spot, point)
  Image highlight;   ///< RGBA32F: outgoing radiance: direct lights' specular lobe + emission (w: emission luminance)
  Image indirect;    ///< RGBA32F: indirect irradiance H, W/m^2
  Image emitted;     ///< RGBA32F: the part of H that comes straight from emissive facets (F M); 0 where no view asks
  Image specular;    ///< RGBA32F: reflected radiance of indirect specular light (BRDF included)
  Buffer glossy;     ///< pixels that trace specular rays (shaders/shared/passes.h)
  Image linear;      ///< RGBA32F: the view's result, before exposure, tone curve or colour map; alpha 0: nothing drawn
  Buffer viewRange;  ///< one ViewRange (shaders/shared/view.h), of views that have one
  Buffer viewBins;   ///< histogram of their values
  Image display;     ///< RGBA8: what is shown and written as PNG (sRGB-encoded)
};

/// Where shading finds indirect light. Null pointers: there is none (H = 0).
struct IndirectInputs {
  const Buffer* grid = nullptr;           ///< one Grid
  const Buffer* shape = nullptr;          ///< facet words
  const Buffer* reverse = nullptr;        ///< voxel -> facet
  const Buffer* around = nullptr;         ///< corners' neighbours
  const Buffer* shaded = nullptr;         ///< vec4 per facet: H
  const Buffer* shadedEmitted = nullptr;  ///< vec4 per facet: F M; null: not wanted, Targets::emitted stays 0
  const Image* volume = nullptr;          ///< RGBA16F, the thesis's lookup (gated off)
  uint32_t normalEncoding = 3;
  SampleParams sample{};
};

GpuCamera makeGpuCamera(const Scene& scene, const Camera& camera, glm::uvec2 size);
void drawForward(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const IndirectInputs& indirect,
                 const Buffer& camera, const ShadeParams& shade, Targets& targets);

}  // namespace irad
