// The specular lobe: GGX microfacets, Smith's height-correlated masking-shadowing, Schlick's Fresnel (glTF 2.0,
// appendix B), and its visible normals (Heitz 2018). Vectors are unit; `alpha` is roughness squared.
#ifndef IRAD_SHARED_GGX_H
#define IRAD_SHARED_GGX_H
#include "shared/types.h"
IRAD_BEGIN

/// Lobes narrower than this are drawn as this wide for point-like lights, whose mirror image has no size.
IRAD_CONST float GGX_LEAST_ALPHA = 2e-3f;

IRAD_FN float ggxDistribution(float nh, float alpha) {
  float a2 = alpha * alpha;
  float d = (nh * a2 - nh) * nh + 1.0f;
  return a2 / (IRAD_PI * d * d);
}
/// G2 / (4 n.l n.v), height-correlated (Heitz 2014, eq. 99).
IRAD_FN float ggxVisibility(float nl, float nv, float alpha) {
  float a2 = alpha * alpha;
  float l = nv * sqrt(nl * nl * (1.0f - a2) + a2);
  float v = nl * sqrt(nv * nv * (1.0f - a2) + a2);
  return 0.5f / (l + v);
}
/// Smith's Lambda: G1 = 1 / (1 + Lambda).
IRAD_FN float ggxLambda(float cosine, float alpha) {
  float c2 = cosine * cosine;
  return 0.5f * (sqrt(1.0f + alpha * alpha * (1.0f - c2) / c2) - 1.0f);
}
IRAD_FN vec3 fresnelSchlick(vec3 f0, float vh) {
  float x = 1.0f - vh;
  float x2 = x * x;
  float x5 = x2 * x2 * x;
  return f0 + (vec3(1.0f) - f0) * x5;
}

/// A visible normal about +Z for the view vector `v` (v.z > 0); Heitz, "Sampling the GGX Distribution of Visible
/// Normals", JCGT 7(4), 2018. A ray reflected about it carries the weight F G2 / G1.
IRAD_FN vec3 ggxVisibleNormal(vec3 v, float alpha, vec2 u) {
  vec3 vh = normalize(vec3(alpha * v.x, alpha * v.y, v.z));
  float lensq = vh.x * vh.x + vh.y * vh.y;
  vec3 t1 = lensq > 0.0f ? vec3(-vh.y, vh.x, 0.0f) / sqrt(lensq) : vec3(1.0f, 0.0f, 0.0f);
  vec3 t2 = cross(vh, t1);
  float r = sqrt(u.x);
  float phi = 2.0f * IRAD_PI * u.y;
  float p1 = r * cos(phi);
  float p2 = r * sin(phi);
  float s = 0.5f * (1.0f + vh.z);
  p2 = (1.0f - s) * sqrt(1.0f - p1 * p1) + s * p2;
  float p3sq = 1.0f - p1 * p1 - p2 * p2;
  vec3 nh = t1 * p1 + t2 * p2 + vh * sqrt(p3sq > 0.0f ? p3sq : 0.0f);
  return normalize(vec3(alpha * nh.x, alpha * nh.y, nh.z > 1e-6f ? nh.z : 1e-6f));
}

/// G2 / G1 of a reflected ray: what is left of the weight besides F.
IRAD_FN float ggxWeight(float nl, float nv, float alpha) {
  float lv = ggxLambda(nv, alpha);
  return (1.0f + lv) / (1.0f + lv + ggxLambda(nl, alpha));
}

/// Directional albedo of the lobe under white light, fitted as f0 * x + y (Karis 2014, "Physically Based Shading on
/// Mobile").
IRAD_FN vec3 environmentBrdf(vec3 f0, float roughness, float nv) {
  float rx = 1.0f - roughness;
  float ry = 0.0425f - 0.0275f * roughness;
  float rz = 1.04f - 0.572f * roughness;
  float rw = 0.022f * roughness - 0.04f;
  float e = exp2(-9.28f * nv);
  float a004 = (rx * rx < e ? rx * rx : e) * rx + ry;
  float x = -1.04f * a004 + rz;
  float y = 1.04f * a004 + rw;
  return f0 * x + vec3(y > 0.0f ? y : 0.0f);
}

IRAD_END
#endif
