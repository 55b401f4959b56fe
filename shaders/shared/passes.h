// Push constants of the passes that make pictures (renderer/forward.cpp, gi/views.cpp, gi/specular.cpp).
#ifndef IRAD_SHARED_PASSES_H
#define IRAD_SHARED_PASSES_H
#include "shared/emitters.h"
#include "shared/facets.h"
#include "shared/gi_params.h"
#include "shared/grid.h"
#include "shared/matrix.h"
#include "shared/scene_gpu.h"
#include "shared/trace.h"
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

/// Lights that "RE Forward" reads through a uniform block; with more of them all are read by address.
IRAD_CONST uint UNIFORM_LIGHTS = 64u;

/// "RE Forward", drawing. What untextured fragments need of the material travels along: as constants it is read once,
/// not per lane.
struct ForwardPush {
  SceneArray scene;    ///< vertices
  CameraArray camera;  ///< vertices
  MaterialArray materials;
  LightArray lights;
  GridArray grid;  ///< of the volume; 0: there is none
  vec4 baseColor;
  vec3 emission;
  float metallic, roughness;
  uint flags;
  uint material;
  uint lightCount;
  float shadowBias;
  uint specularDirect;
  SampleParams sampling;
};

/// "RE Forward", forward/indirect.comp.
struct IndirectPush {
  CameraArray camera;
  GridArray grid;
  UintArray shape, reverse, around;  ///< of FacetArrays
  Vec4Array shaded;                  ///< H per facet
  Vec4Array shadedEmitted;           ///< F M per facet
  SampleParams sampling;
  uvec2 size;
};

/// Targets::glossy: three words of dispatch arguments, the number of pixels, then each pixel that traces, x | y << 16,
/// in no particular order.
IRAD_CONST uint GLOSSY_COUNT = 3u;
IRAD_CONST uint GLOSSY_FIRST = 4u;
IRAD_CONST uint GLOSSY_GROUP = 128u;  ///< pixels per workgroup

/// "RE Specular".
struct SpecularPush {
  CameraArray camera;
  Grid grid;
  FacetRecord facets;
  Vec4Array radiosity;
  ByteArray chebyshev;
  UintArray glossy;
  EmitterRecord emitters;  ///< 0: there are none
  SpecularParams params;
  float jfaMax;
  float leastReflected;  ///< no rays where F0 x H is below, W/m^2
};

/// Views over the targets (view/debug_view.comp) and over the voxels (view/voxel_view.comp).
struct ViewPush {
  CameraArray camera;
  Grid grid;
  FacetRecord facets;
  MatrixRecord matrix;
  Vec4Array values;     ///< per facet: H or B, as the view has it; 0: none
  UintArray chebyshev;  ///< 4 voxels per uint; 0: the volume is bound instead, or there is no field
  uint view;
  uint kind;
  float low, high;  ///< range of a scalar view
  float exposure;
  uint toneCurve;
  uint normalEncoding;
  uint rays;     ///< of a matrix row
  uint padded;   ///< 1: matrix.format padded
  float jfaMax;  ///< voxels that 1.0 of the bound volume stands for; 0: none bound
};

IRAD_END
#endif
