// Light from a sky (docs/method.md 6): bins of directions, by which rays that escape are kept, and the picture of the whole
// sphere that the bins' light, reflections and backgrounds are read from. Directions are the world's.
#ifndef IRAD_SHARED_SKY_H
#define IRAD_SHARED_SKY_H
#include "shared/matrix.h"
#include "shared/trace.h"
IRAD_BEGIN

/// The bins are the squares of a cube around the origin, SKY_EDGE x SKY_EDGE on each face. The number is even, so that
/// the planes between the axes are borders: a floor or a wall along them has no bin on both sides of its horizon.
IRAD_CONST uint SKY_EDGE = 8u;
IRAD_CONST uint SKY_BINS = 6u * SKY_EDGE * SKY_EDGE;
/// Of a matrix row's entries behind those of its facets: bin | hits << SKY_BIN_BITS. Bins from SKY_BINS on are points of
/// what lies outside the grid (shared/outer.h).
IRAD_CONST uint SKY_BIN_BITS = 19u;
IRAD_CONST uint MOST_OUTER_POINTS = (1u << SKY_BIN_BITS) - SKY_BINS;

/// The bin of a direction of any length > 0, of those with `edge` x `edge` squares on a face.
IRAD_FN uint skyBin(vec3 d, uint edge) {
  vec3 a = abs(d);
  uint axis = a.x >= a.y && a.x >= a.z ? 0u : (a.y >= a.z ? 1u : 2u);
  float along = axis == 0u ? d.x : (axis == 1u ? d.y : d.z);
  vec2 aside = axis == 0u ? vec2(d.y, d.z) : (axis == 1u ? vec2(d.z, d.x) : vec2(d.x, d.y));
  vec2 cell = floor((aside / abs(along) + vec2(1.0f)) * (0.5f * float(edge)));
  cell = clamp(cell, vec2(0.0f), vec2(float(edge) - 1.0f));
  return ((2u * axis + (along < 0.0f ? 1u : 0u)) * edge + uint(cell.y)) * edge + uint(cell.x);
}
/// A point of a bin's square on the cube; `within` in (0, 1)^2.
IRAD_FN vec3 skyBinPoint(uint bin, vec2 within, uint edge) {
  uint face = bin / (edge * edge);
  vec2 cell = vec2(float(bin % edge), float(bin / edge % edge));
  vec2 aside = (cell + within) * (2.0f / float(edge)) - vec2(1.0f);
  float along = (face & 1u) == 0u ? 1.0f : -1.0f;
  if (face < 2u) return vec3(along, aside.x, aside.y);
  if (face < 4u) return vec3(aside.y, along, aside.x);
  return vec3(aside.x, aside.y, along);
}

/// What a ray that leaves the grid has met, and whether it is that.
IRAD_FN uint metSky(vec3 direction) { return TRACE_SKY + skyBin(direction, SKY_EDGE); }
IRAD_FN bool isSky(uint met) { return met >= TRACE_SKY && met < TRACE_SKY + (1u << SKY_BIN_BITS); }
/// The same of a ray that has met a point outside the grid.
IRAD_FN uint metOuter(uint point) { return TRACE_SKY + SKY_BINS + point; }
IRAD_FN bool isOuter(uint met) { return isSky(met) && met >= TRACE_SKY + SKY_BINS; }

/// Radiance over the sphere, equirectangular, top row first. Unturned the middle of the picture is -Z, the way that a
/// camera looks, and its right half is on the side of +X.
struct SkyPicture {
  Vec3Array texels;  ///< without a sun that shines as a light
  Vec3Array whole;   ///< with it, as one sees it
  uvec2 size;
  float turn;  ///< about +Y, as a share of a full turn
  vec3 scale;
};
IRAD_ARRAY(SkyRecord, SkyPicture, 8)

/// The texels around a direction, with their weights.
struct SkyTaps {
  uvec4 texel;
  vec4 weight;
};
IRAD_FN SkyTaps skyTaps(vec3 d, uvec2 size, float turn) {
  // At the poles any azimuth is right.
  float azimuth = d.x == 0.0f && d.z == 0.0f ? 0.0f : atan(d.x, -d.z);
  float u = azimuth * (0.5f / IRAD_PI) + 0.5f + turn;
  float v = acos(clamp(d.y, -1.0f, 1.0f)) * (1.0f / IRAD_PI);
  float x = (u - floor(u)) * float(size.x) - 0.5f;
  float y = clamp(v * float(size.y) - 0.5f, 0.0f, float(size.y) - 1.0f);
  float fx = x - floor(x), fy = y - floor(y);
  uint left = uint(floor(x) + float(size.x)) % size.x;
  uint right = (left + 1u) % size.x;
  uint top = min(uint(y), size.y - 1u);
  uint bottom = min(top + 1u, size.y - 1u);
  SkyTaps taps;
  taps.texel = uvec4(left, right, left, right) + size.x * uvec4(top, top, bottom, bottom);
  taps.weight =
      vec4((1.0f - fx) * (1.0f - fy), fx * (1.0f - fy), (1.0f - fx) * fy, fx * fy);
  return taps;
}

/// gi/gather_sky.comp: the irradiance that every facet gets from the sky.
struct GatherSkyPush {
  MatrixRecord matrix;
  Vec4Array bins;  ///< SKY_BINS: mean radiance
  Vec4Array sky;   ///< per facet; w: the rays' mean of (pi x radiance)^2, (W/m^2)^2
};

IRAD_END
#endif
