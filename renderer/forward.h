// The forward pass: depth prepass, then one pass over the materials that writes what every picture is composed from.
// Direct light comes from the shadow-mapped lights, indirect diffuse light from the facets (or the thesis's volume).
#pragma once

#include "renderer/frame.h"
#include "renderer/gpu_scene.h"
#include "renderer/shadow.h"
#include "renderer/targets.h"
#include "shaders/shared/facets.h"
#include "shaders/shared/gi_params.h"
#include "shaders/shared/grid.h"

namespace irad {

/// What the forward pass computes. An effect that is false has no code, loop, fetch, pass or target. Left out where the
/// scene has no such thing the picture is the same, bit for bit.
struct ForwardEffects {
  LightKinds lights;
  bool emission = true;   ///< of materials
  bool alphaTest = true;  ///< masked materials; false: opaque
  bool normalMap = true;
  bool highlights = true;  ///< the lights' specular lobe
  bool indirect = true;    ///< H
  bool specular = true;    ///< what reflections are traced from: Targets::f0
  bool kernels = false;    ///< no effect: who rasterizes (renderer/raster.h)
};

/// Where shading finds indirect light. Null pointers: there is none, and no Targets::indirect.
struct IndirectInputs {
  const Buffer* grid = nullptr;           ///< one Grid
  const Buffer* shape = nullptr;          ///< facet words
  const Buffer* reverse = nullptr;        ///< voxel -> facet
  const Buffer* around = nullptr;         ///< corners' neighbours
  const Buffer* shaded = nullptr;         ///< vec4 per facet: H
  const Buffer* shadedEmitted = nullptr;  ///< vec4 per facet: F M; null: not wanted, no Targets::emitted
  bool keepPosition = false;              ///< of the pixel, local space, in Targets::linear
  const Image* volume = nullptr;          ///< RGBA16F, the thesis's lookup (gated off)
  uint32_t normalEncoding = 3;
  SampleParams sample{};
};

GpuCamera makeGpuCamera(const Scene& scene, const Camera& camera, glm::uvec2 size);
void drawForward(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const IndirectInputs& indirect,
                 const Buffer& camera, const ShadeParams& shade, Targets& targets, const ForwardEffects& effects = {});

}  // namespace irad
