// Push constants of indirect light in pictures (gi/indirect.cpp, gi/specular.cpp).
#ifndef IRAD_SHARED_INDIRECT_H
#define IRAD_SHARED_INDIRECT_H
#include "shared/emitters.h"
#include "shared/facets.h"
#include "shared/gi_params.h"
#include "shared/grid.h"
#include "shared/picked.h"
#include "shared/scene_gpu.h"
#include "shared/sky.h"
#include "shared/surface.h"
#include "shared/trace.h"
IRAD_BEGIN

/// "RE Forward", gi/indirect_links.comp.
struct IndirectPush {
  CameraArray camera;
  GridArray grid;
  UintArray reverse, voxel;  ///< of FacetArrays
  SurfaceRecord surface;
  Vec4Array shaded;         ///< H per facet
  Vec4Array shadedEmitted;  ///< F M per facet
  Vec4Array direct;         ///< D per facet; 0: no light shines, or none is asked for
  UintArray sought;         ///< Targets::sought or, of later parts of the search, Targets::soughtAround
  UintArray soughtAround;   ///< Targets::soughtAround, which the search's first part fills; 0: it has one part
  UintArray doubted;        ///< Targets::doubted, where there is `direct`
  UintArray facet;          ///< Targets::facet; 0: none is asked for
  SampleParams sampling;
  uvec2 size;
  uint part;  ///< of the search, where it has several
};

/// Parts of the search for a pixel's facet where one invocation does it alone: 0 is the pixel's voxel and, of a point that
/// rounding has put into another, the next ones; 1 + i is voxel i of the 27 around, for pixels that are left. Mesa's CPU
/// driver ends all loops of eight invocations side by side after 65,535 rounds, which 27 crowded voxels take more than
/// together, and one far fewer.
IRAD_CONST uint SOUGHT_PARTS = 28u;
IRAD_CONST uint SOUGHT_OWN = 14u;  ///< the pixel's voxel once more: left out

/// gi/direct_seen.comp.
struct DirectSeenPush {
  CameraArray camera;
  SceneArray scene;
  FacetArrays facets;  ///< by value
  SurfaceRecord surface;
  ByteArray chebyshev;
  UintArray doubted;  ///< Targets::doubted
  vec3 origin;        ///< of the grid, local
  float edge;
  uvec3 dims;
};

/// "RE Specular".
struct SpecularPush {
  CameraArray camera;
  FacetRecord facets;
  SurfaceRecord surface;  ///< of rule `triangles`
  Vec4Array radiosity;
  ByteArray chebyshev;
  UintArray glossy;       ///< Targets::glossy
  EmitterRecord emitters;  ///< 0: there are none
  SkyRecord sky;           ///< 0: there is none
  uvec3 dims;              ///< these three: of the Grid
  vec3 origin;
  float inverseEdge;
  SpecularParams params;
  float jfaMax;
  float leastReflected;  ///< no rays where F0 x H is below, W/m^2
};

IRAD_END
#endif
