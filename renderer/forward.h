// The forward pass: depth prepass, then one pass over the materials that writes what every picture is composed from.
// Direct light comes from the shadow-mapped lights; who adds indirect light finds in the targets where to look it up.
#pragma once

#include "renderer/frame/frame.h"
#include "renderer/gpu_scene.h"
#include "renderer/shadow.h"
#include "renderer/targets.h"
#include "shaders/shared/gi_params.h"

namespace irad {

/// What the forward pass computes. An effect that is false has no code, loop, fetch, pass or target. Where the scene
/// has no such thing, leaving it out gives the same picture, bit for bit.
struct ForwardEffects {
  LightKinds lights = LightKinds::all();
  bool emission = true;   ///< of materials
  bool alphaTest = true;  ///< masked materials; false: opaque
  bool normalMap = true;
  bool glass = true;       ///< blended materials
  bool tinted = false;     ///< panes that tint what passes: lights have a map for each channel (ShadowNeeds::tinted)
  Layer layer = {};        ///< not an effect: the layer that is drawn
  bool highlights = true;  ///< the lights' specular lobe
  /// Without a VolumeLookup for a later pass that looks indirect light up: Targets::indirect gets every pixel's
  /// position (local space; w = 0 where nothing is drawn), Targets::linear its normal.
  bool indirect = true;
  bool specular = true;  ///< what reflections are traced from: Targets::f0
  bool kernels = false;  ///< not an effect: who rasterizes (renderer/raster.h)

  /// What the picture at hand is for. What it is not for is left out of its passes like an effect that is off, but
  /// keeps its target, for the next picture.
  struct Wanted {
    bool surfaces = true;     ///< normals and albedo; false: depth alone, and nothing of the rest
    bool direct = true;       ///< light that comes straight from lights, and what materials emit
    bool indirect = true;     ///< what indirect light is looked up by
    bool reflections = true;  ///< what reflections are traced from
  } wanted;
};

/// The thesis's indirect light (T 5.10, eq. 24), looked up while a pixel is shaded, into Targets::indirect. `volume`
/// null: there is none.
struct VolumeLookup {
  const Image* volume = nullptr;  ///< RGBA16F, one texel per voxel
  const Buffer* grid = nullptr;   ///< one Grid
  SampleParams sample{};
};

GpuCamera makeGpuCamera(const Scene& scene, const Camera& camera, glm::uvec2 size);
/// Zero in every target where nothing is drawn, in Targets::emitted everywhere.
void drawForward(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const Buffer& camera,
                 const ShadeParams& shade, Targets& targets, const ForwardEffects& effects = {},
                 const VolumeLookup& lookup = {});

}  // namespace irad
