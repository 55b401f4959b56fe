// Light that comes straight from emissive faces, looked for by each pixel ("RE Emitters", sample.emitters = pixels):
// from the true outlines of the triangles instead of the voxels that they fall into.
#ifndef IRAD_SHARED_PIXEL_EMITTERS_H
#define IRAD_SHARED_PIXEL_EMITTERS_H
#include "shared/facets.h"
#include "shared/grid.h"
#include "shared/scene_gpu.h"
#include "shared/trace.h"
IRAD_BEGIN

/// A triangle of an emissive material, voxel units. It emits on the side that cross(edge1, edge2) points to, where it
/// is double-sided on both.
struct EmissiveTriangle {
  vec3 corner, edge1, edge2;
  vec3 exitance;  ///< M, W/m^2: the mean over the triangle
  uint doubleSided;
};
IRAD_ARRAY(EmissiveTriangleArray, EmissiveTriangle, 4)

/// Every pixel asks all of them, so a scene with more is left to the facets.
IRAD_CONST uint MAX_EMISSIVE_TRIANGLES = 256u;

/// Pushed to gi/emissive_triangles.comp.
struct EmissiveTrianglesPush {
  SceneArray scene;
  GridArray grid;
  EmissiveTriangleArray triangles;
  Vec4Array corners;  ///< of SurfaceArrays, if hasCorners
  uint first;         ///< triangle of the scene
  uint place;         ///< of that in `triangles`
  uint count;
  uint hasCorners;
};

/// Pushed to gi/emitters_seen.comp and gi/emitters_light.comp.
struct PixelEmittersPush {
  Grid grid;
  FacetRecord facets;
  SurfaceRecord surface;  ///< of rule `triangles`
  ByteArray chebyshev;
  EmissiveTriangleArray triangles;
  uint count;
  uint rays;
  float gain;  ///< the factor on F M in H
  uvec2 size;
  uint everywhere;  ///< or only where facets differ (shareOfPixel)
};

/// The angle whose tangent is y / x, both >= 0 and not both 0, to 3e-7 (GLSL's atan may err by 4096 ulp). Halved twice,
/// by tan(a / 2) = t / (1 + sqrt(1 + t^2)), which leaves at most pi / 16 for the power series.
IRAD_FN float arcTangent(float y, float x) {
  bool steep = y > x;
  float t = steep ? x / y : y / x;
  t = t / (1.0f + sqrt(1.0f + t * t));
  t = t / (1.0f + sqrt(1.0f + t * t));
  float t2 = t * t;
  float a = 4.0f * t * (1.0f - t2 * (1.0f / 3.0f - t2 * (1.0f / 5.0f - t2 * (1.0f / 7.0f - t2 * (1.0f / 9.0f)))));
  return steep ? 0.5f * IRAD_PI - a : a;
}

/// An edge's share of Lambert's formula (1760; Baum, Rushmeier and Winget 1989, "Improving radiosity solutions through
/// the use of analytically determined form-factors", eq. 4): the angle that it spans, seen from the origin, times the
/// cosine between the normal and that of its plane with the origin.
IRAD_FN float edgeShare(vec3 a, vec3 b, vec3 normal) {
  vec3 c = cross(a, b);
  float sine = length(c);
  if (!(sine > 0.0f)) return 0.0f;
  float cosine = max(sqrt(dot(a, a) * dot(b, b)) + dot(a, b), 0.0f);  // tan(angle / 2) = sin / (1 + cos)
  return 2.0f * arcTangent(sine, cosine) * dot(c, normal) / sine;
}

/// F from a point of a plane, the origin, to the triangle a, b, c as far as it is above that plane: E = F M,
/// unoccluded.
IRAD_FN float triangleFormFactor(vec3 a, vec3 b, vec3 c, vec3 normal) {
  float ha = dot(a, normal), hb = dot(b, normal), hc = dot(c, normal);
  uint above = (ha > 0.0f ? 1u : 0u) + (hb > 0.0f ? 1u : 0u) + (hc > 0.0f ? 1u : 0u);
  if (above == 0u) return 0.0f;
  float sum;
  if (above == 3u) {
    sum = edgeShare(a, b, normal) + edgeShare(b, c, normal) + edgeShare(c, a, normal);
  } else {
    // One corner is alone above or below the horizon; it becomes the first. p and q: where its edges cross it.
    bool alone = above == 1u;
    vec3 t = a;
    float ht = ha;
    if ((hb > 0.0f) == alone) {
      a = b, ha = hb, b = c, hb = hc, c = t, hc = ht;
    } else if ((hc > 0.0f) == alone) {
      a = c, ha = hc, c = b, hc = hb, b = t, hb = ht;
    }
    vec3 p = a + (b - a) * (ha / (ha - hb));
    vec3 q = a + (c - a) * (ha / (ha - hc));
    sum = alone ? edgeShare(a, p, normal) + edgeShare(p, q, normal) + edgeShare(q, a, normal)
                : edgeShare(p, b, normal) + edgeShare(b, c, normal) + edgeShare(c, q, normal) + edgeShare(q, p, normal);
  }
  return abs(sum) * (0.5f / IRAD_PI);
}

IRAD_END
#endif
