// Writeback of reflections (docs/method.md 8, T 5.12): which fragments the thesis's mask selects, and the records of
// the kernels.
#ifndef IRAD_SHARED_WRITEBACK_H
#define IRAD_SHARED_WRITEBACK_H
#include "shared/facets.h"
#include "shared/gi_params.h"
#include "shared/scene_gpu.h"
#include "shared/types.h"
IRAD_BEGIN

/// T eq. 25-28: the score of a fragment, 0 to 1. `distance_`: from the camera, m; `v`: the fragment's position in
/// voxels, a voxel being a unit cube; `normal`: of its surface, unit.
IRAD_FN float writebackScore(float distance_, vec3 v, vec3 normal, WritebackParams params) {
  float d = pow(distance_, params.alpha);
  vec3 g = v - floor(v);
  vec3 centred = g + (vec3(0.5f) - g) * abs(normal);  // mix(g, 0.5, |n|)
  float s = length(centred - vec3(0.5f));
  return clamp(1.0f - params.k * s / d, 0.0f, 1.0f);
}
/// Whether the fragment writes.
IRAD_FN bool writebackSelects(float distance_, vec3 v, vec3 normal, WritebackParams params) {
  return writebackScore(distance_, v, normal, params) >= params.threshold;
}

/// Where the images that hold a texel per facet have a facet's.
IRAD_CONST uint WRITEBACK_IMAGE_WIDTH = 1024u;
IRAD_FN ivec2 writebackTexel(uint facet) {
  return ivec2(int(facet % WRITEBACK_IMAGE_WIDTH), int(facet / WRITEBACK_IMAGE_WIDTH));
}

/// rho + s of a facet is at most this over max(1, lambda), so that the loop of picture and light has a gain below 1.
IRAD_CONST float WRITEBACK_GAIN = 0.95f;

/// What a picture's writeback counts. Floats >= 0 as bits, so that the largest is the same whatever the order.
IRAD_CONST uint WRITEBACK_BINS = 9u;  ///< 0, 1, ... 7 writers, 8 and more
struct WritebackCounts {
  uint brightest;                ///< largest B or pi x radiance from beyond the scene: what a pixel may reflect, W/m^2
  uint most;                     ///< largest value of a pixel, W/m^2
  uint change;                   ///< largest |W as drawn - W as used|, W/m^2
  uint largest;                  ///< largest W as drawn, W/m^2
  uint writers[WRITEBACK_BINS];  ///< visible facets with so many writers
  uint stores;                   ///< pixels that wrote
};
IRAD_ARRAY(WritebackCountsArray, WritebackCounts, 4)

/// The sums of a facet's pixels are integers, which add up to the same bits in any order: a pixel's value in steps of the
/// largest one, whose three bytes have a word each, low ones first, so that 2^24 pixels fit. (As 64-bit integers, made of
/// floats, they had no more than 7 bits on an H200: there uint(uint64_t(x)) seems to be uint(x), which saturates.)
IRAD_CONST uint WRITEBACK_PARTS = 3u;
IRAD_CONST float WRITEBACK_STEPS = 16777215.0f;  ///< 2^24 - 1

/// Passes over pixels (specular/writeback_pixel.glsl).
struct WritebackPush {
  CameraArray camera;
  Uvec2Array albedo;   ///< of FacetArrays
  UintArray reverse;   ///< of FacetArrays, where pixels have no `facet`
  UintArray facet;     ///< Targets::facet; 0: the first facet of the voxel
  UintArray pixels;    ///< per facet: how many see it
  UintArray writers;   ///< per facet: how many of these write; of the mask
  UintArray sums;      ///< per facet: of its pixels' values; of mode compute
  WritebackCountsArray counts;
  vec3 origin;  ///< these three: of the Grid
  float inverseEdge;
  uvec3 dims;
  float gain;  ///< what rho + s is at most
  WritebackParams params;
};

/// Passes over facets: specular/writeback_clear.comp and specular/writeback_facets.comp.
struct WritebackFacetsPush {
  Vec4Array radiosity;
  UintArray pixels, writers, sums;
  WritebackCountsArray counts;
  Vec4Array used;   ///< W that the light was solved with
  Vec4Array drawn;  ///< W of this picture; w: writers
  uint facets;
  float flush;  ///< W/m^2: less becomes 0
};

IRAD_END
#endif
