// The settings that shaders read: the very structs that are uploaded (members of gi/settings.h's Settings).
#ifndef IRAD_SHARED_GI_PARAMS_H
#define IRAD_SHARED_GI_PARAMS_H
#include "shared/enumeration.h"
IRAD_BEGIN

// clang-format off
// thesis: first front face (d.n < 0), from the facet's voxel, back faces let through. triangles: docs/method.md 5.
#define IRAD_HIT_RULES(X, E) \
  X(E, thesis, "thesis", HIT_RULE_THESIS, 0) \
  X(E, triangles, "triangles", HIT_RULE_TRIANGLES, 1)
IRAD_SHARED_ENUM(HitRule, IRAD_HIT_RULES)

#define IRAD_TRAVERSALS(X, E) \
  X(E, dda, "dda", TRAVERSAL_DDA, 0) \
  X(E, sdf, "sdf", TRAVERSAL_SDF, 1)
IRAD_SHARED_ENUM(Traversal, IRAD_TRAVERSALS)

#define IRAD_SAMPLE_FILTERS(X, E) \
  X(E, nearest, "nearest", FILTER_NEAREST, 0) \
  X(E, linear,  "linear",  FILTER_LINEAR,  1) \
  X(E, blur,    "blur",    FILTER_BLUR,    2)
IRAD_SHARED_ENUM(SampleFilter, IRAD_SAMPLE_FILTERS)

// neutral: Khronos PBR Neutral (2024).
#define IRAD_TONE_CURVES(X, E) \
  X(E, linear,  "linear",  TONE_LINEAR,  0) \
  X(E, neutral, "neutral", TONE_NEUTRAL, 1)
IRAD_SHARED_ENUM(ToneCurve, IRAD_TONE_CURVES)
// clang-format on

struct MatrixParams {
  uint rays;  ///< R: rays per facet
  IRAD_AS(HitRule) hitRule;
  IRAD_AS(Traversal) traversal;
  IRAD_AS(Flag) jitter;  ///< Cranley-Patterson shift per voxel; else the same set everywhere
  uint seed;
  IRAD_EQUALITY(MatrixParams)
};

struct SolverParams {
  float lambda;  ///< T 4.3's gain; 1 leaves the physics alone
  float omega;   ///< under-relaxation, (0, 1]
  float flush;   ///< values below are set to zero, W/m^2
  IRAD_EQUALITY(SolverParams)
};

struct SampleParams {
  IRAD_AS(SampleFilter) filter_;
  IRAD_AS(Flag) premultiplied;
  float normalOffset;  ///< of the volume's lookup, along the normal, voxels
  IRAD_EQUALITY(SampleParams)
};

struct SpecularParams {
  uint rays;
  IRAD_AS(Traversal) traversal;
  float maxRoughness;     ///< rougher surfaces take H / pi instead of traced rays; 1: none does
  float metalRoughness;   ///< the same of those with F0 of METAL_F0 and more; in between for F0 in between
  float fade;             ///< width of the blend below these
  float threshold;        ///< skip where F0 x H is below this share of the largest H
  IRAD_AS(Flag) filter_;  ///< edge-aware filter over the G-buffer after tracing
  IRAD_EQUALITY(SpecularParams)
};

/// F0 of what reflects so much that one sees how rough metals reflect.
IRAD_CONST float DIELECTRIC_F0 = 0.04f;
IRAD_CONST float METAL_F0 = 0.2f;
/// From which roughness on a surface takes H / pi; more than any has where all are traced. `f0`: of its largest channel.
IRAD_FN float roughnessLimit(SpecularParams params, float f0) {
  float metal = min(max((f0 - DIELECTRIC_F0) / (METAL_F0 - DIELECTRIC_F0), 0.0f), 1.0f);
  float limit = params.maxRoughness + metal * (params.metalRoughness - params.maxRoughness);
  return limit < 1.0f ? limit : 2.0f;
}

/// Of writeback.mode = mask: which fragments write (T eq. 25-28, shared/writeback.h).
struct WritebackParams {
  float alpha;      ///< exponent of the distance from the camera, below 1
  float k;          ///< from the distance to a voxel's centre, voxels, to that from the camera, m^alpha
  float threshold;  ///< tau: the least score of a fragment that writes
  IRAD_EQUALITY(WritebackParams)
};

struct ShadeParams {
  float exposure;  ///< linear factor 2^EV
  IRAD_AS(ToneCurve) toneCurve;
  float shadowBias;              ///< normal offset, shadow texels
  uint pcf;                      ///< taps per axis: 1, 3 or 5
  IRAD_AS(Flag) specularDirect;  ///< GGX lobe of direct lights
  IRAD_EQUALITY(ShadeParams)
};

IRAD_END
#endif
