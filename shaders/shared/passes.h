// Push constants of the passes that make pictures (renderer/forward.cpp, gi/views.cpp, gi/specular.cpp).
#ifndef IRAD_SHARED_PASSES_H
#define IRAD_SHARED_PASSES_H
#include "shared/facets.h"
#include "shared/gi_params.h"
#include "shared/grid.h"
#include "shared/scene_gpu.h"
IRAD_BEGIN

struct Projection {
  mat4 matrix;
};
IRAD_ARRAY(ProjectionArray, Projection, 16)

/// "RE Shadow" and "RE Depth".
struct DepthPush {
  SceneArray scene;
  ProjectionArray projection;  ///< local position -> clip; a GpuCamera starts with it
  uint material;
  uint padding;
};

/// "RE Forward".
struct ForwardPush {
  SceneArray scene;
  CameraArray camera;
  GridArray grid;
  FacetRecord facets;
  Vec4Array shaded;         ///< H per facet
  Vec4Array shadedEmitted;  ///< F M per facet
  SampleParams sampling;
  uint normalEncoding;
  uint hasIndirect;
  uint material;
  float shadowBias;
  uint pcf;
  uint specularDirect;
};

IRAD_END
#endif
