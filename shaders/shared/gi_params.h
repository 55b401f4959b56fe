// The settings that shaders read: the very structs that are uploaded (members of gi/settings.h's Settings).
#ifndef IRAD_SHARED_GI_PARAMS_H
#define IRAD_SHARED_GI_PARAMS_H
#include "shared/types.h"
IRAD_BEGIN

// matrix.hit_rule
IRAD_CONST uint HIT_RULE_THESIS = 0u;  ///< first front face (d.n < 0), from the facet's voxel; back faces let through
IRAD_CONST uint HIT_RULE_ROBUST = 1u;  ///< METHOD section 5
// matrix.traversal, specular.traversal
IRAD_CONST uint TRAVERSAL_DDA = 0u;
IRAD_CONST uint TRAVERSAL_SDF = 1u;
// field.method: which field an sdf traversal reads
IRAD_CONST uint FIELD_CHEBYSHEV = 0u;
IRAD_CONST uint FIELD_JFA = 1u;
// sample.filter
IRAD_CONST uint FILTER_NEAREST = 0u;
IRAD_CONST uint FILTER_LINEAR = 1u;
IRAD_CONST uint FILTER_BLUR = 2u;
// camera tone curve
IRAD_CONST uint TONE_LINEAR = 0u;
IRAD_CONST uint TONE_NEUTRAL = 1u;  ///< Khronos PBR Neutral (2024)

struct MatrixParams {
  uint rays;       ///< N: rays per facet
  uint hitRule;
  uint traversal;
  uint jitter;     ///< 1: Cranley-Patterson shift per voxel; 0: the same set everywhere
  uint seed;
};

struct SolverParams {
  float lambda;  ///< T eq. 23's gain; 1 leaves the physics alone
  float omega;   ///< under-relaxation, (0, 1]
  float flush;   ///< values below are set to zero, W/m^2
};

struct SampleParams {
  uint filter_;
  uint premultiplied;
  uint gated;        ///< 1: taps go to facets that face the same way; 0: the thesis's volume lookups
  float normalOffset;  ///< lookup offset along the normal, voxels
};

struct SpecularParams {
  uint rays;
  uint traversal;
  float maxRoughness;  ///< rougher surfaces take H / pi instead of traced rays
  float fade;          ///< width of the blend below maxRoughness
  float threshold;     ///< skip where F0 x H is below this share of the largest H
  uint filter_;        ///< 1: edge-aware filter over the G-buffer after tracing
};

struct ShadeParams {
  float exposure;    ///< linear factor 2^EV
  uint toneCurve;
  float shadowBias;  ///< normal offset, shadow texels
  uint pcf;          ///< taps per axis: 1, 3 or 5
  uint specularDirect;  ///< 1: GGX lobe of direct lights
};

IRAD_END
#endif
