// Depth alone, of the scene or some of its triangles through one projection: "RE Shadow", "RE Depth", outlines.
#pragma once

#include "renderer/frame/frame.h"
#include "renderer/gpu_scene.h"

namespace irad {

struct DepthPass {
  const char* stage;
  const Image& target;  ///< D32, cleared to 0: the far plane's depth; the near plane's is 1
  int layer = 0;
  const Buffer& projections;
  uint64_t offset = 0;                       ///< of the Projection in `projections`, bytes
  bool cull = false;                         ///< backs of single-sided materials
  bool alphaTest = true;                     ///< false: masked materials are opaque
  bool blended = true;                       ///< false: blended materials are left out
  uint32_t screens = 0;                      ///< DepthPush::screens
  const Image* peeled = nullptr;             ///< R32F: depth that blended materials are behind
  const std::vector<Draw>* draws = nullptr;  ///< null: all of the scene's
};

/// Opaque triangles in as few draws as their culling allows, then masked materials, which read their textures.
void drawDepth(Frame& frame, const SceneOnDevice& scene, const DepthPass& pass);

}  // namespace irad
